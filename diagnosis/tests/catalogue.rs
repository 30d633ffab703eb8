//! Every row of the catalogue, hidden in simulated data and found.
//!
//! The simulation here is direct: continuous motion, the effect as physics has it, noise, ADC. It shares no code with the
//! diagnosis. What needs more than this stands beside it: `large.rs` has effects far above the noise, `flicker.rs` noise
//! with a memory.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use nonius_diagnosis::{Diagnosis, diagnose};
use nonius_recording::{Overrides, Recording};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 20_000;
const RATE: f64 = 50e3;
const NOISE: f64 = 0.001;
const PERIODS: f64 = 8.0;

/// An experiment: what happens to angle, channels, reference and samples.
struct Case {
    /// Change of the angle that is real motion, radians.
    motion: fn(t: f64, alpha: f64) -> f64,
    /// Angles that the two channels see, radians, given angle and angular speed.
    seen: fn(alpha: f64, speed: f64) -> (f64, f64),
    /// Channels in amplitudes, given themselves, time, angle and speed.
    channels: fn(c: f64, s: f64, t: f64, alpha: f64, speed: f64) -> (f64, f64),
    /// Noise of a sample: of the amplitude, given channel and speed, and two normal numbers.
    noise: fn(u: f64, slope: f64, speed: f64, normal: [f64; 2]) -> f64,
    reference: bool,
    revolution: bool,
}

const PLAIN: Case = Case {
    motion: |_, _| 0.0,
    seen: |alpha, _| (alpha, alpha),
    channels: |c, s, _, _, _| (c, s),
    noise: |_, _, _, normal| NOISE * normal[0],
    reference: false,
    revolution: false,
};

/// Time, cos, sin, reference.
type Rows = Vec<[f64; 4]>;

fn rows(case: &Case, seed: u64) -> Rows {
    let mut random = StdRng::seed_from_u64(seed);
    let length = SAMPLES as f64 / RATE;
    let swing = random.random_range(8.0..25.0) * TAU;
    let turns = TAU * random.random_range(1.2..3.0) / length;
    let (start, run) = (
        random.random_range(0.0..6.0),
        random.random_range(2.0..10.0) * TAU / length,
    );
    let beta = random.random_range(-0.07..0.07);
    let (a_c, a_s) = (random.random_range(0.7..0.9), random.random_range(0.7..0.9));
    let (b_c, b_s) = (
        random.random_range(-0.05..0.05),
        random.random_range(-0.05..0.05),
    );
    let lsb = 2.0 / f64::from(1 << 14);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    (0..SAMPLES)
        .map(|k| {
            let t = k as f64 / RATE;
            let smooth = swing * (turns * t + start).sin() + run * t;
            let speed = swing * turns * (turns * t + start).cos() + run;
            let alpha = smooth + (case.motion)(t, smooth);
            let (at_c, at_s) = (case.seen)(alpha, speed);
            let (c, s) = (case.channels)(at_c.cos(), (at_s - beta).sin(), t, alpha, speed);
            let n_c = (case.noise)(c, -at_c.sin(), speed, [normal(), normal()]);
            let n_s = (case.noise)(s, (at_s - beta).cos(), speed, [normal(), normal()]);
            let code = |v: f64| (v / lsb).round() * lsb;
            [
                t,
                code(a_c * (c + n_c) + b_c),
                code(a_s * (s + n_s) + b_s),
                1.0 - alpha,
            ]
        })
        .collect()
}

fn recording(case: &Case, rows: &Rows) -> Recording {
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\n");
    if case.revolution {
        text += &format!("# periods_per_revolution: {PERIODS}\n");
    }
    text += if case.reference {
        "time_s,cos,sin,reference_rad\n"
    } else {
        "time_s,cos,sin\n"
    };
    for [t, c, s, r] in rows {
        text += &format!("{t:.7},{c},{s}");
        if case.reference {
            text += &format!(",{r:.9}");
        }
        text += "\n";
    }
    Recording::read_from(text.as_bytes(), "test", &Overrides::default()).unwrap()
}

fn diagnosed(case: &Case, seed: u64) -> Diagnosis {
    diagnose(&recording(case, &rows(case, seed))).unwrap()
}

/// The first finding is the cause (or is confounded with it), and nothing else is named.
fn finds(name: &str, case: &Case) -> Diagnosis {
    let found = diagnosed(case, 7);
    let names: Vec<&str> = found.findings.iter().map(|f| f.cause.as_str()).collect();
    let first = found.findings.first();
    let group =
        first.is_some_and(|f| f.cause == name || f.confounded_with.iter().any(|c| c == name));
    assert!(group, "{name}: {names:?}, {}", found.unexplained.signature);
    assert_eq!(names.len(), 1, "{name}: {names:?}");
    assert!(first.is_some_and(|f| f.p_value < 1e-3 && !f.evidence.is_empty()));
    found
}

