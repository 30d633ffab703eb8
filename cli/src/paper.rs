//! The paper's system in floating point with the numbers of a design.

use std::f64::consts::TAU;

use nonius_model::design::Design;
use nonius_model::reference::{
    Calibration, Configuration, Gamma, Interpolator, Method, Objective, ParameterSet, Poles,
};

/// The reference interpolator of a design.
pub(crate) fn interpolator(design: &Design) -> Interpolator {
    let spec = &design.spec;
    let ts = 1.0 / spec.adc.sample_rate_hz;
    let t = &spec.tracking;
    let set = match spec.calibration.parameters {
        0 => None,
        4 => Some(ParameterSet::Four),
        _ => Some(ParameterSet::Five),
    };
    let method = match t.method {
        1 => Method::One,
        2 => Method::Two,
        _ => Method::Three,
    };
    let configuration = Configuration {
        method,
        poles: Poles::of(TAU * t.bandwidth_hz * ts, t.damping),
        second_pole: match (t.filter_type, method) {
            (2, _) => Some(1.0),
            (_, Method::Two) => None,
            _ => t.pole,
        },
        ts,
        amplitude: spec.sensor.amplitude,
        middle: spec.adc.middle,
        calibration: set.map(|set| Calibration {
            set,
            objective: Objective::FinalForm,
            gamma: Gamma {
                first: 0.5f64.powi(spec.calibration.gamma_first as i32),
                last: 0.5f64.powi(spec.calibration.gamma_last as i32),
                periods: spec.calibration.gear_periods.into(),
            },
            equaliser: vec![2.0, 1.0, 2.0, 1.0, 4.0],
            bound: 0.8,
        }),
    };
    // A design that stands is one that the paper can build.
    Interpolator::new(configuration).expect("Design::new refuses what the paper cannot build")
}
