//! A testbench that cannot fail is worthless: single faults in the Verilog, and the vectors catch each.

mod chip;

use std::path::Path;

use chip::optical;
use nonius_hdl::verify::{Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use rayon::prelude::*;

/// As `nonius build` writes them.
const ROWS: usize = nonius_package::ROWS;

/// The files of a chip.
fn files(spec: &Spec) -> Files {
    let design = Design::new(spec).expect("a design that works");
    let package = nonius_package::package(&design, ROWS).expect("a package");
    assert!(verdict(&package.files).0, "the chip without a fault");
    package.files
}

type Files = Vec<(String, Vec<u8>)>;

fn text(files: &Files, path: &str) -> String {
    let file = files.iter().find(|f| f.0 == path).expect("a file");
    String::from_utf8(file.1.clone()).expect("text")
}

/// The same with `text` at `path`.
fn altered(files: &Files, path: &str, text: &str) -> Files {
    let mut files = files.clone();
    let file = files.iter_mut().find(|f| f.0 == path).expect("a file");
    assert_ne!(file.1, text.as_bytes(), "nothing is altered");
    file.1 = text.into();
    files
}

fn verdict(files: &Files) -> (bool, String) {
    let dir = tempfile::tempdir().expect("scratch folder");
    nonius_package::write(files, dir.path()).expect("a folder");
    let options = Options {
        verilator: false,
        stop_at_first: true,
        ..Options::default()
    };
    let report = verify(dir.path(), &options, &nonius_hdl::progress::silent)
        .unwrap_or_else(|e| panic!("{e}"));
    let failure = report.runs[0].failure.clone().unwrap_or_default();
    (report.passed, failure)
}

/// What is caught, on the page of figures.
fn kept(place: &str, faults: usize) {
    nonius_kept::figure(
        Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/figures.md")),
        &format!("faults planted in {place}, caught by the vectors"),
        &format!("{faults} of {faults}"),
        "hdl/tests/planted_faults.rs",
    );
}

/// The vectors see each of these in the chip, and say where.
fn all_caught(place: &str, files: &Files, rtl: &str, faults: &[Fault]) {
    let sound = text(files, rtl);
    let faulty: Vec<_> = faults
        .iter()
        .map(|(n, change)| (n, change(&sound)))
        .collect();
    faulty.par_iter().for_each(|(name, faulty)| {
        let (passed, failure) = verdict(&altered(files, rtl, faulty));
        assert!(!passed, "{name}: not caught");
        assert!(failure.contains("signal"), "{name}: {failure}");
    });
    kept(place, faults.len());
}

/// The one line that holds all of `words`.
fn line_with<'a>(verilog: &'a str, words: &[&str]) -> &'a str {
    let mut lines = verilog
        .lines()
        .filter(|line| words.iter().all(|word| line.contains(word)));
    let found = lines.next();
    assert!(lines.next().is_none(), "{words:?} stand in two lines");
    found.unwrap_or_else(|| panic!("no line holds {words:?}"))
}

fn replaced(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    assert!(line.contains(from), "{from} is not in {line}");
    verilog.replacen(line, &line.replacen(from, to, 1), 1)
}

/// The text between `from` and `to` in the one line that holds all of `words`.
fn between(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    let rest = line.split_once(from).map(|parts| parts.1);
    let inner = rest.and_then(|rest| rest.split_once(to));
    inner.unwrap_or_else(|| panic!("{line}")).0.to_owned()
}

/// The chip that commits some steps late or early.
fn another_last_step(verilog: &str, by: i32) -> String {
    let step = between(verilog, &["wire last ="], "5'd", ";");
    let other = step.parse::<i32>().expect("a number") + by;
    replaced(verilog, &["wire last ="], &step, &other.to_string())
}

/// The chip that rounds `name` to the nearest, but exact halves down in place of up.
fn half_down(verilog: &str, name: &str) -> String {
    let words = ["wire", &format!(" {name}_rounded =")];
    let guard = between(verilog, &words, "'b0, ", "};");
    let (signal, bit) = guard.trim_end_matches(']').split_once('[').expect("a bit");
    let below = bit.parse::<u32>().expect("a number") - 1;
    let down = format!("{guard} & (|{signal}[{below}:0])");
    replaced(
        verilog,
        &words,
        &format!("{guard}}};"),
        &format!("{down}}};"),
    )
}

type Fault = (&'static str, Box<dyn Fn(&str) -> String>);

fn fault(name: &'static str, change: fn(&str) -> String) -> Fault {
    (name, Box::new(change))
}

/// Of the one line that holds all of `words`, `from` becomes `to`.
fn swap(
    name: &'static str,
    words: &'static [&'static str],
    from: &'static str,
    to: &'static str,
) -> Fault {
    (name, Box::new(move |v| replaced(v, words, from, to)))
}

