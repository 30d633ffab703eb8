//! One calibration from beginning to end.

use nonius_recording::Ellipse;

use crate::check::check;
use crate::clipped::clipped;
use crate::curve::{Curve, dynamic};
use crate::method::{Error, Method, Options};
use crate::residual::residual;
use crate::result::{Calibration, RatioSource};
use crate::samples::Samples;
use crate::seen::Seen;
use crate::set::Set;
use crate::told::{Told, correlations, parameters};
use crate::{cramer_rao, extremes, nothing, words};

/// Calibrates.
///
/// # Errors
/// Where the columns are unusable, and where the samples draw no ellipse; [`undetermined`] puts the latter into a
/// result.
pub fn calibrate(
    cos: &[f64],
    sin: &[f64],
    method: Method,
    options: &Options,
) -> Result<Calibration, Error> {
    check(cos, sin, options)?;
    let samples = Samples::of(cos, sin).ok_or(Error::NoEllipse)?;
    let seen = Seen::by(&samples, method, options).ok_or(Error::NoEllipse)?;
    let (fit, rounding) = (&seen.fit, seen.is_rounding());
    let (mut cannot_tell, remarks) = (seen.cannot_tell(), seen.remarks());
    cannot_tell.extend(clipped(cos, sin));
    // The geometric fit says itself how little it knows.
    let told = match method {
        Method::Unbiased if !rounding => Told::of(method, [false; 5]),
        _ => Told::of(method, seen.untold()),
    };
    let noise_ratio_error = fit.log_ratio_error * fit.noise[1] / fit.noise[0];
    let noise_ratio_source = match options.noise_ratio {
        Some(_) => RatioSource::Given,
        None if fit.ratio_assumed => RatioSource::Assumed,
        None => RatioSource::Estimated,
    };
    let ratio_is_measured = noise_ratio_source == RatioSource::Estimated && !fit.ratio_extreme;
    let bound = cramer_rao::bound(&fit.ellipse, &seen.radians(), fit.noise);
    let bound = bound.filter(|_| !rounding);
    let estimate = seen.estimate;
    let (physical, theta) = (&estimate.covariance, &estimate.theta_covariance);
    let bounds = match method.set() {
        _ if rounding => None,
        Set::Five => bound
            .as_ref()
            .map(|b| (dynamic(&b.covariance), dynamic(&b.theta))),
        _ => estimate.bound.and_then(|b| Some((b.physical?, b.theta))),
    };
    let bounds = bounds.as_ref().map(|(physical, theta)| (physical, theta));
    let own = (&estimate.ellipse, &estimate.theta[..]);
    let shape = fit.shape.clone();
    Ok(Calibration {
        method,
        samples: cos.len(),
        outliers: samples.outliers,
        residual_rms: seen.residual_rms,
        parameters: parameters(
            method,
            own,
            physical.as_ref().zip(theta.as_ref()),
            bounds,
            &told,
        ),
        correlations: physical.as_ref().map(|c| correlations(c, &told.physical)),
        theta_correlations: theta.as_ref().map(|c| correlations(c, &told.theta)),
        ellipse: estimate.ellipse,
        noise: (!rounding).then_some(fit.noise),
        noise_ratio_error: Some(noise_ratio_error)
            .filter(|e| !rounding && ratio_is_measured && e.is_finite()),
        noise_ratio_extreme: fit.ratio_extreme && !rounding,
        noise_ratio_source,
        noise_together: fit.together.filter(|_| !rounding),
        shape: shape.filter(|_| seen.own_residual > words::ROUNDING),
        scatter: fit.scatter.filter(|_| !rounding),
        arc: 1.0 - seen.gap,
        bound,
        cannot_tell,
        remarks,
        theta: estimate.theta,
    })
}

/// What to say where [`calibrate`] finds no ellipse ([`Error::is_ignorance`]): half the ranges for amplitudes, no error
/// bar, and the reason.
#[must_use]
pub fn undetermined(method: Method, cos: &[f64], sin: &[f64], why: &Error) -> Calibration {
    let ellipse = extremes::extremes(cos, sin).unwrap_or(Ellipse {
        a_c: 0.0,
        b_c: cos.first().copied().unwrap_or_default(),
        a_s: 0.0,
        b_s: sin.first().copied().unwrap_or_default(),
        beta: 0.0,
    });
    Calibration {
        method,
        samples: cos.len(),
        outliers: 0,
        residual_rms: if ellipse.is_sound() {
            residual(Method::Unbiased, &ellipse.theta(), cos, sin)
        } else {
            0.0
        },
        parameters: parameters(
            method,
            (&ellipse, &[]),
            None,
            None,
            &Told::of(method, [true; 5]),
        ),
        ellipse,
        theta: vec![],
        correlations: None,
        theta_correlations: None,
        noise: None,
        noise_ratio_error: None,
        noise_ratio_extreme: false,
        noise_ratio_source: RatioSource::Assumed,
        noise_together: None,
        shape: None,
        scatter: None,
        arc: 0.0,
        bound: None,
        cannot_tell: vec![nothing::of_nothing(cos, sin, why)],
        remarks: vec![],
    }
}
