//! One calibration from beginning to end.

use nalgebra::DMatrix;
use nonius_recording::Ellipse;

use crate::cramer_rao;
use crate::curve::{Curve, Parameters, dynamic};
use crate::estimate::{Estimate, estimate};
use crate::method::{Error, Method, Options};
use crate::residual::{collapsed, residual, white};
use crate::result::{Calibration, Correlations, Parameter};
use crate::samples::{self, Samples};
use crate::set::Set;
use crate::unbiased::Fit;
use crate::{extremes, nothing, places, unbiased, words};

/// Which error bars the samples tell.
struct Told {
    /// Of a_c, b_c, a_s, b_s, β.
    physical: Vec<bool>,
    /// Of Θ.
    theta: Vec<bool>,
}

impl Told {
    /// Θ is made of the physical parameters, a cubic of all of them: what one cannot be told of, it cannot either.
    fn of(method: Method, untold: [bool; 5]) -> Self {
        let [a_c, b_c, a_s, b_s, beta] = untold;
        let cross = a_c || beta;
        let sine = a_s || beta;
        let theta = match method.set() {
            Set::Four => vec![a_c, a_c || b_c, a_s, a_s || b_s],
            Set::Five => vec![a_c, a_c || b_c, sine, sine || b_s || cross || b_c, cross],
            set => vec![untold.contains(&true); set.len()],
        };
        let told = |untold: &[bool]| untold.iter().map(|u| !u).collect();
        Self {
            physical: told(&untold),
            theta: told(&theta),
        }
    }
}

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
    let (c, s) = (&samples.cos[..], &samples.sin[..]);
    let mut fit = unbiased::fit(c, s, &samples.start, options.noise_ratio);
    if !fit.converged {
        fit.ellipse = samples.start;
        if samples::gap(&fit.ellipse, c, s) > words::GAP {
            return Err(Error::NoEllipse);
        }
    }
    let mut estimate = estimate(method, c, s, &fit).ok_or(Error::NoEllipse)?;
    let angles: Vec<f64> = c
        .iter()
        .zip(s)
        .map(|(c, s)| fit.ellipse.angle(*c, *s))
        .collect();
    let radians: Vec<f64> = angles.iter().map(|a| a * std::f64::consts::TAU).collect();
    let bound = cramer_rao::bound(&fit.ellipse, &radians, fit.noise);
    let gap = samples::gap(&fit.ellipse, c, s);
    let mut residual_rms = residual(method, &estimate.theta, c, s);
    let own_residual = residual(Method::Unbiased, &fit.ellipse.theta(), c, s);
    if method.searches() && collapsed(method, &estimate.theta, &fit, c, s) {
        let noise = white(&fit);
        estimate = Estimate::of(fit.ellipse, None);
        estimate.cannot_tell = vec![words::of_collapse(method, residual_rms, noise)];
        (estimate.theta, estimate.adrift) = (vec![], true);
        residual_rms = own_residual;
    }

    // Error bars and noise would be those of the numbers' last digits.
    let least = residual_rms.min(own_residual);
    let rounding = least < words::ROUNDING;
    let mut cannot_tell = estimate.cannot_tell;
    if rounding {
        cannot_tell.push(words::of_no_noise(least));
    }
    if !estimate.theta.is_empty() {
        cannot_tell.extend(words::of_method(method));
    }
    if !fit.converged && method == Method::Unbiased {
        cannot_tell.push(
            "a_c, b_c, a_s, b_s, beta: the geometric fit did not come to rest; the values are those of a conic, without \
             error bars"
                .into(),
        );
    }
    let mut untold = [false; 5];
    if fit.converged {
        cannot_tell.extend(words::of_arc(method, gap, &fit, whole(&fit, c.len())));
        untold = words::vague(&fit);
    }
    if method == Method::Extremes {
        let unseen = extremes::unseen(&fit.ellipse, &radians, fit.noise);
        cannot_tell.extend(words::of_extremes(unseen, gap > words::GAP));
        for (i, untold) in untold[..4].iter_mut().enumerate() {
            *untold |= unseen[i / 2];
        }
    }
    if estimate.adrift || rounding {
        untold = [true; 5];
    }
    // The geometric fit says itself how little it knows.
    let told = Told::of(
        method,
        if method == Method::Unbiased && !rounding {
            [false; 5]
        } else {
            untold
        },
    );
    // The bound beside every method is made of the ratio, but only one weighs the channels by it.
    if (method == Method::Unbiased || fit.ratio_extreme) && !rounding {
        cannot_tell.extend(words::of_ratio(&fit));
    }
    if !rounding {
        cannot_tell.extend(words::of_residuals(method, &fit, own_residual));
    }
    cannot_tell.extend(places::on_the_curve(angles).and_then(words::of_places));
    if !(rounding || fit.ratio_extreme || fit.ratio_assumed) {
        let steps = [c, s].map(samples::code_step);
        cannot_tell.extend(words::of_rounding(fit.noise, steps));
    }
    let mut remarks = vec![];
    if let Some(given) = options.noise_ratio {
        let own = unbiased::fit(c, s, &samples.start, None);
        remarks.extend(words::of_given_ratio(given, &own));
    }
    if let Some(bias) = estimate.bias {
        remarks.push(words::of_bias(bias, !untold.contains(&true)));
    }
    if gap > words::GAP && untold.contains(&false) {
        remarks.extend(words::of_bias_on_an_arc(method));
    }
    if samples.outliers > 0 {
        let (n, s) = (
            samples.outliers,
            if samples.outliers > 1 {
                "s lie"
            } else {
                " lies"
            },
        );
        remarks.push(format!("{n} sample{s} far off the ellipse and left out"));
    }
    if method != Method::Unbiased && fit.converged && own_residual > words::ROUNDING {
        let beside = words::beside_unbiased(method, &estimate.ellipse.parameters(), &fit, untold);
        remarks.extend(beside);
    }
    if method.set().cubic() && !estimate.theta.is_empty() {
        remarks.push(format!(
            "an ellipse leaves a residual of {own_residual:.4e} of the amplitude rms"
        ));
    }
    let errors = estimate
        .covariance
        .as_ref()
        .zip(estimate.theta_covariance.as_ref());
    let bound = bound.filter(|_| !rounding);
    let bounds = match method.set() {
        _ if rounding => None,
        Set::Five => bound
            .as_ref()
            .map(|b| (dynamic(&b.covariance), dynamic(&b.theta))),
        _ => estimate.bound.and_then(|b| Some((b.physical?, b.theta))),
    };
    Ok(Calibration {
        method,
        samples: cos.len(),
        outliers: samples.outliers,
        residual_rms,
        parameters: parameters(
            method,
            &estimate.ellipse,
            &estimate.theta,
            errors,
            bounds.as_ref().map(|(physical, theta)| (physical, theta)),
            &told,
        ),
        correlations: estimate
            .covariance
            .as_ref()
            .map(|c| correlations(c, &told.physical)),
        theta_correlations: estimate
            .theta_covariance
            .as_ref()
            .map(|c| correlations(c, &told.theta)),
        ellipse: estimate.ellipse,
        theta: estimate.theta,
        noise: (!rounding).then_some(fit.noise),
        noise_ratio_error: (!rounding
            && options.noise_ratio.is_none()
            && !fit.ratio_assumed
            && !fit.ratio_extreme)
            .then(|| fit.log_ratio_error * fit.noise[1] / fit.noise[0])
            .filter(|e| e.is_finite()),
        noise_ratio_extreme: fit.ratio_extreme && !rounding,
        shape: fit.shape.clone().filter(|_| own_residual > words::ROUNDING),
        scatter: fit.scatter.filter(|_| !rounding),
        arc: 1.0 - gap,
        bound,
        cannot_tell,
        remarks,
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
            &ellipse,
            &[],
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
        shape: None,
        scatter: None,
        arc: 0.0,
        bound: None,
        cannot_tell: vec![nothing::of_nothing(cos, sin, why)],
        remarks: vec![],
    }
}

