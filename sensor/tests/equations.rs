//! Each cause alters the signal as its equation says: two simulations without noise, with the cause and without it.

use std::f64::consts::TAU;

use nonius_sensor::{Motion, Samples, Sensor};

const RATE: f64 = 10_000.0;
const LSB: f64 = 1.0 / 1_073_741_824.0;
/// Two roundings of the ADC.
const CLOSE: f64 = 2.0 * LSB;
const BETA: f64 = 0.04;
const AMPLITUDES: [f64; 2] = [0.8, 0.75];

fn sensor(cause: &str, noise: f64, bits: u32) -> Sensor {
    let lsb = 2f64.powi(1 - bits as i32);
    let text = format!(
        "[signals]\na_c = 0.8\nb_c = 0.03\na_s = 0.75\nb_s = -0.02\nbeta = {BETA}\nnoise_rms = {noise:?}\n\
         [adc]\nbits = {bits}\nlsb = {lsb:?}\ncentre = 0.0\nsample_rate_hz = {RATE:?}\n\
         [motion]\nperiods_travelled = 900.0\nspeed_max_periods_per_s = 700.0\n{cause}"
    );
    Sensor::from_toml(&text, "sensor.toml").expect("a sensor")
}

/// Constant speed, in periods per second.
fn steady(samples: usize, speed: f64) -> Motion {
    let time_s: Vec<f64> = (0..samples).map(|k| k as f64 / RATE).collect();
    let alpha = time_s.iter().map(|t| TAU * speed * t).collect();
    Motion { time_s, alpha }
}

/// The motion, and both channels with the cause less without it, in amplitudes.
fn difference(cause: &str, motion: &Motion) -> [Vec<f64>; 2] {
    let with = sensor(&format!("[[cause]]\n{cause}"), 0.0, 31).simulate(motion, 3);
    let without = sensor("", 0.0, 31).simulate(motion, 3);
    let channel =
        |a: &[f64], b: &[f64], by: f64| a.iter().zip(b).map(|(a, b)| (a - b) / by).collect();
    [
        channel(&with.cos, &without.cos, AMPLITUDES[0]),
        channel(&with.sin, &without.sin, AMPLITUDES[1]),
    ]
}

/// The difference is what an equation of the angle and the time says.
fn obeys(cause: &str, equation: impl Fn(f64, f64) -> [f64; 2]) {
    let motion = steady(2000, 130.0);
    let [cos, sin] = difference(cause, &motion);
    let mut largest = 0.0f64;
    for k in 0..cos.len() {
        let expected = equation(motion.alpha[k], motion.time_s[k]);
        for (is, expected) in [cos[k], sin[k]].into_iter().zip(expected) {
            assert!(
                (is - expected).abs() < 4.0 * CLOSE,
                "{cause} {k}: {is} {expected}"
            );
            largest = largest.max(is.abs());
        }
    }
    assert!(largest > 1e-4, "{cause} does nothing");
}

/// A channel that is sampled later is bent later: at constant speed it is what it was at the angle before.
#[test]
fn bends_are_as_late_as_the_channel() {
    let delay = 4e-5;
    let before = |alpha: f64| alpha - TAU * 130.0 * delay;
    let bent = |u: f64| u + 0.05 * u * u - 0.04 * u.powi(3);
    let causes = "name = \"channel_skew\"\ndelay_s = -4e-5\n\
        [[cause]]\nname = \"even_nonlinearity\"\nk_cos = 0.05\nk_sin = 0.05\n\
        [[cause]]\nname = \"odd_nonlinearity\"\nk_cos = -0.04\nk_sin = -0.04\n\
        [[cause]]\nname = \"spatial_harmonic\"\norder = 5\namplitude_cos = 0.02\nphase_cos = 0.3\n\
        amplitude_sin = 0.03\nphase_sin = -0.9\n";
    obeys(causes, |alpha, _| {
        let cos = alpha.cos();
        let (sin, late) = ((alpha - BETA).sin(), (before(alpha) - BETA).sin());
        [
            bent(cos) - cos + 0.02 * (5.0 * alpha + 0.3).cos(),
            bent(late) - sin + 0.03 * (5.0 * before(alpha) - 0.9).cos(),
        ]
    });
}

