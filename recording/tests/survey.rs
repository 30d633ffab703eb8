//! The quick look at synthetic recordings of known signals and motion.

use std::f64::consts::TAU;

use nonius_recording::{Ellipse, FitMethod, Overrides, Recording, Survey};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};

const SENSOR: Ellipse = Ellipse {
    a_c: 0.9,
    b_c: 0.2,
    a_s: 0.7,
    b_s: -0.1,
    beta: 0.15,
};

/// Samples at 10 kHz of a motion given in periods, with white noise in fractions of the amplitude.
fn survey(
    samples: u32,
    sigma: f64,
    spoil: impl Fn(u32, &mut (f64, f64)),
    motion: impl Fn(f64) -> f64,
) -> Survey {
    let mut random = StdRng::seed_from_u64(1);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    let (mut time, mut cos, mut sin) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..samples {
        let t = f64::from(k) * 1e-4;
        let alpha = TAU * motion(t);
        let c = SENSOR.a_c * (alpha.cos() + sigma * noise()) + SENSOR.b_c;
        let s = SENSOR.a_s * ((alpha - SENSOR.beta).sin() + sigma * noise()) + SENSOR.b_s;
        let mut pair = (c, s);
        spoil(k, &mut pair);
        time.push(t);
        cos.push(pair.0);
        sin.push(pair.1);
    }
    let recording = Recording::from_samples(time, cos, sin, &Overrides::default())
        .expect("samples that make a recording");
    Survey::of(&recording)
}

fn clean(_: u32, _: &mut (f64, f64)) {}

#[track_caller]
fn assert_ellipse(survey: &Survey, within: f64) {
    let found = survey.fit.ellipse;
    assert_eq!(
        survey.fit.method,
        FitMethod::Conic,
        "{:?}",
        survey.fit.notes
    );
    for (found, expected) in [
        (found.a_c, SENSOR.a_c),
        (found.b_c, SENSOR.b_c),
        (found.a_s, SENSOR.a_s),
        (found.b_s, SENSOR.b_s),
        (found.beta, SENSOR.beta),
    ] {
        assert!(
            (found - expected).abs() < within,
            "{found}, expected {expected}"
        );
    }
}

#[track_caller]
fn assert_near(found: f64, expected: f64, relative: f64) {
    assert!(
        (found / expected - 1.0).abs() < relative,
        "{found}, expected {expected}"
    );
}

#[test]
fn signals_noise_and_speed_are_found() {
    for speed in [300.0, -300.0] {
        let survey = survey(20_000, 0.01, clean, |t| speed * t);
        assert_ellipse(&survey, 1e-3);
        assert_near(survey.noise_rms, 0.01, 0.1);
        assert_near(survey.fit.residual_rms, 0.01, 0.1);
        assert_near(survey.motion.max_speed_periods_per_s, 300.0, 0.06);
        assert_near(survey.motion.periods_net, speed * 2.0, 1e-3);
        assert_near(survey.motion.periods_travelled, 600.0, 1e-3);
        assert_eq!(survey.notes, [""; 0]);
    }
}

#[test]
fn slow_motion_under_noise_keeps_its_speed() {
    // 0.0005 periods per sample: noise moves the angle further than motion does.
    let survey = survey(20_000, 0.02, clean, |t| 5.0 * t);
    assert_near(survey.motion.max_speed_periods_per_s, 5.0, 0.1);
    assert_near(survey.motion.periods_travelled, 10.0, 0.05);
    assert!(survey.motion.max_step_periods > 10.0 * survey.motion.max_speed_periods_per_sample);
}

#[test]
fn fast_motion_that_reverses_is_followed() {
    // Up to 0.31 periods per sample.
    let survey = survey(20_000, 0.02, clean, |t| 50.0 * (TAU * 10.0 * t).sin());
    assert_ellipse(&survey, 2e-3);
    assert_near(survey.motion.max_speed_periods_per_s, TAU * 500.0, 0.05);
    assert_near(survey.motion.periods_travelled, 20.0 * 4.0 * 50.0, 0.01);
}

#[test]
fn near_half_a_period_per_sample_the_speed_is_doubted() {
    let survey = survey(2000, 0.001, clean, |t| 4.3e3 * t);
    assert!(
        survey.notes[0].contains("the direction and the count are lost"),
        "{:?}",
        survey.notes
    );
}

#[test]
fn glitches_and_a_row_of_zeros_lead_nobody_astray() {
    let spoil = |k: u32, pair: &mut (f64, f64)| {
        if k == 0 {
            *pair = (0.0, 0.0);
        } else if k.is_multiple_of(97) {
            *pair = (f64::from(k % 5) * 30.0 - 60.0, 55.0);
        }
    };
    let survey = survey(20_000, 0.005, spoil, |t| 2000.0 * t);
    assert_ellipse(&survey, 1e-3);
    assert!(survey.fit.outliers >= 206);
    assert_near(survey.motion.max_speed_periods_per_s, 2000.0, 0.03);
    assert_near(survey.motion.periods_net, 4000.0, 1e-3);
}

#[test]
fn a_short_arc_falls_back_on_the_extremes_and_says_so() {
    let survey = survey(2000, 0.003, clean, |t| 0.5 * t);
    assert_eq!(survey.fit.method, FitMethod::Extremes);
    assert!(
        survey.notes[0].contains("those of the extremes"),
        "{:?}",
        survey.notes
    );
}

#[test]
fn three_quarters_of_a_period_serve_and_say_so() {
    let survey = survey(2000, 0.001, clean, |t| 3.75 * t);
    assert_ellipse(&survey, 5e-3);
    assert!(
        survey.notes[0].starts_with("the recording covers 0.7"),
        "{:?}",
        survey.notes
    );
}

#[test]
fn a_standstill_has_no_ellipse() {
    let survey = survey(2000, 0.01, clean, |_| 0.1);
    assert_eq!(survey.fit.method, FitMethod::Extremes);
}

#[test]
fn sixteen_samples_of_a_turn_are_enough() {
    let survey = survey(16, 0.0, clean, |t| 625.0 * t);
    assert_ellipse(&survey, 1e-6);
    assert_near(survey.motion.max_speed_periods_per_s, 625.0, 1e-6);
}
