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

/// Writes four functions of places.
fn fill(
    [a, b, c, d]: [&mut [f64]; 4],
    places: impl Iterator<Item = f64>,
    of: impl Fn(f64) -> [f64; 4],
) {
    let lists = a.iter_mut().zip(b).zip(c).zip(d);
    for (x, (((a, b), c), d)) in places.zip(lists) {
        [*a, *b, *c, *d] = of(x);
    }
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
            let (first, w) = Self::piece(spacing, pieces, k as f64);
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

    /// Its knots, as numbers of samples: some lie before the first and behind the last one.
    pub(crate) fn knots(&self) -> impl Iterator<Item = f64> {
        let pieces = self.count() - 3;
        (0..=pieces).map(|i| i as f64 * self.spacing - 0.5)
    }

    /// The spline and its derivative per sample at any place between samples.
    pub(crate) fn between(&self, coefficients: &[f64], sample: f64) -> (f64, f64) {
        let (first, x) = Self::piece(self.spacing, self.count() - 3, sample);
        let sum = |by: [f64; 4]| -> f64 {
            let own = coefficients[first..].iter().zip(by);
            own.map(|(c, b)| c * b).sum()
        };
        (sum(weights(x)), sum(slopes(x)) / self.spacing)
    }

    /// The piece that a place lies in, and how far in it.
    fn piece(spacing: f64, pieces: usize, sample: f64) -> (usize, f64) {
        let x = (sample + 0.5) / spacing;
        let first = (x as usize).min(pieces - 1);
        (first, x - first as f64)
    }

    /// The B-splines of a stretch of samples from `start` on.
    pub(crate) fn basis(&self, start: usize, samples: usize, slope: bool) -> Basis {
        let last = self.count() - 4;
        let begin = start as f64 + 0.5;
        let places = (0..samples as u32).map(|k| (begin + f64::from(k)) / self.spacing);
        let places: Vec<f64> = places.collect();
        let mut basis = Basis {
            weights: std::array::from_fn(|_| vec![0.0; samples]),
            pieces: vec![],
        };
        let mut from = 0;
        while from < samples {
            let first = (places[from] as usize).min(last);
            let within = |x: &f64| first == last || *x < (first + 1) as f64;
            let range = from..from + places[from..].partition_point(within);
            from = range.end;
            let lists = basis.weights.each_mut().map(|w| &mut w[range.clone()]);
            let places = places[range.clone()].iter().map(|x| x - first as f64);
            if slope {
                fill(lists, places, |x| slopes(x).map(|v| v / self.spacing));
            } else {
                fill(lists, places, weights);
            }
            basis.pieces.push((first, range));
        }
        basis
    }

    /// Sums of products with the B-splines → coefficients.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        self.solve_together(x.as_chunks_mut::<1>().0);
    }

    /// The same of many columns, of as many coefficients each: several at once, for each step waits for the one before.
    pub(crate) fn solve_all<'a>(&self, columns: impl Iterator<Item = &'a mut Vec<f64>>) {
        const TOGETHER: usize = 8;
        let mut columns: Vec<&mut Vec<f64>> = columns.collect();
        let mut rows = vec![[0.0; TOGETHER]; self.count()];
        for group in columns.chunks_mut(TOGETHER) {
            for (i, column) in group.iter().enumerate() {
                rows.iter_mut()
                    .zip(column.iter())
                    .for_each(|(row, v)| row[i] = *v);
            }
            self.solve_together(&mut rows);
            for (i, column) in group.iter_mut().enumerate() {
                column
                    .iter_mut()
                    .zip(&rows)
                    .for_each(|(v, row)| *v = row[i]);
                without_tails(column);
            }
        }
    }

    fn solve_together<const N: usize>(&self, x: &mut [[f64; N]]) {
        for i in 0..x.len() {
            let mut now = x[i];
            for d in 1..4.min(i + 1) {
                let (by, other) = (self.factor[i][d], x[i - d]);
                now.iter_mut().zip(other).for_each(|(v, o)| *v -= by * o);
            }
            now.iter_mut().for_each(|v| *v /= self.factor[i][0]);
            x[i] = now;
        }
        for i in (0..x.len()).rev() {
            let mut now = x[i];
            for d in 1..4.min(x.len() - i) {
                let (by, other) = (self.factor[i + d][d], x[i + d]);
                now.iter_mut().zip(other).for_each(|(v, o)| *v -= by * o);
            }
            now.iter_mut().for_each(|v| *v /= self.factor[i][0]);
            x[i] = now;
        }
    }

    /// Coefficients of the best spline through `values`.
    #[must_use]
    pub fn fit(&self, values: &[f64], weight: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.count()];
        for start in (0..self.samples).step_by(STRETCH) {
            let range = start..(start + STRETCH).min(self.samples);
            let basis = self.basis(start, range.len(), false);
            let pairs = values[range.clone()].iter().zip(&weight[range]);
            // A sample that does not count may hold anything.
            let weighted: Vec<f64> = pairs
                .map(|(v, w)| if *w == 0.0 { 0.0 } else { v * w })
                .collect();
            basis.accumulate(&weighted, &mut x);
        }
        self.solve(&mut x);
        x
    }

    /// The spline at every sample.
    #[must_use]
    pub fn values(&self, coefficients: &[f64]) -> Vec<f64> {
        self.evaluate(coefficients, false)
    }

    /// Its derivative per sample.
    #[must_use]
    pub fn derivative(&self, coefficients: &[f64]) -> Vec<f64> {
        self.evaluate(coefficients, true)
    }

    fn evaluate(&self, coefficients: &[f64], slope: bool) -> Vec<f64> {
        let mut all = vec![0.0; self.samples];
        for start in (0..self.samples).step_by(STRETCH) {
            let end = (start + STRETCH).min(self.samples);
            let basis = self.basis(start, end - start, slope);
            basis.add(coefficients, 1.0, &mut all[start..end]);
        }
        all
    }

    /// What of `values` no such spline can follow.
    #[must_use]
    pub fn residual(&self, values: &[f64], weight: &[f64]) -> Vec<f64> {
        self.residuals(&[values], weight).swap_remove(0)
    }

    /// The same of several columns.
    #[must_use]
    pub fn residuals(&self, columns: &[&[f64]], weight: &[f64]) -> Vec<Vec<f64>> {
        let mut sums = vec![vec![0.0; self.count()]; columns.len()];
        let stretches = || {
            (0..self.samples)
                .step_by(STRETCH)
                .map(|start| start..(start + STRETCH).min(self.samples))
        };
        let mut weighted = vec![];
        for range in stretches() {
            let basis = self.basis(range.start, range.len(), false);
            for (values, sums) in columns.iter().zip(&mut sums) {
                let pairs = values[range.clone()].iter().zip(&weight[range.clone()]);
                // A sample that does not count may hold anything.
                weighted.clear();
                weighted.extend(pairs.map(|(v, w)| if *w == 0.0 { 0.0 } else { v * w }));
                basis.accumulate(&weighted, sums);
            }
        }
        self.solve_all(sums.iter_mut());
        let mut left: Vec<Vec<f64>> = columns.iter().map(|values| values.to_vec()).collect();
        for range in stretches() {
            let basis = self.basis(range.start, range.len(), false);
            for (left, coefficients) in left.iter_mut().zip(&sums) {
                let part = &mut left[range.clone()];
                basis.add(coefficients, -1.0, part);
                for (v, w) in part.iter_mut().zip(&weight[range.clone()]) {
                    *v = if *w == 0.0 { 0.0 } else { *v * w };
                }
            }
        }
        left
    }
}

