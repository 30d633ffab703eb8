//! The simulation that a diagnosis puts to the test: five fitted parameters and white noise.

pub(crate) mod motion;
pub(crate) mod sensor;

use nonius_calibration::Ellipse;
use serde::Serialize;

use crate::finding::{Cause, Parameter};
use crate::model::exact;
use crate::model::{Fit, System};

/// The sensor with its five fitted parameters and white noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Simulation {
    /// What it holds.
    pub causes: Vec<SimulatedCause>,
    /// Rms of radial and tangential residual, in fractions of the amplitude.
    pub residual_rms: f64,
    /// The same on data that was not fitted.
    pub held_out_residual_rms: f64,
    /// Against the reference, on data that was not fitted, radians.
    pub position_error_rms_rad: Option<f64>,
}

/// A cause that every simulation has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatedCause {
    /// Its name.
    pub cause: Cause,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// Standard errors of a_c, b_c, a_s, b_s and β, by those of the five numbers that were fitted beside an ellipse.
fn errors(ellipse: &Ellipse, base: &Fit) -> [f64; 5] {
    /// Small against every error that is seen, large against rounding.
    const STEP: f64 = 1e-6;
    let parameters = |x: &[f64]| {
        let e = exact::ellipse(ellipse, x);
        [e.a_c, e.b_c, e.a_s, e.b_s, e.beta]
    };
    let (x, covariance) = (&base.solution.x, &base.solution.covariance);
    let at = parameters(x);
    let slopes: Vec<[f64; 5]> = (0..x.len())
        .map(|i| {
            let mut moved = x.clone();
            moved[i] += STEP;
            let there = parameters(&moved);
            std::array::from_fn(|p| (there[p] - at[p]) / STEP)
        })
        .collect();
    std::array::from_fn(|p| {
        let pairs = (0..x.len()).flat_map(|i| (0..x.len()).map(move |j| (i, j)));
        let square = pairs.map(|(i, j)| slopes[i][p] * covariance[(i, j)] * slopes[j][p]);
        square.sum::<f64>().max(0.0).sqrt()
    })
}

/// The simulation by the five parameters that were fitted.
pub(crate) fn simulation(
    base: &Fit,
    system: &System,
    held_out: f64,
    rms: f64,
    position: Option<f64>,
    unit: &str,
) -> Simulation {
    let n = system.context.samples() as f64;
    let noise = system.noise();
    let ellipse = &system.context.ellipse;
    let e = exact::ellipse(ellipse, &base.solution.x);
    let [a_c, b_c, a_s, b_s, beta] = errors(ellipse, base);
    let p = Parameter::measured;
    Simulation {
        causes: vec![
            SimulatedCause {
                cause: Cause::Offset,
                parameters: vec![p("b_c", e.b_c, b_c, unit), p("b_s", e.b_s, b_s, unit)],
            },
            SimulatedCause {
                cause: Cause::GainMismatch,
                parameters: vec![p("a_c", e.a_c, a_c, unit), p("a_s", e.a_s, a_s, unit)],
            },
            SimulatedCause {
                cause: Cause::QuadratureError,
                parameters: vec![p("beta", e.beta, beta, "rad")],
            },
            SimulatedCause {
                cause: Cause::WhiteNoise,
                parameters: vec![p("rms", noise, noise / (2.0 * n).sqrt(), "amplitude")],
            },
        ],
        residual_rms: rms,
        held_out_residual_rms: held_out,
        position_error_rms_rad: position,
    }
}
