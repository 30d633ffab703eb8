//! Flicker noise is found, and never claimed of noise, drift or motion of another kind.
//!
//! It is simulated as semiconductors make it: a sum of relaxations with time constants a factor apart, each of the same
//! power. That has nothing of a 1/f formula in it.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, Diagnosis, diagnose};
use nonius_kept::every;
use nonius_recording::{Overrides, Recording};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 20_000;
/// So long that its functions are fitted to a part of the samples first.
const LONG: usize = 400_000;
const RATE: f64 = 50e3;
const NOISE: f64 = 0.001;

type OfTime = fn(t: f64) -> f64;

/// Noise of one channel.
enum Colour {
    White,
    /// Sum of relaxations; rms of each.
    Flicker(f64),
    /// First-order autoregression of that coefficient, and rms.
    Regression(f64, f64),
    /// Two levels so far either side of zero; it leaves one where white noise of unit rms exceeds 2.4, about every
    /// 120 samples.
    Telegraph(f64),
}

/// A sum of first-order relaxations: coefficient per sample, rms of each, state; and a level that jumps.
struct Relaxations(Vec<(f64, f64, f64)>, f64);

impl Relaxations {
    fn new(colour: &Colour) -> Self {
        let list = match colour {
            Colour::White | Colour::Telegraph(_) => vec![],
            // From a tenth of a hertz to ten kilohertz, three to the factor of ten.
            Colour::Flicker(rms) => (0..16)
                .map(|i| {
                    let corner = 0.1 * 10f64.powf(f64::from(i) / 3.0);
                    ((-TAU * corner / RATE).exp(), *rms, 0.0)
                })
                .collect(),
            Colour::Regression(coefficient, rms) => vec![(*coefficient, *rms, 0.0)],
        };
        let level = match colour {
            Colour::Telegraph(level) => *level,
            _ => 0.0,
        };
        Self(list, level)
    }

    fn next(&mut self, normal: &mut impl FnMut() -> f64) -> f64 {
        for (coefficient, rms, state) in &mut self.0 {
            let fresh = *rms * (1.0 - *coefficient * *coefficient).sqrt();
            *state = *coefficient * *state + fresh * normal();
        }
        if self.1 != 0.0 && normal() > 2.4 {
            self.1 = -self.1;
        }
        self.0.iter().map(|r| r.2).sum::<f64>() + self.1
    }
}

fn diagnosed(colour: &Colour, seed: u64, motion: OfTime, drift: OfTime) -> Diagnosis {
    diagnosed_of(SAMPLES, colour, seed, motion, drift)
}

fn diagnosed_of(
    samples: usize,
    colour: &Colour,
    seed: u64,
    motion: OfTime,
    drift: OfTime,
) -> Diagnosis {
    let mut random = StdRng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let mut noises = [Relaxations::new(colour), Relaxations::new(colour)];
    // Two that jump by themselves have four levels, and are not told from flicker noise.
    noises[1].1 = 0.0;
    for _ in 0..SAMPLES {
        noises.iter_mut().for_each(|n| {
            n.next(&mut normal);
        });
    }
    let lsb = 2.0 / f64::from(1 << 14);
    let code = |v: f64| (v / lsb).round() * lsb;
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\ntime_s,cos,sin\n");
    for k in 0..samples {
        let t = k as f64 / RATE;
        let alpha = 90.0 * (TAU * 5.3 * t + 0.2).sin() + 300.0 * t + motion(t);
        let own = noises
            .each_mut()
            .map(|n| n.next(&mut normal) + NOISE * normal());
        let (c, s) = (
            alpha.cos() + own[0] + drift(t),
            (alpha - 0.03).sin() + own[1] - drift(t),
        );
        text += &format!("{t:.7},{},{}\n", code(0.8 * c), code(0.75 * s));
    }
    let recording = Recording::read_from(text.as_bytes(), "test", &Overrides::default());
    diagnose(&recording.expect("a recording that can be read"))
        .expect("signals that draw an ellipse")
}

fn names(found: &Diagnosis) -> Vec<Cause> {
    found.findings.iter().map(|f| f.cause).collect()
}

