//! Standard errors of a least-squares estimate whose residuals are not simply the noise: H⁻¹ V H⁻¹, with H = Σ g gᵀ
//! and V = Σ r² g gᵀ. It holds for any distribution of the residuals, as long as the samples are independent.

use nalgebra::{DMatrix, DVector};

/// Sums over the samples.
pub(crate) struct Sandwich {
    bread: DMatrix<f64>,
    filling: DMatrix<f64>,
    slope: DVector<f64>,
    count: usize,
}

impl Sandwich {
    pub(crate) fn new(parameters: usize) -> Self {
        Self {
            bread: DMatrix::zeros(parameters, parameters),
            filling: DMatrix::zeros(parameters, parameters),
            slope: DVector::zeros(parameters),
            count: 0,
        }
    }

    /// A sample's residual and its derivative by the parameters.
    pub(crate) fn add(&mut self, residual: f64, slope: &[f64]) {
        self.slope.copy_from_slice(slope);
        let g = &self.slope;
        self.bread.syger(1.0, g, g, 1.0);
        self.filling.syger(residual * residual, g, g, 1.0);
        self.count += 1;
    }

    /// Covariance of the parameters; `None` where the samples do not determine them.
    pub(crate) fn covariance(mut self) -> Option<DMatrix<f64>> {
        self.bread.fill_upper_triangle_with_lower_triangle();
        self.filling.fill_upper_triangle_with_lower_triangle();
        let n = self.count as f64;
        let free = n - self.bread.nrows() as f64;
        if free < 1.0 {
            return None;
        }
        let inverse = self.bread.try_inverse()?;
        let all = &inverse * self.filling * &inverse * (n / free);
        all.iter().all(|v| v.is_finite()).then_some(all)
    }
}
