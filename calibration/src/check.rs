//! What no method can use.

use crate::method::{Error, Options};

/// Refuses columns that are unusable.
pub(crate) fn check(cos: &[f64], sin: &[f64], options: &Options) -> Result<(), Error> {
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
