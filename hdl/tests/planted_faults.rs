//! A testbench that cannot fail is worthless: single faults in the Verilog, and the vectors catch each.

mod chip;
#[path = "planted_faults/edit.rs"]
mod edit;
#[path = "planted_faults/faults.rs"]
mod faults;
#[path = "planted_faults/recall.rs"]
mod recall;

use std::sync::LazyLock;

use chip::optical;
use edit::{Fault, on_one_line};
use faults::{faults, harmonic_faults, skew_faults};
use nonius_hdl::verify::{Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_testvectors::stimulus;
use rayon::prelude::*;
use recall::{moved_faults, recall_faults};

/// As `nonius build` writes them.
const ROWS: usize = nonius_package::ROWS;
const RTL: &str = "rtl/optical.v";
const TABLE: &str = "coefficients/sine_table.mem";

/// What most faults stumble over, first: the same vectors in another order.
const FIRST: [&str; 7] = ["loss", "bounds", "ties", "random", "fade", "vanish", "weak"];

/// The files of a chip, which has no fault.
fn files(spec: &Spec) -> Files {
    let design = Design::new(spec).expect("a design that works");
    let mut stimuli = stimulus::named(&design, ROWS);
    stimuli.sort_by_key(|one| {
        FIRST
            .iter()
            .position(|name| one.name == *name)
            .unwrap_or(FIRST.len())
    });
    let package = nonius_package::package_with(&design, stimuli, "sweep").expect("a package");
    // All rows are soonest through Verilator; a fault is soonest found in Icarus.
    let all = Options {
        icarus: false,
        ..Options::PATIENT
    };
    let (passed, failure) = verdict(&package.files, &all);
    assert!(passed, "the chip without a fault: {failure}");
    package.files
}

/// Those of the shipped design, which holds as many periods as its rows have: else the search never begins again.
static OPTICAL: LazyLock<Files> = LazyLock::new(|| {
    let mut spec = optical();
    spec.calibration.hold_periods = Some(40);
    files(&spec)
});

const UNTIL_IT_FAILS: Options = Options {
    verilator: false,
    stop_at_first: true,
    ..Options::PATIENT
};

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

fn verdict(files: &Files, options: &Options) -> (bool, String) {
    let dir = tempfile::tempdir().expect("scratch folder");
    nonius_package::write(files, dir.path()).expect("a folder");
    let report = verify(dir.path(), options, &nonius_hdl::progress::silent)
        .unwrap_or_else(|e| panic!("{e}"));
    let failure = report.runs[0].failure.clone().unwrap_or_default();
    (report.passed, failure)
}

/// What is caught, on the page of figures.
fn kept(place: &str, faults: usize) {
    nonius_kept::figure(
        &format!("faults planted in {place}, caught by the vectors"),
        &format!("{faults} of {faults}"),
        "hdl/tests/planted_faults.rs",
    );
}

/// The vectors see each of these in the chip, and say where.
fn all_caught(place: &str, files: &Files, rtl: &str, faults: &[Fault]) {
    let sound = on_one_line(&text(files, rtl));
    let faulty = faults.iter().map(|(name, change)| {
        let faulty = change(&sound);
        assert_ne!(faulty, sound, "{name}: nothing is altered");
        (name, faulty)
    });
    let faulty: Vec<_> = faulty.collect();
    faulty.par_iter().for_each(|(name, faulty)| {
        let (passed, failure) = verdict(&altered(files, rtl, faulty), &UNTIL_IT_FAILS);

        assert!(!passed, "{name}: not caught");
        assert!(failure.contains("signal"), "{name}: {failure}");
    });
    kept(place, faults.len());
}

#[test]
fn vectors_catch_every_fault_in_the_recall() {
    let variant = &chip::shipped::variants::recalls()[1];
    let files = files(&variant.spec);
    all_caught("the recall", &files, RTL, &recall_faults());
}

#[test]
fn vectors_catch_every_fault_in_the_recall_of_what_has_moved() {
    let mut spec = chip::shipped::variants::recalls()[1].spec.clone();
    // Gains that follow a fade of some periods, and are held for all of it.
    let c = &mut spec.calibration;
    (c.gamma_first, c.gamma_last, c.hold_periods) = (3, 7, Some(100));
    let files = files(&spec);
    all_caught("the recall of what has moved", &files, RTL, &moved_faults());
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
        let faulty = altered(files, path, &(rows.join("\n") + "\n"));
        let (passed, _) = verdict(&faulty, &UNTIL_IT_FAILS);

        assert!(!passed, "row {row}, bit {bit}: not caught");
    });
    kept(place, faults.len());
}

#[test]
fn vectors_catch_every_fault_in_the_correction_of_skew() {
    let mut spec = optical();
    spec.correction.channel_skew_s = 1e-7;
    all_caught("the correction of skew", &files(&spec), RTL, &skew_faults());
}

#[test]
fn vectors_catch_every_planted_fault() {
    all_caught("the Verilog", &OPTICAL, RTL, &faults());
}

/// One entry of the table: first, last and some between, the last bit of value or slope.
#[test]
fn vectors_catch_every_fault_in_the_table() {
    let last = text(&OPTICAL, TABLE).lines().count() - 1;
    let faults = [(0, 14), (last, 0), (13, 14), (37, 0)];
    rows_caught("the sine table", &OPTICAL, TABLE, &faults);
}
