//! What the data cannot tell, and what to know about the numbers, in plain words.

use nonius_quantity::agree;

use crate::curve::{Curve, Parameters};
use crate::gradient::Minimum;
use crate::method::Method;
use crate::noise::TESTED;
use crate::together::Together;
use crate::unbiased::Fit;

pub(crate) const NAMES: [&str; 5] = ["a_c", "b_c", "a_s", "b_s", "beta"];
/// Standard errors above this, in amplitudes or radians, are no knowledge.
const VAGUE: f64 = 0.1;
/// Largest gap between neighbouring angles, in turns, of data that go round.
pub(crate) const GAP: f64 = 0.25;
/// Loss by a short arc that is worth a name.
const WORSE: f64 = 3.0;
/// Residual below which it is rounding, in fractions of the amplitude.
pub(crate) const ROUNDING: f64 = 1e-8;

/// Where the geometric fit did not come to rest.
pub(crate) const OF_A_CONIC: &str = "a_c, b_c, a_s, b_s, beta: the geometric fit did not come to rest; the values are those of a conic, \
     without error bars";

/// Samples that were left out.
pub(crate) fn of_outliers(outliers: usize) -> Option<String> {
    let lie = agree(outliers, "sample lies", "samples lie");
    let are = agree(outliers, "is", "are");
    (outliers > 0).then(|| format!("{outliers} {lie} far off the ellipse and {are} left out"))
}

/// What an ellipse leaves, beside a set that is more than one.
pub(crate) fn of_an_ellipse(residual: f64) -> String {
    format!("an ellipse leaves a residual of {residual:.4e} of the amplitude rms")
}

/// Of extremes that noise pushes outwards; `bars`: their error bars are shown.
pub(crate) fn of_bias(bias: [f64; 2], bars: bool) -> String {
    let [c, s] = bias.map(|b| b * 100.0);
    let bars = if bars {
        "; the error bars, from a hundred repetitions, hold the scatter about that"
    } else {
        ""
    };
    format!(
        "with this noise the extremes are off by {c:+.2} % in a_c and {s:+.2} % in a_s on average{bars}"
    )
}

/// Which parameters the samples tell no better than [`VAGUE`], by the geometric fit.
pub(crate) fn vague(fit: &Fit) -> [bool; 5] {
    let units = fit.ellipse.units();
    std::array::from_fn(|i| {
        let error = fit.covariance[(i, i)].sqrt() / units[i];
        error.is_nan() || error > VAGUE
    })
}

/// Of a short arc: what noise does to the methods that minimise no distance.
pub(crate) fn of_bias_on_an_arc(method: Method) -> Option<String> {
    (!matches!(method, Method::Unbiased | Method::Extremes)).then(|| {
        format!(
            "noise biases {} the more the shorter the arc is, on this one perhaps by many of its error bars, which do not \
             hold the bias; unbiased has none",
            method.name()
        )
    })
}

/// Of extremes that no sample reached, of cosine and sine; `arc`: an arc is missing, and not only the places between few
/// samples.
pub(crate) fn of_extremes(unseen: [bool; 2], arc: bool) -> Vec<String> {
    let channels = [("cos", "a_c and b_c"), ("sin", "a_s and b_s")];
    let without = channels
        .into_iter()
        .zip(unseen)
        .filter(|(_, unseen)| *unseen);
    without
        .map(|((channel, both), _)| {
            let reach = if arc { "the arc does" } else { "the samples do" };
            format!(
                "{both} cannot be told by extremes: {reach} not reach both ends of {channel}; unbiased takes the whole \
                 curve"
            )
        })
        .collect()
}

/// Of the arc that is there: `whole` are the standard errors that samples spread over whole periods would have.
pub(crate) fn of_arc(
    method: Method,
    gap: f64,
    fit: &Fit,
    whole: Option<Parameters>,
) -> Vec<String> {
    let mut out = vec![];
    let errors: Vec<f64> = (0..5).map(|i| fit.covariance[(i, i)].sqrt()).collect();
    if gap > GAP {
        let worse = whole.map(|whole| {
            let named = (0..5).map(|i| (errors[i] / whole[i], NAMES[i]));
            let mut named: Vec<_> = named.filter(|(w, _)| w.is_nan() || *w > WORSE).collect();
            named.sort_by(|a, b| b.0.total_cmp(&a.0));
            let list: Vec<String> = named
                .iter()
                .map(|(w, name)| format!("{name} {w:.0} times"))
                .collect();
            list.join(", ")
        });
        let loss = match worse {
            Some(list) if !list.is_empty() => {
                format!("; less well known than from whole periods: {list}")
            }
            _ => String::new(),
        };
        out.push(format!(
            "{gap:.2} of the scale period holds no sample, and what the curve does there is an extrapolation{loss}"
        ));
    }
    let units = fit.ellipse.units();
    let vague = vague(fit);
    let whose = if method == Method::Unbiased {
        "its"
    } else {
        "even with unbiased its"
    };
    for (i, name) in NAMES.iter().enumerate() {
        let error = errors[i] / units[i];
        if vague[i] {
            out.push(if i == 4 {
                format!("{name} cannot be told from these samples: {whose} standard error is {error:.2} rad")
            } else {
                let percent = error * 100.0;
                format!(
                    "{name} cannot be told from these samples: {whose} standard error is {percent:.0} % of the amplitude"
                )
            });
        }
    }
    out
}

