//! Where the default estimator is beyond what is tested of it, it says so.

use crate::support::campaign::{SAMPLES, SENSOR};
use nonius_calibration::{Calibration, Curve, Ellipse, Method, Options, calibrate};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

/// The sensor of the campaign, whose phase error is 5°, with another one, degrees.
fn sensor(beta: f64) -> Ellipse {
    Ellipse {
        beta: beta.to_radians(),
        ..Ellipse::of(&SENSOR.into())
    }
}

/// Seven periods and a bit with this noise, (cos, sin), of each sample.
fn recorded(
    sensor: &Ellipse,
    seed: u64,
    noise: impl Fn(&mut dyn FnMut() -> f64, &mut StdRng) -> (f64, f64),
    ratio: Option<f64>,
) -> Calibration {
    let mut random = StdRng::seed_from_u64(seed);
    let mut normal = StdRng::seed_from_u64(!seed);
    let mut draw = || -> f64 { StandardNormal.sample(&mut normal) };
    let step = 7.3 * std::f64::consts::TAU / SAMPLES as f64;
    let (cos, sin): (Vec<f64>, Vec<f64>) = (0..SAMPLES)
        .map(|k| {
            let (at, by) = (sensor.point(k as f64 * step), noise(&mut draw, &mut random));
            (at.x + by.0, at.y + by.1)
        })
        .unzip();
    let options = Options { noise_ratio: ratio };
    calibrate(&cos, &sin, Method::Unbiased, &options).expect("an ellipse")
}

fn says(found: &Calibration, what: &str) -> bool {
    found.cannot_tell.iter().any(|s| s.contains(what))
}

/// Noise of 20 %, channels nearly in phase, one channel with 25 times the noise of the other: at the tightest bend of the curve the
/// estimates and their error bars are off.
#[test]
fn noise_beside_a_tight_bend_is_named() {
    let bends = |beta: f64, noise: [f64; 2], ratio: Option<f64>| {
        let white =
            |draw: &mut dyn FnMut() -> f64, _: &mut StdRng| (noise[0] * draw(), noise[1] * draw());
        let found = recorded(&sensor(beta), 5, white, ratio);
        says(&found, "where the curve bends most")
    };
    assert!(bends(5.0, [0.2; 2], None));
    assert!(bends(5.0, [0.15; 2], None));
    assert!(bends(80.0, [0.01; 2], None));
    assert!(bends(5.0, [0.002, 0.05], Some(25.0)));
    for noise in [0.001, 0.01, 0.05, 0.08] {
        assert!(!bends(5.0, [noise; 2], None), "{noise}");
    }
    assert!(!bends(40.0, [0.03; 2], None));
}

/// A light that flickers behind both channels: the estimator takes the noise for their own.
#[test]
fn noise_that_both_channels_have_is_named() {
    for (sign, size, beta) in [
        (1.0, 0.01, 5.0),
        (-1.0, 0.01, 5.0),
        (1.0, 0.05, 5.0),
        (-1.0, 0.01, 45.0),
        (1.0, 0.01, -45.0),
    ] {
        for seed in 0..8 {
            let shared = |draw: &mut dyn FnMut() -> f64, _: &mut StdRng| {
                let both = 0.8f64.sqrt() * draw();
                let mut own = || 0.2f64.sqrt() * draw();
                (size * (both + own()), size * (sign * both + own()))
            };
            let found = recorded(&sensor(beta), seed, shared, None);
            let together = found.noise_together.expect("it is there");
            let off = (together.value - 0.8 * sign) / together.std_error;
            assert!(off.abs() < 4.5, "{together:?}");
            assert!(says(&found, "goes together"));
        }
    }
    let alone = |draw: &mut dyn FnMut() -> f64, _: &mut StdRng| (0.01 * draw(), 0.017 * draw());
    let seen = |beta: f64, ratio: Option<f64>, seed: u64| {
        recorded(&sensor(beta), seed, alone, ratio)
            .noise_together
            .is_some()
    };
    assert!(!(0..150).any(|seed| seen(5.0, None, seed)));
    // Nor where the ratio that is given is another.
    assert!(!(0..20).any(|seed| seen(45.0, Some(5.0), seed)));
}

/// Of noise with long tails the squares scatter more, and so does the ratio that is made of them.
#[test]
fn the_ratio_of_noise_with_long_tails_is_within_its_error() {
    let laplace = |_: &mut dyn FnMut() -> f64, random: &mut StdRng| {
        let mut one = || {
            let u: f64 = random.random_range(-1.0..1.0);
            -0.01 * u.signum() * (1.0 - u.abs()).max(1e-12).ln()
        };
        (one(), 1.7 * one())
    };
    let covered = (0..200).filter(|seed| {
        let found = recorded(&sensor(5.0), *seed, laplace, None);
        let [c, s] = found.noise.expect("there is noise");
        let error = found.noise_ratio_error.expect("it is told");
        (s / c - 1.7).abs() < 1.96 * error
    });
    let covered = covered.count();
    // 95 % of 200, and four standard deviations.
    assert!((178..=200).contains(&covered), "{covered} of 200");
}
