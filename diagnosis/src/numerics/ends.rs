//! The lowest and the highest of some values.

/// Both.
pub(crate) fn ends(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let start = [f64::MAX, f64::MIN];
    let fold = |[low, high]: [f64; 2], v: f64| [low.min(v), high.max(v)];
    values.into_iter().fold(start, fold)
}

/// From one to the other.
pub(crate) fn span(values: impl IntoIterator<Item = f64>) -> f64 {
    let [low, high] = ends(values);
    high - low
}
