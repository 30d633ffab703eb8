//! Causes that grow with the speed or turn over with its sign.

use std::f64::consts::TAU;

use nonius_kept::every;

use nonius_diagnosis::Cause;

use crate::harness::{
    Case, LSB, NOISE, PLAIN, alone, diagnosed, diagnosed_of, finds, finds_beside, finds_nothing,
    names, near, of_cause, shows, within_errors,
};
use crate::motion::rumble;

/// The offsets turn over with the direction, by so many per mille of the amplitude.
fn turning<const COS: i32, const SIN: i32>() -> Case {
    Case {
        channels: |c, s, _, _, v| {
            let by = |per_mille| f64::from(per_mille) * 1e-3 * v.signum();
            (c + by(COS), s + by(SIN))
        },
        ..PLAIN
    }
}

/// Both channels are late by so many microseconds.
fn late<const MICROSECONDS: u32>() -> Case {
    Case {
        seen: |a, v| {
            let seen = a - f64::from(MICROSECONDS) * 1e-6 * v;
            (seen, seen)
        },
        reference: true,
        ..PLAIN
    }
}

/// A latency that is ten times as strong as what goes with the speed beside it hides nothing of that.
#[test]
fn what_goes_with_speed_shows_beside_a_latency() {
    let skew = Case {
        seen: |a, v| (a - 5e-5 * v, a - 5.3e-5 * v),
        ..late::<50>()
    };
    let found = diagnosed(&skew, 7);
    assert_eq!(names(&found), [Cause::Latency, Cause::ChannelSkew]);
    of_cause(&found, Cause::ChannelSkew, "delay_s", -3e-6);
    assert!(
        !found.unexplained.significant,
        "{}",
        found.unexplained.signature
    );
    let hysteresis = Case {
        seen: |a, v| (a - 5e-5 * v, a - 5e-5 * v),
        reference: true,
        ..turning::<3, -4>()
    };
    let found = diagnosed(&hysteresis, 7);
    assert!(
        names(&found).contains(&Cause::Hysteresis),
        "{:?}",
        names(&found)
    );
}

/// Without a reference a delay is the motion a little later, whatever its size.
#[test]
fn no_latency_without_a_reference() {
    let late = Case {
        reference: false,
        ..late::<30>()
    };
    finds_nothing(&late, 7);
}

#[test]
fn delays_and_bandwidths() {
    let found = finds(
        Cause::ChannelSkew,
        &Case {
            seen: |a, v| (a, a + 1e-6 * v),
            ..PLAIN
        },
    );
    near(&found, "delay_s", 1e-6);
    // Far below its corner a low pass is a delay.
    finds_beside(
        Cause::BandwidthMismatch,
        Cause::ChannelSkew,
        &Case {
            seen: |a, v| (a, a - (2e-6 * v).atan()),
            channels: |c, s, _, _, v| (c, s / (1.0 + (2e-6 * v).powi(2)).sqrt()),
            ..PLAIN
        },
    );
    let found = finds(
        Cause::CommonBandwidth,
        &Case {
            channels: |c, s, _, _, v| {
                let g = 1.0 / (1.0 + (2e-5 * v).powi(2)).sqrt();
                (c * g, s * g)
            },
            ..PLAIN
        },
    );
    near(&found, "tau_s", 2e-5);
    let found = finds(Cause::Latency, &late::<3>());
    near(&found, "delay_s", 3e-6);
}

