//! The methods, and what each says.

use nalgebra::DMatrix;
use serde::Serialize;

use crate::ellipse::Ellipse;
use crate::gradient::{Set, ends, minimise};
use crate::{bound, conic, extremes, jackknife, unbiased, words};

/// How to calibrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The geometric fit less its curvature bias.
    Unbiased,
    /// Heydemann's least squares (5).
    Heydemann,
    /// The extremes of the two signals.
    Extremes,
    /// The gradient search of 5.2: four parameters.
    Sumsq4,
    /// That of 5.3: five.
    Sumsq5,
    /// That of 5.4: eight.
    Poly8,
    /// And nine, with the phase.
    Poly9,
}

/// What may be given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// σ_s/σ_c; `None` estimates it. Only [`Method::Unbiased`] uses it.
    pub noise_ratio: Option<f64>,
}

/// Why there is no calibration at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Not enough samples.
    #[error("{0} samples are too few; 16 or more are needed")]
    TooFew(usize),
    /// Nothing moves.
    #[error("the signals stand still: {0}; move the scale by a period or more while recording")]
    Standstill(String),
    /// The columns differ in length.
    #[error("{0} samples of cos, {1} of sin")]
    Lengths(usize, usize),
    /// A value is not finite.
    #[error("sample {0} is not finite")]
    NotFinite(usize),
    /// No ellipse.
    #[error(
        "the samples lie on no ellipse; is this a sin/cos pair, and does the recording cover enough of a period?"
    )]
    NoEllipse,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// a_c, b_c, a_s, b_s, beta, theta_1 …
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Standard error; `None` where it cannot be told.
    pub std_error: Option<f64>,
    /// "column" is the unit of the columns.
    pub unit: String,
}

/// A calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// How.
    pub method: Method,
    /// Samples used.
    pub samples: usize,
    /// Rms of the corrected radius less one.
    pub residual_rms: f64,
    /// The ellipse.
    pub ellipse: Ellipse,
    /// Physical parameters, then Θ.
    pub parameters: Vec<Parameter>,
    /// Correlations of the physical parameters, where they are known.
    pub correlations: Option<[[f64; 5]; 5]>,
    /// Noise of the channels, rms, in the unit of the columns.
    pub noise: [f64; 2],
    /// Standard errors of the physical parameters that no unbiased estimator can beat.
    pub bound: Option<[f64; 5]>,
    /// Angle error of the calibration by that bound, radians rms.
    pub angle_bound: Option<f64>,
    /// What the data cannot tell.
    pub cannot_tell: Vec<String>,
}

impl Method {
    fn set(self) -> Option<Set> {
        match self {
            Self::Sumsq4 => Some(Set::Four),
            Self::Sumsq5 => Some(Set::Five),
            Self::Poly8 => Some(Set::Eight),
            Self::Poly9 => Some(Set::Nine),
            _ => None,
        }
    }
}

/// What an estimator says: the five physical parameters, then Θ.
struct Estimate {
    ellipse: Ellipse,
    theta: Vec<f64>,
    cannot_tell: Vec<String>,
}

/// Calibrates.
///
/// # Errors
/// Where there is nothing to fit an ellipse to.
pub fn calibrate(
    cos: &[f64],
    sin: &[f64],
    method: Method,
    options: &Options,
) -> Result<Calibration, Error> {
    check(cos, sin)?;
    let rough = conic::heydemann(cos, sin);
    let start = rough
        .or_else(|| extremes::extremes(cos, sin))
        .ok_or(Error::NoEllipse)?;
    let fit = unbiased::fit(cos, sin, &start, options.noise_ratio);
    let usable = fit.converged && fit.ellipse.is_sound();
    let anchor = if usable { fit.ellipse } else { start };
    let (estimate, covariance) = if method == Method::Unbiased {
        let covariance = DMatrix::from_fn(5, 5, |i, j| fit.covariance[(i, j)]);
        let own = Estimate {
            ellipse: fit.ellipse,
            theta: fit.ellipse.theta().to_vec(),
            cannot_tell: words::of_fit(&fit),
        };
        let theta = bound::theta_errors(&fit.ellipse, &fit.covariance);
        let mut all = DMatrix::zeros(10, 10);
        all.view_mut((0, 0), (5, 5)).copy_from(&covariance);
        for (i, error) in theta.iter().enumerate() {
            all[(5 + i, 5 + i)] = error * error;
        }
        (own, Some(all))
    } else {
        let own = estimate(method, cos, sin, &anchor).ok_or(Error::NoEllipse)?;
        let vector = |cos: &[f64], sin: &[f64]| {
            let found = estimate(method, cos, sin, &anchor)?;
            let mut all = found.ellipse.parameters().as_slice().to_vec();
            all.extend(found.theta);
            Some(all)
        };
        (own, jackknife::covariance(cos, sin, &vector))
    };
    let gap = words::gap(&anchor, cos, sin);
    let mut cannot_tell = estimate.cannot_tell;
    cannot_tell.extend(words::of_arc(gap));
    if method == Method::Extremes {
        cannot_tell.push(
            "beta: the extremes of the channels say nothing about the phase between them".into(),
        );
    }
    let parameters = parameters(
        method,
        &estimate.ellipse,
        &estimate.theta,
        covariance.as_ref(),
    );
    let bound = fit
        .covariance
        .iter()
        .all(|v| v.is_finite())
        .then(|| std::array::from_fn(|i| fit.covariance[(i, i)].max(0.0).sqrt()));
    let correlations = covariance.as_ref().map(|c| {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt().max(f64::MIN_POSITIVE)
            })
        })
    });
    Ok(Calibration {
        method,
        samples: cos.len(),
        residual_rms: residual(method, &estimate.ellipse, &estimate.theta, cos, sin),
        ellipse: estimate.ellipse,
        parameters,
        correlations,
        noise: fit.noise,
        bound,
        angle_bound: angle_bound(&fit, cos, sin),
        cannot_tell,
    })
}

