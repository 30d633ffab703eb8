//! The generated chips agree with the model in every bit of every probe and register, in Icarus and in Verilator.

mod chip;

use chip::{optical, shipped, write};
use nonius_hdl::ChipDir;
use nonius_hdl::verify::{Options, verify};
use nonius_model::spec::{All, CalibrationMethod, CalibrationStart, Coding, Multipliers, Spec};

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
    for run in &report.runs {
        assert_eq!(run.warnings, Vec::<String>::new(), "{}", run.tool);
    }
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
        // Four samples a period: the increments have a bit more.
        with(&|s| {
            s.tracking.method = 1;
            s.sensor.speed_max_periods_per_s = 250e3;
        }),
        with(&|s| {
            s.sensor.speed_max_periods_per_s = 250e3;
            s.tracking.filter_type = 1;
            s.tracking.pole = Some(0.9995);
        }),
        with(&|s| s.adc.coding = Coding::OffsetBinary),
        with(&|s| s.chip.multipliers = Multipliers::All(All::All)),
    ];
    all.extend([2, 3, 5].map(|n| with(&|s| s.chip.multipliers = Multipliers::Count(n))));
    all.extend([8, 9].map(|n| with(&|s| s.calibration.parameters = n)));
    all.extend([
        with(&|s| {
            s.calibration.parameters = 9;
            s.chip.multipliers = Multipliers::All(All::All);
            s.tracking.method = 2;
            slow_type_1(s);
        }),
        with(&|s| {
            s.calibration.parameters = 8;
            s.calibration.completion = false;
            s.chip.multipliers = Multipliers::Count(3);
        }),
        with(&|s| {
            s.calibration.parameters = 4;
            s.calibration.method = CalibrationMethod::Exact;
        }),
        with(&|s| {
            s.calibration.method = CalibrationMethod::Exact;
            s.chip.multipliers = Multipliers::Count(2);
            slow_type_1(s);
            s.tracking.pole = Some(0.9);
        }),
        with(&|s| s.calibration.method = CalibrationMethod::SumOfSquares),
        with(&|s| {
            s.calibration.parameters = 4;
            s.calibration.method = CalibrationMethod::Batch;
        }),
    ]);
    all.extend([8, 16, 18].map(|bits| {
        with(&|s| {
            s.adc.bits = bits;
            s.sensor.noise_rms = 0.0;
            s.accuracy.rms_periods = 60e-6 * 2f64.powi(12 - bits as i32);
        })
    }));
    all
}

/// Chips that start by least squares.
fn started() -> Vec<Spec> {
    let with = |parameters: u32, method: CalibrationMethod, multipliers: Multipliers| {
        let mut spec = optical();
        spec.calibration.start = CalibrationStart::LeastSquares;
        spec.calibration.parameters = parameters;
        spec.calibration.method = method;
        spec.chip.multipliers = multipliers;
        spec
    };
    use CalibrationMethod::{Exact, Final};
    vec![
        with(5, Final, Multipliers::Count(1)),
        with(4, Final, Multipliers::All(All::All)),
        with(5, Exact, Multipliers::Count(2)),
        with(9, Final, Multipliers::Count(1)),
    ]
}

/// The sum of squares with bends.
fn squared() -> Vec<Spec> {
    let with = |parameters: u32, method: CalibrationMethod, multipliers: Multipliers| {
        let mut spec = optical();
        spec.calibration.parameters = parameters;
        spec.calibration.method = method;
        spec.chip.multipliers = multipliers;
        spec
    };
    use CalibrationMethod::{Batch, SumOfSquares};
    vec![
        with(8, SumOfSquares, Multipliers::Count(2)),
        with(9, SumOfSquares, Multipliers::Count(1)),
        with(8, Batch, Multipliers::Count(1)),
        with(9, Batch, Multipliers::All(All::All)),
    ]
}

/// Chips for a sine that is sampled later or earlier: each method and type, each parameter set, the series to its first
/// order (so little skew that it is enough) and to its second.
fn skewed() -> Vec<Spec> {
    let with =
        |method: u32, filter_type: u32, parameters: u32, multipliers: Multipliers, delay: f64| {
            let mut spec = optical();
            spec.tracking.method = method;
            spec.tracking.filter_type = filter_type;
            if filter_type == 1 {
                spec.sensor.speed_max_periods_per_s = 1e3;
            }
            spec.calibration.parameters = parameters;
            spec.chip.multipliers = multipliers;
            spec.correction.channel_skew_s = delay;
            spec
        };
    let (one, all) = (Multipliers::Count(1), Multipliers::All(All::All));
    vec![
        with(3, 2, 5, one, 1e-7),
        with(3, 2, 5, all, -1e-7),
        with(1, 2, 4, all, 2e-7),
        with(1, 1, 5, one, 1e-9),
        with(2, 1, 4, one, -4e-7),
        with(3, 1, 9, all, 1e-6),
        with(3, 2, 9, one, 3e-7),
        with(3, 2, 0, one, 3e-7),
    ]
}

/// Nobody's linter has anything to say, without waivers: Verilator -Wall, Icarus -Wall, Yosys check.
#[test]
fn every_variant_is_clean() {
    let others = ["magnetic", "interferometer"].map(shipped::spec);
    let all = variants().into_iter().chain(started()).chain(squared());
    for spec in all.chain(skewed()).chain(others) {
        let dir = tempfile::tempdir().expect("scratch folder");
        write(&spec, 2, dir.path());
        let chip = ChipDir::open(dir.path()).expect("a chip");
        let lint = nonius_hdl::verilator::lint(&chip).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(lint, Vec::<String>::new(), "{:?}", spec.chip);
        let check = nonius_hdl::yosys::check(&chip).unwrap_or_else(|e| panic!("{e}"));
        assert!(check.passed, "{:?}", check.failure);
        assert_eq!(check.warnings, Vec::<String>::new());
    }
}

const ICARUS: Options = Options {
    icarus: true,
    verilator: false,
    stop_at_first: false,
    time_limit: None,
};

/// All of them in Icarus, each third in Verilator too: its builds take most of the time.
fn agree(specs: Vec<Spec>, rows: usize) {
    for (i, spec) in specs.iter().enumerate() {
        let both = Options::default();
        agrees(spec, rows, if i % 3 == 0 { &both } else { &ICARUS });
    }
}

#[test]
fn every_variant_in_icarus() {
    for spec in variants() {
        agrees(&spec, 120, &ICARUS);
    }
}

#[test]
fn starts_in_icarus_and_verilator() {
    agree(started(), 120);
}

/// Six gears and more above the designed one.
#[test]
fn narrow_loops_in_icarus() {
    for (method, bandwidth) in [(3, 1e3), (1, 300.0)] {
        let mut spec = optical();
        spec.tracking.method = method;
        spec.tracking.bandwidth_hz = bandwidth;
        agrees(&spec, 300, &ICARUS);
    }
}

#[test]
fn squares_with_bends_in_icarus_and_verilator() {
    agree(squared(), 120);
}

#[test]
fn skews_in_icarus_and_verilator() {
    agree(skewed(), 120);
}

#[test]
fn shipped_designs_in_icarus_and_verilator() {
    for name in ["optical", "magnetic", "interferometer"] {
        agrees(&shipped::spec(name), 2000, &Options::default());
    }
}
