//! The generated chips agree with the model in every bit of every probe and register, in Icarus and in Verilator.

#[path = "../examples/bit_exact/row.rs"]
mod row;

use std::fs;
use std::path::Path;

use crate::chip::shipped::variants::{self, Variant};
use crate::chip::{write, write_with};
use nonius_hdl::ChipDir;
use nonius_hdl::verify::{Options, verify};
use nonius_kept::every;
use rayon::prelude::*;

/// With every stimulus.
fn agrees(variant: &Variant, rows: usize, options: &Options) {
    agrees_on(|_| true, variant, rows, options);
}

/// With what a search, a correction or a loop makes other signals of: the rest is standstill, creep, and what the sweep and the
/// loss of signal hold too. In the long campaign all.
fn agrees_on_most(variant: &Variant, options: &Options) {
    let most = |name: &str| !matches!(name, "standstill" | "backwards" | "creep" | "step");
    agrees_on(most, variant, ROWS, options);
}

fn agrees_on(
    stimuli: fn(&str) -> bool,
    Variant { what, spec }: &Variant,
    rows: usize,
    options: &Options,
) {
    let dir = tempfile::tempdir().expect("scratch folder");
    write_with(spec, rows, dir.path(), stimuli);
    let report = verify(dir.path(), options, &nonius_hdl::progress::silent)
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(
        report.passed,
        "{what}: {:?} {:?} {:?} {:?}: {report:#?}",
        spec.tracking, spec.calibration, spec.adc, spec.chip
    );
    for run in &report.runs {
        assert_eq!(run.warnings, Vec::<String>::new(), "{}", run.tool);
    }
}

/// Nobody's linter has anything to say, without waivers: Verilator -Wall, Icarus -Wall, Yosys check. Of all
/// variants every twelfth; what a simulator warns of when it builds the others is seen below.
#[test]
fn variants_are_clean() {
    let some: Vec<Variant> = variants::everything().into_iter().step_by(12).collect();
    some.par_iter().for_each(|Variant { what, spec }| {
        let dir = tempfile::tempdir().expect("scratch folder");
        write(spec, 2, dir.path());
        let chip = ChipDir::open(dir.path()).expect("a chip");
        let lint = nonius_hdl::verilator::lint(&chip).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(lint, Vec::<String>::new(), "{what}");
        let check = nonius_hdl::yosys::check(&chip).unwrap_or_else(|e| panic!("{e}"));
        assert!(check.passed, "{what}: {:?}", check.failure);
        assert_eq!(check.warnings, Vec::<String>::new(), "{what}");
    });
}

/// Rows of each stimulus: enough to lock, which skew waits for, and to calibrate.
const ROWS: usize = 200;

const ICARUS: Options = Options {
    verilator: false,
    ..Options::PATIENT
};
const VERILATOR: Options = Options {
    icarus: false,
    ..Options::PATIENT
};

/// All in Verilator, each `nth` in Icarus too, which takes most of the time.
fn agree(variants: &[Variant], nth: usize) {
    variants.par_iter().enumerate().for_each(|(i, variant)| {
        let both = i % nth == 0;
        let simulators = if both { &Options::PATIENT } else { &VERILATOR };
        agrees_on_most(variant, simulators);
    });
}

/// The vectors that `build` writes, and fewer in the simulator that is slower.
#[test]
fn shipped_designs_in_icarus_and_verilator() {
    variants::shipped().par_iter().for_each(|variant| {
        agrees(variant, 2000, &VERILATOR);
        agrees(variant, ROWS, &ICARUS);
    });
}

/// Every second search with its largest parameter set in Verilator, every third with the smaller one, and of both each third in Icarus
/// too; in the long form every search. The others with their largest are those of any_state.rs.
#[test]
fn searches_in_icarus_and_verilator() {
    let searches = variants::searches().into_iter();
    let (largest, smaller): (Vec<_>, Vec<_>) = searches.partition(Variant::is_largest);
    let some: Vec<Variant> = every(2, largest).chain(every(3, smaller)).collect();
    agree(&some, 3);
}

/// Loops, ADCs and numbers of multipliers, here every twelfth, and designs with every word said; in the long campaign all.
#[test]
fn every_other_variant_in_icarus_and_verilator() {
    let others = [
        vec![variants::fixed()],
        variants::radius_alone(),
        // Every method and type, and each of the four ways to build it.
        variants::loops().into_iter().step_by(3).collect(),
        variants::poles(),
        variants::sparse(),
        variants::adcs(),
        variants::multipliers(),
    ];
    let others: Vec<Variant> = others.into_iter().flatten().step_by(12).collect();
    agree(&others, others.len());
    agree(&variants::words(), 2);
    // Narrow loops take longer to lock.
    variants::narrow()
        .par_iter()
        .for_each(|variant| agrees(variant, 300, &VERILATOR));
}

/// Every fourth; in the long campaign all.
#[test]
fn skews_in_icarus_and_verilator() {
    let some: Vec<Variant> = variants::skewed().into_iter().step_by(4).collect();
    agree(&some, some.len());
}

/// Rows enough for the last gear, a hold in it and a return; fewer in the simulator that is slower. The last; in the long campaign all.
#[test]
fn a_recall_in_icarus_and_verilator() {
    let recall = variants::recalls().pop().expect("a variant");
    agrees(&recall, 1000, &VERILATOR);
    agrees(&recall, ROWS, &ICARUS);
}

/// Every second; in the long campaign all.
#[test]
fn gears_in_icarus_and_verilator() {
    let some: Vec<Variant> = variants::gears().into_iter().step_by(2).collect();
    agree(&some, some.len());
}

/// Two tables in a chip, one of them with words that have a sign: every fourth; in the long campaign all.
#[test]
fn harmonics_in_icarus_and_verilator() {
    let some: Vec<Variant> = variants::harmonics().into_iter().step_by(4).collect();
    agree(&some, some.len());
}

/// Every sixth chip, in the long form all: the page is of the files that the generator writes today.
#[test]
fn the_page_is_of_these_chips() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/bit-exact.md");
    let page = fs::read_to_string(page).expect("docs/bit-exact.md");
    assert!(page.starts_with(row::HEAD), "{}", row::HEAD);
    let some: Vec<Variant> = every(6, variants::everything()).collect();
    some.par_iter().for_each(|Variant { what, spec }| {
        let begins = row::begins(what, spec).expect("a chip");
        let stands = |row: &str| row.starts_with(&begins) && row.matches(" equal ").count() == 2;
        assert!(
            page.lines().any(stands),
            "docs/bit-exact.md has no row {begins} or not two that are equal: run cargo run --release -p nonius-hdl --example bit_exact -- docs"
        );
    });
}