/// Faults in the Verilog, each of one place.
fn faults() -> Vec<Fault> {
    vec![
        swap(
            "rounding of the phase error: by the wrong bit",
            &["wire", " e_seen_rounded ="],
            "e_exact[15]}",
            "e_exact[14]}",
        ),
        swap(
            "rounding of c: cut off",
            &["wire", " c_rounded ="],
            "c_exact[10]",
            "1'b0",
        ),
        swap(
            "rounding of theta_1: cut off",
            &["wire", " theta_1_rounded ="],
            "200 +",
            "000 +",
        ),
        swap(
            "half of theta_1's last bit rounds down",
            &["wire", " theta_1_rounded ="],
            "5000200 +",
            "50001ff +",
        ),
        fault("half of theta_5's last bit rounds down", |v| {
            half_down(v, "theta_5")
        }),
        fault("half of c's last bit rounds down", |v| half_down(v, "c")),
        fault("half of s's last bit rounds down", |v| half_down(v, "s")),
        fault("half of e_seen's last bit rounds down", |v| {
            half_down(v, "e_seen")
        }),
        fault("half of rho_c's last bit rounds down", |v| {
            half_down(v, "rho_c")
        }),
        fault("half of rho_s's last bit rounds down", |v| {
            half_down(v, "rho_s")
        }),
        fault("saturation of s: wraps", |v| {
            let kept = between(v, &["wire", " s_now = "], "? ", " :");
            let all = between(v, &["wire", " s_now = "], "= ", ";");
            replaced(v, &["wire", " s_now = "], &all, &kept)
        }),
        fault("saturation of theta_2: wraps", |v| {
            let words = ["wire", " theta_2_deviation_next_bits = "];
            let kept = between(v, &words, "? ", " :");
            let all = between(v, &words, "= ", ";");
            replaced(v, &words, &all, &kept)
        }),
        swap(
            "saturation of theta_4: at the other end",
            &["wire", " theta_4_deviation_next_bits = "],
            "{24{~",
            "{24{",
        ),
        swap(
            "sign extension of a product",
            &["wire", " sin_magnitude_sum ="],
            "{{7{sin_slope_times_sin_inside[24]}}",
            "{7'b0",
        ),
        swap(
            "sign extension of the speed",
            &["wire", " alpha_hat_sum ="],
            "{{3{speed[25]}}",
            "{3'b0",
        ),
        swap(
            "logical shift in place of the arithmetic one",
            &["wire", " kick_shifted ="],
            ">>>",
            ">>",
        ),
        fault("latency: one clock more", |v| another_last_step(v, 1)),
        fault("latency: a register committed one step early", |v| {
            another_last_step(v, -1)
        }),
        swap(
            "a chip that does not wait for samples",
            &["wire start ="],
            " & sample_valid",
            "",
        ),
        swap(
            "a sample that an early strobe begins anew",
            &["wire start ="],
            "(step == 5'd0) & sample_valid",
            "sample_valid",
        ),
        swap(
            "valid longer than a clock",
            &["valid <= last"],
            "last",
            "last | (valid & (step == 5'd0) & ~sample_valid)",
        ),
        swap(
            "a step counter that runs by itself",
            &["else if (start |"],
            "else if (start | (step != 5'd0))",
            "else",
        ),
        swap(
            "last bit of the coefficient a",
            &["operand_", "sh1cf1c"],
            "sh1cf1c",
            "sh1cf1d",
        ),
        swap(
            "last bit of the coefficient a + b",
            &["operand_", "sh13b1b"],
            "sh13b1b",
            "sh13b1a",
        ),
        swap(
            "last bit of the lock limit",
            &["wire in_window_now ="],
            "6'sd7",
            "6'sd8",
        ),
        swap(
            "last bit of the limit that begins again",
            &["wire residual_large_condition_7_now ="],
            "< 4'sd1)",
            "< 4'sd2)",
        ),
        swap(
            "last bit of the limit that holds",
            &["wire residual_large_condition_3_now ="],
            "~rho_now[17:12]) < 6'sd1)",
            "~rho_now[17:12]) < 6'sd2)",
        ),
        swap(
            "direction forwards from twice the speed on",
            &["wire speed_below_direction_rate_now ="],
            "< 15'sd1;",
            "< 15'sd2;",
        ),
        swap(
            "sectors counted again by turning back behind",
            &["wire sector_behind_condition_now ="],
            " & behind_used",
            " & 1'b0",
        ),
        swap(
            "sectors counted again by turning back ahead",
            &["wire sector_ahead_now ="],
            " & ahead_used",
            " & 1'b0",
        ),
        swap(
            "turning back that is never forgotten",
            &["wire behind_used_next_now ="],
            "(whole_period_now | sector_behind)",
            "whole_period_now",
        ),
        fault(
            "parameters of the next sample at the ports too early",
            |v| {
                let idle = "if (start) begin\n            upper_half <=";
                assert_eq!(v.matches(idle).count(), 1);
                v.replace(idle, &idle.replace("start", "step == 5'd0"))
            },
        ),
        fault("a stale operand", |v| {
            let forwarded = |line: &&str| line.contains("operand_") && line.ends_with("_now;");
            let line = v.lines().find(forwarded).expect("a forwarded operand");
            v.replacen(line, &line.replace("_now;", ";"), 1)
        }),
    ]
}