fn near(found: &Diagnosis, parameter: &str, value: f64) {
    let list = &found.findings[0].parameters;
    let p = list.iter().find(|p| p.name == parameter).unwrap();
    let off = (p.value - value).abs();
    assert!(
        off < 4.0 * p.std_error + 1e-12,
        "{parameter} {} +/- {}, true {value}",
        p.value,
        p.std_error
    );
    assert!(
        p.std_error < 0.3 * value.abs(),
        "{parameter} +/- {}",
        p.std_error
    );
}

#[test]
fn nothing_is_found_where_nothing_is_hidden() {
    for seed in 0..6 {
        for (reference, revolution) in [(false, false), (true, true)] {
            let found = diagnosed(
                &Case {
                    reference,
                    revolution,
                    ..PLAIN
                },
                seed,
            );
            let names: Vec<&str> = found.findings.iter().map(|f| f.cause.as_str()).collect();
            assert!(names.is_empty(), "{seed}: {names:?}");
            assert!(
                !found.unexplained.significant,
                "{seed}: {}",
                found.unexplained.signature
            );
        }
    }
}

#[test]
fn static_causes() {
    let found = finds(
        "even_nonlinearity",
        &Case {
            channels: |c, s, _, _, _| (c + 0.003 * c * c, s + 0.002 * s * s),
            ..PLAIN
        },
    );
    near(&found, "k_cos", 0.003);
    near(&found, "k_sin", 0.002);
    let found = finds(
        "odd_nonlinearity",
        &Case {
            channels: |c, s, _, _, _| (c + 0.004 * c.powi(3), s - 0.003 * s.powi(3)),
            ..PLAIN
        },
    );
    near(&found, "k_cos", 0.004);
    let found = finds(
        "spatial_harmonic",
        &Case {
            channels: |c, s, _, a, _| {
                (
                    c + 0.002 * (4.0 * a + 1.0).cos(),
                    s + 0.003 * (4.0 * a).sin(),
                )
            },
            ..PLAIN
        },
    );
    near(&found, "amplitude_cos", 0.002);
    finds(
        "saturation",
        &Case {
            channels: |c, s, _, _, _| {
                (c - 0.05 * (c - 0.8).max(0.0), s - 0.05 * (s - 0.8).max(0.0))
            },
            ..PLAIN
        },
    );
    finds(
        "adc_nonlinearity",
        &Case {
            channels: |c, s, _, _, _| (c + 0.0005 * (c + 0.02).signum(), s),
            ..PLAIN
        },
    );
}

#[test]
fn causes_of_speed() {
    let found = finds(
        "channel_skew",
        &Case {
            seen: |a, v| (a, a + 1e-6 * v),
            ..PLAIN
        },
    );
    near(&found, "delay_s", 1e-6);
    finds(
        "bandwidth_mismatch",
        &Case {
            seen: |a, v| (a, a - (2e-6 * v).atan()),
            channels: |c, s, _, _, v| (c, s / (1.0 + (2e-6 * v).powi(2)).sqrt()),
            ..PLAIN
        },
    );
    let found = finds(
        "common_bandwidth",
        &Case {
            channels: |c, s, _, _, v| {
                let g = 1.0 / (1.0 + (2e-5 * v).powi(2)).sqrt();
                (c * g, s * g)
            },
            ..PLAIN
        },
    );
    near(&found, "tau_s", 2e-5);
    finds(
        "delayed_crosstalk",
        &Case {
            channels: |c, s, _, a, v| {
                (
                    c + 0.1 * (a - 1e-5 * v).sin(),
                    s + 0.05 * (a - 1e-5 * v).cos(),
                )
            },
            ..PLAIN
        },
    );
    let found = finds(
        "hysteresis",
        &Case {
            channels: |c, s, _, _, v| (c + 0.002 * v.signum(), s - 0.001 * v.signum()),
            ..PLAIN
        },
    );
    near(&found, "offset_cos", 0.002);
    let found = finds(
        "latency",
        &Case {
            seen: |a, v| (a - 3e-6 * v, a - 3e-6 * v),
            reference: true,
            ..PLAIN
        },
    );
    near(&found, "delay_s", 3e-6);
}

