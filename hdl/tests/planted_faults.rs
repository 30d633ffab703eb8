//! A testbench that cannot fail is worthless: single faults in the Verilog, and the vectors catch each.

mod corrections;
mod edit;
mod faults;
mod periods;
mod recall;
mod seen_by;
mod sparse;

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex};

use crate::chip::{self, optical};
use corrections::{harmonic_faults, skew_faults};
use edit::{Fault, on_one_line};
use faults::faults;
use nonius_hdl::verify::{Options, verify};
use nonius_kept::{every, figure, figure_of_all};
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, Spec};
use nonius_testvectors::stimulus::{self, Stimulus};
use periods::{dropping_faults, first_gear_faults, resting_faults};
use rayon::prelude::*;
use recall::{moved_faults, recall_faults};
use sparse::sparse_faults;

/// As `nonius build` writes them.
const ROWS: usize = nonius_package::ROWS;
const RTL: &str = "rtl/optical.v";
const TABLE: &str = "coefficients/sine_table.mem";

type Files = Vec<(String, Vec<u8>)>;

/// A chip without a fault, with its stimuli.
struct Sound {
    design: Design,
    stimuli: Vec<Stimulus>,
    /// With all stimuli, as `nonius build` writes it.
    all: Files,
    /// With one of them.
    one: Mutex<HashMap<String, Arc<Files>>>,
}

impl Sound {
    fn new(spec: &Spec) -> Self {
        let design = Design::new(spec).expect("a design that works");
        let stimuli = stimulus::named(&design, ROWS);
        let package = nonius_package::package_with(&design, stimuli.clone(), "sweep");
        let all = package.expect("a package").files;
        // All rows are soonest through Verilator; a fault is soonest found in Icarus.
        let verilator = Options {
            icarus: false,
            ..Options::PATIENT
        };
        let seen = verdict(&all, &verilator);
        assert!(seen.is_none(), "the chip without a fault: {seen:?}");
        Self {
            design,
            stimuli,
            all,
            one: Mutex::default(),
        }
    }

    /// The same with one stimulus, if there is one of that name.
    fn with_one(&self, name: &str) -> Option<Arc<Files>> {
        if let Some(files) = self.one.lock().expect("no test has failed").get(name) {
            return Some(files.clone());
        }
        let stimulus = self.stimuli.iter().find(|one| one.name == name)?.clone();
        let package = nonius_package::package_with(&self.design, vec![stimulus], name);
        let files = Arc::new(package.expect("a package").files);
        let mut kept = self.one.lock().expect("no test has failed");
        Some(kept.entry(name.to_owned()).or_insert(files).clone())
    }

    /// What catches `text` in the place of the file at `path`: the stimulus that did the last time is tried first.
    fn caught(&self, fault: &str, path: &str, text: &str) -> Option<Failure> {
        let last = seen_by::last(fault).and_then(|stimulus| self.with_one(&stimulus));
        let soon = last.and_then(|files| verdict(&altered(&files, path, text), &UNTIL_IT_FAILS));
        let caught = soon.or_else(|| verdict(&altered(&self.all, path, text), &UNTIL_IT_FAILS))?;
        seen_by::keep(fault, &caught.stimulus);
        Some(caught)
    }
}

/// Those of the shipped design, which holds as many periods as its rows have: else the search never begins again.
static OPTICAL: LazyLock<Sound> = LazyLock::new(|| {
    let mut spec = optical();
    spec.calibration.hold_periods = Some(40);
    Sound::new(&spec)
});

const UNTIL_IT_FAILS: Options = Options {
    verilator: false,
    stop_at_first: true,
    ..Options::PATIENT
};

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

/// Where a chip differs from the model.
#[derive(Debug)]
struct Failure {
    stimulus: String,
    says: String,
}

/// Where the chip differs from the model; `None`: nowhere.
fn verdict(files: &Files, options: &Options) -> Option<Failure> {
    let dir = tempfile::tempdir().expect("scratch folder");
    nonius_package::write(files, dir.path()).expect("a folder");
    let report = verify(dir.path(), options, &nonius_hdl::progress::silent)
        .unwrap_or_else(|e| panic!("{e}"));
    let run = &report.runs[0];
    (!report.passed).then(|| Failure {
        stimulus: run
            .stimuli
            .iter()
            .find(|one| !one.passed)
            .map_or_else(String::new, |one| one.name.clone()),
        says: run.failure.clone().unwrap_or_default(),
    })
}

/// What is caught, on the page of figures.
fn kept(keep: fn(&str, &str, &str), place: &str, faults: usize) {
    keep(
        &format!("faults planted in {place}, caught by the vectors"),
        &format!("{faults} of {faults}"),
        "hdl/tests/planted_faults.rs",
    );
}

