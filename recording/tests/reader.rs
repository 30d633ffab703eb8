//! What the reader understands.

use nonius_recording::{AdcSource, Overrides, Recording};

fn read_with(text: &str, overrides: &Overrides) -> Recording {
    Recording::read_from(text.as_bytes(), "r.csv", overrides).unwrap_or_else(|e| panic!("{e}"))
}

fn read(text: &str) -> Recording {
    read_with(text, &Overrides::default())
}

/// Rows of a slow turn, made by `row` from time, cos and sin.
fn rows(count: u32, row: impl Fn(f64, f64, f64) -> String) -> String {
    let row = |k| {
        let alpha = f64::from(k) * 0.05;
        row(f64::from(k) * 0.01, alpha.cos(), alpha.sin())
    };
    (0..count).map(|k| row(k) + "\n").collect()
}

fn plain(head: &str) -> String {
    let rows = rows(100, |t, c, s| format!("{t:.2},{c:.4},{s:.4}"));
    format!("{head}time_s,cos,sin\n{rows}")
}

#[test]
fn every_column_finds_its_place() {
    let rows = rows(100, |t, c, s| {
        format!("{s:.4},{t:.2},21.5,{:.4},{c:.4},note,7", -5.0 * t)
    });
    let recording = read(&format!(
        "sin,time_s,temperature_c,reference_rad,cos,remark,x\n{rows}"
    ));
    assert_eq!(recording.samples(), 100);
    assert_eq!(recording.cos[0], 1.0);
    assert_eq!(recording.sin[1], 0.05);
    assert_eq!(recording.metadata.sample_rate_hz, 100.0);
    assert_eq!(
        recording.temperature_c.as_ref().expect("temperatures")[99],
        21.5
    );
    assert!((recording.reference_rad.as_ref().expect("a reference")[99] + 4.95).abs() < 1e-9);
    assert_eq!(recording.other("x").expect("the column"), [7.0; 100]);
    assert!(
        recording
            .other("remark")
            .expect("the column")
            .iter()
            .all(|v| v.is_nan())
    );
    assert_eq!(recording.other("y"), None);
}

#[test]
fn semicolons_decimal_commas_marks_quotes_and_blank_ends_are_understood() {
    let comma = |v: f64| format!("{v:.4}").replace('.', ",");
    let rows = rows(50, |t, c, s| {
        format!(" \"{}\" ; {};{}\r", comma(t), comma(c), comma(s))
    });
    let head = "\u{feff}# scale_period_m: 0,002;;\r\n\r\n\"time_s\"; cos ;sin\r\n";
    let recording = read(&format!("{head}{rows}\r\n;;\r\n\r\n"));
    assert_eq!(recording.samples(), 50);
    assert_eq!(recording.sin[1], 0.05);
    assert_eq!(recording.metadata.scale_period_m, Some(0.002));
    assert_eq!(
        recording.notes.len(),
        1,
        "only the ADC: {:?}",
        recording.notes
    );
}

#[test]
fn blank_lines_inside_are_skipped_and_said() {
    let text = plain("").replacen("\n0.50,", "\n\n0.50,", 1);
    let recording = read(&text);
    assert_eq!(recording.samples(), 100);
    let said = "blank lines among the samples were skipped, the first is line 52";
    assert!(
        recording.notes.iter().any(|n| n == said),
        "{:?}",
        recording.notes
    );
}

#[test]
fn the_rate_serves_where_there_is_no_time() {
    let rows = rows(100, |_, c, s| format!("{c:.4},{s:.4}"));
    let recording = read(&format!("# sample_rate_hz: 50\ncos,sin\n{rows}"));
    assert_eq!(recording.time_s[99], 1.98);
    assert_eq!(recording.metadata.sample_rate_hz, 50.0);
    let overrides = Overrides {
        sample_rate_hz: Some(200.0),
        ..Overrides::default()
    };
    let recording = read_with(
        &format!("# sample_rate_hz: 50\ncos,sin\n{rows}"),
        &overrides,
    );
    assert_eq!(recording.metadata.sample_rate_hz, 200.0);
}

#[test]
fn time_wins_over_the_rate_and_says_so() {
    let recording = read(&plain("# sample_rate_hz: 120\n"));
    assert_eq!(recording.metadata.sample_rate_hz, 100.0);
    let said = "times and sample_rate_hz disagree: 100 Hz and 120 Hz; the times win";
    assert_eq!(recording.notes[0], said);
    assert_eq!(read(&plain("# sample_rate_hz: 100\n")).notes.len(), 1);
}

