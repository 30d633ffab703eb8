//! What each method says, in one shape.

use nalgebra::{DMatrix, SMatrix};
use nonius_recording::Ellipse;

use crate::curve::{Curve, dynamic, theta_covariance};
use crate::method::Method;
use crate::set::Set;
use crate::set_bound::{self, SetBound};
use crate::unbiased::Fit;
use crate::{conic, extremes, gradient, words};

/// What an estimator says.
pub(crate) struct Estimate {
    pub(crate) ellipse: Ellipse,
    pub(crate) covariance: Option<DMatrix<f64>>,
    pub(crate) theta: Vec<f64>,
    pub(crate) theta_covariance: Option<DMatrix<f64>>,
    pub(crate) cannot_tell: Vec<String>,
    /// It stands somewhere, but not where the samples would have it.
    pub(crate) adrift: bool,
    /// Of the amplitudes by the noise, in amplitudes.
    pub(crate) bias: Option<[f64; 2]>,
    /// The bound, where the method's set is not that of five parameters.
    pub(crate) bound: Option<SetBound>,
}

impl Estimate {
    /// Of a method that finds an ellipse.
    pub(crate) fn of(ellipse: Ellipse, covariance: Option<SMatrix<f64, 5, 5>>) -> Self {
        let sound = covariance.filter(|c| c.iter().all(|v| v.is_finite()));
        Self {
            theta: ellipse.theta().to_vec(),
            theta_covariance: sound.map(|c| dynamic(&theta_covariance(&ellipse, &c))),
            ellipse,
            covariance: sound.as_ref().map(dynamic),
            cannot_tell: vec![],
            adrift: false,
            bias: None,
            bound: None,
        }
    }
}

/// By each method; `fit` is the unbiased one.
pub(crate) fn estimate(method: Method, cos: &[f64], sin: &[f64], fit: &Fit) -> Option<Estimate> {
    match method {
        Method::Unbiased => Some(Estimate::of(
            fit.ellipse,
            fit.converged.then_some(fit.covariance),
        )),
        Method::Heydemann => {
            let found = conic::heydemann(cos, sin)?;
            Some(Estimate::of(found, conic::covariance(cos, sin, &found)))
        }
        Method::Extremes => {
            let found = extremes::extremes(cos, sin)?;
            let repeats = extremes::repeats(cos, sin, &fit.ellipse, fit.noise);
            let mut estimate = Estimate::of(found, repeats.as_ref().map(|r| r.covariance));
            if let Some(repeats) = repeats {
                let bias = [
                    repeats.bias[0] / fit.ellipse.a_c,
                    repeats.bias[2] / fit.ellipse.a_s,
                ];
                estimate.bias = Some(bias);
            }
            Some(estimate)
        }
        Method::Sumsq4 | Method::Sumsq5 | Method::Poly8 | Method::Poly9 => {
            let set = method.set();
            let minimum = gradient::minimise(set, cos, sin, &fit.ellipse);
            let bound = (set != Set::Five)
                .then(|| set_bound::of_minimum(set, &minimum, (cos, sin), fit.noise));
            Some(Estimate {
                cannot_tell: words::of_minimum(method, &minimum),
                adrift: minimum.faint > 0 || !minimum.converged,
                ellipse: minimum.ellipse.unwrap_or(fit.ellipse),
                covariance: minimum.ellipse_covariance,
                theta: minimum.theta,
                theta_covariance: minimum.covariance,
                bias: None,
                bound: bound.flatten(),
            })
        }
    }
}
