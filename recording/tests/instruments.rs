//! Files as instruments write them: lines about themselves first, units in a row or in the names, tabs, other names.

use nonius_recording::{Overrides, Recording};

/// Rows of 100 samples a millisecond apart, from time in seconds, cos and sin.
fn rows(row: impl Fn(usize, f64, f64, f64) -> String) -> String {
    let row = |k: usize| {
        let alpha = k as f64 * 0.1;
        row(k, k as f64 * 1e-3, alpha.cos(), alpha.sin()) + "\r\n"
    };
    (0..100).map(row).collect()
}

fn columns(time: Option<&str>, cos: &str, sin: &str) -> Overrides {
    Overrides {
        time_column: time.map(str::to_owned),
        cos_column: Some(cos.to_owned()),
        sin_column: Some(sin.to_owned()),
        ..Overrides::default()
    }
}

fn read(text: &str, overrides: &Overrides) -> Result<Recording, String> {
    Recording::read_from(text.as_bytes(), "r.csv", overrides).map_err(|e| e.to_string())
}

/// A hundred samples at 1 kHz, the cosine first; what is said of it, but for the ADC.
fn is_read(text: &str, overrides: &Overrides) -> Vec<String> {
    let recording = read(text, overrides).unwrap_or_else(|e| panic!("{e}\n{text:.300}"));
    assert_eq!(recording.samples(), 100);
    let rate = recording.metadata.sample_rate_hz;
    assert!((rate / 1000.0 - 1.0).abs() < 1e-9, "{rate}");
    assert!((recording.cos[10] / recording.cos[0] - 1f64.cos()).abs() < 1e-3);
    let notes = recording.notes.into_iter();
    notes.filter(|note| !note.contains("ADC")).collect()
}

#[test]
fn a_row_of_units_and_a_blank_line() {
    let body =
        rows(|_, t, c, s| format!("{:.4},{:.3},{:.3}", 1e3 * t - 10.0, 500.0 * c, 500.0 * s));
    let text = format!("Time,Channel A,Channel B\r\n(ms),(mV),(mV)\r\n\r\n{body}");
    let notes = is_read(&text, &columns(Some("Time"), "Channel A", "Channel B"));
    assert!(notes.is_empty(), "{notes:?}");
}

/// Its extra columns have a value in the row of units only, and the first column counts.
#[test]
fn a_row_of_units_with_more_cells_than_the_samples() {
    let body = rows(|k, _, c, s| format!("{k},{c:.4},{s:.4},"));
    let text =
        format!("X,CH1,CH2,Start,Increment,\r\nSequence,Volt,Volt,-3.0e-02,1.0e-03\r\n{body}");
    let overrides = Overrides {
        sample_rate_hz: Some(1000.0),
        ..columns(None, "CH1", "CH2")
    };
    is_read(&text, &overrides);
    let plain = text.replacen("Sequence,Volt,Volt,-3.0e-02,1.0e-03\r\n", "", 1);
    let error = read(&plain, &overrides).expect_err("short rows");
    assert!(error.contains("4 cells where the header has 6"), "{error}");
}

#[test]
fn lines_about_the_instrument_come_first() {
    let body = rows(|_, t, c, s| format!("{t:.4e},{c:.4},{s:.4}"));
    let head = "Model,X1\nFirmware Version,1.52\n\nSample Interval,1e-3,,\nLabel,,,\n";
    let text = format!("{head}TIME,CH1,CH2\n{body}");
    let notes = is_read(&text, &columns(Some("TIME"), "CH1", "CH2"));
    let said = [
        "the header is line 6: lines 1 to 5 were not read, but for `# key: value`",
        "the column 'TIME' has no unit and is taken to be in seconds",
    ];
    assert_eq!(notes, said);
    // With other names the line with most columns is the header that has them not.
    let error = read(&text, &columns(None, "CH3", "CH4")).expect_err("other names");
    let said =
        "r.csv:6: there is no column 'CH3' (nearest: 'CH2'); the columns are 'TIME', 'CH1', 'CH2'";
    assert!(error.starts_with(said), "{error}");
    // Of a hundred lines, not more.
    let long = format!("{}TIME,CH1,CH2\n{body}", "Remark,x\n".repeat(100));
    is_read(&long, &columns(Some("TIME"), "CH1", "CH2"));
    let longer = format!("Remark,x\n{long}");
    let error = read(&longer, &columns(Some("TIME"), "CH1", "CH2")).expect_err("too far");
    assert!(error.starts_with("r.csv:1: there is no column"), "{error}");
}

/// The lines first, and the units.
#[test]
fn both() {
    let body = rows(|_, t, c, s| format!("{t:.4},{c:.4},{s:.4}"));
    let text = format!(
        "Record Length,100,,\nVertical Units,V,V\nSource,CH1,CH2\nSecond,Volt,Volt\n{body}"
    );
    let notes = is_read(&text, &columns(Some("Source"), "CH1", "CH2"));
    assert_eq!(
        notes,
        ["the header is line 3: lines 1 to 2 were not read, but for `# key: value`"]
    );
    let one = text.replacen("Record Length,100,,\n", "", 1);
    let notes = is_read(&one, &columns(Some("Source"), "CH1", "CH2"));
    assert_eq!(
        notes,
        ["the header is line 2: line 1 was not read, but for `# key: value`"]
    );
    let text = format!("x-axis,1,2\nsecond,Volt,Volt\n{body}");
    assert!(is_read(&text, &columns(Some("x-axis"), "1", "2")).is_empty());
}

