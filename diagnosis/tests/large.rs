//! Large effects: a hundred times what can be seen, and more. What second order leaves of them is above the noise and must
//! not be given another name.
//!
//! The simulation is direct, as in `catalogue.rs`; low passes are integrated between the samples.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use nonius_diagnosis::{Diagnosis, diagnose};
use nonius_recording::{Overrides, Recording};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 20_000;
const RATE: f64 = 50e3;
const NOISE: f64 = 0.001;
/// Steps of the simulation between two samples.
const FINE: usize = 24;
const PERIODS: f64 = 8.0;

/// What happens to the channels: given the ideal ones, time, angle and speed, in amplitudes.
type Channels = fn(c: f64, s: f64, t: f64, alpha: f64, speed: f64) -> (f64, f64);

struct Case {
    motion: fn(t: f64) -> f64,
    /// Angles that the channels see, given angle and speed.
    seen: fn(alpha: f64, speed: f64) -> (f64, f64),
    channels: Channels,
    /// Time constants of a low pass in each channel, seconds.
    tau: [f64; 2],
    reference: bool,
    revolution: bool,
}

const PLAIN: Case = Case {
    motion: |_| 0.0,
    seen: |alpha, _| (alpha, alpha),
    channels: |c, s, _, _, _| (c, s),
    tau: [0.0; 2],
    reference: false,
    revolution: false,
};

fn recording(case: &Case) -> Recording {
    let mut random = StdRng::seed_from_u64(11);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let length = SAMPLES as f64 / RATE;
    let (swing, turns, run) = (14.0 * TAU, TAU * 2.2 / length, 6.0 * TAU / length);
    let beta = 0.04;
    let lsb = 2.0 / f64::from(1 << 14);
    let code = |v: f64| (v / lsb).round() * lsb;
    let ideal = |t: f64| {
        let smooth = swing * (turns * t + 0.7).sin() + run * t;
        let speed = swing * turns * (turns * t + 0.7).cos() + run;
        let alpha = smooth + (case.motion)(t);
        let (at_c, at_s) = (case.seen)(alpha, speed);
        let (c, s) = (case.channels)(at_c.cos(), (at_s - beta).sin(), t, alpha, speed);
        ([c, s], alpha)
    };
    let mut filtered = ideal(-200.0 / RATE).0;
    let step = 1.0 / RATE / FINE as f64;
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\n");
    if case.revolution {
        text += &format!("# periods_per_revolution: {PERIODS}\n");
    }
    text += "time_s,cos,sin";
    text += if case.reference {
        ",reference_rad\n"
    } else {
        "\n"
    };
    for k in -200..SAMPLES as i64 {
        let t = k as f64 / RATE;
        for i in 0..FINE {
            // The middle of each step: second order in it.
            let now = ideal(t - (FINE - i) as f64 * step + 0.5 * step).0;
            for ((y, u), tau) in filtered.iter_mut().zip(now).zip(case.tau) {
                if tau > 0.0 {
                    *y = u + (*y - u) * (-step / tau).exp();
                }
            }
        }
        let (now, alpha) = ideal(t);
        if k < 0 {
            continue;
        }
        let out = |i: usize| {
            if case.tau[i] > 0.0 {
                filtered[i]
            } else {
                now[i]
            }
        };
        let (c, s) = (out(0) + NOISE * normal(), out(1) + NOISE * normal());
        text += &format!("{t:.7},{},{}", code(0.6 * c + 0.02), code(0.55 * s - 0.03));
        if case.reference {
            text += &format!(",{alpha:.9}");
        }
        text += "\n";
    }
    Recording::read_from(text.as_bytes(), "test", &Overrides::default()).unwrap()
}

/// Nothing but the cause is named, nothing is left unexplained, and the residue is the noise.
fn alone(name: &str, case: &Case) -> Diagnosis {
    let found = diagnose(&recording(case)).unwrap();
    let names: Vec<&str> = found.findings.iter().map(|f| f.cause.as_str()).collect();
    assert_eq!(names, [name], "{name}: {}", found.unexplained.signature);
    assert!(
        !found.unexplained.significant,
        "{name}: {}",
        found.unexplained.signature
    );
    let rms = found.extended.residual_rms;
    assert!(
        rms < 1.1 * NOISE,
        "{name}: residual {rms}, before {}",
        found.simulation.residual_rms
    );
    found
}

fn near(found: &Diagnosis, parameter: &str, value: f64) {
    let list = &found.findings[0].parameters;
    let p = list.iter().find(|p| p.name == parameter).unwrap();
    assert!(
        (p.value - value).abs() < 4.0 * p.std_error,
        "{parameter} {} +/- {}, true {value}",
        p.value,
        p.std_error
    );
}

