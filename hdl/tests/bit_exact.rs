//! The generated chips agree with the model in every bit of every probe and register, in Icarus and in Verilator.

use std::fs;
use std::path::Path;

use nonius_hdl::verify::{Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::{All, Coding, Multipliers, Spec};
use nonius_testvectors::{stimulus, vectors};

fn optical() -> Spec {
    let text = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../designs/optical.toml"
    ));
    Spec::from_toml(&text.expect("designs/optical.toml"), "optical.toml").expect("a shipped design")
}

fn write(spec: &Spec, rows: usize, dir: &Path) {
    let design = Design::new(spec).expect("a design that works");
    let stimuli = stimulus::named(&design, rows);
    let names: Vec<_> = stimuli
        .iter()
        .map(|s| (s.name.clone(), s.samples.len()))
        .collect();
    let chip = nonius_codegen::generate(&design, "test", &names).expect("templates render");
    let put = |path: &str, text: &str| {
        let path = dir.join(path);
        fs::create_dir_all(path.parent().expect("below dir")).expect("folder");
        fs::write(path, text).expect("file");
    };
    for (path, text) in &chip.files {
        put(path, text);
    }
    for one in &stimuli {
        put(
            &format!("vectors/{}.vec", one.name),
            &vectors::rows(&design, one, &chip.columns),
        );
    }
    let json = format!(
        "{{\"name\": \"{}\", \"clocks_per_sample\": {}}}",
        spec.name, chip.clocks
    );
    put("design.json", &json);
}

fn agrees(spec: &Spec, rows: usize, options: &Options) {
    let dir = tempfile::tempdir().expect("scratch folder");
    write(spec, rows, dir.path());
    let report = verify(dir.path(), options, &nonius_hdl::progress::silent)
        .unwrap_or_else(|e| panic!("{e}"));
    assert!(
        report.passed,
        "{:?} {:?} {:?} {:?}: {report:#?}",
        spec.tracking, spec.calibration, spec.adc, spec.chip
    );
}

/// Method, type, parameters, multipliers, ADC bits: one after the other away from the shipped design.
fn variants() -> Vec<Spec> {
    let base = optical();
    let with = |change: &dyn Fn(&mut Spec)| {
        let mut spec = base.clone();
        change(&mut spec);
        spec
    };
    let slow_type_1 = |s: &mut Spec| {
        s.tracking.filter_type = 1;
        s.sensor.speed_max_periods_per_s = 1e3;
    };
    let mut all = vec![
        with(&|s| s.tracking.method = 1),
        with(&|s| {
            s.tracking.method = 1;
            slow_type_1(s);
        }),
        with(&|s| {
            s.tracking.method = 2;
            slow_type_1(s);
        }),
        with(&|s| {
            slow_type_1(s);
            s.tracking.pole = Some(0.9);
        }),
        with(&|s| s.calibration.parameters = 4),
        with(&|s| s.calibration.parameters = 0),
        with(&|s| s.adc.coding = Coding::OffsetBinary),
        with(&|s| s.chip.multipliers = Multipliers::All(All::All)),
    ];
    all.extend([2, 3, 5].map(|n| with(&|s| s.chip.multipliers = Multipliers::Count(n))));
    all.extend([8, 16, 18].map(|bits| {
        with(&|s| {
            s.adc.bits = bits;
            s.sensor.noise_rms = 0.0;
            s.accuracy.rms_periods = 60e-6 * 2f64.powi(12 - bits as i32);
        })
    }));
    all
}

#[test]
fn every_variant_in_icarus() {
    let options = Options {
        verilator: false,
        ..Options::default()
    };
    for spec in variants() {
        agrees(&spec, 250, &options);
    }
}

#[test]
fn shipped_design_in_icarus_and_verilator() {
    agrees(&optical(), 2000, &Options::default());
}
