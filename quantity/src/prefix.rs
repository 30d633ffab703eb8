//! Prefixes of the SI.

/// From femto to tera.
const PREFIXES: [&str; 10] = ["f", "p", "n", "µ", "m", "", "k", "M", "G", "T"];
/// Which of them is none.
const NONE: i32 = 5;

/// The prefix of a number of this size, and the power of ten that it stands for; none above one for units that have none
/// there.
pub(crate) fn prefix(size: f64, above_one: bool) -> (&'static str, i32) {
    if size == 0.0 || !size.is_finite() {
        return ("", 0);
    }
    let most = if above_one { 4 } else { 0 };
    let steps = (size.abs().log10() / 3.0).floor().clamp(-5.0, 4.0) as i32;
    let steps = steps.min(most);
    (PREFIXES[(steps + NONE) as usize], 3 * steps)
}
