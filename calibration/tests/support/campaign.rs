//! Many recordings of one known sensor, each with its own noise, and what the estimators make of them.
//!
//! Two things make few seeds say much. Each seed runs twice, with the noise and with its negative: the sum holds the
//! bias and hardly any scatter. And each error stands beside the linear estimate's, F⁻¹ Σ g ε, whose variance is the
//! Cramér–Rao bound exactly: the mean difference of their squares is how far the estimator's variance is from the bound,
//! again with hardly any scatter. The bound here is written from equation (4) and shares no code with the crate's.

use std::f64::consts::TAU;

use nalgebra::{SMatrix, SVector};
use nonius_calibration::{Method, Options, calibrate};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

/// a_c, b_c, a_s, b_s and β (radians).
pub(crate) type Sensor = [f64; 5];

/// Offsets 10 % and −8 %, gain ratio 1.2, β = 5°.
pub(crate) const SENSOR: Sensor = [1.0, 0.1, 0.83, -0.08, 0.087_266_462_599_716_47];
/// In each recording.
pub(crate) const SAMPLES: usize = 4000;

type Vector = SVector<f64, 5>;

/// What is simulated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Case {
    pub(crate) method: Method,
    pub(crate) sensor: Sensor,
    /// Rms of the white noise of cosine and sine, in the unit of the amplitudes.
    pub(crate) noise: [f64; 2],
    /// Scale periods that the samples are spread over.
    pub(crate) periods: f64,
}

/// Sums over seeds, per parameter a_c, b_c, a_s, b_s, β; errors in units of the bound.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) seeds: usize,
    /// Recordings without an estimate or without an error bar.
    pub(crate) refused: usize,
    /// Half the sum of the errors with the noise and its negative.
    even: Vector,
    even_square: Vector,
    square: Vector,
    /// Squared error less that of the linear estimate.
    excess: Vector,
    excess_square: Vector,
    /// Stated variance.
    stated: Vector,
    inside: Vector,
}

impl Case {
    /// The angles; every seed begins elsewhere on whole periods, at the same place on an arc.
    fn angles(&self, random: &mut StdRng) -> Vec<f64> {
        let first: f64 = random.random_range(0.0..TAU);
        let first = if self.periods < 1.0 { 0.7 } else { first };
        let step = TAU * self.periods / SAMPLES as f64;
        (0..SAMPLES).map(|k| first + step * k as f64).collect()
    }

    /// Runs seeds; `done` hears of each.
    pub(crate) fn run(&self, seeds: std::ops::Range<u64>, done: &(dyn Fn() + Sync)) -> Tally {
        let mut tally = Tally::default();
        for seed in seeds {
            self.one(seed, &mut tally);
            done();
        }
        tally
    }