#[test]
fn metadata_is_read_and_the_command_line_wins() {
    let head = "# made on a bench\n# Operator: N. N.\n# adc_bits: 12\n# full_scale: 2\n\
                # periods_per_revolution: 1024\n";
    let recording = read(&plain(head));
    assert_eq!(recording.metadata.periods_per_revolution, Some(1024));
    assert_eq!(
        recording.metadata.other,
        [("Operator".to_owned(), "N. N.".to_owned())]
    );
    let adc = recording.metadata.adc.cos;
    assert_eq!(
        (adc.bits, adc.lsb, adc.source),
        (12, 4.0 / 4096.0, AdcSource::Described)
    );
    let overrides = Overrides {
        adc_bits: Some(10),
        full_scale: Some(4.0),
        periods_per_revolution: Some(3),
        ..Overrides::default()
    };
    let recording = read_with(&plain(head), &overrides);
    assert_eq!(recording.metadata.periods_per_revolution, Some(3));
    let adc = recording.metadata.adc.sin;
    assert_eq!((adc.bits, adc.full_scale()), (10, 4.0));
}

#[test]
fn a_key_nearly_right_is_said() {
    let recording = read(&plain("# sample_rate: 100\n"));
    let said =
        "'sample_rate' in line 1 is not a known key and was ignored; was sample_rate_hz meant?";
    assert_eq!(recording.notes[0], said);
}

#[test]
fn a_row_of_zeros_a_gap_and_repeated_samples_are_data() {
    let text = "time_s,cos,sin\n-0.01,0,0\n".to_owned()
        + &rows(100, |t, c, s| {
            let t = if t > 0.5 { t + 3.0 } else { t };
            format!("{t:.2},{c:.4},{s:.4}")
        });
    assert_eq!(read(&text).metadata.sample_rate_hz, 100.0);
    let doubled: String = plain("").lines().map(|l| format!("{l}\n")).collect();
    let doubled = doubled.replacen("0.30,", "0.30,0.0707,0.9975\n0.30,", 1);
    let twice = doubled.replace("0.30,0.0707,0.9975\n0.30,0.0707,0.9975", "X");
    assert!(twice.contains('X'), "the row is there twice");
    assert_eq!(read(&doubled).samples(), 101);
    let held = plain("").replace("0.31,0.0208,0.9998", "0.31,0.0707,0.9975");
    assert_eq!(read(&held).samples(), 100);
}

#[test]
fn a_wrapped_reference_becomes_continuous() {
    let rows = rows(400, |t, c, s| {
        let angle = (-9.0 * t).rem_euclid(std::f64::consts::TAU);
        format!("{t:.2},{c:.4},{s:.4},{angle:.6}")
    });
    let reference = read(&format!("time_s,cos,sin,reference_rad\n{rows}"))
        .reference_rad
        .expect("a reference");
    assert!((reference[399] - reference[0] + 9.0 * 3.99).abs() < 1e-5);
}

#[test]
fn samples_in_memory_make_a_recording() {
    let time: Vec<f64> = (0..64).map(f64::from).collect();
    let cos: Vec<f64> = time.iter().map(|t| (t / 9.0).cos()).collect();
    let sin: Vec<f64> = time.iter().map(|t| (t / 9.0).sin()).collect();
    let none = Overrides::default();
    let recording = Recording::from_samples(time.clone(), cos.clone(), sin.clone(), &none)
        .expect("samples that make a recording");
    assert_eq!(recording.metadata.adc.cos.source, AdcSource::Assumed);
    let short = Recording::from_samples(time, cos, sin[1..].to_vec(), &none)
        .expect_err("columns of unequal length");
    assert!(short.to_string().contains("[64, 64, 63]"), "{short}");
}

#[test]
fn a_million_rows_are_read_in_good_time() {
    let text = "cos,sin\n".to_owned()
        + &(0..1_000_000)
            .map(|k| f64::from(k) * 0.001)
            .map(|a| format!("{:.6},{:.6}\n", a.cos(), a.sin()))
            .collect::<String>();
    let overrides = Overrides {
        sample_rate_hz: Some(1e5),
        ..Overrides::default()
    };
    let start = std::time::Instant::now();
    let recording = read_with(&text, &overrides);
    assert_eq!(recording.samples(), 1_000_000);
    // Some 0.5 s on a busy core; quadratic behaviour would take hours.
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}
