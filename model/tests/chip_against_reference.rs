//! The chip against the paper: same ADC codes, same physical design, two programs that share no formula.
//!
//! The chip makes decisions that the paper does not know (γ shifts gear, each sector of travel counts once, what was found is applied
//! where a period ends, the modes are equalised). The reference is told them sample by sample; everything else it computes from the physical design.

use std::f64::consts::TAU;

use crate::agreement::{Difference, WorstCase, compare, equaliser};
use crate::support::shipped::variants::third_and_fifth;
use crate::support::{Encoder, optical};
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::reference::catch_up::Behind;
use nonius_model::reference::gate::{Gate, GateState, Window};
use nonius_model::spec::{CalibrationMethod, Coding, Spec};

/// The optical design with another loop.
fn with_loop(method: u32, filter_type: u32) -> Spec {
    let mut spec = optical();
    spec.tracking.method = method;
    spec.tracking.filter_type = filter_type;
    if filter_type == 1 {
        // What lags at speed cannot be fast.
        spec.sensor.speed_max_periods_per_s = 1.5e3;
    }
    spec
}

/// Each structure of the chip that differs in an equation.
fn structures() -> Vec<(String, Spec)> {
    let mut list = Vec::new();
    for (method, filter_type, pole) in [
        (1, 2, None),
        (1, 1, None),
        (1, 1, Some(0.9)),
        (2, 1, None),
        (3, 2, None),
        (3, 1, None),
        (3, 1, Some(0.97)),
    ] {
        for parameters in [0, 4, 5] {
            let mut spec = with_loop(method, filter_type);
            spec.tracking.pole = pole;
            spec.calibration.parameters = parameters;
            let pole = pole.map_or(String::new(), |p| format!(" pole {p}"));
            let name = format!("method {method} type {filter_type}{pole}, {parameters} parameters");
            list.push((name, spec));
        }
    }
    // A skew that the first order takes off, and two that need the second.
    for (method, filter_type, parameters, delay) in [
        (1, 2, 5, 1e-7),
        (3, 2, 5, -1e-7),
        (2, 1, 4, 4e-8),
        (3, 1, 5, 2e-10),
    ] {
        let mut spec = with_loop(method, filter_type);
        spec.calibration.parameters = parameters;
        spec.correction.channel_skew_s = delay;
        let name =
            format!("method {method} type {filter_type}, {parameters} parameters, skew {delay} s");
        list.push((name, spec));
    }
    // Harmonics, with a skew too.
    for (method, parameters, delay) in [(3, 5, 0.0), (3, 4, 0.0), (1, 0, 0.0), (1, 5, 1e-7)] {
        let mut spec = optical();
        spec.tracking.method = method;
        spec.calibration.parameters = parameters;
        spec.correction.channel_skew_s = delay;
        spec.correction.harmonics = third_and_fifth();
        let name = format!("method {method}, {parameters} parameters, harmonics, skew {delay} s");
        list.push((name, spec));
    }
    // Searches that remember: recursion (11) through each kind of loop filter, the mean gradient of the squares,
    // the sum over a period.
    for (method, filter_type, search, parameters) in [
        (3, 2, CalibrationMethod::Exact, 5),
        (3, 2, CalibrationMethod::Exact, 4),
        (1, 1, CalibrationMethod::Exact, 5),
        (2, 1, CalibrationMethod::Exact, 5),
        (3, 2, CalibrationMethod::SumOfSquares, 5),
        (3, 2, CalibrationMethod::SumOfSquares, 4),
        (3, 2, CalibrationMethod::Batch, 5),
        (3, 2, CalibrationMethod::Batch, 4),
    ] {
        let mut spec = with_loop(method, filter_type);
        spec.calibration.method = search;
        spec.calibration.parameters = parameters;
        if search == CalibrationMethod::Exact {
            spec.calibration.lag = Some(false);
        }
        let name =
            format!("method {method} type {filter_type}, {search:?}, {parameters} parameters");
        list.push((name, spec));
    }
    // Bends, which move what the radius shows of them, and with the completion what it does not. Loops of type 1 lag so far that bends
    // come to their bounds, where words end a last bit below.
    for (method, filter_type, parameters, completion) in [
        (3, 2, 9, true),
        (3, 2, 8, true),
        (1, 2, 9, true),
        (3, 2, 9, false),
    ] {
        let mut spec = with_loop(method, filter_type);
        spec.calibration.parameters = parameters;
        spec.calibration.completion = completion;
        let with = if completion {
            "completed"
        } else {
            "radius alone"
        };
        let name = format!("method {method} type {filter_type}, {parameters} parameters, {with}");
        list.push((name, spec));
    }
    // So fast that bends rest at times, and that the phase error shows what the radius does not.
    for (search, parameters, top) in [
        (CalibrationMethod::Final, 8, 0.2),
        (CalibrationMethod::Final, 9, 0.2),
        (CalibrationMethod::Final, 4, 0.25),
        (CalibrationMethod::Final, 5, 0.25),
        (CalibrationMethod::Final, 9, 0.25),
        (CalibrationMethod::SumOfSquares, 5, 0.25),
    ] {
        let mut spec = optical();
        spec.calibration.method = search;
        spec.calibration.parameters = parameters;
        spec.sensor.speed_max_periods_per_s = top * spec.adc.sample_rate_hz;
        spec.tracking.bandwidth_hz = 0.01 * spec.adc.sample_rate_hz;
        // Harmonics that no bend takes off are a signal that fades, to a sample in many: nobody tells the reference what is recalled then.
        spec.calibration.recall = Some(false);
        let name = format!("{search:?}, {parameters} parameters, up to {top} periods a sample");
        list.push((name, spec));
    }
    let mut binary = optical();
    binary.adc.coding = Coding::OffsetBinary;
    binary.adc.bits = 14;
    binary.sensor.amplitude = 0.3;
    list.push(("offset binary, 14 bits, amplitude 0.3".into(), binary));
    for name in ["magnetic", "interferometer"] {
        list.push((name.into(), crate::support::shipped::spec(name)));
    }
    list
}

