//! The ellipse that the signals draw, before anything else is known of them.

use nonius_calibration::{Ellipse, Error, Method, Options, calibrate};
use nonius_recording::Recording;

/// Most samples that it is fitted to; the model of all samples has the five parameters again.
const ENOUGH: usize = 8192;

/// The ellipse of all samples, where one can be fitted.
pub(crate) fn of_all(recording: &Recording) -> Option<Ellipse> {
    ellipse(recording, &vec![1.0; recording.samples()]).ok()
}

/// The ellipse of the samples that count, for a weight of each.
///
/// # Errors
/// Where none can be fitted.
pub(crate) fn ellipse(recording: &Recording, weight: &[f64]) -> Result<Ellipse, Error> {
    let every = weight.len().div_ceil(ENOUGH).max(1);
    let kept = |values: &[f64]| -> Vec<f64> {
        let pairs = values.iter().zip(weight).filter(|(_, w)| **w > 0.0);
        pairs.map(|(v, _)| *v).step_by(every).collect()
    };
    let (cos, sin) = (kept(&recording.cos), kept(&recording.sin));
    let fit = calibrate(&cos, &sin, Method::Unbiased, &Options::default())?;
    Ok(fit.ellipse)
}
