//! A sine that is sampled later than the cosine: the chip that knows by how much, against the one that does not.

use std::f64::consts::TAU;

use crate::chip_support::{Bench, optical, rms, shipped};
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::{Design, PHASE_MAX};
use nonius_model::kernel::skew::{Order, correct};
use nonius_model::kernel::{Constant, Probes, State};
use nonius_model::reference::skew::together;
use nonius_model::spec::Spec;

/// β of the sensor, radians.
const BETA: f64 = 0.06;
/// Delay of its sine, seconds: at the top speed of the design 0.05 rad.
const DELAY: f64 = 8e-8;
const SAMPLES: u32 = 90_000;

fn spec(parameters: u32, corrected: f64) -> Spec {
    let mut spec = optical();
    spec.calibration.parameters = parameters;
    spec.correction.channel_skew_s = corrected;
    if parameters > 0 {
        // A phase that is calibrated follows part of what skew does; here it is to follow little.
        spec.calibration.gamma_last = Some(11);
    }
    spec
}

/// Turns at the time of sample k, which need not be whole.
type Motion = fn(f64) -> f64;

fn forwards(k: f64) -> f64 {
    0.0983 * k
}

fn backwards(k: f64) -> f64 {
    -0.0983 * k
}

/// Up to the top speed in both directions, six times.
fn sweep(k: f64) -> f64 {
    let slow = TAU / 15_000.0;
    0.0983 / slow * (slow * k).sin()
}

struct Seen {
    /// Angle error over the last third, periods: nothing is removed from it.
    errors: Vec<f64>,
    /// tan β as calibrated.
    tan_beta: f64,
}

/// The chip of `spec` behind a sensor with β, an amplitude off by 10 % and a sine that is `delay` seconds late.
fn run(spec: &Spec, delay: f64, motion: Motion) -> Seen {
    let mut bench = Bench::new(spec, 3);
    let late = delay * spec.adc.sample_rate_hz;
    // What is not calibrated is not wrong.
    let (beta, wrong) = match spec.calibration.parameters {
        0 => (0.0, 0.0),
        4 | 8 => (0.0, 1.0),
        _ => (BETA, 1.0),
    };
    let mut errors = vec![];
    for k in 0..SAMPLES {
        let k = f64::from(k);
        let (cos, sin) = (TAU * motion(k), TAU * motion(k + late) - beta);
        let error = bench.chip.position() - motion(k);
        if k >= f64::from(SAMPLES) / 1.5 {
            assert!(bench.chip.state.locked);
            errors.push(error - error.round());
        }
        bench.step((
            (1.0 + 0.1 * wrong) * cos.cos() + 0.03 * wrong,
            (1.0 - 0.05 * wrong) * sin.sin() - 0.02 * wrong,
        ));
    }
    let theta = bench.chip.theta();
    let tan_beta = if spec.calibration.has_bend() {
        theta[4]
    } else {
        theta[4] / theta[0]
    };
    Seen { errors, tan_beta }
}

/// With the correction the angle error is that of the sensor without skew, sample by sample, to what the design says that the
/// series leaves and to what ADC, calibration and arithmetic do to either; in both directions, through reversals, for a sine
/// that is late or early. Without it the error is there: where speed changes, the calibration cannot hide it.
#[test]
fn the_angle_error_is_that_of_the_sensor_without_skew() {
    for (parameters, motion, name) in [
        (5, forwards as Motion, "forwards"),
        (5, backwards, "backwards"),
        (5, sweep, "sweep"),
        (4, sweep, "sweep"),
        (0, sweep, "sweep"),
        (9, sweep, "sweep"),
        (8, sweep, "sweep"),
    ] {
        for delay in [DELAY, -DELAY] {
            let with = spec(parameters, delay);
            let design = Design::new(&with).expect("a design that works");
            let (skew, budget) = (design.skew.expect("a correction"), &design.budget);
            let sound = run(&spec(parameters, 0.0), 0.0, motion).errors;
            let more = |corrected: f64| {
                let errors = run(&spec(parameters, corrected), delay, motion).errors;
                let more: Vec<f64> = errors.iter().zip(&sound).map(|(a, b)| a - b).collect();
                rms(&more)
            };
            let (mended, plain) = (more(delay), more(0.0));
            let either =
                (budget.adc.powi(2) + budget.calibration.powi(2)).sqrt() + budget.arithmetic();
            let allowed = skew.residual_rms_periods + 2.0 * either;
            println!(
                "{parameters} parameters, {name}, {delay:e} s: more than without skew {mended:.2e} (allowed {allowed:.2e}), not corrected {plain:.2e}; series {:.2e}",
                skew.residual_rms_periods
            );
            assert!(mended <= allowed, "{mended} of {allowed}");
            if name == "sweep" {
                // κ (1 + cos 2α)/2, of which the loop follows the first; speed goes like a cosine. A phase that is calibrated
                // runs after it.
                let expected = skew.phase_max / 2.0 / 2f64.sqrt() / TAU;
                let hidden = if matches!(parameters, 5 | 9) {
                    0.5
                } else {
                    0.05
                };
                assert!(plain > (1.0 - hidden) * expected, "{plain} of {expected}");
                assert!(plain < 1.05 * expected, "{plain} of {expected}");
            }
        }
    }
}

