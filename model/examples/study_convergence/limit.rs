//! The Cramér–Rao bound beside the estimators.
//!
//! For a constant sensor of five parameters without harmonics, samples evenly over the period: of the whole run (what an
//! unbiased estimator could reach that keeps all of it), and of so many samples as the chip's last γ averages over. A step γ
//! against a gradient whose modes are brought to about 1/2 leaves as much of the noise as a mean of 4/γ samples, each of the
//! 64 sectors once a period.

use std::f64::consts::TAU;

use nonius_calibration::cramer_rao::{Bound, Plan};
use nonius_model::design::Design;
use nonius_recording::Ellipse;

use super::scenario::{SAMPLES, SENSOR, SPEED, Scenario};

/// Name and bound of each row.
pub(crate) fn bounds(design: &Design, scenario: Scenario) -> Vec<(String, Bound)> {
    let spec = &design.spec;
    let lsb = 2.0 * spec.adc.full_scale / 2f64.powi(spec.adc.bits as i32) / spec.sensor.amplitude;
    let averaged = 4usize << spec.calibration.gamma_last;
    let all = SAMPLES as usize;
    let bits = spec.adc.bits;
    [
        ("Cramér–Rao bound, whole run".to_owned(), all, 0.0),
        (
            format!("Cramér–Rao bound, whole run, {bits} bits"),
            all,
            lsb,
        ),
        (
            format!("Cramér–Rao bound, {averaged} samples, {bits} bits"),
            averaged,
            lsb,
        ),
    ]
    .into_iter()
    .filter_map(|(name, samples, lsb)| {
        let plan = Plan {
            ellipse: Ellipse {
                a_c: SENSOR.a_c,
                b_c: SENSOR.b_c,
                a_s: SENSOR.a_s,
                b_s: SENSOR.b_s,
                beta: SENSOR.beta,
            },
            noise: [scenario.sigma(); 2],
            lsb: [lsb; 2],
            samples,
            start: 0.0,
            // The sectors of the last gamma lie as evenly as the samples.
            periods: (SPEED * samples as f64 / TAU).round(),
        };
        Some((name, plan.bound()?))
    })
    .collect()
}