#[test]
fn of_the_angle() {
    let found = alone(
        "spatial_harmonic",
        &Case {
            channels: |c, s, _, a, _| {
                (c + 0.05 * (3.0 * a + 0.4).cos(), s + 0.04 * (3.0 * a).sin())
            },
            ..PLAIN
        },
    );
    near(&found, "amplitude_cos", 0.05);
    near(&found, "amplitude_sin", 0.04);
    let found = alone(
        "even_nonlinearity",
        &Case {
            channels: |c, s, _, _, _| (c + 0.05 * c * c, s - 0.04 * s * s),
            ..PLAIN
        },
    );
    near(&found, "k_cos", 0.05);
    let found = alone(
        "odd_nonlinearity",
        &Case {
            channels: |c, s, _, _, _| (c - 0.06 * c.powi(3), s - 0.05 * s.powi(3)),
            ..PLAIN
        },
    );
    near(&found, "k_sin", -0.05);
    let found = alone(
        "saturation",
        &Case {
            channels: |c, s, _, _, _| {
                let pressed = |v: f64| v - 0.3 * (v - 0.77).max(0.0);
                (pressed(c), pressed(s))
            },
            ..PLAIN
        },
    );
    near(&found, "threshold", 0.77);
}

#[test]
fn of_the_speed() {
    // The largest speed is some 3.4e3 rad/s: a tenth of a radian.
    let found = alone(
        "bandwidth_mismatch",
        &Case {
            tau: [0.0, 3e-5],
            ..PLAIN
        },
    );
    near(&found, "tau_sin_s", 3e-5);
    let found = alone(
        "channel_skew",
        &Case {
            seen: |a, v| (a, a + 3e-5 * v),
            ..PLAIN
        },
    );
    near(&found, "delay_s", 3e-5);
    let found = alone(
        "common_bandwidth",
        &Case {
            tau: [1e-4, 1e-4],
            ..PLAIN
        },
    );
    near(&found, "tau_s", 1e-4);
    // A third of a radian late, of a hundredth: where the fraction itself is large, its square turns the channels, and
    // that is not in the shape.
    alone(
        "delayed_crosstalk",
        &Case {
            channels: |c, s, _, a, v| {
                (
                    c + 0.01 * (a - 0.04 - 1e-4 * v).sin(),
                    s + 0.008 * (a - 1e-4 * v).cos(),
                )
            },
            ..PLAIN
        },
    );
    let found = alone(
        "hysteresis",
        &Case {
            channels: |c, s, _, _, v| (c + 0.003 * v.signum(), s - 0.004 * v.signum()),
            ..PLAIN
        },
    );
    near(&found, "offset_cos", 0.003);
    let found = alone(
        "latency",
        &Case {
            seen: |a, v| (a - 3e-5 * v, a - 3e-5 * v),
            reference: true,
            ..PLAIN
        },
    );
    near(&found, "delay_s", 3e-5);
}

#[test]
fn of_a_line() {
    let found = alone(
        "interference",
        &Case {
            channels: |c, s, t, _, _| {
                (
                    c + 0.05 * (TAU * 151.3 * t).cos(),
                    s + 0.04 * (TAU * 151.3 * t + 2.0).cos(),
                )
            },
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 151.3);
    near(&found, "amplitude_sin", 0.04);
    let found = alone(
        "amplitude_ripple",
        &Case {
            channels: |c, s, t, _, _| {
                let m = 1.0 + 0.06 * (TAU * 333.3 * t).cos();
                (c * m, s * m)
            },
            ..PLAIN
        },
    );
    near(&found, "depth", 0.06);
    let found = alone(
        "vibration",
        &Case {
            motion: |t| 0.1 * (TAU * 1234.5 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "amplitude", 0.1);
}

#[test]
fn of_the_time() {
    alone(
        "offset_drift",
        &Case {
            channels: |c, s, t, _, _| (c + 0.15 * t, s - 0.1 * t),
            ..PLAIN
        },
    );
    alone(
        "gain_drift",
        &Case {
            channels: |c, s, t, _, _| (c * (1.0 + 0.2 * t), s * (1.0 - 0.15 * t)),
            ..PLAIN
        },
    );
}

#[test]
fn of_the_revolution() {
    let turning = Case {
        revolution: true,
        ..PLAIN
    };
    let found = alone(
        "runout",
        &Case {
            channels: |c, s, _, a, _| {
                let m = 1.0 + 0.05 * (a / PERIODS + 0.5).cos();
                (c * m, s * m)
            },
            ..turning
        },
    );
    near(&found, "depth", 0.05);
    let found = alone(
        "contamination",
        &Case {
            channels: |c, s, _, a, _| {
                let off = (a / PERIODS - 1.0 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                let m = 1.0 - 0.2 * (-0.5 * (off / 0.1f64).powi(2)).exp();
                (c * m, s * m)
            },
            revolution: true,
            ..PLAIN
        },
    );
    // The place counts from where the recording begins, a whole number of periods off.
    let place = &found.findings[0].parameters[1];
    let period = TAU / PERIODS;
    let off = (place.value - 1.0 + period / 2.0).rem_euclid(period) - period / 2.0;
    assert!(off.abs() < 5.0 * place.std_error, "{off}");
    near(&found, "width", 0.1);
}
