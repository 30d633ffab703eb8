//! Section 5.4: cubic channels, and the direction that the radius cannot see.

use std::f64::consts::TAU;

use nonius_calibration::gradient::minimise;
use nonius_calibration::set::{BLIND, Set};
use nonius_calibration::{Calibration, Curve, Ellipse, Method, Options, calibrate};

const SENSOR: Ellipse = Ellipse {
    a_c: 0.7,
    b_c: 0.06,
    a_s: 0.85,
    b_s: -0.05,
    beta: 0.0,
};

/// Root of P(u) = target for a cubic that rises.
fn inverse(cubic: [f64; 4], target: f64) -> f64 {
    let mut u = target;
    for _ in 0..100 {
        let value = ((cubic[2] * u + cubic[1]) * u + cubic[0]) * u + cubic[3];
        u -= (value - target) / ((3.0 * cubic[2] * u + 2.0 * cubic[1]) * u + cubic[0]);
    }
    u
}

/// Signals that P_c and P_s, acting on normalised signals, turn into cos α and sin(α − β)/cos β.
fn signals(p_c: [f64; 4], p_s: [f64; 4], beta: f64) -> (Vec<f64>, Vec<f64>) {
    let pair = |k: u32| {
        let alpha = 0.1 + TAU * 3.0 * f64::from(k) / 2000.0;
        let u = inverse(p_c, alpha.cos());
        let v = inverse(p_s, (alpha - beta).sin() / beta.cos());
        (SENSOR.a_c * u + SENSOR.b_c, SENSOR.a_s * v + SENSOR.b_s)
    };
    (0..2000).map(pair).unzip()
}

/// Largest error of the corrected angle, less its mean, radians.
fn angle_error(found: &Calibration, cos: &[f64], sin: &[f64]) -> f64 {
    let errors: Vec<f64> = (0..cos.len())
        .map(|k| {
            let alpha = 0.1 + TAU * 3.0 * k as f64 / 2000.0;
            let (c, s) = found.correct(cos[k], sin[k]);
            let (sin, cos) = alpha.sin_cos();
            (s * cos - c * sin).atan2(c * cos + s * sin)
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    errors
        .iter()
        .fold(0.0, |most: f64, e| most.max((e - mean).abs()))
}

fn found(method: Method, signals: &(Vec<f64>, Vec<f64>)) -> Calibration {
    calibrate(&signals.0, &signals.1, method, &Options::default()).expect("a calibration")
}

/// On the unit circle the direction moves the pair across the radius, by ½ sin 2α per unit, and in no other way.
#[test]
fn the_blind_direction_turns_and_does_not_stretch() {
    let straight = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    for k in 0..360 {
        let (sin, cos) = (TAU * f64::from(k) / 360.0).sin_cos();
        for e in [1e-3, 0.1, -0.3] {
            let moved: Vec<f64> = straight.iter().zip(BLIND).map(|(t, v)| t + e * v).collect();
            let (c, s) = Set::Eight.correct(&moved, cos, sin);
            let (along, across) = (c * cos + s * sin - 1.0, s * cos - c * sin);
            assert!(along.abs() < 1e-15);
            assert!((across - e * sin * cos).abs() < 1e-15);
        }
    }
}

/// Bends that the radius can see are found, with the amplitudes unequal and the origin off the centre.
#[test]
fn visible_bends_are_inverted() {
    // Equal cubic terms have no part along the blind direction.
    let (p_c, p_s) = ([1.0, 0.02, 0.03, -0.01], [1.0, -0.015, 0.03, 0.005]);
    for (method, beta) in [(Method::Poly8, 0.0), (Method::Poly9, 0.05)] {
        let signals = signals(p_c, p_s, beta);
        let cubic = found(method, &signals);
        // The amplitudes that normalise are not quite those that bend, so of the second order a little is left along
        // the blind direction.
        let error = angle_error(&cubic, &signals.0, &signals.1);
        assert!(
            cubic.residual_rms < 2e-5,
            "{method:?}: residual {}",
            cubic.residual_rms
        );
        assert!(error < 1e-3, "{method:?}: angle {error}");
        let ellipse = found(Method::Unbiased, &signals);
        assert!(angle_error(&ellipse, &signals.0, &signals.1) > 10.0 * error);
    }
}

/// A bend along the blind direction stays, whatever the sizes of the signals, and the words say so.
#[test]
fn the_invisible_bend_stays_and_is_named() {
    let e = 0.04;
    let (p_c, p_s) = ([1.0 - e, 0.0, e, 0.0], [1.0 + e, 0.0, -e, 0.0]);
    let signals = signals(p_c, p_s, 0.0);
    for method in [Method::Poly8, Method::Poly9] {
        let cubic = found(method, &signals);
        let error = angle_error(&cubic, &signals.0, &signals.1);
        assert!((error - e / 2.0).abs() < 0.1 * e, "{method:?}: {error}");
        assert!(
            cubic
                .cannot_tell
                .iter()
                .any(|s| s.contains("changes no radius"))
        );
    }
}

/// Noise does not move Θ along the blind direction: with unequal amplitudes a search over all eight would wander.
#[test]
fn noise_does_not_move_the_blind_direction() {
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, StandardNormal};
    let mut random = StdRng::seed_from_u64(7);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let frame = Ellipse {
        beta: 0.0,
        ..SENSOR
    };
    let (mut cos, mut sin) = signals([1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], 0.0);
    cos.iter_mut()
        .chain(&mut sin)
        .for_each(|y| *y += 0.01 * draw());
    let minimum = minimise(Set::Eight, &cos, &sin, &frame);
    assert!(minimum.converged && minimum.faint == 0);
    // Back to normalised signals: cubic terms times a³ and so on; the offsets enter too, so compare corrected pairs.
    let mut along = 0.0;
    for k in 0..3600 {
        let alpha = TAU * f64::from(k) / 3600.0;
        let y = frame.point(alpha);
        let (c, s) = Set::Eight.correct(&minimum.theta, y.x, y.y);
        let (sin, cos) = alpha.sin_cos();
        along += (s * cos - c * sin) * 2.0 * (2.0 * alpha).sin() / 3600.0;
    }
    // Amplitude of sin 2α in the angle: a gain mismatch found from 2000 samples scatters by σ √(2/n) / 2.
    assert!(
        along.abs() < 4.0 * 0.012 * (1.0f64 / 2000.0).sqrt(),
        "{along}"
    );
}

/// The physical parameters of bent channels are mean and first harmonic.
#[test]
fn amplitude_and_offset_are_of_the_first_harmonic() {
    let (p_c, p_s) = ([1.0, 0.02, 0.03, -0.01], [1.0, -0.015, 0.03, 0.005]);
    let beta = 0.05;
    let signals = signals(p_c, p_s, beta);
    let cubic = found(Method::Poly9, &signals);
    let n = signals.0.len() as f64;
    let mean = |f: &dyn Fn(usize) -> f64| (0..signals.0.len()).map(f).sum::<f64>() / n;
    let alpha = |k: usize| 0.1 + TAU * 3.0 * k as f64 / 2000.0;
    let expected = [
        mean(&|k| 2.0 * signals.0[k] * alpha(k).cos()),
        mean(&|k| signals.0[k]),
        mean(&|k| 2.0 * signals.1[k] * (alpha(k) - beta).sin()),
        mean(&|k| signals.1[k]),
        beta,
    ];
    for (parameter, expected) in cubic.parameters.iter().zip(expected) {
        let miss = (parameter.value - expected).abs();
        assert!(
            miss < 5e-4,
            "{} {}: {expected}",
            parameter.name,
            parameter.value
        );
    }
}