#[test]
fn units_in_the_names() {
    let body = rows(|_, t, c, s| format!("{:.1},{c:.4},{s:.4}", 1e6 * t));
    for time in ["Time (us)", "Time [µs]", "time_us"] {
        let text = format!("#Device Name: A\n#Serial Number: 1\n\n{time},1,2\n{body}");
        let notes = is_read(&text, &columns(Some(time), "1", "2"));
        assert!(notes.is_empty(), "{notes:?}");
    }
    let text = format!("in us,C1 in V,C2 in V\n{body}");
    is_read(&text, &columns(Some("in us"), "C1 in V", "C2 in V"));
}

/// What stands in the way of the header is told, and not that an earlier line is none.
#[test]
fn what_is_wrong_behind_a_preamble() {
    let body = rows(|_, t, c, s| format!("{t:.4},{c:.4},{s:.4}"));
    let with = |head: &str| {
        let overrides = columns(Some("TIME"), "CH1", "CH2");
        read(&format!("Model,X1\n{head}\n{body}"), &overrides).expect_err("refused")
    };
    let error = with("TIME,CH1,CH2,Label,Label");
    assert!(
        error.starts_with("r.csv:2:20: the column 'Label' is there twice"),
        "{error}"
    );
    let error = with("TIME,\"CH1,CH2");
    assert!(error.starts_with("r.csv:2:6: the quote"), "{error}");
    let bytes = [&b"Model,X1\nTIME,CH1 (\xB5V),CH2\n"[..], body.as_bytes()].concat();
    let read = Recording::read_from(&bytes[..], "r.csv", &columns(Some("TIME"), "CH1", "CH2"));
    let error = read.expect_err("Latin-1").to_string();
    assert!(
        error.starts_with("r.csv:2:11: the text is not UTF-8"),
        "{error}"
    );
}

#[test]
fn tabs_and_empty_cells() {
    let body = rows(|_, t, c, s| format!("{t:.4}\t\t\"{c:.4}\"\t{s:.4}\t 7"));
    let text = format!("time_s\tnote\tcos\tsin\tother\n{body}");
    assert!(is_read(&text, &Overrides::default()).is_empty());
}

#[test]
fn tabs_with_decimal_commas() {
    let comma = |v: f64| format!("{v:.4}").replace('.', ",");
    let body = rows(|_, t, c, s| format!("{}\t{}\t{}", comma(t), comma(c), comma(s)));
    let text = format!("time_s\tcos\tsin\n{body}");
    assert!(is_read(&text, &Overrides::default()).is_empty());
}

#[test]
fn what_is_no_row_of_units_is_a_wrong_row() {
    let body = rows(|_, t, c, s| format!("{t:.4},{c:.4},{s:.4}"));
    let with = |row: &str| {
        read(
            &format!("time_s,cos,sin\n{row}\n{body}"),
            &Overrides::default(),
        )
    };
    let error = with("s,V,mV").expect_err("two units");
    assert!(
        error.starts_with("r.csv:2:5: the signals have the units 'v' and 'mv'"),
        "{error}"
    );
    let text = format!("time_s,C1 (mV),C2 (V)\n{body}");
    let error = read(&text, &columns(None, "C1 (mV)", "C2 (V)")).expect_err("two units");
    assert!(
        error.starts_with("r.csv:1: the signals have the units 'mv' and 'v'"),
        "{error}"
    );
    let error = with("fortnights,V,V").expect_err("no unit of time");
    assert!(
        error.starts_with("r.csv:2:1: 'fortnights' in the column 'time_s'"),
        "{error}"
    );
    let error = with("s,NaN,V").expect_err("no unit");
    assert!(
        error.starts_with("r.csv:2:1: 's' in the column 'time_s'"),
        "{error}"
    );
    let error = with("s,V,V\ns,V,V").expect_err("one is enough");
    assert!(error.starts_with("r.csv:3:1: 's' in the column"), "{error}");
    let overrides = columns(Some("when"), "cos", "sin");
    let error = read(&format!("time_s,cos,sin\n{body}"), &overrides).expect_err("no column");
    assert!(
        error.contains("no column 'when'") && error.contains("--time COLUMN"),
        "{error}"
    );
    for (name, option) in [("cos", "--cos"), ("reference_rad", "--time")] {
        let text = format!("reference_rad,cos,sin\n{body}");
        let error = read(&text, &columns(Some(name), "cos", "sin")).expect_err("twice");
        let said =
            format!("the column '{name}' has a fixed meaning; give another column with {option}");
        assert!(error.contains(&said), "{error}");
    }
    let text = format!("Time (s),cos,sin\nms,V,V\n{body}");
    let notes = read(&text, &columns(Some("Time (s)"), "cos", "sin"))
        .expect("milliseconds")
        .notes;
    assert!(
        notes[0].contains("another unit of time than the name"),
        "{notes:?}"
    );
}