/// Of noise that is large beside the radius of the curve where that bends most: beyond what is tested.
pub(crate) fn of_tight_bend(radius: f64) -> Option<String> {
    /// In standard deviations of the noise; smaller ones were tried, and their error bars held too little.
    const TIGHTEST: f64 = 5.0;
    (radius < TIGHTEST).then(|| {
        format!(
            "where the curve bends most its radius is only {radius:.1} times the noise ({TIGHTEST} and more are tested): values may be off by \
             more than their error bars; record with less noise, or take the mean of neighbouring samples of a slow scale"
        )
    })
}

/// Of noise that both channels have together.
pub(crate) fn of_noise_together(together: Together) -> String {
    let Together { value, std_error } = together;
    format!(
        "the noise of both channels goes together (correlation {value:.2} ± {std_error:.2}: light, supply or ground that they share), and is \
         taken for their own: the parameters, beta first, are off, the more the larger the noise"
    )
}

/// Of samples that stand at an end of a channel.
pub(crate) fn of_clipped(channel: &str, end: &str, count: usize, value: f64) -> String {
    format!(
        "{count} samples of {channel} stand at its {end} value {value}, as where an amplifier or ADC clips: what they should be is \
         not known, and those that were not left out pull at the parameters; record with less gain"
    )
}

/// Of samples that stand at a few places of the period only. Five places lie on an ellipse whatever the signals are, and at eight a third
/// harmonic and the noise of one channel look alike.
pub(crate) fn of_places(places: usize) -> Option<String> {
    (3..=8).contains(&places).then(|| {
        format!(
            "the samples stand at {places} places of the period only ({places} samples made whole periods, or the axis stood there): \
             whether the signals are an ellipse and how much noise each channel has cannot be told from so few, and a distortion is \
             in the parameters; record at another speed"
        )
    })
}

/// Of codes that are coarse beside the noise: rounding repeats with the angle then.
pub(crate) fn of_rounding(noise: [f64; 2], steps: [Option<f64>; 2]) -> Option<String> {
    /// Noise and rounding together, in codes: a third of a code and 1/√12.
    const COARSE: f64 = 0.44;
    let share = |i: usize| steps[i].map(|step| noise[i] / step);
    let quiet = [share(0), share(1)]
        .into_iter()
        .flatten()
        .fold(f64::INFINITY, f64::min);
    (quiet < COARSE).then(|| {
        format!(
            "the residual is {quiet:.2} of a code, of which rounding alone makes 0.29: rounding beside so little noise is no noise but \
             repeats with the angle, and the parameters may be off by two to three of their error bars"
        )
    })
}

/// Two decimals, or of less than one hundredth the power of ten.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 0.01 {
        format!("{percent:.0e}")
    } else {
        format!("{percent:.2}")
    }
}

/// Of a residual without noise.
pub(crate) fn of_no_noise(residual: f64) -> String {
    format!(
        "the least residual is {residual:.0e} of the amplitude rms, which is the rounding of the numbers and no noise: standard errors, the noise, \
         its ratio and the bound would mean nothing"
    )
}

/// Of the noise, and of what is not noise.
pub(crate) fn of_residuals(method: Method, fit: &Fit, residual_rms: f64) -> Vec<String> {
    let mut out = vec![];
    if residual_rms < ROUNDING {
        return out;
    }
    if let Some(shape) = &fit.shape
        && !method.set().cubic()
    {
        out.push(format!(
            "the signals are no exact ellipse: the radius strays by {} % of the amplitude rms in step with the angle, \
             most at order {}; the parameters are those of the nearest ellipse, and the error bars, which count it as \
             noise, are a rough guess; how large an angle error stays the radius does not say, for bends alike in both \
             channels hardly show there; `nonius diagnose` looks for the cause",
            percent(shape.rms),
            shape.order
        ));
    }
    if let Some(scatter) = fit.scatter
        && fit.changes
    {
        out.push(format!(
            "consecutive parts of the recording differ {scatter:.1} times as much as the error bars say: something \
             changes in time (drift, a line, amplitude noise), and error bars are up to that much too small"
        ));
    }
    out
}

pub(crate) fn of_ratio(fit: &Fit) -> Option<String> {
    if fit.ratio_extreme {
        return Some(extreme_ratio(fit));
    }
    fit.ratio_assumed.then(|| {
        "the ratio of the channels' noise cannot be told from these samples; equal noise was taken (--noise-ratio gives \
         another)"
            .into()
    })
}