fn check(cos: &[f64], sin: &[f64], options: &Options) -> Result<(), Error> {
    if let Some(ratio) = options.noise_ratio
        && !(ratio > 0.0 && ratio.is_finite())
    {
        return Err(Error::Ratio(ratio));
    }
    if cos.len() != sin.len() {
        return Err(Error::Lengths(cos.len(), sin.len()));
    }
    if cos.len() < nonius_recording::MIN_SAMPLES {
        return Err(Error::TooFew(cos.len()));
    }
    let mut pairs = cos.iter().zip(sin);
    if let Some(k) = pairs.position(|(c, s)| !c.is_finite() || !s.is_finite()) {
        return Err(Error::NotFinite(k));
    }
    let constant = |values: &[f64]| values.iter().all(|v| *v == values[0]);
    if constant(cos) && constant(sin) {
        let why = format!(
            "every value of cos is {} and of sin {}, as also where nothing is connected",
            cos[0], sin[0]
        );
        return Err(Error::Standstill(why));
    }
    // Before any fit: among so few codes there is always something that looks like an ellipse.
    if nonius_recording::at_rest(cos, sin) {
        let why = "both channels stay within a few steps of the ADC about one place".into();
        return Err(Error::Standstill(why));
    }
    for (name, values) in [("cos", cos), ("sin", sin)] {
        if constant(values) {
            let why = format!("every value of {name} is {}", values[0]);
            return Err(Error::Standstill(why));
        }
    }
    Ok(())
}

