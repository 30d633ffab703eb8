//! The Cramér–Rao bound beside the estimators.
//!
//! For a constant sensor without harmonics, samples evenly over the period: of the whole run (what an
//! unbiased estimator could reach that keeps all of it), and of so many samples as the chip's last γ averages over. A step γ
//! against a gradient whose modes are brought to about 1/2 leaves as much of the noise as a mean of 4/γ samples, each of the
//! 64 sectors once a period. Of the sets with a cubic with the direction v held that no radius shows (or hardly, where β is not 0), and found, as
//! uniform motion tells it. Θ of eight and nine parameters is that of the paper's raw powers.

use std::f64::consts::TAU;

use nonius_calibration::cramer_rao::Plan;
use nonius_calibration::set::Set;
use nonius_calibration::set_bound::{Motion, SetBound};
use nonius_model::design::Design;
use nonius_recording::Ellipse;

use super::scenario::{SAMPLES, SENSOR, SPEED, Scenario};

/// Name and bound of each row.
pub(crate) fn bounds(design: &Design, scenario: Scenario) -> Vec<(String, SetBound)> {
    let spec = &design.spec;
    let lsb = 2.0 * spec.adc.full_scale / 2f64.powi(spec.adc.bits as i32) / spec.sensor.amplitude;
    let averaged = 4usize << spec.calibration.gamma_last();
    let all = SAMPLES as usize;
    let bits = spec.adc.bits;
    let mut rows = vec![(
        "whole run, five".to_owned(),
        (Set::Five, Motion::Unknown),
        (all, 0.0),
    )];
    for (name, set, motion) in [
        ("four", Set::Four, Motion::Unknown),
        ("five", Set::Five, Motion::Unknown),
        ("eight, v held", Set::Eight, Motion::Unknown),
        ("eight, uniform motion", Set::Eight, Motion::Uniform),
        ("nine, v held", Set::Nine, Motion::Unknown),
        ("nine, uniform motion", Set::Nine, Motion::Uniform),
    ] {
        for (record, samples) in [
            ("whole run".to_owned(), all),
            (format!("{averaged} samples"), averaged),
        ] {
            let name = format!("{record}, {bits} bits, {name}");
            rows.push((name, (set, motion), (samples, lsb)));
        }
    }
    let ellipse = Ellipse {
        a_c: SENSOR.a_c,
        b_c: SENSOR.b_c,
        a_s: SENSOR.a_s,
        b_s: SENSOR.b_s,
        beta: SENSOR.beta,
    };
    rows.into_iter()
        .filter_map(|(name, (set, motion), (samples, lsb))| {
            // The sectors of the last gamma lie as evenly as the samples.
            let plan = Plan {
                ellipse,
                noise: [scenario.sigma(); 2],
                lsb: [lsb; 2],
                samples,
                start: 0.0,
                periods: (SPEED * samples as f64 / TAU).round(),
            };
            let bound = plan.bound_of(set, motion)?;
            Some((format!("Cramér–Rao bound, {name}"), bound))
        })
        .collect()
}