#[test]
fn delayed_crosstalk() {
    let (into_cos, into_sin, omega) = (3e-6, -2e-6, TAU * 130.0);
    obeys(
        "name = \"delayed_crosstalk\"\nproduct_into_cos_s = 3e-6\nproduct_into_sin_s = -2e-6",
        |alpha, _| {
            let slopes = [(alpha - BETA).cos(), -alpha.sin()];
            [-into_cos * omega * slopes[0], -into_sin * omega * slopes[1]]
        },
    );
    let delay = 2e-4;
    obeys(
        "name = \"delayed_crosstalk\"\nproduct_into_cos_s = 3e-6\nproduct_into_sin_s = -2e-6\ndelay_s = 2e-4",
        |alpha, _| {
            let before = alpha - omega * delay;
            let of_sin = (before - BETA).sin() - (alpha - BETA).sin();
            let of_cos = before.cos() - alpha.cos();
            [into_cos / delay * of_sin, into_sin / delay * of_cos]
        },
    );
}

#[test]
fn harmonics_of_a_line() {
    obeys(
        "name = \"interference\"\nfrequency_hz = 50.0\namplitude_cos = 0.003\nphase_cos = 0.4\namplitude_sin = 0.0\nphase_sin = 0.0\namplitude_cos_2 = 0.002\nphase_cos_2 = 1.0\namplitude_sin_3 = 0.001\nphase_sin_3 = -1.0",
        |_, t| {
            let line = |harmonic: f64, phase: f64| (TAU * 50.0 * harmonic * t + phase).cos();
            [
                0.003 * line(1.0, 0.4) + 0.002 * line(2.0, 1.0),
                0.001 * line(3.0, -1.0),
            ]
        },
    );
}

#[test]
fn drifts_bend_between_their_ends() {
    let last = 1999.0 / RATE;
    let bent = |change: f64, second: f64, third: f64, t: f64| {
        let x = 2.0 * t / last - 1.0;
        let polynomials = [1.5 * x * x - 0.5, 2.5 * x.powi(3) - 1.5 * x];
        0.5 * change * x + second * polynomials[0] + third * (polynomials[1] - x)
    };
    obeys(
        "name = \"offset_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\ncurve_cos_2 = 0.004\ncurve_sin_3 = 0.003",
        |_, t| [bent(0.01, 0.004, 0.0, t), bent(-0.006, 0.0, 0.003, t)],
    );
    obeys(
        "name = \"gain_drift\"\nchange_cos = 0.01\nchange_sin = 0.0\ncurve_cos_3 = 0.004",
        |alpha, t| [alpha.cos() * bent(0.01, 0.0, 0.004, t), 0.0],
    );
}

#[test]
fn what_warms_up_is_an_exponential() {
    let last = 1999.0 / RATE;
    let gone = |start: f64, tau: f64, t: f64| 1.0 - (-(t - start).max(0.0) / tau).exp();
    let warmed = |start: f64, tau: f64, t: f64| gone(start, tau, t) / gone(start, tau, last) - 0.5;
    obeys(
        "name = \"offset_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\ntau_s = 0.03\nstart_s = 0.05",
        |_, t| [0.01, -0.006].map(|change| change * warmed(0.05, 0.03, t)),
    );
    obeys(
        "name = \"gain_drift\"\nchange_cos = 0.01\nchange_sin = 0.0\ntau_s = 0.1",
        |alpha, t| [alpha.cos() * 0.01 * warmed(0.0, 0.1, t), 0.0],
    );
}