/// Faults in the correction of channel skew.
fn skew_faults() -> Vec<Fault> {
    vec![
        swap(
            "skew taken the other way round",
            &["wire", " s_difference_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "half of the skew's product left out of the second order",
            &["wire", " s_between_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "skew before lock",
            &["wire", " skew_chosen ="],
            "locked ?",
            "1'b1 ?",
        ),
        swap(
            "phase of the sensor with the wrong sign",
            &["wire", " skew_slope_difference_now ="],
            " - ",
            " + ",
        ),
    ]
}

/// Faults in the correction of stored harmonics.
fn harmonic_faults() -> Vec<Fault> {
    vec![
        swap(
            "harmonics of the cosine added",
            &["wire", " c_difference ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "harmonics of the sine added",
            &["wire", " s_difference_2_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "phase correction of the harmonics the other way round",
            &["wire", " s_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "second order of the phase correction with the wrong sign",
            &["wire", " harmonic_through ="],
            "} + {{",
            "} - {{",
        ),
        swap(
            "expanded about the segment's beginning",
            &["wire", " harmonic_inside_now ="],
            "'sh400;",
            "'sh000;",
        ),
    ]
}

/// Faults in the recall.
fn recall_faults() -> Vec<Fault> {
    vec![
        swap(
            "recall before the last gear",
            &["wire recall_now ="],
            " & recall_condition",
            "",
        ),
        swap(
            "recall of what is recent",
            &["wire", " theta_2_deviation_next ="],
            "recall ? proven_2",
            "recall ? recent_2",
        ),
        swap(
            "no recall of the phase",
            &["wire", " theta_5_deviation_next ="],
            "recall ?",
            "1'b0 ?",
        ),
        swap(
            "what is recent is proven in recall",
            &["wire remember_now ="],
            " & ~recall_now",
            "",
        ),
        swap(
            "held for a period only",
            &["wire returning_next_now ="],
            "recall_now &",
            "1'b0 &",
        ),
        swap(
            "quiet periods counted from before the loss",
            &["wire gear_periods_again ="],
            " | travel_clear_condition",
            "",
        ),
    ]
}

#[test]
fn vectors_catch_every_fault_in_the_recall() {
    let variant = &chip::shipped::variants::recalls()[1];
    let files = files(&variant.spec);
    all_caught("the recall", &files, RTL, &recall_faults());
}

#[test]
fn vectors_catch_every_fault_in_the_correction_of_harmonics() {
    let mut spec = optical();
    spec.correction.harmonics = chip::shipped::variants::third_and_fifth();
    let files = files(&spec);
    all_caught(
        "the correction of harmonics",
        &files,
        RTL,
        &harmonic_faults(),
    );
    // One entry of the table: first, last and some between, in each column.
    let path = "coefficients/harmonic_table.mem";
    let design = Design::new(&spec).expect("a design that works");
    let table = &design.structure.harmonics.as_ref().expect("a table").table;
    let widths = table.columns.iter().map(|c| c.format.width);
    let ends: Vec<u32> = widths
        .rev()
        .scan(0, |end, width| {
            *end += width;
            Some(*end)
        })
        .collect();
    let last = table.rows() - 1;
    // Two bits below the sign: what the vectors, which meet each row some times, cannot miss.
    let faults = [(0, ends[0]), (last, ends[1]), (13, ends[2]), (137, ends[3])];
    let faults = faults.map(|(row, end)| (row, end - 3));
    rows_caught("the table of harmonics", &files, path, &faults);
}

/// The vectors see one bit (row, bit) turned over in each of these rows of a table.
fn rows_caught(place: &str, files: &Files, path: &str, faults: &[(usize, u32)]) {
    let sound = text(files, path);
    faults.par_iter().for_each(|&(row, bit)| {
        let mut rows: Vec<String> = sound.lines().map(ToOwned::to_owned).collect();
        let word = u128::from_str_radix(&rows[row], 16).expect("hex") ^ (1 << bit);
        rows[row] = format!("{word:0digits$x}", digits = rows[row].len());
        let (passed, _) = verdict(&altered(files, path, &(rows.join("\n") + "\n")));
        assert!(!passed, "row {row}, bit {bit}: not caught");
    });
    kept(place, faults.len());
}

const RTL: &str = "rtl/optical.v";
const TABLE: &str = "coefficients/sine_table.mem";

#[test]
fn vectors_catch_every_fault_in_the_correction_of_skew() {
    let mut spec = optical();
    spec.correction.channel_skew_s = 1e-7;
    all_caught("the correction of skew", &files(&spec), RTL, &skew_faults());
}

#[test]
fn vectors_catch_every_planted_fault() {
    all_caught("the Verilog", &files(&optical()), RTL, &faults());
}

/// One entry of the table: first, last and some between, the last bit of value or slope.
#[test]
fn vectors_catch_every_fault_in_the_table() {
    let files = files(&optical());
    let last = text(&files, TABLE).lines().count() - 1;
    let faults = [(0, 14), (last, 0), (13, 14), (37, 0)];
    rows_caught("the sine table", &files, TABLE, &faults);
}
