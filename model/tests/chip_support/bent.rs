//! A sensor with bends that most searches do not calibrate, at a machine's speeds.

use nonius_model::bits::Bits;
use nonius_model::design::Design;
use nonius_model::kernel::State;
use nonius_model::kernel::step::Equaliser;
use nonius_model::spec::{Calibration, Spec};

/// Samples per second.
pub(crate) const RATE: u32 = 5000;

/// A design whose completion, where there is one, is awake at 50 periods a second.
pub(crate) fn slow(spec: &Spec) -> Spec {
    let mut spec = spec.clone();
    spec.adc.sample_rate_hz = RATE.into();
    spec.sensor.speed_max_periods_per_s = 500.0;
    let completed = spec.calibration.completed().is_some();
    spec.tracking.bandwidth_hz = if completed { 150.0 } else { 300.0 };
    spec.accuracy.rms_periods = 200e-6;
    spec
}

/// A sensor with bends of 1 and 3 %; offsets of 10 % with these signs.
pub(crate) fn bent_sensor(spec: &Spec, signs: u32) -> impl Fn(f64) -> (f64, f64) + use<> {
    let sign = move |bit: u32| if signs >> bit & 1 == 0 { 0.1 } else { -0.1 };
    // What is not calibrated is no part of the sensor.
    let phase = match spec.calibration.parameters {
        5 | 9 => 5f64.to_radians(),
        _ => 0.0,
    };
    let bent = |u: f64| u + 0.01 * u * u + 0.03 * u * u * u;
    move |alpha: f64| {
        let (c, s) = (alpha.cos() + sign(0), (alpha - phase).sin() + sign(1));
        (bent(c), bent(s))
    }
}

/// Deviations of θ1 … θ9, every bit of them.
pub(crate) fn parameters(s: &State<Bits>) -> [f64; 9] {
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

/// σ √(γ/2) of θ1 … θ9, γ that of the parameter: the last one times the equaliser's power of two, and what is
/// left of the phase's once γ has settled.
pub(crate) fn noise(design: &Design) -> [f64; 9] {
    noise_in(design, design.spec.calibration.gears())
}

/// The same in a gear of γ.
pub(crate) fn noise_in(design: &Design, gear: u32) -> [f64; 9] {
    let (k, by) = (&design.spec.calibration, Equaliser::of(&design.structure));
    let (gain, offset, bend) = (by.gain, by.offset, by.bend);
    let less = if k.phase_settles() && gear >= k.settled_gears() {
        Calibration::PHASE_HALVINGS
    } else {
        0
    };
    let phase = by.phase - less as i32;
    let powers = [gain, offset, gain, offset, phase, bend, bend, bend, 0];
    let mut gamma = powers.map(|power| 2f64.powi(power - (k.gamma_first + gear) as i32));
    gamma[8] = 2f64.powi(-(k.completion_gamma as i32));
    gamma.map(|gamma| design.spec.sensor.noise_rms * (gamma / 2.0).sqrt())
}