#[test]
fn crosstalk_and_hysteresis() {
    finds(
        Cause::DelayedCrosstalk,
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
    let found = finds(Cause::Hysteresis, &turning::<2, -1>());
    near(&found, "offset_cos", 0.002);
}

/// A fraction that appears in the other channel turns the pair by the speed as well, by its square: that is no latency of its own.
#[test]
fn a_large_crosstalk_is_not_late_as_well() {
    let crosstalk = Case {
        channels: |c, s, _, a, v| {
            let (sin, cos) = (a - 2e-5 * v).sin_cos();
            (c + 0.15 * sin, s + 0.12 * cos)
        },
        reference: true,
        ..PLAIN
    };
    for seed in 0..2 {
        assert_eq!(
            names(&diagnosed(&crosstalk, seed)),
            [Cause::DelayedCrosstalk]
        );
    }
}

/// The clock jitters by 600 ns.
pub(crate) const JITTERING: Case = Case {
    noise: |_, slope, v, n| NOISE * n[0] + slope * v * 6e-7 * n[1],
    ..PLAIN
};

/// On an axis that shakes, too, whose noise is higher about its mode: that is no line of the clock.
#[test]
fn clock_jitter() {
    finds(Cause::ClockJitter, &JITTERING);
    let shaking = Case {
        motion: |t, _| rumble(t),
        ..JITTERING
    };
    finds(Cause::ClockJitter, &shaking);
}

#[test]
fn large() {
    // The largest speed is some 3.4e3 rad/s: a tenth of a radian.
    let found = alone(
        Cause::BandwidthMismatch,
        &Case {
            tau: [0.0, 3e-5],
            ..PLAIN
        },
    );
    within_errors(&found, "tau_sin_s", 3e-5);
    let found = alone(
        Cause::ChannelSkew,
        &Case {
            seen: |a, v| (a, a + 3e-5 * v),
            ..PLAIN
        },
    );
    within_errors(&found, "delay_s", 3e-5);
    let found = alone(
        Cause::CommonBandwidth,
        &Case {
            tau: [1e-4, 1e-4],
            ..PLAIN
        },
    );
    within_errors(&found, "tau_s", 1e-4);
    // A third of a radian late, of a hundredth: where the fraction itself is large, its square turns the channels, and
    // that is not in the shape.
    alone(
        Cause::DelayedCrosstalk,
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
    let found = alone(Cause::Hysteresis, &turning::<3, -4>());
    within_errors(&found, "offset_cos", 0.003);
    let found = alone(Cause::Latency, &late::<30>());
    within_errors(&found, "delay_s", 3e-5);
}

/// A radius that falls with the speed as a capacitor's memory makes it, to half at a fourth of the largest speed and hardly
/// farther above: no low pass, although one explains most of it.
#[test]
fn another_law_of_the_speed_has_no_name() {
    let found = diagnosed(
        &Case {
            channels: |c, s, _, _, v| {
                let soaked = 0.004 / (1.0 + (v / 800.0).powi(2));
                (c * (1.0 + soaked), s * (1.0 + soaked))
            },
            ..PLAIN
        },
        5,
    );
    assert!(names(&found).is_empty(), "{:?}", names(&found));
    assert!(found.unexplained.significant);
}

/// A capacitor before each channel, charged to the mean before the recording begins: a high pass of 4 Hz.
#[test]
fn a_capacitor_before_each_channel() {
    const SECONDS: f64 = 0.04;
    shows(Cause::AcCoupling, |rows| {
        let mut slow = [0.0; 2];
        for k in 0..rows.len() {
            let step = if k == 0 {
                0.0
            } else {
                rows[k][0] - rows[k - 1][0]
            };
            for (channel, slow) in slow.iter_mut().enumerate() {
                let value = rows[k][1 + channel];
                *slow += (value - *slow) * (1.0 - (-step / SECONDS).exp());
                rows[k][1 + channel] = ((value - *slow) / LSB).round() * LSB;
            }
        }
    });
}

/// Both channels bend, and the sine is sampled so many tenths of a microsecond later: its bends are.
fn bent_and_late<const TENTHS: i32, const COS: i32, const SIN: i32>() -> Case {
    Case {
        seen: |a, v| (a, a + 1e-7 * f64::from(TENTHS) * v),
        channels: |c, s, _, _, _| {
            let bent = |u: f64, per_mille: i32| u + 1e-3 * f64::from(per_mille) * u.powi(3);
            (bent(c, COS), bent(s, SIN))
        },
        reference: true,
        ..PLAIN
    }
}

/// What a delay does to a bend is many times the noise here, and would be a low pass, or have no name; and which of the two explains
/// more is no matter.
#[test]
fn a_channel_that_is_late_bends_late() {
    fn is_found<const TENTHS: i32, const COS: i32, const SIN: i32>() {
        for seed in [7, 8] {
            let found = diagnosed(&bent_and_late::<TENTHS, COS, SIN>(), seed);
            let mut named = names(&found);
            named.sort_unstable();
            let what = format!(
                "{TENTHS} {COS} {SIN} {seed}: {}",
                found.unexplained.signature
            );
            assert_eq!(
                named,
                [Cause::OddNonlinearity, Cause::ChannelSkew],
                "{what}"
            );
            assert!(!found.unexplained.significant, "{what}");
            let delay = 1e-7 * f64::from(TENTHS);
            of_cause(&found, Cause::ChannelSkew, "delay_s", delay);
            of_cause(
                &found,
                Cause::OddNonlinearity,
                "k_cos",
                1e-3 * f64::from(COS),
            );
            of_cause(
                &found,
                Cause::OddNonlinearity,
                "k_sin",
                1e-3 * f64::from(SIN),
            );
        }
    }
    is_found::<60, 40, -20>();
    is_found::<-60, 40, -20>();
    is_found::<200, 40, 40>();
    is_found::<-200, -60, 40>();
    is_found::<10, -60, -60>();
}

/// A channel has a third harmonic, and the sine is sampled so many microseconds later: up to a fifth of a radian, and of three in its
/// harmonic.
fn harmonic_and_late<const MICROSECONDS: i32>() -> Case {
    Case {
        seen: |a, v| (a, a + 1e-6 * f64::from(MICROSECONDS) * v),
        channels: |c, s, _, a, v| {
            let late = a + 1e-6 * f64::from(MICROSECONDS) * v;
            (
                c + 0.006 * (3.0 * a + 0.3).cos(),
                s + 0.007 * (3.0 * late + 1.7).cos(),
            )
        },
        ..PLAIN
    }
}

/// Before the harmonic is known, what the delay does to it moves the delay from look to look, to and fro: it has to be found all the same.
/// The same of a low pass.
#[test]
fn a_channel_that_is_late_has_late_harmonics() {
    let low_pass = |tau: [f64; 2]| Case {
        tau,
        ..harmonic_and_late::<0>()
    };
    let all = [
        (
            Cause::ChannelSkew,
            "delay_s",
            6e-5,
            harmonic_and_late::<60>(),
        ),
        (
            Cause::ChannelSkew,
            "delay_s",
            -6e-5,
            harmonic_and_late::<-60>(),
        ),
        (
            Cause::ChannelSkew,
            "delay_s",
            2e-5,
            harmonic_and_late::<20>(),
        ),
        (
            Cause::BandwidthMismatch,
            "tau_cos_s",
            6e-5,
            low_pass([6e-5, 0.0]),
        ),
        (
            Cause::BandwidthMismatch,
            "tau_sin_s",
            6e-5,
            low_pass([0.0, 6e-5]),
        ),
    ];
    for (cause, parameter, value, case) in every(3, all) {
        let found = diagnosed(&case, 7);
        let mut named = names(&found);
        named.sort_unstable();
        let what = format!("{cause} {value}: {}", found.unexplained.signature);
        assert_eq!(named, [Cause::SpatialHarmonic, cause], "{what}");
        assert!(!found.unexplained.significant, "{what}");
        of_cause(&found, cause, parameter, value);
        of_cause(&found, Cause::SpatialHarmonic, "amplitude_cos", 0.006);
        of_cause(&found, Cause::SpatialHarmonic, "amplitude_sin", 0.007);
    }
}

/// An amplitude that follows the motion to and fro may be one that changes with time, with the place or with the acceleration.
#[test]
fn a_line_that_the_motion_has_is_no_ripple() {
    let swung = Case {
        channels: |c, s, t, _, _| {
            // The motion goes to and fro 2.2 times in 0.4 s.
            let m = 1.0 + 0.004 * (2.0 * TAU * 5.5 * t).cos();
            (c * m, s * m)
        },
        ..PLAIN
    };
    let found = diagnosed_of(&swung, 20_000).expect("an ellipse");
    let named = names(&found);
    assert!(!named.contains(&Cause::AmplitudeRipple), "{named:?}");
    assert!(found.unexplained.significant || !named.is_empty());
}
