//! Least squares on sums of products.

use nalgebra::{DMatrix, DVector};

use crate::shapes::library::Shape;

/// Directions with less than this share of a column's own square are combinations of others.
const DEPENDENT: f64 = 1e-8;

/// The sum of products; in several sums, so that no addition waits for the last one.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    const SUMS: usize = 8;
    let mut sums = [0.0; SUMS];
    let (left, right) = (a.chunks_exact(SUMS), b.chunks_exact(SUMS));
    let rest = left.remainder().iter().zip(right.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in left.zip(right) {
        for i in 0..SUMS {
            sums[i] += a[i] * b[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// `values` without their projection on `shapes`.
pub(crate) fn without(values: &[f64], shapes: &[Vec<f64>]) -> Vec<f64> {
    let solution = Normal::of_columns(values, shapes).solve();
    let mut left = values.to_vec();
    for (shape, x) in shapes.iter().zip(&solution.x) {
        for (l, s) in left.iter_mut().zip(shape) {
            *l -= x * s;
        }
    }
    left
}

/// Weights of values that give the amount of a shape in them, free of others.
pub(crate) fn weights_of(shape: &[f64], others: &[Vec<f64>]) -> Vec<f64> {
    let free = without(shape, others);
    let square: f64 = free.iter().map(|v| v * v).sum();
    free.iter().map(|v| v / square).collect()
}

/// Normal equations.
#[derive(Clone, Debug)]
pub(crate) struct Normal {
    /// Products of columns.
    pub(crate) gram: DMatrix<f64>,
    /// Products with the data.
    pub(crate) right: DVector<f64>,
    /// Square of the data.
    pub(crate) power: f64,
    /// Squares of the columns before anything was taken off them.
    norms: DVector<f64>,
}

/// Their solution.
#[derive(Clone, Debug, Default)]
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

impl Solution {
    /// The gain in log-likelihood.
    pub(crate) fn gain(&self) -> f64 {
        0.5 * self.explained
    }
}

impl Normal {
    pub(crate) fn new(gram: DMatrix<f64>, right: DVector<f64>, power: f64) -> Self {
        Self {
            norms: gram.diagonal(),
            gram,
            right,
            power,
        }
    }

    pub(crate) fn of_columns(values: &[f64], columns: &[Vec<f64>]) -> Self {
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
        Self::new(gram, right, dot(values, values))
    }

    /// Some of the columns.
    pub(crate) fn only(&self, kept: &[usize]) -> Self {
        let gram = self.gram.select_rows(kept).select_columns(kept);
        Self::new(gram, self.right.select_rows(kept), self.power)
    }

    /// The columns that shapes make of these.
    pub(crate) fn of(&self, shapes: &[Shape]) -> Self {
        let m = shapes.len();
        let mut small = Self {
            gram: DMatrix::zeros(m, m),
            right: DVector::zeros(m),
            power: self.power,
            norms: DVector::zeros(m),
        };
        for (i, shape) in shapes.iter().enumerate() {
            small.right[i] = shape.0.iter().map(|(a, x)| x * self.right[*a]).sum();
            for (j, other) in shapes[..=i].iter().enumerate() {
                let value = self.product(shape, other);
                small.gram[(i, j)] = value;
                small.gram[(j, i)] = value;
            }
            small.norms[i] = small.gram[(i, i)];
        }
        small
    }

    pub(crate) fn product(&self, a: &Shape, b: &Shape) -> f64 {
        let row = |i: usize| -> f64 { b.0.iter().map(|(j, y)| y * self.gram[(i, *j)]).sum() };
        a.0.iter().map(|(i, x)| x * row(*i)).sum()
    }

    /// The same columns and data with the projection on some shapes taken off; those as they were before.
    pub(crate) fn deflated(&self, shapes: &[Shape]) -> Self {
        let solution = self.of(shapes).solve();
        let m = self.right.len();
        // What of each column lies along each shape.
        let mut along = DMatrix::zeros(m, shapes.len());
        for (j, shape) in shapes.iter().enumerate() {
            for (i, x) in &shape.0 {
                let mut column = along.column_mut(j);
                column.axpy(*x, &self.gram.column(*i), 1.0);
            }
        }
        let spread = &along * &solution.covariance;
        let x = DVector::from_column_slice(&solution.x);
        Self {
            gram: &self.gram - &spread * along.transpose(),
            right: &self.right - &along * x,
            power: self.power - solution.explained,
            norms: self.norms.clone(),
        }
    }

    /// The solution for shapes beside what was taken off; `whole` is the same before that.
    pub(crate) fn solve_beside(&self, whole: &Self, shapes: &[Shape]) -> Solution {
        let mut small = self.of(shapes);
        for (norm, shape) in small.norms.iter_mut().zip(shapes) {
            *norm = whole.product(shape, shape);
        }
        small.solve()
    }

    /// The least-squares solution; directions that the columns hardly have are left at zero.
    pub(crate) fn solve(&self) -> Solution {
        let m = self.right.len();
        // A column of nothing gets no amount, and has no place among the others: where most are nothing, as knots at speeds
        // that never come, the search for eigenvalues ends in no number at all.
        let kept: Vec<usize> = (0..m).filter(|i| self.norms[*i] > 1e-300).collect();
        let scale: Vec<f64> = kept.iter().map(|i| self.norms[*i].sqrt().recip()).collect();
        let count = kept.len();
        let (mut x, mut covariance) = (vec![0.0; m], DMatrix::zeros(m, m));
        if count == 0 {
            return Solution {
                x,
                covariance,
                explained: 0.0,
                rank: 0,
            };
        }
        let unit = DMatrix::from_fn(count, count, |i, j| {
            self.gram[(kept[i], kept[j])] * scale[i] * scale[j]
        });
        let right = DVector::from_fn(count, |i, _| self.right[kept[i]] * scale[i]);
        let eigen = unit.symmetric_eigen();
        let largest = eigen.eigenvalues.amax().max(1.0);
        let (mut amounts, mut spread) = (DVector::zeros(count), DMatrix::zeros(count, count));
        let (mut explained, mut rank) = (0.0, 0);
        for (value, vector) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value < DEPENDENT * largest {
                continue;
            }
            let along = vector.dot(&right);
            explained += along * along / value;
            amounts += vector * (along / value);
            spread.ger(1.0 / *value, &vector, &vector, 1.0);
            rank += 1;
        }
        for (j, to) in kept.iter().enumerate() {
            x[*to] = amounts[j] * scale[j];
            for (i, row) in kept.iter().enumerate() {
                covariance[(*row, *to)] = spread[(i, j)] * scale[i] * scale[j];
            }
        }
        Solution {
            x,
            covariance,
            explained,
            rank,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Normal;

    /// As of knots at speeds that the axis never has, beside columns that depend on each other.
    #[test]
    fn columns_of_nothing_change_nothing() {
        let n = 200;
        let column = |f: fn(f64) -> f64| -> Vec<f64> { (0..n).map(|k| f(f64::from(k))).collect() };
        let some = [
            column(|k| (0.1 * k).sin()),
            column(|k| (0.1 * k).cos()),
            column(|k| (0.1 * k + 1.0).sin()),
        ];
        let data = column(|k| (0.1 * k + 0.4).sin() + 0.01 * (7.0 * k * k).sin());
        let mut all = vec![vec![0.0; data.len()]; 60];
        all.splice(20..20, some.iter().cloned());
        let (few, many) = (
            Normal::of_columns(&data, &some).solve(),
            Normal::of_columns(&data, &all).solve(),
        );
        assert_eq!((few.rank, many.rank), (2, 2));
        assert!((few.explained - many.explained).abs() < 1e-9 * few.explained);
        for (i, x) in few.x.iter().enumerate() {
            assert!((x - many.x[20 + i]).abs() < 1e-9);
        }
        assert!(many.x[..20].iter().all(|x| *x == 0.0));
    }
}