/// Of a ratio at the end of what the residuals tell.
fn extreme_ratio(fit: &Fit) -> String {
    let [c, s] = fit.relative_noise();
    let (quiet, loud) = if s > c {
        ("cos", "sin")
    } else {
        ("sin", "cos")
    };
    format!(
        "the ratio of the channels' noise cannot be told from these samples: {loud} has {TESTED} or more times the noise of \
         {quiet}, each in fractions of its amplitude, and the noise of {quiet} may be far smaller than what stands here; \
         error bars and bounds are a rough guess (--noise-ratio gives the ratio where it is known)"
    )
}

/// Of a ratio of the channels' noise that was given, where the samples say another one.
pub(crate) fn of_given_ratio(given: f64, own: &Fit) -> Option<String> {
    /// Standard errors.
    const ANOTHER: f64 = 4.0;
    if !own.converged || own.ratio_assumed {
        return None;
    }
    let ratio = own.noise[1] / own.noise[0];
    let rest = "error bars and bounds are those of the ratio that was given";
    if own.ratio_extreme {
        // Of 8 and of 50 the samples say the same.
        let gain = own.ellipse.a_s / own.ellipse.a_c;
        let [c, s] = own.relative_noise();
        let sense = (s / c).ln().signum();
        let limit = gain * TESTED.powf(sense);
        let word = if sense > 0.0 { "more" } else { "less" };
        return ((given / limit).ln() * sense < 0.0).then(|| {
            format!("--noise-ratio {given}: the samples say {limit:.2} or {word}; {rest}")
        });
    }
    let off = (given / ratio).ln().abs() / own.log_ratio_error;
    (off > ANOTHER).then(|| {
        format!(
            "--noise-ratio {given}: the samples say {ratio:.2} ± {:.2}; {rest}",
            ratio * own.log_ratio_error
        )
    })
}

pub(crate) fn of_method(method: Method) -> Vec<String> {
    let mut out = vec![];
    let name = method.name();
    if !method.finds_phase() {
        out.push(format!(
            "beta: {name} takes the channels to be a quarter of a period apart and cannot tell a phase error"
        ));
    }
    if method.set().cubic() {
        out.push(
            "the direction v (theta_1 -1, theta_3 +1, theta_5 +1, theta_7 -1, for signals of amplitude 1) changes no \
             radius but turns the angle by 1/2 sin 2 alpha per unit; the radius cannot tell it, Theta is held at \
             straight channels along v, and error bars do not hold it"
                .into(),
        );
    }
    out
}

pub(crate) fn of_minimum(method: Method, minimum: &Minimum) -> Vec<String> {
    let mut out = vec![];
    if minimum.faint > 0 {
        let (n, plural) = (minimum.faint, if minimum.faint > 1 { "s" } else { "" });
        out.push(format!(
            "{n} direction{plural} of Theta cannot be told from these samples"
        ));
    }
    if minimum.ellipse.is_none() {
        let name = method.name();
        out.push(format!(
            "a_c, b_c, a_s, b_s, beta: the curve that {name} found cannot be turned back into signals; theirs are the \
             values of the nearest ellipse"
        ));
    }
    if !minimum.converged {
        out.push("the search did not come to rest: take its numbers as a rough guess".into());
    }
    out
}

/// Of a search that maps all samples to nearly one place; `residual` is what it leaves, `noise` what noise alone leaves.
pub(crate) fn of_collapse(method: Method, residual: f64, noise: f64) -> String {
    format!(
        "theta: the search of {} collapsed: it turns all samples into nearly one place of the circle, where the residual is \
         {residual:.1e} of the amplitude rms and noise alone makes {noise:.1e}; its values are withheld, and a_c, b_c, a_s, \
         b_s and beta are those of the nearest ellipse; move the scale by a whole period or more while recording",
        method.name()
    )
}

/// How an estimate lies beside the unbiased one, in standard errors of the latter.
pub(crate) fn beside_unbiased(
    method: Method,
    found: &Parameters,
    fit: &Fit,
    untold: [bool; 5],
) -> Option<String> {
    let told = (0..5).filter(|i| !untold[*i] && (*i < 4 || method.finds_phase()));
    let against = told.map(|i| {
        let miss = (found[i] - fit.ellipse.parameters()[i]) / fit.covariance[(i, i)].sqrt();
        (miss.abs(), NAMES[i])
    });
    let (most, name) = against.max_by(|a, b| a.0.total_cmp(&b.0))?;
    if method.set().cubic() {
        return None;
    }
    (most > 2.0 && most.is_finite()).then(|| {
        format!(
            "{name} lies {most:.1} standard errors of unbiased from what that finds: noise and distortion bias {}",
            method.name()
        )
    })
}
