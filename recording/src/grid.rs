//! The grid of codes behind a column of values: y = origin + k · step.
//!
//! The step is sought among the differences of neighbouring values and their small fractions, made
//! precise over growing spans, and accepted where nearly every value lies near the grid. That holds
//! up against the rounding of the text, missing codes, and a few values from elsewhere (a first row
//! of zeros).

use std::f64::consts::TAU;

use crate::cells::Digits;
use crate::step;

/// Codes beyond this many are not told from rounding.
const MOST_CODES: f64 = 16_777_216.0;
/// Codes beyond this many, where the step is that of the decimals alone.
const MOST_DECIMAL_CODES: f64 = 65_536.0;
/// Values looked at to find the step.
const LOOKED_AT: usize = 1 << 15;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    pub(crate) step: f64,
    /// The grid point nearest to 0, in −step/2 … step/2.
    pub(crate) origin: f64,
    /// Steps between the smallest and the largest value.
    pub(crate) codes: f64,
}

/// The distinct finite values of a column, sorted.
pub(crate) fn distinct(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.dedup();
    sorted
}

/// The grid of `sorted` distinct values, written with `digits`; `None` where there is none to see.
pub(crate) fn find(sorted: &[f64], digits: Digits) -> Option<Grid> {
    let (&low, &high) = (sorted.first()?, sorted.last()?);
    let span = high - low;
    let largest = low.abs().max(high.abs());
    let quantum = digits.quantum(largest);
    if span <= 0.0 || !span.is_finite() {
        return None;
    }
    let whole = |v: &f64| v.fract() == 0.0;
    if sorted.iter().all(whole) {
        let step = common_divisor(sorted);
        return (span / step <= MOST_CODES).then(|| Grid::new(step, low, span));
    }
    let middle = sorted.len().saturating_sub(LOOKED_AT) / 2;
    let part = &sorted[middle..sorted.len().min(middle + LOOKED_AT)];
    let found = step::search(part, quantum, f64::max(quantum, span / MOST_CODES))
        .into_iter()
        .filter(|(step, _)| span / step <= MOST_CODES)
        .filter_map(|(step, origin)| step::fit(sorted, step, origin))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((step, origin)) = found {
        return Some(Grid::new(step, origin, span));
    }
    let decimals_alone = quantum > 0.0 && span / quantum <= MOST_DECIMAL_CODES;
    decimals_alone.then(|| Grid::new(quantum, low, span))
}

/// The step of the codes that the values are, of which nobody knows how they were written; `None` where there is none to see.
#[must_use]
pub fn code_step(values: &[f64]) -> Option<f64> {
    find(&distinct(values), Digits::default()).map(|grid| grid.step)
}

/// Where values lie on a grid of that step: the offset in fractions of a step, −0.5 … 0.5, and how
/// well they agree on it, 0 … 1.
pub(crate) fn phase(values: &[f64], step: f64, about: f64) -> (f64, f64) {
    let (mut re, mut im, mut n) = (0.0, 0.0, 0.0);
    for value in values {
        let (s, c) = (((value - about) / step).fract() * TAU).sin_cos();
        re += c;
        im += s;
        n += 1.0;
    }
    (
        f64::atan2(im, re) / TAU,
        f64::hypot(re, im) / f64::max(n, 1.0),
    )
}

impl Grid {
    fn new(step: f64, point: f64, span: f64) -> Self {
        let origin = point - (point / step).round() * step;
        // What rounding left of a grid through 0.
        let origin = if origin.abs() < 1e-5 * step {
            0.0
        } else {
            origin
        };
        Self {
            step,
            origin,
            codes: span / step,
        }
    }
}

/// The greatest common divisor of the differences of whole numbers.
fn common_divisor(sorted: &[f64]) -> f64 {
    let mut divisor = 0.0f64;
    for pair in sorted.windows(2) {
        let mut rest = pair[1] - pair[0];
        while rest > 0.0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        if divisor == 1.0 {
            break;
        }
    }
    divisor.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `step` seen through text with `decimals`, at every code where `keep` holds.
    fn seen(
        step: f64,
        origin: f64,
        decimals: usize,
        keep: impl Fn(i64) -> bool,
    ) -> (Vec<f64>, Digits) {
        let mut digits = Digits::default();
        let values: Vec<f64> = (-1000..1000)
            .filter(|k| keep(*k))
            .map(|k| {
                let text = format!("{:.decimals$}", origin + k as f64 * step);
                digits.see(&text);
                text.parse().expect("a number")
            })
            .collect();
        (distinct(&values), digits)
    }

    #[track_caller]
    fn assert_step(found: Option<Grid>, step: f64) {
        let found = found.expect("a grid");
        assert!(
            (found.step / step - 1.0).abs() < 1e-4,
            "{found:?}, expected {step}"
        );
    }

    #[test]
    fn a_full_grid_rounded_by_the_text() {
        let (values, digits) = seen(2.446_34e-4, 1e-4, 6, |_| true);
        let found = find(&values, digits);
        assert_step(found, 2.446_34e-4);
        assert!(
            (found.expect("a grid").origin - 1e-4).abs() < 2e-6,
            "{found:?}"
        );
    }

    #[test]
    fn a_grid_with_few_codes_and_a_foreign_zero() {
        let (mut values, digits) = seen(0.039_525, 0.013, 5, |k| (29..90).contains(&k));
        values.push(0.0);
        assert_step(find(&distinct(&values), digits), 0.039_525);
    }

    #[test]
    fn a_sparse_grid_where_no_difference_is_one_step() {
        let (values, digits) = seen(3.3 / 65536.0, 0.0, 9, |k| k % 10 == 0 || k % 15 == 0);
        assert_step(find(&values, digits), 5.0 * 3.3 / 65536.0);
    }

    #[test]
    fn whole_numbers_are_counts_and_multiples_of_16_left_aligned_ones() {
        let (values, digits) = seen(1.0, 0.0, 0, |k| k % 3 == 0 || k % 7 == 0);
        assert_step(find(&values, digits), 1.0);
        let (values, digits) = seen(16.0, 0.0, 0, |_| true);
        assert_step(find(&values, digits), 16.0);
    }

    #[test]
    fn values_without_a_grid_have_none() {
        let mut digits = Digits::default();
        let values: Vec<f64> = (0..3000).map(|k| f64::from(k).sin()).collect();
        values.iter().for_each(|v| digits.see(&v.to_string()));
        assert_eq!(find(&distinct(&values), digits), None);
        assert_eq!(find(&distinct(&values), Digits::default()), None);
    }

    #[test]
    fn coarse_decimals_are_a_grid_of_their_own() {
        let mut digits = Digits::default();
        let texts: Vec<String> = (0..3000)
            .map(|k| format!("{:.3}", f64::from(k).sin()))
            .collect();
        texts.iter().for_each(|t| digits.see(t));
        let values: Vec<f64> = texts.iter().map(|t| t.parse().expect("a number")).collect();
        assert_step(find(&distinct(&values), digits), 1e-3);
    }
}