#[test]
fn lines() {
    let found = finds(
        "interference",
        &Case {
            channels: |c, s, t, _, _| {
                (
                    c + 0.001 * (TAU * 150.0 * t).cos(),
                    s + 0.0015 * (TAU * 150.0 * t + 2.0).cos(),
                )
            },
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 150.0);
    near(&found, "amplitude_sin", 0.0015);
    let found = finds(
        "amplitude_ripple",
        &Case {
            channels: |c, s, t, _, _| {
                let m = 1.0 + 0.001 * (TAU * 333.0 * t).cos();
                (c * m, s * m)
            },
            ..PLAIN
        },
    );
    near(&found, "depth", 0.001);
    let found = finds(
        "vibration",
        &Case {
            motion: |t, _| 0.002 * (TAU * 1234.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "amplitude", 0.002);
    assert_eq!(
        serde_json::to_value(found.findings[0].chip).unwrap(),
        "is not a sensor error"
    );
}

#[test]
fn slow_changes() {
    finds(
        "offset_drift",
        &Case {
            channels: |c, s, t, _, _| (c + 0.01 * t, s - 0.008 * t),
            ..PLAIN
        },
    );
    finds(
        "gain_drift",
        &Case {
            channels: |c, s, t, _, _| (c * (1.0 + 0.01 * t), s * (1.0 - 0.006 * t)),
            ..PLAIN
        },
    );
}

#[test]
fn causes_of_the_revolution() {
    let revolving = Case {
        revolution: true,
        ..PLAIN
    };
    let found = finds(
        "runout",
        &Case {
            channels: |c, s, _, a, _| {
                let m = 1.0 + 0.002 * (a / PERIODS + 0.5).cos();
                (c * m, s * m)
            },
            ..revolving
        },
    );
    near(&found, "depth", 0.002);
    finds(
        "contamination",
        &Case {
            channels: |c, s, _, a, _| {
                let off = (a / PERIODS - 1.0 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                let m = 1.0 - 0.01 * (-0.5 * (off / 0.08).powi(2)).exp();
                (c * m, s * m)
            },
            revolution: true,
            ..PLAIN
        },
    );
    let found = finds(
        "graduation_error",
        &Case {
            seen: |a, _| {
                let e = a + 0.003 * (3.0 * a / PERIODS).cos();
                (e, e)
            },
            reference: true,
            revolution: true,
            ..PLAIN
        },
    );
    near(&found, "amplitude", 0.003);
    let gain = found.findings[0].gain;
    assert!(
        gain.position_error_rms_after_rad.unwrap()
            < 0.6 * gain.position_error_rms_before_rad.unwrap()
    );
    finds(
        "cogging",
        &Case {
            motion: |_, a| 0.004 * (61.0 * a / PERIODS).sin(),
            revolution: true,
            ..PLAIN
        },
    );
}

#[test]
fn noises() {
    let found = finds(
        "amplitude_noise",
        &Case {
            noise: |u, _, _, n| NOISE * n[0] + 0.002 * u * n[1],
            ..PLAIN
        },
    );
    near(&found, "rms", 0.002);
    finds(
        "clock_jitter",
        &Case {
            noise: |_, slope, v, n| NOISE * n[0] + slope * v * 6e-7 * n[1],
            ..PLAIN
        },
    );
}

#[test]
fn causes_in_the_data() {
    let damaged = |name: &str, damage: &dyn Fn(&mut Rows)| {
        let mut data = rows(&PLAIN, 3);
        damage(&mut data);
        let found = diagnose(&recording(&PLAIN, &data)).unwrap();
        let names: Vec<&str> = found.findings.iter().map(|f| f.cause.as_str()).collect();
        assert_eq!(names, [name], "{}", found.unexplained.signature);
        assert_eq!(found.positions.len(), data.len());
    };
    damaged("glitches", &|data| {
        for k in [500, 4321, 9000, 15_000] {
            data[k][1] += 0.2;
        }
    });
    damaged("dropped_samples", &|data| {
        for k in [15_000, 9000, 4321, 500] {
            data.remove(k);
        }
    });
    damaged("repeated_samples", &|data| {
        for k in [500, 4321, 9000, 12_000, 15_000, 17_000] {
            let before = data[k - 1];
            data[k][1] = before[1];
            data[k][2] = before[2];
        }
    });
    let lsb = 2.0 / f64::from(1 << 14);
    damaged("stuck_bit", &|data| {
        for row in data {
            let code = (row[1] / lsb).round() as i64 + 8192;
            row[1] = ((code & !8) - 8192) as f64 * lsb;
        }
    });
    damaged("coarse_quantisation", &|data| {
        for row in data {
            row[1] = (row[1] / lsb / 16.0).round() * 16.0 * lsb;
        }
    });
}

/// A shape that the library does not hold is not given a name.
#[test]
fn strangers_stay_unnamed() {
    let case = Case {
        channels: |c, s, _, a, v| {
            let odd = 0.01 * (a * 1.5).sin().abs().powi(3) * (v / 3000.0).abs().sqrt();
            (c + odd, s)
        },
        ..PLAIN
    };
    let found = diagnosed(&case, 5);
    assert!(found.unexplained.significant);
    assert!(!found.unexplained.signature.is_empty());
}
