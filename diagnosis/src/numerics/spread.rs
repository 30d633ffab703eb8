//! Values in the unit of their own spread.

/// Centred, of unit spread; `None` if it does not change.
pub(crate) fn standardised(values: &[f64]) -> Option<Vec<f64>> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let spread = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt();
    let finite = spread.is_finite() && spread > 1e-9;
    finite.then(|| values.iter().map(|v| (v - mean) / spread).collect())
}
