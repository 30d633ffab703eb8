//! Sums of products with the same weights at every place of a recording.

use nonius_fourier::Complex;

use crate::numerics::solve::dot;

/// The sum of the values from each place on, times the weights.
pub(crate) fn sums(values: &[f64], weights: &[f64]) -> Vec<f64> {
    /// From so many weights on by transforms, whose time does not grow with their number.
    const MANY: usize = 200;
    if weights.len() < MANY {
        one_by_one(values, weights)
    } else {
        by_blocks(values, weights)
    }
}

fn one_by_one(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let windows = values.windows(weights.len());
    windows.map(|near| dot(near, weights)).collect()
}

/// Fewer weights than values in a block.
fn by_blocks(values: &[f64], weights: &[f64]) -> Vec<f64> {
    /// Values that are transformed together; far more than there are weights.
    const BLOCK: usize = 16_384;
    let transformed = |of: &[f64]| {
        let padded = of.iter().copied().chain(std::iter::repeat(0.0));
        let mut all: Vec<Complex<f64>> = padded.take(BLOCK).map(Complex::from).collect();
        nonius_fourier::forward(&mut all);
        all
    };
    let by = transformed(weights);
    // Further on in a block, the sums would go round its end.
    let inside = BLOCK + 1 - weights.len();
    let places = (values.len() + 1).saturating_sub(weights.len());
    let mut all = Vec::with_capacity(places);
    for from in (0..places).step_by(inside) {
        let block = &values[from..values.len().min(from + BLOCK)];
        let mut product = transformed(block);
        product
            .iter_mut()
            .zip(&by)
            .for_each(|(p, w)| *p *= w.conj());
        nonius_fourier::inverse(&mut product);
        let own = product.iter().take(inside.min(places - from));
        all.extend(own.map(|p| p.re / BLOCK as f64));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::{by_blocks, one_by_one};

    #[test]
    fn blocks_and_single_places_agree() {
        let values: Vec<f64> = (0..40_000)
            .map(|k| f64::from(k * k % 1009) / 1009.0)
            .collect();
        let weights: Vec<f64> = (0..1200).map(|k| (f64::from(k) * 0.37).sin()).collect();
        for n in [1199, 1200, 16_384, 16_385, 31_569, 40_000] {
            let (fast, slow) = (
                by_blocks(&values[..n], &weights),
                one_by_one(&values[..n], &weights),
            );
            assert_eq!(fast.len(), slow.len(), "{n}");
            let apart = fast.iter().zip(&slow).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-9, "{n}");
        }
    }
}
