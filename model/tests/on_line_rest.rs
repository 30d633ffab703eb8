//! Standstill and vibration: without net travel the parameters stay where they are.
//!
//! Between two clearings of the map of sectors each of the 64 sectors moves the parameters once at most, and the map is cleared
//! where the position is a whole period from where it was last. So what stays within a period can take no more than what is left
//! of one map, on one side of its place, however long it lasts: ten minutes differ from one by chance only, and the tests show both.

mod chip_support;

use std::f64::consts::TAU;

use chip_support::shipped::variants::{Variant, searches};
use chip_support::{Bench, figure};
use nonius_model::bits::Bits;
use nonius_model::design::Design;
use nonius_model::kernel::State;
use nonius_model::spec::Spec;
use rayon::prelude::*;

/// Samples per second.
const RATE: u32 = 5000;

/// Deviations of θ1 … θ9, every bit of them.
fn parameters(s: &State<Bits>) -> [f64; 9] {
    [
        s.theta_1_deviation,
        s.theta_2_deviation,
        s.theta_3_deviation,
        s.theta_4_deviation,
        s.theta_5_deviation,
        s.theta_6_deviation,
        s.theta_7_deviation,
        s.theta_8_deviation,
        s.theta_9_deviation,
    ]
    .map(Bits::to_f64)
}

/// σ √(γ/2) of θ1 … θ9, γ that of the parameter: the last one times the equaliser's power of two.
fn noise(design: &Design) -> [f64; 9] {
    let (spec, amplitude) = (&design.spec, design.structure.amplitude_shift as i32);
    let gain = 1 + amplitude;
    let phase = if design.structure.has_bend() {
        2
    } else {
        3 + amplitude
    };
    let last = -(spec.calibration.gamma_last as i32);
    let mut gamma = [gain, 0, gain, 0, phase, 0, 0, 0, 0].map(|power| 2f64.powi(power + last));
    gamma[8] = 2f64.powi(-(spec.calibration.completion_gamma as i32));
    gamma.map(|gamma| spec.sensor.noise_rms * (gamma / 2.0).sqrt())
}

fn calibrated_phase(spec: &Spec) -> f64 {
    match spec.calibration.parameters {
        5 | 9 => 5f64.to_radians(),
        _ => 0.0,
    }
}

/// How far the furthest parameter goes, in units of its noise, while the scale rests, or vibrates by `amplitude` (turns), about
/// `place`.
fn moved(variant: &Variant, place: f64, amplitude: f64, seconds: u32, seed: u32) -> f64 {
    let mut spec = variant.spec.clone();
    spec.adc.sample_rate_hz = RATE.into();
    spec.sensor.speed_max_periods_per_s = 500.0;
    spec.tracking.bandwidth_hz = 300.0;
    spec.accuracy.rms_periods = 200e-6;
    let sign = |bit: u32| if seed >> bit & 1 == 0 { 0.1 } else { -0.1 };
    // What is not calibrated is no part of the sensor.
    let phase = calibrated_phase(&spec);
    let linear = |alpha: f64| (alpha.cos() + sign(0), (alpha - phase).sin() + sign(1));
    let bent = |u: f64| u + 0.01 * u * u + 0.03 * u * u * u;
    let signals = |alpha: f64| {
        let (c, s) = linear(alpha);
        (bent(c), bent(s))
    };
    let mut bench = Bench::new(&spec, u64::from(seed));
    // 50 periods a second for forty seconds, then it stops there.
    let mut turns = 0.0;
    while turns < 2000.0 + place {
        turns += 0.01;
        bench.step(signals(TAU * turns));
    }
    assert!(bench.chip.state.locked);
    let before = parameters(&bench.chip.state);
    let noise = noise(&bench.design);
    let mut furthest = 0.0f64;
    for k in 0..seconds * RATE {
        let t = f64::from(k) / f64::from(RATE);
        let place = turns + amplitude * (TAU * 7.3 * t).sin();
        bench.step(signals(TAU * place));
        if k % 500 == 0 {
            let now = parameters(&bench.chip.state);
            for (i, now) in now.into_iter().enumerate() {
                furthest = furthest.max((now - before[i]).abs() / noise[i]);
            }
        }
    }
    assert!(bench.chip.state.locked);
    furthest
}

/// What is furthest from where it was, in its noise, is within the limit.
fn holds(variant: &Variant, when: &str, furthest: f64) {
    let (what, set) = (&variant.what, variant.spec.calibration.parameters);
    println!("{what}, {set} parameters, {when}: {furthest:.2} of the noise");
    assert!(furthest <= 3.0, "{what}");
}

/// The same at eight places of the period, with all signs of offsets.
fn anywhere(variant: &Variant, (when, amplitude): (&str, f64), seconds: u32) -> f64 {
    let at = |eighth: u32| moved(variant, f64::from(eighth) / 8.0, amplitude, seconds, eighth);
    let furthest = (0..8).map(at).fold(0.0, f64::max);
    holds(variant, when, furthest);
    furthest
}

/// A minute (of the searches whose figures are kept, of the others a third) at eight places of the period, sensors with all signs
/// of offsets, 5° of phase where it is calibrated, 1 % of even and 3 % of cubic distortion: no parameter of any search moves by
/// more than three times its noise.
#[test]
fn neither_standstill_nor_vibration_moves_a_parameter() {
    let measured: Vec<String> = searches()
        .par_iter()
        .flat_map_iter(|variant| {
            let kept = variant.what == "final form" || variant.what == "completed";
            let seconds = if kept { 60 } else { 20 };
            let set = variant.spec.calibration.parameters;
            let both = [("standstill", 0.0), ("vibration", 0.1)].into_iter();
            both.filter_map(move |when| {
                let furthest = anywhere(variant, when, seconds);
                kept.then(|| format!("{set} parameters, {} {furthest:.1}", when.0))
            })
        })
        .collect();
    figure(
        "a minute at rest or vibrating by ±0.1 periods, at any place, bends of 1 and 3 %: the furthest a parameter moves, in its noise",
        &measured.join("; "),
        "model/tests/on_line_rest.rs",
    );
}

/// Ten minutes.
#[test]
fn ten_minutes_of_vibration_move_no_parameter() {
    for variant in searches() {
        if !matches!(variant.what.as_str(), "final form" | "completed") {
            continue;
        }
        holds(&variant, "ten minutes", moved(&variant, 0.3, 0.1, 600, 2));
    }
}
