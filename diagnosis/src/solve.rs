//! Least squares on whitened columns.

use nalgebra::{DMatrix, DVector};

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `values` without their projection on `shapes`.
pub(crate) fn without(values: &[f64], shapes: &[Vec<f64>]) -> Vec<f64> {
    let solution = Normal::of(values, shapes).solve();
    let mut left = values.to_vec();
    for (shape, x) in shapes.iter().zip(&solution.x) {
        for (l, s) in left.iter_mut().zip(shape) {
            *l -= x * s;
        }
    }
    left
}

/// Normal equations.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    gram: DMatrix<f64>,
    right: DVector<f64>,
}

/// Their solution.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    /// One number per column.
    pub(crate) x: Vec<f64>,
    /// Covariance for data of unit noise.
    pub(crate) covariance: DMatrix<f64>,
    /// What the columns explain of the sum of squares.
    pub(crate) explained: f64,
    /// Columns that are not combinations of the others.
    pub(crate) rank: usize,
}

impl Normal {
    pub(crate) fn of(values: &[f64], columns: &[Vec<f64>]) -> Self {
        let m = columns.len();
        let mut gram = DMatrix::zeros(m, m);
        let mut right = DVector::zeros(m);
        for i in 0..m {
            right[i] = dot(&columns[i], values);
            for j in 0..=i {
                let value = dot(&columns[i], &columns[j]);
                gram[(i, j)] = value;
                gram[(j, i)] = value;
            }
        }
        Self { gram, right }
    }

    /// These columns and more.
    pub(crate) fn extended(&self, values: &[f64], columns: &[Vec<f64>], more: &[Vec<f64>]) -> Self {
        let (m, k) = (columns.len(), more.len());
        let mut gram = DMatrix::zeros(m + k, m + k);
        gram.view_mut((0, 0), (m, m)).copy_from(&self.gram);
        let mut right = DVector::zeros(m + k);
        right.rows_mut(0, m).copy_from(&self.right);
        for (i, column) in more.iter().enumerate() {
            right[m + i] = dot(column, values);
            for (j, other) in columns.iter().chain(&more[..=i]).enumerate() {
                let value = dot(column, other);
                gram[(m + i, j)] = value;
                gram[(j, m + i)] = value;
            }
        }
        Self { gram, right }
    }

    /// The least-squares solution; directions that the columns hardly have are left at zero.
    pub(crate) fn solve(&self) -> Solution {
        let m = self.right.len();
        let scale: Vec<f64> = (0..m)
            .map(|i| self.gram[(i, i)].sqrt().max(1e-150))
            .collect();
        let unit = DMatrix::from_fn(m, m, |i, j| self.gram[(i, j)] / scale[i] / scale[j]);
        let right = DVector::from_fn(m, |i, _| self.right[i] / scale[i]);
        if m == 0 {
            return Solution {
                x: vec![],
                covariance: unit,
                explained: 0.0,
                rank: 0,
            };
        }
        let eigen = unit.symmetric_eigen();
        let largest = eigen.eigenvalues.amax().max(1e-300);
        let (mut x, mut covariance) = (DVector::zeros(m), DMatrix::zeros(m, m));
        let (mut explained, mut rank) = (0.0, 0);
        for (value, vector) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value < 1e-8 * largest {
                continue;
            }
            let along = vector.dot(&right);
            explained += along * along / value;
            x += vector * (along / value);
            covariance += vector * vector.transpose() / *value;
            rank += 1;
        }
        Solution {
            x: (0..m).map(|i| x[i] / scale[i]).collect(),
            covariance: DMatrix::from_fn(m, m, |i, j| covariance[(i, j)] / scale[i] / scale[j]),
            explained,
            rank,
        }
    }
}