/// A sweep with reversals up to the top speed; of a batch, which is full with 64 sectors, so slow that none is jumped over.
fn sweep(spec: &Spec) -> impl Fn(f64) -> f64 {
    let share = if spec.is_sparse() { 0.95 } else { 0.8 };
    let mut top = share * spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    if spec.calibration.is_batch() {
        top = top.min(1.0 / 80.0);
    }
    let slow = TAU / 30_000.0;
    move |k| top / slow * (slow * k).sin() + 0.1
}

fn check(name: &str, found: &Difference, worst: &WorstCase) {
    println!(
        "{name}: alpha_hat {:.1e} (rms {:.1e}, bound {:.1e}) turns, e {:.1e} ({:.1e}), rho {:.1e} ({:.1e}), theta {:.1e} ({:.1e})",
        found.alpha_hat,
        found.alpha_hat_rms,
        worst.alpha_hat,
        found.e,
        worst.e,
        found.rho,
        worst.rho,
        found.theta,
        worst.theta,
    );
    assert!(found.alpha_hat <= worst.alpha_hat, "{name}: {found:?}");
    assert!(found.e <= worst.e, "{name}: {found:?}");
    assert!(found.rho <= worst.rho, "{name}: {found:?}");
    assert!(found.theta <= worst.theta, "{name}: {found:?}");
}

/// Without and with a correction of skew, whose series ends.
fn kept(reading: &str, [without, with]: [f64; 2]) {
    nonius_kept::figure(
        &format!(
            "chip, {reading}, against the paper in `f64`: largest difference of the angle, periods; with skew corrected"
        ),
        &format!("{without:.1e}; {with:.1e}"),
        "model/tests/chip_against_reference.rs",
    );
}

/// The comparison is one of a calibration that happens: hundreds of updates, every gear of γ, parameters that moved.
fn calibrated(spec: &Spec, found: &Difference) {
    if !spec.calibration.is_on() {
        assert_eq!((found.updates, found.moved), (0, 0.0));
    } else {
        assert!(found.updates > 600 && found.moved > 0.05, "{found:?}");
        assert_eq!(
            found.gears,
            spec.calibration.gamma_last() - spec.calibration.gamma_first
        );
        assert_eq!(
            found.completions > 20,
            spec.calibration.completed().is_some(),
            "{found:?}"
        );
    }
}

/// The finest words of all that the unrounded reading takes: tables, coefficients, and what saturates, which ends a last bit
/// below its bound.
fn finest(spec: &mut Spec) {
    spec.formats.signal_fraction = Some(24);
    spec.formats.sine_rows_log2 = Some(13);
    spec.formats.coefficient_bits = Some(32);
    spec.formats.gain_bits = Some(32);
    if !spec.correction.harmonics.is_empty() {
        spec.formats.harmonic_rows_log2 = Some(12);
    }
    if spec.calibration.is_on() {
        spec.formats.residual_fraction = Some(24);
    }
    if spec.calibration.has_bend() {
        spec.formats.accumulator_fraction = Some(30);
    }
    if spec.calibration.has_phase() {
        spec.formats.cross_bits = Some(32);
    }
}

/// The chip's equations are the paper's: with the finest sine table and coefficients the unrounded chip and the
/// reference differ by the table's interpolation error and the coefficients' last bit, some 10⁻⁹ of a period, in
/// every method and type, four, five, and by the final form eight and nine parameters, through reversals and all of the convergence; where skew is corrected, by the rest
/// of its series too.
#[test]
fn the_equations_agree() {
    let mut largest = [0.0f64; 2];
    for (name, mut spec) in structures() {
        finest(&mut spec);
        let design = Design::new(&spec).expect("a design that works");
        let found = compare(
            &design,
            &mut Chip::unrounded(&design),
            sweep(&spec),
            &equaliser(&spec),
        );
        check(&name, &found, &WorstCase::of(&design, false));
        calibrated(&spec, &found);
        let largest = &mut largest[usize::from(!spec.correction.is_none())];
        *largest = largest.max(found.alpha_hat);
    }
    kept("unrounded", largest);
}

