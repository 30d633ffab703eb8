//! Bias, efficiency and coverage of the default estimator, against the Cramér–Rao bound.
//!
//! The short form runs here; `cargo run --release -p nonius-calibration --example statistics` runs two thousand seeds
//! and writes docs/offline-statistics.md.

use nonius_calibration::cramer_rao::bound;
use nonius_calibration::{Calibration, Curve, Ellipse, Method, Options, calibrate};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 4000;

fn truth() -> Ellipse {
    Ellipse {
        a_c: 1.0,
        b_c: 0.1,
        a_s: 0.83,
        b_s: -0.08,
        beta: 5f64.to_radians(),
    }
}

fn angles(start: f64) -> Vec<f64> {
    // Seven whole turns.
    let step = 7.0 * std::f64::consts::TAU / SAMPLES as f64;
    (0..SAMPLES).map(|k| start + step * k as f64).collect()
}

fn fitted(seed: u64, noise: [f64; 2], options: &Options) -> Calibration {
    let mut random = StdRng::seed_from_u64(seed);
    let start: f64 = random.random_range(0.0..std::f64::consts::TAU);
    let mut draw = |sigma: f64| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut random);
        normal * sigma
    };
    let (mut cos, mut sin) = (vec![], vec![]);
    for alpha in angles(start) {
        let y = truth().point(alpha);
        cos.push(y.x + draw(noise[0]));
        sin.push(y.y + draw(noise[1]));
    }
    calibrate(&cos, &sin, Method::Unbiased, options).expect("an ellipse")
}

/// Mean error and spread in bounds, and coverage of the 95 % interval, for each parameter.
fn campaign(noise: [f64; 2], seeds: u64) -> [(f64, f64, f64); 5] {
    let limit = bound(&truth(), &angles(0.3), noise).expect("whole turns");
    let mut sums = [(0.0, 0.0, 0.0); 5];
    for seed in 0..seeds {
        let found = fitted(seed, noise, &Options::default());
        for (i, sum) in sums.iter_mut().enumerate() {
            let parameter = &found.parameters[i];
            let error = parameter.value - truth().parameters()[i];
            let own = parameter.std_error.expect("an error bar");
            let unit = limit.covariance[(i, i)].sqrt();
            sum.0 += error / unit;
            sum.1 += (error / unit).powi(2);
            sum.2 += f64::from(u8::from(error.abs() < 1.96 * own));
        }
    }
    let n = seeds as f64;
    sums.map(|(mean, square, inside)| {
        let mean = mean / n;
        (mean, (square / n - mean * mean).sqrt(), inside / n)
    })
}

#[test]
fn unbiased_efficient_and_honest() {
    let seeds = 300;
    // Three standard deviations of what is estimated from so many seeds.
    let slack = 3.0 / (seeds as f64).sqrt();
    for noise in [0.001, 0.01, 0.05] {
        for (i, (bias, spread, coverage)) in campaign([noise; 2], seeds).into_iter().enumerate() {
            assert!(
                bias.abs() < 0.1 + slack,
                "noise {noise}, parameter {i}: bias {bias}"
            );
            assert!(
                spread < 1.05 + slack * 0.71,
                "noise {noise}, parameter {i}: spread {spread}"
            );
            assert!(
                (coverage - 0.95).abs() < 0.02 + slack * 0.22,
                "noise {noise}, parameter {i}: {coverage}"
            );
        }
    }
}

#[test]
fn unequal_noise_does_no_harm() {
    let seeds = 150;
    let slack = 3.0 / (seeds as f64).sqrt();
    for (i, (bias, spread, _)) in campaign([0.05 / 1.7, 0.05], seeds).into_iter().enumerate() {
        assert!(bias.abs() < 0.1 + slack, "parameter {i}: bias {bias}");
        assert!(
            spread < 1.05 + slack * 0.71,
            "parameter {i}: spread {spread}"
        );
    }
    let found = fitted(1, [0.05 / 1.7, 0.05], &Options::default());
    let noise = found.noise.expect("noise");
    let ratio = noise[1] / noise[0];
    assert!((ratio - 1.7).abs() < 0.15, "{ratio}");
}
