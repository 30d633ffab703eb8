//! What few places of the period and coarse codes cannot tell is said.

use std::f64::consts::TAU;

use nonius_calibration::{Calibration, Method, Options, calibrate};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: u32 = 4000;

/// A third harmonic of `third`, `sigma` of noise, so many samples a period, in codes of this step.
fn recorded(per_period: f64, third: f64, sigma: f64, step: f64) -> Calibration {
    let mut random = StdRng::seed_from_u64(7);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let mut code = |y: f64| ((y + sigma * draw()) / step).round() * step;
    let one = |k: u32| {
        let alpha = 0.3 + TAU * f64::from(k) / per_period;
        let (c, s) = (alpha.cos(), (alpha - 0.087).sin());
        (
            code(1.1 * c + 0.1 + third * (3.0 * alpha).cos()),
            code(0.9 * s - 0.1 + third * (3.0 * alpha).sin()),
        )
    };
    let (cos, sin): (Vec<f64>, Vec<f64>) = (0..SAMPLES).map(one).unzip();
    calibrate(&cos, &sin, Method::Unbiased, &Options::default()).expect("an ellipse")
}

fn says(found: &Calibration, what: &str) -> bool {
    found.cannot_tell.iter().any(|said| said.contains(what))
}

/// Five places lie on an ellipse whatever the signals are: an error bar of thousandths stands beside a β that a harmonic made.
#[test]
fn a_few_places_of_the_period_are_named() {
    for places in 5..=8 {
        let found = recorded(f64::from(places), 0.03, 1e-3, 1e-6);
        assert!(
            says(&found, &format!("stand at {places} places")),
            "{places}: {:?}",
            found.cannot_tell
        );
    }
    for per_period in [5.003, 7.91, 9.0, 16.0, 64.0] {
        let found = recorded(per_period, 0.0, 1e-3, 1e-6);
        assert!(
            found.cannot_tell.is_empty(),
            "{per_period}: {:?}",
            found.cannot_tell
        );
    }
}

/// A short recording at any places leaves gaps, too.
#[test]
fn gaps_between_few_samples_are_no_places() {
    let mut random = StdRng::seed_from_u64(3);
    for samples in [32, 40, 48, 64, 100, 200] {
        let mut calibrated = 0;
        for _ in 0..200 {
            let one = |random: &mut StdRng| {
                let alpha = random.random_range(0.0..TAU);
                let mut noise = || -> f64 { StandardNormal.sample(random) };
                (alpha.cos() + 1e-3 * noise(), alpha.sin() + 1e-3 * noise())
            };
            let (cos, sin): (Vec<f64>, Vec<f64>) = (0..samples).map(|_| one(&mut random)).unzip();
            let Ok(found) = calibrate(&cos, &sin, Method::Unbiased, &Options::default()) else {
                continue;
            };
            calibrated += 1;
            assert!(!says(&found, "places of the period"), "{samples}");
        }
        assert!(calibrated > 190, "{samples}: {calibrated} of 200");
    }
}

/// Rounding is white only where the noise is a third of a code and more.
#[test]
fn coarse_codes_beside_little_noise_are_named() {
    let step = 2.0 / 256.0;
    for (share, coarse) in [
        (0.05, true),
        (0.13, true),
        (0.25, true),
        (0.45, false),
        (2.0, false),
    ] {
        let found = recorded(401.3, 0.0, share * step, step);
        assert_eq!(
            says(&found, "of a code"),
            coarse,
            "{share}: {:?}",
            found.cannot_tell
        );
    }
}