/// The bit-true chip with the word lengths that its budget chose differs from the paper by no more than these word
/// lengths can do in the worst case.
#[test]
fn the_bits_agree_to_the_rounding() {
    let mut largest = [0.0f64; 2];
    for (name, spec) in structures() {
        let design = Design::new(&spec).expect("a design that works");
        let found = compare(
            &design,
            &mut Chip::bit_true(&design),
            sweep(&spec),
            &equaliser(&spec),
        );
        check(&name, &found, &WorstCase::of(&design, true));
        calibrated(&spec, &found);
        // And on the average by less than the budget allows.
        assert!(
            found.alpha_hat_rms <= design.budget.allowed,
            "{name}: {found:?}"
        );
        let largest = &mut largest[usize::from(!spec.correction.is_none())];
        *largest = largest.max(found.alpha_hat);
    }
    kept("bit-true", largest);
}

/// The comparison is sharp: a reference whose loop is 1 % wider, or whose γ is 1 % larger, misses the bounds by more than
/// a hundredfold.
#[test]
fn a_small_difference_in_the_design_is_seen() {
    let mut spec = optical();
    finest(&mut spec);
    let design = Design::new(&spec).expect("a design that works");
    let worst = WorstCase::of(&design, false);
    let mut wider = design.clone();
    wider.spec.tracking.bandwidth_hz *= 1.01;
    let found = compare(
        &wider,
        &mut Chip::unrounded(&design),
        sweep(&spec),
        &equaliser(&spec),
    );
    assert!(found.alpha_hat > 100.0 * worst.alpha_hat, "{found:?}");
    assert!(found.e > 100.0 * worst.e, "{found:?}");
    let larger = equaliser(&spec) * 1.01;
    let found = compare(
        &design,
        &mut Chip::unrounded(&design),
        sweep(&spec),
        &larger,
    );
    assert!(found.theta > 100.0 * worst.theta, "{found:?}");
    assert!(found.rho > 100.0 * worst.rho, "{found:?}");
}

/// The chip's gate by travelled angle keeps an interval of sectors, the reference's a map of all 64. Where no sector is
/// jumped over they are the same thing: equal decisions at every sample, through reversals on large and small arcs.
#[test]
fn the_travel_gates_decide_alike() {
    let spec = optical();
    let design = Design::new(&spec).expect("a design that works");
    let encoder = Encoder::ideal(&spec);
    let mut chip = Chip::bit_true(&design);
    let always = Window {
        e: f64::INFINITY,
        rho: f64::INFINITY,
        samples: 0,
    };
    let mut gate = GateState::new(Gate::Travelled(always));
    let mut catching_up = Behind::default();
    let (mut counted, mut fresh) = (0, 0);
    let (mut behind, mut long, mut dropped) = (0, 0, 0);
    for k in 0..80_000 {
        let t = f64::from(k);
        let turns = 3.0 * (t / 3000.0).sin() + 0.9 * (t / 411.0).sin() + 0.2 * (t / 67.0).sin();
        let [cos, sin] = encoder.codes(turns);
        let (was_locked, position) = (chip.state.locked, chip.position());
        let chip_waits = chip.state.gamma_gear.to_f64() >= 4.0;
        let probes = chip.step_codes(cos, sin, false, true);
        if !was_locked {
            // The chip's map begins where it was last not counting.
            gate = GateState::new(Gate::Travelled(always));
            catching_up = Behind::default();
        }
        // The optical design, which waits for the end of a period from the fifth gear on.
        let expected = gate.step(0.0, 0.0, position * TAU, chip_waits);
        if was_locked {
            // What the loop has to catch up with does not count, until two periods had such a sample.
            let far = chip_waits && probes.e.to_f64().abs() >= spec.small_error();
            let seen = catching_up.step(far, gate.cleared(), true);
            behind += u32::from(expected && seen.catches_up);
            dropped += u32::from(expected && !seen.catches_up && seen.ends_so);
            long += u32::from(far && !seen.catches_up);
            let expected = expected && !seen.catches_up && !seen.ends_so;
            assert_eq!(probes.fresh, expected, "sample {k}");
            counted += 1;
            fresh += u32::from(expected);
        }
    }
    println!("{fresh} of {counted} samples were in a fresh sector");
    assert!(counted > 75_000 && fresh > 1000);
    assert!(
        behind > 10 && long > 10 && dropped > 0,
        "{behind} caught up, {long} counted all the same, {dropped} ended a period that is dropped"
    );
}