/// The vectors see each of these in the chip, and say where: every sixth, in the long form all.
fn all_caught(place: &str, chip: &Sound, rtl: &str, faults: &[Fault]) {
    let sound = on_one_line(&text(&chip.all, rtl));
    let some = every(6, faults);
    let faulty = some.map(|(name, change)| {
        let faulty = change(&sound);
        assert_ne!(faulty, sound, "{name}: nothing is altered");
        (name, faulty)
    });
    let faulty: Vec<_> = faulty.collect();
    faulty.par_iter().for_each(|(name, faulty)| {
        let caught = chip.caught(&format!("{place}: {name}"), rtl, faulty);

        let caught = caught.unwrap_or_else(|| panic!("{name}: not caught"));
        assert!(caught.says.contains("signal"), "{name}: {}", caught.says);
    });
    kept(figure_of_all, place, faults.len());
}

#[test]
fn vectors_catch_every_fault_in_the_recall() {
    let variant = &chip::shipped::variants::recalls()[1];
    all_caught(
        "the recall",
        &Sound::new(&variant.spec),
        RTL,
        &recall_faults(),
    );
}

#[test]
fn vectors_catch_every_fault_in_the_recall_of_what_has_moved() {
    let mut spec = chip::shipped::variants::recalls()[1].spec.clone();
    // Gains that follow a fade of some periods, and are held for all of it.
    let c = &mut spec.calibration;
    (c.gamma_first, c.gamma_last, c.hold_periods) = (3, Some(7), Some(100));
    let chip = Sound::new(&spec);
    all_caught("the recall of what has moved", &chip, RTL, &moved_faults());
}

#[test]
fn vectors_catch_every_fault_in_the_correction_of_harmonics() {
    let mut spec = optical();
    spec.correction.harmonics = chip::shipped::variants::third_and_fifth();
    let chip = Sound::new(&spec);
    all_caught(
        "the correction of harmonics",
        &chip,
        RTL,
        &harmonic_faults(),
    );
    // One entry of the table: first, last and some between, in each column.
    let path = "coefficients/harmonic_table.mem";
    let table = &chip
        .design
        .structure
        .harmonics
        .as_ref()
        .expect("a table")
        .table;
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
    rows_caught("the table of harmonics", &chip, path, &faults);
}

/// The vectors see one bit (row, bit) turned over in each of these rows of a table.
fn rows_caught(place: &str, chip: &Sound, path: &str, faults: &[(usize, u32)]) {
    let sound = text(&chip.all, path);
    faults.par_iter().for_each(|&(row, bit)| {
        let mut rows: Vec<String> = sound.lines().map(ToOwned::to_owned).collect();
        let word = u128::from_str_radix(&rows[row], 16).expect("hex") ^ (1 << bit);
        rows[row] = format!("{word:0digits$x}", digits = rows[row].len());
        let fault = format!("{place}: row {row} bit {bit}");

        let caught = chip.caught(&fault, path, &(rows.join("\n") + "\n"));
        assert!(caught.is_some(), "{fault}: not caught");
    });
    kept(figure, place, faults.len());
}

#[test]
fn vectors_catch_every_fault_in_the_correction_of_skew() {
    let mut spec = optical();
    spec.correction.channel_skew_s = 1e-7;
    let chip = Sound::new(&spec);
    all_caught("the correction of skew", &chip, RTL, &skew_faults());
}

#[test]
fn vectors_catch_every_fault_in_dropping_periods_and_resting_bends() {
    let mut spec = optical();
    spec.calibration.parameters = 9;
    // Settled within the rows.
    spec.calibration.gear_periods = Some(1);
    let chip = Sound::new(&spec);
    all_caught("the dropping of periods", &chip, RTL, &dropping_faults());
    all_caught("the resting of bends", &chip, RTL, &resting_faults());
}

#[test]
fn vectors_catch_every_fault_in_the_first_gear_of_bends_by_squares() {
    let mut spec = optical();
    spec.calibration.parameters = 8;
    spec.calibration.method = CalibrationMethod::SumOfSquares;
    spec.calibration.gear_periods = Some(1);
    let chip = Sound::new(&spec);
    all_caught("the first gear of bends", &chip, RTL, &first_gear_faults());
}

#[test]
fn vectors_catch_every_fault_where_samples_are_few() {
    let mut sparse = chip::shipped::variants::sparse().into_iter();
    let nine = sparse.find(|variant| variant.spec.calibration.parameters == 9);
    let chip = Sound::new(&nine.expect("one with bends").spec);
    all_caught("what few samples teach", &chip, RTL, &sparse_faults());
}

#[test]
fn vectors_catch_every_planted_fault() {
    all_caught("the Verilog", &OPTICAL, RTL, &faults());
}

/// One entry of the table: first, last and some between, the last bit of value or slope.
#[test]
fn vectors_catch_every_fault_in_the_table() {
    let last = text(&OPTICAL.all, TABLE).lines().count() - 1;
    let faults = [(0, 14), (last, 0), (13, 14), (37, 0)];
    rows_caught("the sine table", &OPTICAL, TABLE, &faults);
}