/// Samples that are looked at together.
const STRETCH: usize = 4096;

/// The B-splines of a stretch of samples: shared by all that is fitted or taken off there.
pub(crate) struct Basis {
    /// The four B-splines that are not zero, sample by sample.
    weights: [Vec<f64>; 4],
    /// The first of them, and the samples between its knots.
    pieces: Vec<(usize, std::ops::Range<usize>)>,
}

impl Basis {
    /// Adds the products of weighted values with the B-splines to `sums`.
    pub(crate) fn accumulate(&self, weighted: &[f64], sums: &mut [f64]) {
        for (first, range) in &self.pieces {
            let (values, last) = weighted[range.clone()].as_chunks::<4>();
            for (i, weights) in self.weights.iter().enumerate() {
                let (weights, last_weights) = weights[range.clone()].as_chunks::<4>();
                // Four sums, so that no addition waits for the last one.
                let mut sum = [0.0; 4];
                for (v, w) in values.iter().zip(weights) {
                    for lane in 0..4 {
                        sum[lane] += v[lane] * w[lane];
                    }
                }
                let rest: f64 = last.iter().zip(last_weights).map(|(v, w)| v * w).sum();
                sums[first + i] += sum.iter().sum::<f64>() + rest;
            }
        }
    }

    /// Writes `values` less the spline of these coefficients.
    pub(crate) fn take_off(&self, coefficients: &[f64], values: &[f64], to: &mut [f64]) {
        taken_off(self, coefficients, values, to);
    }

    /// Adds `by` times the spline of these coefficients to `values`.
    pub(crate) fn add(&self, coefficients: &[f64], by: f64, values: &mut [f64]) {
        let [w0, w1, w2, w3] = &self.weights;
        for (first, range) in &self.pieces {
            let [a, b, c, d]: [f64; 4] = std::array::from_fn(|i| by * coefficients[first + i]);
            for k in range.clone() {
                values[k] += a * w0[k] + b * w1[k] + c * w2[k] + d * w3[k];
            }
        }
    }
}

/// See [`Basis::take_off`]. Fused by the processor or, on an old one, slowly: all find the same values.
#[multiversion::multiversion(targets("x86_64+avx2+fma"))]
fn taken_off(basis: &Basis, coefficients: &[f64], values: &[f64], to: &mut [f64]) {
    for (first, range) in &basis.pieces {
        let [a, b, c, d]: [f64; 4] = std::array::from_fn(|i| coefficients[first + i]);
        let [wa, wb, wc, wd] = basis.weights.each_ref().map(|w| &w[range.clone()]);
        let weights = wa.iter().zip(wb).zip(wc).zip(wd);
        let pairs = to[range.clone()].iter_mut().zip(&values[range.clone()]);
        for ((to, v), (((wa, wb), wc), wd)) in pairs.zip(weights) {
            *to = v - d.mul_add(*wd, c.mul_add(*wc, b.mul_add(*wb, a * wa)));
        }
    }
}

/// Far from where a function is, the spline that follows it dies away to numbers whose products a processor takes long
/// over, and which are nothing.
fn without_tails(spline: &mut [f64]) {
    /// Far below any rounding of what is large in it.
    const NOTHING: f64 = 1e-30;
    let most = spline.iter().fold(0.0, |m, v| f64::max(m, v.abs()));
    let small = spline.iter_mut().filter(|v| v.abs() < NOTHING * most);
    small.for_each(|v| *v = 0.0);
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
