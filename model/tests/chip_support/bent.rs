//! A sensor with bends that most searches do not calibrate, at a machine's speeds.

use nonius_model::spec::Spec;

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