#[test]
fn saturation_of_single_rails() {
    let over = |y: f64| (y - 0.8).max(0.0);
    let pair = |alpha: f64| [alpha.cos(), (alpha - BETA).sin()];
    obeys(
        "name = \"saturation\"\nthreshold = 0.8\ncompression = 0.1\ncompression_lower = 0.0",
        |alpha, _| pair(alpha).map(|y| -0.1 * over(y)),
    );
    obeys(
        "name = \"saturation\"\nthreshold = 0.8\ncompression = 0.1\ncompression_upper = 0.0\ncompression_sin_lower = 0.3",
        |alpha, _| {
            let [cos, sin] = pair(alpha);
            [0.1 * over(-cos), 0.3 * over(-sin)]
        },
    );
}

/// Behind a rail that clips there is nothing more: neither what else is in the channel, nor noise.
#[test]
fn a_rail_that_clips_is_flat() {
    let causes = "[[cause]]\nname = \"saturation\"\nthreshold = 0.7\ncompression = 1.0\ncompression_sin_lower = 0.0\n\
                  [[cause]]\nname = \"spatial_harmonic\"\norder = 3\namplitude_cos = 0.05\nphase_cos = 0.4\namplitude_sin = 0.05\nphase_sin = 0.1\n";
    let samples = sensor(causes, 0.01, 31).simulate(&steady(2000, 130.0), 3);
    let normal = |v: &[f64], a: f64, b: f64| v.iter().map(|v| (v - b) / a).collect::<Vec<_>>();
    let (cos, sin) = (
        normal(&samples.cos, 0.8, 0.03),
        normal(&samples.sin, 0.75, -0.02),
    );
    let at = |v: &[f64], rail: f64| v.iter().filter(|y| (**y - rail).abs() < 1e-6).count();
    for (channel, rail) in [(&cos, 0.7), (&cos, -0.7), (&sin, 0.7)] {
        assert!(at(channel, rail) > 300, "{rail}: {}", at(channel, rail));
        assert!(channel.iter().all(|y| y * rail.signum() < 0.7 + 1e-6));
    }
    assert!(sin.iter().any(|y| *y < -0.95));
}

#[test]
fn ac_coupling_is_a_first_order_high_pass() {
    let (speed, corner) = (130.0, 40.0);
    let motion = steady(20_000, speed);
    let cause = format!("[[cause]]\nname = \"ac_coupling\"\ncorner_hz = {corner:?}");
    let samples = sensor(&cause, 0.0, 31).simulate(&motion, 3);
    // Of whole periods, once the capacitor has its charge.
    let (mut real, mut imaginary) = (0.0, 0.0);
    for k in 10_000..20_000 {
        let y = (samples.cos[k] - 0.03) / 0.8;
        real += y * motion.alpha[k].cos() / 5000.0;
        imaginary -= y * motion.alpha[k].sin() / 5000.0;
    }
    // jω/(jω + ω_c).
    let x = corner / speed;
    let expected = [1.0 / (1.0 + x * x), x / (1.0 + x * x)];
    // Lines from sample to sample are off the circle by a twelfth of the square of the angle between them.
    let off = 1.5 * (TAU * speed / RATE).powi(2) / 12.0 * expected[1];
    assert!((real - expected[0]).abs() < off, "{real} {expected:?}");
    assert!(
        (imaginary - expected[1]).abs() < off,
        "{imaginary} {expected:?}"
    );
}

#[test]
fn flicker_noise_has_the_density_that_it_says() {
    let motion = steady(100_000, 0.0);
    let [cos, sin] = difference("name = \"flicker_noise\"\ndensity_at_1_hz = 2e-4", &motion);
    // Power between two frequencies: the integral of density² / f.
    for (low, high) in [(10.0, 40.0), (200.0, 800.0)] {
        for values in [&cos, &sin] {
            let n = values.len();
            let lines = (low * n as f64 / RATE) as usize..(high * n as f64 / RATE) as usize;
            // Every seventh line is enough, and each counts for seven.
            let power: f64 = lines
                .step_by(7)
                .map(|line| {
                    let turn = TAU * line as f64 / n as f64;
                    let (mut re, mut im) = (0.0, 0.0);
                    for (k, v) in values.iter().enumerate() {
                        let (s, c) = (turn * k as f64).sin_cos();
                        (re, im) = (re + v * c, im + v * s);
                    }
                    7.0 * 2.0 * (re * re + im * im) / (n * n) as f64
                })
                .sum();
            let expected = 4e-8 * (high / low).ln();
            assert!(
                (power / expected - 1.0).abs() < 0.35,
                "{low}: {power} {expected}"
            );
        }
    }
}