    fn one(&self, seed: u64, tally: &mut Tally) {
        let [a_c, b_c, a_s, b_s, beta] = self.sensor;
        let [sigma_c, sigma_s] = self.noise;
        let mut random = StdRng::seed_from_u64(seed);
        let mut information = SMatrix::<f64, 5, 5>::zeros();
        let mut score = Vector::zeros();
        let (mut clean, mut noise) = (vec![], vec![]);
        for alpha in self.angles(&mut random) {
            let normal: [f64; 2] = std::array::from_fn(|_| StandardNormal.sample(&mut random));
            let e = [normal[0] * sigma_c, normal[1] * sigma_s];
            let (sin, cos) = alpha.sin_cos();
            let (sin_s, cos_s) = (alpha - beta).sin_cos();
            clean.push([a_c * cos + b_c, a_s * sin_s + b_s]);
            noise.push(e);
            // Across the curve: (∂y_s/∂α, −∂y_c/∂α), whatever its length.
            let across = [a_s * cos_s, a_c * sin];
            let variance = (across[0] * sigma_c).powi(2) + (across[1] * sigma_s).powi(2);
            let g = Vector::new(
                across[0] * cos,
                across[0],
                across[1] * sin_s,
                across[1],
                -across[1] * a_s * cos_s,
            );
            information += g * g.transpose() / variance;
            score += g * (across[0] * e[0] + across[1] * e[1]) / variance;
        }
        let bound = information
            .try_inverse()
            .expect("the arc tells the parameters");
        let unit = bound.diagonal().map(f64::sqrt);
        let linear = (bound * score).component_div(&unit);
        let errors = [1.0, -1.0].map(|sign| {
            let add = |i: usize| -> Vec<f64> {
                let pairs = clean.iter().zip(&noise);
                pairs.map(|(y, e)| y[i] + sign * e[i]).collect()
            };
            self.error(&add(0), &add(1), &unit)
        });
        tally.seeds += 1;
        let [Some(plus), Some(minus)] = errors else {
            tally.refused += 1;
            return;
        };
        let even = (plus.0 + minus.0) / 2.0;
        tally.even += even;
        tally.even_square += even.component_mul(&even);
        for (error, stated) in [plus, minus] {
            let square = error.component_mul(&error);
            let excess = square - linear.component_mul(&linear);
            tally.square += square / 2.0;
            tally.excess += excess / 2.0;
            tally.excess_square += excess.component_mul(&excess) / 2.0;
            tally.stated += stated.component_mul(&stated) / 2.0;
            tally.inside +=
                error.zip_map(&stated, |e, s| f64::from(u8::from(e.abs() < 1.96 * s))) / 2.0;
        }
    }

    /// Error and stated standard error, in units of the bound.
    fn error(&self, cos: &[f64], sin: &[f64], unit: &Vector) -> Option<(Vector, Vector)> {
        let found = calibrate(cos, sin, self.method, &Options::default()).ok()?;
        let values = Vector::from_fn(|i, _| found.parameters[i].value - self.sensor[i]);
        let mut stated = Vector::zeros();
        for i in 0..5 {
            // β where the method holds it fixed.
            stated[i] = found.parameters[i].std_error.unwrap_or(0.0);
        }
        let known = stated.iter().take(4).all(|s| *s > 0.0);
        known.then(|| (values.component_div(unit), stated.component_div(unit)))
    }
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.seeds += other.seeds;
        self.refused += other.refused;
        self.even += other.even;
        self.even_square += other.even_square;
        self.square += other.square;
        self.excess += other.excess;
        self.excess_square += other.excess_square;
        self.stated += other.stated;
        self.inside += other.inside;
    }
}

impl Tally {
    fn n(&self) -> f64 {
        (self.seeds - self.refused) as f64
    }

    /// Mean error in units of the bound.
    pub(crate) fn bias(&self) -> Vector {
        self.even / self.n()
    }

    /// Standard error of [`Self::bias`].
    pub(crate) fn bias_error(&self) -> Vector {
        let n = self.n();
        let mean = self.bias();
        let variance = self.even_square / n - mean.component_mul(&mean);
        variance.map(|v| (v.max(0.0) / n).sqrt())
    }

    /// Standard deviation in units of the bound, by the excess over the linear estimate.
    pub(crate) fn spread(&self) -> Vector {
        let bias = self.bias();
        let excess = self.excess / self.n() - bias.component_mul(&bias);
        excess.map(|e| (1.0 + e).max(0.0).sqrt())
    }

    /// Standard error of [`Self::spread`].
    pub(crate) fn spread_error(&self) -> Vector {
        let n = self.n();
        let mean = self.excess / n;
        let variance = self.excess_square / n - mean.component_mul(&mean);
        variance.zip_map(&self.spread(), |v, s| (v.max(0.0) / n).sqrt() / (2.0 * s))
    }

    /// Root mean square of the stated standard error in units of the bound.
    pub(crate) fn stated(&self) -> Vector {
        (self.stated / self.n()).map(f64::sqrt)
    }

    /// Share of the 95 % intervals that hold the truth.
    pub(crate) fn coverage(&self) -> Vector {
        self.inside / self.n()
    }
}