/// At constant speed the calibration cannot tell skew from a phase error: without the correction θ5 shows β less speed times
/// delay, with it β as without skew.
#[test]
fn the_phase_parameter_stays_at_the_phase_error() {
    for parameters in [5, 9] {
        for (motion, speed) in [(forwards as Motion, 0.0983), (backwards, -0.0983)] {
            let kappa = TAU * speed * DELAY * optical().adc.sample_rate_hz;
            let skew = Design::new(&spec(parameters, DELAY))
                .expect("a design")
                .skew;
            let left = skew.expect("a correction").sine_error_max;
            let sound = run(&spec(parameters, 0.0), 0.0, motion).tan_beta.atan();
            let mended = run(&spec(parameters, DELAY), DELAY, motion).tan_beta.atan();
            let plain = run(&spec(parameters, 0.0), DELAY, motion).tan_beta.atan();
            println!(
                "{parameters} parameters, kappa {kappa:.4}: beta {BETA}, {sound:.5} without skew, {mended:.5} corrected, {plain:.5} not"
            );
            assert!((mended - sound).abs() <= left, "{mended}, {sound}, {left}");
            assert!(
                (plain - (sound - kappa)).abs() < 0.05 * kappa.abs(),
                "{plain}"
            );
        }
    }
}

/// The largest skews that are not refused, at top speed, from rest and not yet calibrated: the loop locks, keeps its lock
/// where the correction sets in, and is left with what the design says.
#[test]
fn the_largest_skew_locks() {
    for (delay, top, bandwidth) in [
        (3.9e-7, 100e3, 10e3),
        (-3.9e-7, 100e3, 20e3),
        // A whole sample.
        (9.9e-7, 39e3, 10e3),
        (-9.9e-7, 39e3, 20e3),
        // And nearly the widest loop that is not refused for it.
        (9.9e-7, 39e3, 60e3),
    ] {
        for direction in [1.0, -1.0] {
            let mut spec = spec(5, delay);
            spec.sensor.speed_max_periods_per_s = top;
            spec.tracking.bandwidth_hz = bandwidth;
            spec.accuracy.rms_periods = 1e-3;
            let design = Design::new(&spec).expect("a design that works");
            let skew = design.skew.expect("a correction");
            assert!(skew.phase_max > 0.95 * PHASE_MAX, "{}", skew.phase_max);
            let fs = spec.adc.sample_rate_hz;
            let speed = direction * 0.997 * top / fs;
            let mut bench = Bench::new(&spec, 5);
            let (mut errors, mut locked) = (vec![], None);
            for k in 0..60_000 {
                let k = f64::from(k);
                let error = bench.chip.position() - speed * k;
                let (cos, sin) = (TAU * speed * k, TAU * speed * (k + delay * fs) - BETA);
                bench.step((1.1 * cos.cos() + 0.03, 0.95 * sin.sin() - 0.02));
                let now = bench.chip.state.locked;
                assert!(now || locked.is_none(), "lock lost at sample {k}");
                locked = locked.or(now.then_some(k));
                if k > 40_000.0 {
                    errors.push(error - error.round());
                }
            }
            let (budget, error) = (&design.budget, rms(&errors));
            let allowed = skew.residual_rms_periods + budget.total();
            println!(
                "{delay:e} s, {} periods/s, loop {bandwidth} Hz: locked after {locked:?} samples, error {error:.2e} of {allowed:.2e}, uncorrected {:.2e}",
                direction * top,
                skew.uncorrected_rms_periods
            );
            assert!(locked.is_some() && error <= allowed, "{error} of {allowed}");
        }
    }
}

