//! What a recording cannot show whatever is in it, and the experiment that would.

use crate::causes::speed_varies;
use crate::context::Context;

/// Share of the largest speed below which the scale stands.
const STANDS: f64 = 0.02;
/// Fewest scale periods that a calibration can see.
const PERIODS: f64 = 1.0;
/// Fewest revolutions that repeat themselves.
const REVOLUTIONS: f64 = 1.9;

/// A sentence for each group of causes that this recording cannot show.
#[must_use]
pub fn unseen(context: &Context) -> Vec<String> {
    let mut list: Vec<&str> = vec![];
    if context.periods_travelled() < PERIODS {
        list.push("not enough motion: less than a scale period was travelled, so hardly any error of the sensor can be seen; move it over several periods");
    }
    let stands = STANDS * context.top_speed();
    let moves = |sign: f64| context.speed.iter().any(|v| v * sign > stands);
    if !speed_varies(context) {
        list.push("not enough motion: at this constant speed channel skew, bandwidths, delayed crosstalk and hysteresis look like phase, gain and offset; record several speeds");
    } else if !(moves(1.0) && moves(-1.0)) {
        list.push("not enough motion: hysteresis is not seen in one direction; reverse");
    }
    if context.against_reference.is_none() {
        list.push("without a reference, latency and graduation errors look like motion; record a better instrument beside it");
    }
    match &context.phi {
        None => list.push("without periods_per_revolution, run-out, contamination and cogging are not looked for; give it if the axis turns"),
        Some(phi) => {
            let start = [f64::MAX, f64::MIN];
            let [low, high] = phi.iter().fold(start, |[a, b], p| [a.min(*p), b.max(*p)]);
            if (high - low) / std::f64::consts::TAU < REVOLUTIONS {
                list.push("within less than two revolutions, what repeats with the revolution and what changes with time are one; turn further");
            }
        }
    }
    list.into_iter().map(str::to_owned).collect()
}
