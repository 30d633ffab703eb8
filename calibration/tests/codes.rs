//! Codes of an ADC: a standstill that flickers by a few of them, and a signal of a few of them that turns.

use nonius_calibration::{Error, Method, Options, calibrate, report, undetermined};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: u32 = 3000;

/// Codes with `sigma` of noise about a signal that turns `periods` times.
fn codes(
    seed: u64,
    sigma: f64,
    amplitude: f64,
    periods: f64,
    [c0, s0]: [f64; 2],
) -> (Vec<f64>, Vec<f64>) {
    let mut random = StdRng::seed_from_u64(seed);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let one = |k: u32| {
        let alpha = 0.4 + std::f64::consts::TAU * periods * f64::from(k) / f64::from(SAMPLES);
        let (s, c) = alpha.sin_cos();
        (
            (c0 + amplitude * c + sigma * draw()).round(),
            (s0 + amplitude * s + sigma * draw()).round(),
        )
    };
    (0..SAMPLES).map(one).unzip()
}

#[test]
fn a_standstill_is_called_that_and_nothing_else_by_every_method() {
    for sigma in [0.0, 0.15, 0.25, 0.35, 0.45, 0.7] {
        for seed in 0..40 {
            let place = [
                1200.0 + seed as f64 * 0.618 % 1.0,
                -500.0 + seed as f64 * 0.414 % 1.0,
            ];
            let (cos, sin) = codes(seed, sigma, 0.0, 0.0, place);
            let method = Method::ALL[seed as usize % Method::ALL.len()];
            let why = calibrate(&cos, &sin, method, &Options::default()).expect_err("a standstill");
            assert!(matches!(why, Error::Standstill(_)), "{sigma} {seed}: {why}");
            let found = undetermined(method, &cos, &sin, &why);
            assert!(found.parameters.iter().all(|p| p.std_error.is_none()));
            let said = report(&found, None);
            let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(said.contains("the scale stands still"), "{said}");
            assert!(said.contains("move the scale by a whole period"), "{said}");
            for other in ["places of the period", "on a line", "speed"] {
                assert!(!said.contains(other), "{said}");
            }
        }
    }
}

/// An amplitude of two and of five codes, whole turns, at speeds from one period in the recording to three samples a period.
#[test]
fn a_signal_of_a_few_codes_that_turns_is_fitted() {
    // Rounding of two codes is no white noise and bends the curve.
    for (amplitude, sigma, near) in [
        (2.0, 0.2, 0.5),
        (2.0, 0.35, 0.5),
        (5.0, 0.35, 0.15),
        (5.0, 0.7, 0.15),
    ] {
        for periods in [1.0, 7.3, 431.7, 987.6] {
            let (cos, sin) = codes(1, sigma, amplitude, periods, [0.3, -0.2]);
            let found = calibrate(&cos, &sin, Method::Unbiased, &Options::default());
            let found = found.unwrap_or_else(|e| panic!("{amplitude} {sigma} {periods}: {e}"));
            for (a, offset) in [
                (found.ellipse.a_c, found.ellipse.b_c - 0.3),
                (found.ellipse.a_s, found.ellipse.b_s + 0.2),
            ] {
                assert!(
                    (a - amplitude).abs() < near && offset.abs() < near,
                    "{amplitude} {sigma} {periods}: {:?}",
                    found.ellipse
                );
            }
            assert!(found.parameters.iter().all(|p| p.std_error.is_some()));
        }
    }
}