/// Physical parameters, then Θ; `errors` are the covariances of both, `bounds` the least that they can be.
fn parameters(
    method: Method,
    ellipse: &Ellipse,
    theta: &[f64],
    errors: Option<(&DMatrix<f64>, &DMatrix<f64>)>,
    bounds: Option<(&DMatrix<f64>, &DMatrix<f64>)>,
    told: &Told,
) -> Vec<Parameter> {
    let own =
        |c: &DMatrix<f64>, i: usize| Some(c[(i, i)].sqrt()).filter(|e| e.is_finite() && *e > 0.0);
    let physical = words::NAMES.iter().enumerate().map(|(i, name)| Parameter {
        name: (*name).into(),
        value: ellipse.parameters()[i],
        std_error: errors
            .filter(|_| told.physical[i])
            .and_then(|(c, _)| own(c, i)),
        unit: if i == 4 { "rad" } else { "column" }.into(),
        bound: bounds.and_then(|(c, _)| own(c, i)),
    });
    let powers = method.set().powers();
    let thetas = theta
        .iter()
        .zip(powers)
        .enumerate()
        .map(|(i, (value, power))| Parameter {
            name: format!("theta_{}", i + 1),
            value: *value,
            std_error: errors
                .filter(|_| told.theta[i])
                .and_then(|(_, c)| own(c, i)),
            unit: match power {
                0 => "1".into(),
                1 => "1/column".into(),
                n => format!("1/column^{n}"),
            },
            bound: bounds.and_then(|(_, c)| own(c, i)),
        });
    physical.chain(thetas).collect()
}

fn correlations(c: &DMatrix<f64>, told: &[bool]) -> Correlations {
    let known = |i: usize| told[i] && c[(i, i)] > 0.0;
    let one = |i: usize, j: usize| {
        let size = (c[(i, i)] * c[(j, j)]).sqrt();
        // Of a sandwich both halves differ in their last digits.
        let both = (c[(i, j)] + c[(j, i)]) / 2.0;
        let value = if i == j { 1.0 } else { both / size };
        (known(i) && known(j) && value.is_finite()).then_some(value)
    };
    let n = c.nrows();
    (0..n)
        .map(|i| (0..n).map(|j| one(i, j)).collect())
        .collect()
}

/// Standard errors from as many samples over whole periods.
fn whole(fit: &Fit, samples: usize) -> Option<Parameters> {
    let step = std::f64::consts::TAU / 360.0;
    let angles: Vec<f64> = (0..360).map(|k| f64::from(k) * step).collect();
    let bound = cramer_rao::bound(&fit.ellipse, &angles, fit.noise)?;
    let share = 360.0 / samples as f64;
    Some(bound.covariance.diagonal().map(|v| (v * share).sqrt()))
}
