//! Every measured recording, played into the Verilog of a design that was made for it. The homodyne ones are long and
//! go through Verilator alone. Here every third; in the long form all.

use std::path::Path;

use nonius_hdl::progress::silent;
use nonius_hdl::verify::{Options, verify};
use nonius_kept::every;
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_recording::{Overrides, Recording};
use rayon::prelude::*;

const VERILATOR: Options = Options {
    icarus: false,
    ..Options::PATIENT
};

/// What `nonius new --from` and `nonius build --play --repeat` do, and `nonius verify` after them.
fn agrees(file: &Path, repeat: u32, options: &Options) {
    let name = file.display();
    let recording = Recording::read(file, &Overrides::default()).expect("a recording");
    let (text, _) =
        nonius::new::fitted_text("it", file, &recording).expect("a design can follow it");
    let spec = Spec::from_toml(&text, "it.toml").expect("a design");
    let design = Design::new(&spec).expect("a design");
    let played = nonius::play::stimulus("recording", &spec, &recording, repeat);
    let samples = played.samples.len() as u64;
    assert!(samples >= 1000, "{name}: too little is played");
    let package =
        nonius_package::package_with(&design, vec![played], "recording").expect("a package");
    let dir = tempfile::tempdir().expect("scratch folder");
    nonius_package::write(&package.files, dir.path()).expect("a folder");
    let report = verify(dir.path(), options, &silent).unwrap_or_else(|e| panic!("{e}"));
    assert!(report.passed, "{name}: {report:#?}");
    for run in &report.runs {
        assert_eq!(run.samples, Some(samples), "{name}");
    }
}

#[test]
fn recordings_agree_in_every_bit() {
    let Some(folder) = nonius_kept::recordings("recordings in Verilog") else {
        return;
    };
    let recordings = [
        ("rm44_center", 4, Options::PATIENT),
        ("rm44_static_x500um", 4, Options::PATIENT),
        ("rm44_gap_z500um", 4, Options::PATIENT),
        ("rm44_jumps", 1, Options::PATIENT),
        ("interf3x3_fs", 1, Options::PATIENT),
        ("interf3x3_mmi", 1, Options::PATIENT),
        ("wheel_magnetometer", 1, Options::PATIENT),
        ("homodyne_settle", 1, VERILATOR),
        ("homodyne_stop", 1, VERILATOR),
    ];
    let some: Vec<_> = every(3, recordings).collect();
    some.par_iter().for_each(|(name, repeat, simulators)| {
        agrees(&folder.join(format!("{name}.csv")), *repeat, simulators);
    });
}

/// One period of the first encoder of the table, far from an ellipse, round and round.
#[test]
fn an_averaged_period_agrees_in_every_bit() {
    let Some(folder) = nonius_kept::recordings("recordings in Verilog") else {
        return;
    };
    let table =
        std::fs::read_to_string(folder.join("optical_servo_tables.csv")).expect("the table");
    let units = nonius_kept::units(&table);
    assert_eq!(units[0].lines().count(), 1 + 512);
    let dir = tempfile::tempdir().expect("scratch folder");
    let one = dir.path().join("unit_0.csv");
    std::fs::write(&one, &units[0]).expect("a file");
    agrees(&one, 4, &Options::PATIENT);
}