fn check(cos: &[f64], sin: &[f64]) -> Result<(), Error> {
    if cos.len() != sin.len() {
        return Err(Error::Lengths(cos.len(), sin.len()));
    }
    if cos.len() < 16 {
        return Err(Error::TooFew(cos.len()));
    }
    let pairs = cos.iter().zip(sin);
    if let Some(k) = pairs
        .clone()
        .position(|(c, s)| !c.is_finite() || !s.is_finite())
    {
        return Err(Error::NotFinite(k));
    }
    for (name, values) in [("cos", cos), ("sin", sin)] {
        if values.iter().all(|v| *v == values[0]) {
            return Err(Error::Standstill(format!(
                "every value of {name} is {}",
                values[0]
            )));
        }
    }
    Ok(())
}

fn estimate(method: Method, cos: &[f64], sin: &[f64], start: &Ellipse) -> Option<Estimate> {
    let of = |ellipse: Ellipse| Estimate {
        ellipse,
        theta: ellipse.theta().to_vec(),
        cannot_tell: vec![],
    };
    match method {
        Method::Unbiased | Method::Heydemann => conic::heydemann(cos, sin).map(of),
        Method::Extremes => extremes::extremes(cos, sin).map(of),
        Method::Sumsq4 | Method::Sumsq5 | Method::Poly8 | Method::Poly9 => {
            let set = method.set()?;
            let minimum = minimise(set, cos, sin, start);
            let theta = &minimum.theta;
            let ellipse = match set {
                Set::Four | Set::Five => Ellipse::of_theta(theta),
                Set::Eight | Set::Nine => {
                    let channel = |i: usize| [theta[i], theta[i + 1], theta[i + 2], theta[i + 3]];
                    let cross = theta.get(8).copied().unwrap_or(0.0);
                    let (a_c, b_c) = ends(channel(0), (start.a_c, start.b_c))?;
                    let beta = (cross * a_c).atan();
                    // The sine is corrected to sin α − (its part of the cosine channel).
                    let mut sine = channel(4);
                    sine[3] += cross * b_c;
                    let scaled = sine.map(|t| t * beta.cos());
                    let (a_s, b_s) = ends(scaled, (start.a_s, start.b_s))?;
                    Ellipse {
                        a_c,
                        b_c,
                        a_s,
                        b_s,
                        beta,
                    }
                }
            };
            let cannot_tell = words::of_minimum(set, &minimum);
            ellipse.is_sound().then_some(Estimate {
                ellipse,
                theta: minimum.theta,
                cannot_tell,
            })
        }
    }
}

fn parameters(
    method: Method,
    ellipse: &Ellipse,
    theta: &[f64],
    covariance: Option<&DMatrix<f64>>,
) -> Vec<Parameter> {
    let error = |i: usize| {
        let own = covariance.map(|c| c[(i, i)].sqrt());
        own.filter(|e| e.is_finite())
    };
    let names = ["a_c", "b_c", "a_s", "b_s", "beta"];
    let physical = ellipse.parameters();
    let mut list: Vec<Parameter> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let fixed =
                i == 4 && matches!(method, Method::Extremes | Method::Sumsq4 | Method::Poly8);
            Parameter {
                name: (*name).into(),
                value: physical[i],
                std_error: if fixed { None } else { error(i) },
                unit: if i == 4 { "rad" } else { "column" }.into(),
            }
        })
        .collect();
    let powers = method.set().unwrap_or(Set::Five).powers();
    for (i, (value, power)) in theta.iter().zip(powers).enumerate() {
        list.push(Parameter {
            name: format!("theta_{}", i + 1),
            value: *value,
            std_error: error(5 + i),
            unit: match power {
                0 => "1".into(),
                1 => "1/column".into(),
                n => format!("1/column^{n}"),
            },
        });
    }
    list
}

fn residual(method: Method, ellipse: &Ellipse, theta: &[f64], cos: &[f64], sin: &[f64]) -> f64 {
    let radius = |y_c: f64, y_s: f64| {
        let (c, s) = match method.set() {
            Some(set) => set.correct(theta, y_c, y_s),
            None => ellipse.corrected(y_c, y_s),
        };
        c.hypot(s) - 1.0
    };
    let pairs = cos.iter().zip(sin);
    let sum: f64 = pairs.map(|(c, s)| radius(*c, *s).powi(2)).sum();
    (sum / cos.len() as f64).sqrt()
}

/// The bound of the angle for the arcs that the samples cover, from a thousand of them.
fn angle_bound(fit: &unbiased::Fit, cos: &[f64], sin: &[f64]) -> Option<f64> {
    let every = cos.len().div_ceil(1000);
    let angles: Vec<f64> = cos
        .iter()
        .zip(sin)
        .step_by(every)
        .map(|(c, s)| {
            let (c, s) = fit.ellipse.corrected(*c, *s);
            s.atan2(c)
        })
        .collect();
    let noise = fit.noise.map(|n| n.max(f64::MIN_POSITIVE));
    let found = bound::bound(&fit.ellipse, &angles, noise)?;
    let share = (angles.len() as f64 / cos.len() as f64).sqrt();
    Some(found.angle_by_parameters * share).filter(|v| v.is_finite())
}