fn pairs(probes: &Probes<Bits>) -> Vec<(&'static str, Option<Bits>)> {
    let names = Probes::<Bits>::VALUES.iter().filter(|n| **n != "skew");
    names.map(|n| (*n, probes.value(n))).collect()
}

fn registers(chip: &Chip<Bits>) -> Vec<Option<Bits>> {
    let names = State::<Bits>::VALUES.iter();
    names.map(|n| chip.state.value(n)).collect()
}

/// A delay of 0 in the correction changes no bit of any probe or register: nothing but the delay acts.
#[test]
fn no_delay_is_no_correction() {
    for parameters in [0, 4, 5, 8, 9] {
        for order in [Order::First, Order::Second] {
            let mut with = Design::new(&spec(parameters, DELAY)).expect("a design that works");
            with.constants.skew_delay = Constant::rounded(0.0, 0);
            with.structure.skew = Some(order);
            let mut without = with.clone();
            without.structure.skew = None;
            let [mut with, mut without] = [with, without].map(|d| Chip::bit_true(&d));
            for k in 0..6000 {
                let turns = sweep(f64::from(k));
                let (cos, sin) = (TAU * turns, TAU * turns - BETA);
                let code = |x: f64| (x * 1700.0).round() as i64;
                let codes = (code(cos.cos()), code(0.9 * sin.sin()));
                let a = with.step_codes(codes.0, codes.1, false, true);
                let b = without.step_codes(codes.0, codes.1, false, true);
                assert_eq!(pairs(&a), pairs(&b), "sample {k}");
                assert_eq!(registers(&with), registers(&without), "sample {k}");
            }
            assert!(with.state.locked);
        }
    }
}

/// What is absent or 0 is no correction: the same design.
#[test]
fn a_delay_of_zero_is_the_design_without_it() {
    let text = shipped::text("optical");
    let read = |text: &str| Spec::from_toml(text, "optical.toml").expect("a design");
    let absent = Design::new(&read(&text)).expect("a design");
    let zero = format!("{text}\n[correction]\nchannel_skew_s = 0.0\n");
    assert_eq!(Design::new(&read(&zero)).expect("a design"), absent);
    let late = format!("{text}\n[correction]\nchannel_skew_s = 1e-8\n");
    let late = Design::new(&read(&late)).expect("a design");
    let more = |parameters: u32, delay: f64| {
        let [with, without] =
            [delay, 0.0].map(|d| Design::new(&spec(parameters, d)).expect("a design"));
        with.graph.products() - without.graph.products()
    };
    assert_eq!([0, 4, 5, 8, 9].map(|n| more(n, DELAY)), [4, 4, 7, 4, 4]);
    // So little that the first order does.
    assert_eq!([0, 4, 5, 8, 9].map(|n| more(n, 1e-10)), [2; 5]);
    assert!((late.skew.expect("a correction").delay_quantised_s - 1e-8).abs() < 1e-13);
}

/// The series is of second order: against the exact solution it is off by no more than κ³/12 and its next term: eight times
/// less at half the κ.
#[test]
fn the_series_is_of_second_order() {
    let design = Design::new(&spec(8, DELAY)).expect("a design that works");
    let (k, structure) = (design.constants.real(), &design.structure);
    let off = |kappa: f64| {
        (0..200)
            .map(|i| {
                let (sin, c) = (TAU * f64::from(i) / 200.0).sin_cos();
                let late = kappa.cos() * sin + kappa.sin() * c;
                let series = correct((c, late), (Order::Second, kappa), (1.0, 0.0), &k, structure);
                let [_, exact] = together([c, late], kappa, 0.0);
                assert!((exact - sin).abs() < 1e-12);
                (series - exact).abs()
            })
            .fold(0.0, f64::max)
    };
    for kappa in [PHASE_MAX, -PHASE_MAX, 0.1] {
        let (whole, half) = (off(kappa), off(kappa / 2.0));
        assert!(
            whole <= kappa.abs().powi(3) / 12.0 * (1.0 + kappa.abs()),
            "{kappa}: {whole}"
        );
        assert!(
            (7.5..9.0).contains(&(whole / half)),
            "{kappa}: {whole}, {half}"
        );
    }
}
