//! A recording that mostly stands still: noise is taken for noise.

use nonius_calibration::{Method, Options, calibrate};
use nonius_kept::{every, long};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: u32 = 4000;
const SEEDS: u64 = 100;

/// White noise, in fractions of each amplitude, about an ellipse; `turns` are the scale periods travelled at 0 to 1 of
/// the recording.
fn signals(seed: u64, noise: f64, turns: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = StdRng::seed_from_u64(seed);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let one = |k: u32| {
        let alpha = std::f64::consts::TAU * turns(f64::from(k) / f64::from(SAMPLES));
        (
            alpha.cos() + 0.1 + noise * draw(),
            0.83 * ((alpha - 0.0873).sin() + noise * draw()) - 0.08,
        )
    };
    (0..SAMPLES).map(one).unzip()
}

/// `stops` places 0.17 periods apart, a tenth of the time on the way.
fn stepping(stops: f64, t: f64) -> f64 {
    let (stop, way) = ((stops * t).floor(), (stops * t).fract());
    0.17 * (stop + (way * 10.0 - 9.0).max(0.0))
}

/// Nine tenths of the samples at one place, before, after and amid the motion, and at many places. Sentences of a
/// thousandth's probability each: of eight hundred noises more than four have one once in some thousand times, of every second,
/// which is the short form, more than three.
#[test]
fn standstill_and_white_noise_are_no_distortion_and_no_drift() {
    let motions: [fn(f64) -> f64; 4] = [
        |t| 0.13 + 30.0 * (t - 0.9).max(0.0),
        |t| 0.13 + 30.0 * t.min(0.1),
        |t| 0.13 + 30.0 * (t.clamp(0.45, 0.55) - 0.45),
        |t| stepping(12.0, t),
    ];
    let (mut shapes, mut parts) = (0, 0);
    for (i, motion) in (0..).zip(motions) {
        for (j, noise) in (0..).zip([0.001, 0.01]) {
            for seed in every(2, 0..SEEDS) {
                let (cos, sin) = signals(1000 * i + 200 * j + seed, noise, motion);
                let found = calibrate(&cos, &sin, Method::Unbiased, &Options::default())
                    .expect("a calibration");
                let said = |words: &str| found.cannot_tell.iter().any(|s| s.contains(words));
                shapes += u32::from(said("no exact ellipse"));
                parts += u32::from(said("consecutive parts of the recording differ"));
            }
        }
    }
    let allowed = if long() { 4 } else { 3 };
    assert!(shapes <= allowed && parts <= allowed, "{shapes} {parts}");
}

/// What is there is still found: a bent channel and a drift, in the same recordings.
#[test]
fn beside_a_standstill_distortion_and_drift_are_found() {
    for seed in 0..10 {
        let turns = |t: f64| 0.13 + 30.0 * (t - 0.9).max(0.0);
        let (cos, sin) = signals(seed, 0.01, turns);
        let said = |cos: &[f64], words: &str| {
            let found = calibrate(cos, &sin, Method::Unbiased, &Options::default());
            let found = found.expect("a calibration");
            found.cannot_tell.iter().any(|s| s.contains(words))
        };
        let bent: Vec<f64> = cos.iter().map(|c| c + 0.05 * c.powi(3)).collect();
        assert!(said(&bent, "no exact ellipse"), "{seed}");
        let slow = |k: usize| 0.03 * (k as f64 * 0.004).sin();
        let drifting: Vec<f64> = cos.iter().enumerate().map(|(k, c)| c + slow(k)).collect();
        assert!(said(&drifting, "consecutive parts"), "{seed}");
    }
}
