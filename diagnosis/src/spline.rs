//! Motion is a nuisance: a cubic spline in time, fitted by banded least squares and taken off.

/// Least-squares projection on uniform cubic B-splines over sample numbers.
#[derive(Clone, Debug)]
pub struct Spline {
    /// Samples between knots.
    spacing: f64,
    /// Cholesky factor: four diagonals per coefficient.
    factor: Vec<[f64; 4]>,
    samples: usize,
}

/// The four B-splines that are not zero at `x` in 0 … 1 between two knots.
fn weights(x: f64) -> [f64; 4] {
    let y = 1.0 - x;
    [
        y * y * y / 6.0,
        (3.0 * x * x * x - 6.0 * x * x + 4.0) / 6.0,
        (3.0 * y * y * y - 6.0 * y * y + 4.0) / 6.0,
        x * x * x / 6.0,
    ]
}

/// Their derivatives by `x`.
fn slopes(x: f64) -> [f64; 4] {
    let y = 1.0 - x;
    [
        -y * y / 2.0,
        (3.0 * x * x - 4.0 * x) / 2.0,
        -(3.0 * y * y - 4.0 * y) / 2.0,
        x * x / 2.0,
    ]
}

impl Spline {
    /// A spline over `samples` samples with a knot about every `spacing` of them; `weight` is 0 where a sample does
    /// not count.
    #[must_use]
    pub fn new(samples: usize, spacing: f64, weight: &[f64]) -> Self {
        let pieces = ((samples as f64 / spacing).round() as usize).max(1);
        let spacing = samples as f64 / pieces as f64;
        let count = pieces + 3;
        let mut normal = vec![[0.0; 4]; count];
        for (k, weight) in weight.iter().enumerate().take(samples) {
            let (first, w) = Self::at(spacing, pieces, k);
            let b = weights(w);
            for i in 0..4 {
                for j in 0..=i {
                    // Row first+i, column first+j: stored by distance from the diagonal.
                    normal[first + i][i - j] += weight * b[i] * b[j];
                }
            }
        }
        let scale = samples as f64 / count as f64;
        for row in &mut normal {
            row[0] += 1e-13 * scale.max(1e-3);
        }
        // Cholesky in the band.
        for i in 0..count {
            for d in (0..4.min(i + 1)).rev() {
                let j = i - d;
                let mut sum = normal[i][d];
                for m in 1..4 - d {
                    if j >= m {
                        sum -= normal[i][d + m] * normal[j][m];
                    }
                }
                normal[i][d] = if d == 0 {
                    sum.max(1e-300).sqrt()
                } else {
                    sum / normal[j][0]
                };
            }
        }
        Self {
            spacing,
            factor: normal,
            samples,
        }
    }

    /// Samples between knots.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Number of coefficients.
    #[must_use]
    pub fn count(&self) -> usize {
        self.factor.len()
    }

    fn at(spacing: f64, pieces: usize, k: usize) -> (usize, f64) {
        let x = (k as f64 + 0.5) / spacing;
        let first = (x as usize).min(pieces - 1);
        (first, x - first as f64)
    }

    /// Coefficients of the best spline through `values`.
    #[must_use]
    pub fn fit(&self, values: &[f64], weight: &[f64]) -> Vec<f64> {
        let pieces = self.count() - 3;
        let mut x = vec![0.0; self.count()];
        for k in 0..self.samples {
            if weight[k] == 0.0 {
                continue;
            }
            let (first, w) = Self::at(self.spacing, pieces, k);
            for (i, b) in weights(w).into_iter().enumerate() {
                x[first + i] += weight[k] * b * values[k];
            }
        }
        for i in 0..x.len() {
            for d in 1..4.min(i + 1) {
                x[i] -= self.factor[i][d] * x[i - d];
            }
            x[i] /= self.factor[i][0];
        }
        for i in (0..x.len()).rev() {
            for d in 1..4 {
                if i + d < x.len() {
                    x[i] -= self.factor[i + d][d] * x[i + d];
                }
            }
            x[i] /= self.factor[i][0];
        }
        x
    }

    /// The spline at every sample.
    #[must_use]
    pub fn values(&self, coefficients: &[f64]) -> Vec<f64> {
        self.evaluate(coefficients, weights, 1.0)
    }

    /// Its derivative per sample.
    #[must_use]
    pub fn derivative(&self, coefficients: &[f64]) -> Vec<f64> {
        self.evaluate(coefficients, slopes, 1.0 / self.spacing)
    }

    fn evaluate(&self, coefficients: &[f64], basis: fn(f64) -> [f64; 4], scale: f64) -> Vec<f64> {
        let pieces = self.count() - 3;
        (0..self.samples)
            .map(|k| {
                let (first, w) = Self::at(self.spacing, pieces, k);
                let parts = basis(w).into_iter().enumerate();
                scale * parts.map(|(i, b)| b * coefficients[first + i]).sum::<f64>()
            })
            .collect()
    }

    /// What of `values` no such spline can follow.
    #[must_use]
    pub fn residual(&self, values: &[f64], weight: &[f64]) -> Vec<f64> {
        let smooth = self.values(&self.fit(values, weight));
        values
            .iter()
            .zip(smooth)
            .zip(weight)
            .map(|((v, s), w)| (v - s) * w)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Spline;

    #[test]
    fn cubics_leave_nothing_and_fast_waves_stay() {
        let n = 1000;
        let weight = vec![1.0; n];
        let spline = Spline::new(n, 50.0, &weight);
        let cubic: Vec<f64> = (0..n)
            .map(|k| {
                let x = k as f64 / 300.0;
                1.0 - 2.0 * x + x * x * x
            })
            .collect();
        let left = spline.residual(&cubic, &weight);
        assert!(left.iter().all(|v| v.abs() < 1e-6));
        let slope = spline.derivative(&spline.fit(&cubic, &weight));
        let x: f64 = 500.0 / 300.0;
        assert!((slope[500] - (-2.0 + 3.0 * x * x) / 300.0).abs() < 1e-5);
        let wave: Vec<f64> = (0..n).map(|k| (k as f64 * 0.7).sin()).collect();
        let left = spline.residual(&wave, &weight);
        let power = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
        assert!(power(&left) > 0.9 * power(&wave));
        // A projection: once is enough.
        let twice = spline.residual(&left, &weight);
        assert!(left.iter().zip(&twice).all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn samples_that_do_not_count_pull_nothing() {
        let n = 400;
        let mut weight = vec![1.0; n];
        let mut values = vec![2.0; n];
        weight[200] = 0.0;
        values[200] = 1e6;
        let left = Spline::new(n, 40.0, &weight).residual(&values, &weight);
        assert!(left.iter().all(|v| v.abs() < 1e-6));
    }
}
