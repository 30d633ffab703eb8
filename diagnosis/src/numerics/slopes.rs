//! How values change from sample to sample.

/// Lays a straight line from the value before a run to the one behind it; at an end there is one neighbour, and none where there is
/// nothing but the run.
pub(crate) fn lay_straight(values: &mut [f64], run: std::ops::Range<usize>) {
    let before = run.start.checked_sub(1).map(|k| values[k]);
    let after = values.get(run.end).copied();
    let (Some(first), Some(last)) = (before.or(after), after.or(before)) else {
        return;
    };
    let step = (last - first) / (run.len() + 1) as f64;
    for (k, value) in values[run].iter_mut().enumerate() {
        *value = first + step * (k + 1) as f64;
    }
}

/// Change per sample.
pub(crate) fn gradient(values: &[f64]) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|k| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(last));
            (values[b] - values[a]) / (b - a).max(1) as f64
        })
        .collect()
}

/// Change per sample of what moves fast: right to the fourth order.
pub(crate) fn fine_gradient(values: &[f64]) -> Vec<f64> {
    let mut change = gradient(values);
    for (k, w) in values.windows(5).enumerate() {
        change[k + 2] = (8.0 * (w[3] - w[1]) - (w[4] - w[0])) / 12.0;
    }
    change
}

/// Second derivative per sample squared by the neighbours alone: the noise of a sample of the reference stands in the residual there, too,
/// and would be found in what goes with the acceleration.
pub(crate) fn around(values: &[f64]) -> Vec<f64> {
    let mut bends = vec![0.0; values.len()];
    for (k, w) in values.windows(5).enumerate() {
        bends[k + 2] = (w[0] - w[1] - w[3] + w[4]) / 3.0;
    }
    bends
}