/// Codes from the lowest one on.
fn codes(values: &[f64], bits: u32) -> Vec<i64> {
    let half = 2f64.powi(bits as i32 - 1);
    values
        .iter()
        .map(|v| (v * half + half).round() as i64)
        .collect()
}

/// Codes of cos and of sin with a cause of the codes and without it, of an ADC of 14 bits.
fn of_codes(cause: &str) -> [[Vec<i64>; 2]; 2] {
    let motion = steady(3000, 37.0);
    [format!("[[cause]]\n{cause}"), String::new()].map(|cause| {
        let samples = sensor(&cause, 0.0, 14).simulate(&motion, 3);
        [codes(&samples.cos, 14), codes(&samples.sin, 14)]
    })
}

#[test]
fn a_stuck_bit_never_changes_and_no_other_bit_is_touched() {
    for (level, set) in [(0, 0), (1, 1 << 5)] {
        let [with, without] = of_codes(&format!(
            "name = \"stuck_bit\"\nbit = 5\nchannel = \"sin\"\nlevel = {level}"
        ));
        assert_eq!(with[0], without[0]);
        for (is, was) in with[1].iter().zip(&without[1]) {
            assert_eq!(*is, was & !(1 << 5) | set);
        }
        assert_ne!(with[1], without[1]);
    }
}

#[test]
fn coarse_codes_come_in_steps() {
    let [with, without] =
        of_codes("name = \"coarse_quantisation\"\nstep_lsb = 6\nremainder_lsb = 2");
    for (with, without) in with.iter().zip(&without) {
        for (is, was) in with.iter().zip(without) {
            assert_eq!(is.rem_euclid(6), 2);
            assert!((0..6).contains(&(was - is)), "{was} {is}");
        }
    }
}

/// A noisy recording whole, and with a cause of its rows.
fn rows(cause: &str) -> [Samples; 2] {
    let motion = steady(20_000, 37.0);
    [String::new(), format!("[[cause]]\n{cause}")]
        .map(|cause| sensor(&cause, 0.001, 14).simulate(&motion, 3))
}

#[test]
fn dropped_samples_are_missing_and_the_others_are_as_they_were() {
    let [whole, left] = rows("name = \"dropped_samples\"\nshare = 0.01");
    let lost = whole.cos.len() - left.cos.len();
    assert!((130..270).contains(&lost), "{lost} of 20000");
    let mut from = 0;
    for (k, time) in left.time_s.iter().enumerate() {
        let at = from
            + whole.time_s[from..]
                .iter()
                .position(|t| t == time)
                .expect("a time of the whole");
        assert_eq!((left.cos[k], left.sin[k]), (whole.cos[at], whole.sin[at]));
        from = at + 1;
    }
}

#[test]
fn repeated_samples_are_the_ones_before_them() {
    let [whole, doubled] = rows("name = \"repeated_samples\"\nshare = 0.01");
    assert_eq!(whole.time_s, doubled.time_s);
    let pair = |s: &Samples, k: usize| (s.cos[k], s.sin[k]);
    let mut count = 0;
    for k in 1..whole.cos.len() {
        if pair(&doubled, k) != pair(&whole, k) {
            assert_eq!(pair(&doubled, k), pair(&doubled, k - 1));
            count += 1;
        }
    }
    assert!((130..270).contains(&count), "{count} of 20000");
}