/// Every second seed; in the long form all.
#[test]
fn it_is_found() {
    for seed in every(2, 0..4) {
        let found = diagnosed(&Colour::Flicker(0.0005), seed, |_| 0.0, |_| 0.0);
        assert_eq!(names(&found), [Cause::FlickerNoise], "seed {seed}");
        assert!(found.findings[0].p_value < 1e-3);
        // A spectrum tells half of what samples do, and its other lines as much as those that were fitted.
        let gain = found.findings[0].gain;
        let all = gain.detection_snr.expect("an SNR").powi(2) / 2.0;
        let held_out = gain.held_out_log_likelihood_gain.expect("a gain");
        assert!(
            (0.2 * all..1.1 * all).contains(&held_out),
            "{held_out} {all}"
        );
        // Equal powers a third of a decade apart: power per hertz is that of one over f times ln 10 / 3.
        let density = 0.0005 * (3.0 / 10f64.ln()).sqrt();
        let p = &found.findings[0].parameters[0];
        assert!(
            (p.value / density).ln().abs() < 0.2,
            "seed {seed}: {} +/- {}, true {density}",
            p.value,
            p.std_error
        );
    }
}

/// So weak that hardly more than its slowest parts are seen, which steps, a drift or a capacitor could be: half of them are
/// known, and hardly another name is given. Every second seed; in the long form all.
#[test]
fn weak_noise_is_told_from_steps() {
    let (mut known, mut other, mut all) = (0, 0, 0);
    for seed in every(2, 0..16) {
        all += 1;
        let found = diagnosed(&Colour::Flicker(0.00004), seed, |_| 0.0, |_| 0.0);
        for name in names(&found) {
            if name == Cause::FlickerNoise {
                known += 1;
            } else {
                other += 1;
            }
        }
    }
    assert!(known * 16 >= 7 * all, "{known} of {all}");
    assert!(other <= 1, "{other} of {all}");
}

/// One seed; in the long form three.
#[test]
fn it_is_not_claimed_of_anything_else() {
    let still: OfTime = |_| 0.0;
    for seed in every(3, 0..3) {
        let cases: [(&str, Colour, OfTime, OfTime); 8] = [
            ("white noise", Colour::White, still, still),
            (
                "fast regression",
                Colour::Regression(0.6, 0.002),
                still,
                still,
            ),
            (
                "slow regression",
                Colour::Regression(0.9, 0.002),
                still,
                still,
            ),
            (
                "very slow regression",
                Colour::Regression(0.99, 0.002),
                still,
                still,
            ),
            ("straight drift", Colour::White, still, |t| 0.02 * t),
            ("bent drift", Colour::White, still, |t| {
                0.01 * (2.0 * t).exp()
            }),
            (
                "vibration",
                Colour::White,
                |t| 0.004 * (TAU * 37.0 * t).sin(),
                still,
            ),
            ("hum", Colour::White, still, |t| {
                0.003 * (TAU * 50.0 * t).sin()
            }),
        ];
        for (what, colour, motion, drift) in cases {
            let found = diagnosed(&colour, seed, motion, drift);
            assert!(
                !names(&found).contains(&Cause::FlickerNoise),
                "{what}, seed {seed}: {:?}",
                found.findings
            );
        }
    }
}

#[test]
fn offsets_that_jump_between_two_levels_are_not_flicker_noise() {
    for seed in 0..3 {
        let found = diagnosed(&Colour::Telegraph(0.0004), seed, |_| 0.0, |_| 0.0);
        assert_eq!(names(&found), [], "seed {seed}");
        assert!(found.unexplained.significant, "seed {seed}");
    }
}

/// A polynomial of time would follow them nearly as well as they do themselves.
#[test]
fn steps_are_no_drift() {
    let steps: OfTime = |t| match t {
        t if t < 0.05 => 0.0,
        t if t < 0.11 => 0.0015,
        t if t < 0.2 => -0.001,
        t if t < 0.31 => 0.002,
        _ => 0.0005,
    };
    for seed in 0..3 {
        let found = diagnosed(&Colour::White, seed, |_| 0.0, steps);
        assert_eq!(names(&found), [], "seed {seed}");
        assert!(found.unexplained.significant, "seed {seed}");
    }
}

/// What is chance in the first part of a long recording is no evidence if it is taken for all of it, and slow functions whose amounts
/// were fitted to a part of the samples leave what looks like slow noise in the others.
#[test]
fn a_long_recording_of_white_noise_has_none() {
    let still: OfTime = |_| 0.0;
    let found = diagnosed_of(LONG, &Colour::White, 13, still, still);
    assert_eq!(names(&found), []);
    assert!(!found.unexplained.significant);
}

/// Noise of which only the slow part stands out of the white noise is seen in all of a long recording.
#[test]
fn weak_noise_is_found_in_a_long_recording() {
    let still: OfTime = |_| 0.0;
    // More samples than are looked at one by one.
    let found = diagnosed_of(90_000, &Colour::Flicker(0.00008), 1, still, still);
    assert_eq!(names(&found), [Cause::FlickerNoise]);
}
