//! Standard errors of any estimator: leave out every so many samples, and see how far the estimate moves.

use nalgebra::{DMatrix, DVector};

/// Groups; each is every so many samples, so that each covers the same arc.
const GROUPS: usize = 40;

/// An estimate from two columns; `None` where there is none.
pub(crate) type Estimator<'a> = &'a dyn Fn(&[f64], &[f64]) -> Option<Vec<f64>>;

/// Covariance of an estimate; `None` where it cannot be made without some of the samples.
pub(crate) fn covariance(
    cos: &[f64],
    sin: &[f64],
    estimate: Estimator<'_>,
) -> Option<DMatrix<f64>> {
    let groups = GROUPS.min(cos.len() / 12);
    if groups < 8 {
        return None;
    }
    let without = |v: &[f64], group: usize| -> Vec<f64> {
        let kept = v.iter().enumerate().filter(|(k, _)| k % groups != group);
        kept.map(|(_, x)| *x).collect()
    };
    let mut all = vec![];
    for group in 0..groups {
        let found = estimate(&without(cos, group), &without(sin, group))?;
        all.push(DVector::from_vec(found));
    }
    let g = groups as f64;
    let mean = all
        .iter()
        .fold(DVector::zeros(all[0].len()), |sum, e| sum + e)
        / g;
    let mut sum = DMatrix::zeros(mean.len(), mean.len());
    for e in &all {
        let d = e - &mean;
        sum += &d * d.transpose();
    }
    Some(sum * ((g - 1.0) / g))
}
