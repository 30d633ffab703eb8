//! The search for a step: which differences it divides, and how precisely.

use crate::grid::phase;

/// The share of the values that must lie near the grid.
const NEARLY_ALL: f64 = 0.95;
/// Steps within which a value is near a place of the grid.
const NEAR: f64 = 0.25;
/// Steps counted in a difference, at most.
const WIDEST: f64 = 33_554_432.0;

/// Steps that nearly all of the `sorted` values are whole multiples of, each with a point of its
/// grid. `quantum` is the rounding of the text, `least` the smallest step of interest.
pub(crate) fn search(sorted: &[f64], quantum: f64, least: f64) -> Vec<(f64, f64)> {
    let ordered = |mut differences: Vec<f64>| {
        differences.sort_unstable_by(f64::total_cmp);
        differences
    };
    let first = ordered(sorted.windows(2).map(|w| w[1] - w[0]).collect());
    let found: Vec<_> = candidates(&first, least)
        .into_iter()
        .filter_map(|step| fit(sorted, precise(step, &first), sorted[sorted.len() / 2]))
        .filter(|(step, _)| *step > 1.5 * quantum)
        .collect();
    if !found.is_empty() {
        return found;
    }
    // Where the values are sparse no difference is one step, but two differences may differ by one.
    let second = first.windows(2).map(|w| w[1] - w[0]);
    let second = ordered(second.filter(|d| *d > 3.0 * quantum).collect());
    candidates(&second, least)
        .into_iter()
        .map(|step| precise(precise(step, &second), &first))
        .filter_map(|step| fit(sorted, step, sorted[sorted.len() / 2]))
        .filter(|(step, _)| *step > 3.0 * quantum)
        .collect()
}

/// Steps worth a trial: small differences of the `ordered`, and their halves, thirds and quarters.
fn candidates(ordered: &[f64], least: f64) -> Vec<f64> {
    let last = ordered.len().saturating_sub(1);
    let mut steps: Vec<f64> = [0, 1, 2, last / 50, last / 20, last / 10, last / 4, last / 2]
        .into_iter()
        .filter_map(|rank| ordered.get(rank))
        .flat_map(|d| [1.0, 2.0, 3.0, 4.0].map(|part| d / part))
        .filter(|step| *step >= least)
        .collect();
    steps.sort_unstable_by(f64::total_cmp);
    steps.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * *b);
    steps
}

/// A step made precise by counting it in wider and wider of the `ordered` differences.
fn precise(mut step: f64, ordered: &[f64]) -> f64 {
    let widest = ordered.last().copied().unwrap_or(0.0);
    let mut most = 1.0;
    while most < WIDEST {
        let counted = ordered.partition_point(|d| (d / step).round() <= most);
        let (mut sum, mut count) = (0.0, 0.0);
        for d in &ordered[..counted] {
            let steps = (d / step).round();
            if steps >= 1.0 {
                sum += d;
                count += steps;
            }
        }
        if count > 0.0 {
            step = sum / count;
        }
        if most > widest / step {
            break;
        }
        most *= 2.0;
    }
    step
}

/// Whether some of the values, spread over all, lie near a grid of this step: where far fewer do than nearly all, the others need
/// not be looked at.
fn some_fit(sorted: &[f64], step: f64, about: f64) -> bool {
    const SOME: usize = 250;
    const MANY: f64 = 0.8;
    let some: Vec<f64> = (sorted.iter().copied())
        .step_by((sorted.len() / SOME).max(1))
        .collect();
    let origin = about + phase(&some, step, about).0 * step;
    let near = |v: &&f64| {
        let places = (**v - origin) / step;
        (places - places.round()).abs() < NEAR
    };
    some.iter().filter(near).count() as f64 >= MANY * some.len() as f64
}

/// Straight line through the values over their whole-number places on the grid. `None` where too
/// few lie near it.
pub(crate) fn fit(sorted: &[f64], mut step: f64, about: f64) -> Option<(f64, f64)> {
    if !some_fit(sorted, step, about) {
        return None;
    }
    let mut origin = about;
    for _ in 0..4 {
        origin += phase(sorted, step, origin).0 * step;
        let near = |v: &f64| {
            let k = ((v - origin) / step).round();
            let rest = v - origin - k * step;
            (rest.abs() < NEAR * step).then_some((k, rest))
        };
        let (mut n, mut k1, mut k2, mut r1, mut rk) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (k, rest) in sorted.iter().filter_map(near) {
            n += 1.0;
            k1 += k;
            k2 += k * k;
            r1 += rest;
            rk += rest * k;
        }
        let spread = n * k2 - k1 * k1;
        if n < NEARLY_ALL * sorted.len() as f64 {
            return None;
        }
        if spread > 0.0 {
            let slope = (n * rk - k1 * r1) / spread;
            step += slope;
            origin += (r1 - slope * k1) / n;
        }
        if step.is_nan() || step <= 0.0 {
            return None;
        }
    }
    Some((step, origin))
}
