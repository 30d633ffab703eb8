//! Static causes of each channel.

use std::f64::consts::FRAC_PI_2;

use nonius_diagnosis::Cause;

use crate::harness::{
    Case, LSB, PLAIN, alone, damaged, evenly, finds, names, near, of_cause, shows, within_errors,
};

#[test]
fn bends_and_harmonics() {
    let found = finds(
        Cause::EvenNonlinearity,
        &Case {
            channels: |c, s, _, _, _| (c + 0.003 * c * c, s + 0.002 * s * s),
            ..PLAIN
        },
    );
    near(&found, "k_cos", 0.003);
    near(&found, "k_sin", 0.002);
    let found = finds(
        Cause::OddNonlinearity,
        &Case {
            channels: |c, s, _, _, _| (c + 0.004 * c.powi(3), s - 0.003 * s.powi(3)),
            ..PLAIN
        },
    );
    near(&found, "k_cos", 0.004);
    let found = finds(
        Cause::SpatialHarmonic,
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
}

/// Every order of the catalogue, of any phase.
#[test]
fn harmonics_of_every_order() {
    type Channels = fn(f64, f64, f64, f64, f64) -> (f64, f64);
    fn of<const ORDER: u32>(c: f64, s: f64, _: f64, a: f64, _: f64) -> (f64, f64) {
        let turned = f64::from(ORDER) * a;
        (
            c + 0.002 * (turned + 1.0).cos(),
            s + 0.003 * (turned - 0.4).sin(),
        )
    }
    let orders: [(f64, Channels); 6] = [
        (2.0, of::<2>),
        (3.0, of::<3>),
        (4.0, of::<4>),
        (5.0, of::<5>),
        (6.0, of::<6>),
        (7.0, of::<7>),
    ];
    for (order, channels) in orders {
        let found = finds(Cause::SpatialHarmonic, &Case { channels, ..PLAIN });
        assert_eq!(found.findings[0].parameter("order"), Some(order));
        near(&found, "amplitude_cos", 0.002);
        near(&found, "amplitude_sin", 0.003);
    }
}

/// A strong harmonic whose phase is nearly a bend's is no bend: what that leaves of it is far beyond chance.
#[test]
fn a_harmonic_beside_a_bend_is_a_harmonic() {
    let found = finds(
        Cause::SpatialHarmonic,
        &Case {
            channels: |c, s, _, a, _| {
                let third = |phase: f64| 0.0015 * (3.0 * a + phase).cos();
                (c + third(0.07), s + third(0.07 + FRAC_PI_2))
            },
            ..PLAIN
        },
    );
    near(&found, "amplitude_cos", 0.0015);
}

/// At a speed that does not change, orders two and four of the scale period have the frequencies of a line and of its harmonic: they are
/// never that alone.
#[test]
fn harmonics_at_one_speed_are_not_only_a_line() {
    let found = evenly(
        &Case {
            channels: |c, s, _, a, _| {
                let both = 0.002 * (2.0 * a + 0.3).cos() + 0.001 * (4.0 * a + 1.0).cos();
                (c + both, s)
            },
            ..PLAIN
        },
        400.3,
        1,
    );
    assert!(!found.findings.is_empty());
    for one in &found.findings {
        let mut group = one.confounded_with.iter().chain([&one.cause]);
        let harmonic = group.any(|name| *name == Cause::SpatialHarmonic);
        assert!(harmonic, "{:?}", names(&found));
    }
}

#[test]
fn rails_and_codes() {
    finds(
        Cause::Saturation,
        &Case {
            channels: |c, s, _, _, _| {
                (c - 0.05 * (c - 0.8).max(0.0), s - 0.05 * (s - 0.8).max(0.0))
            },
            ..PLAIN
        },
    );
    finds(
        Cause::AdcNonlinearity,
        &Case {
            channels: |c, s, _, _, _| (c + 0.0005 * (c + 0.02).signum(), s),
            ..PLAIN
        },
    );
    shows(Cause::StuckBit, |rows| {
        for row in rows {
            let code = (row[1] / LSB).round() as i64 + 8192;
            row[1] = ((code & !8) - 8192) as f64 * LSB;
        }
    });
    shows(Cause::CoarseQuantisation, |rows| {
        for row in rows {
            row[1] = (row[1] / LSB / 16.0).round() * 16.0 * LSB;
        }
    });
}

/// Steps of the codes stand in every angle, but hardly in its low orders: a bend beside them keeps its name.
#[test]
fn a_bend_beside_coarse_steps() {
    let bent = Case {
        channels: |c, s, _, _, _| (c + 0.004 * c * c, s),
        ..PLAIN
    };
    let found = damaged(&bent, |rows| {
        for row in rows {
            row[1] = (row[1] / LSB / 32.0).round() * 32.0 * LSB;
        }
    });
    let left = &found.unexplained.signature;
    assert_eq!(
        names(&found),
        [Cause::CoarseQuantisation, Cause::EvenNonlinearity],
        "{left}"
    );
}

#[test]
fn large() {
    let found = alone(
        Cause::SpatialHarmonic,
        &Case {
            channels: |c, s, _, a, _| {
                (c + 0.05 * (3.0 * a + 0.4).cos(), s + 0.04 * (3.0 * a).sin())
            },
            ..PLAIN
        },
    );
    within_errors(&found, "amplitude_cos", 0.05);
    within_errors(&found, "amplitude_sin", 0.04);
    let found = alone(
        Cause::EvenNonlinearity,
        &Case {
            channels: |c, s, _, _, _| (c + 0.05 * c * c, s - 0.04 * s * s),
            ..PLAIN
        },
    );
    within_errors(&found, "k_cos", 0.05);
    let found = alone(
        Cause::OddNonlinearity,
        &Case {
            channels: |c, s, _, _, _| (c - 0.06 * c.powi(3), s - 0.05 * s.powi(3)),
            ..PLAIN
        },
    );
    within_errors(&found, "k_sin", -0.05);
    let found = alone(
        Cause::Saturation,
        &Case {
            channels: |c, s, _, _, _| {
                let pressed = |v: f64| v - 0.3 * (v - 0.77).max(0.0);
                (pressed(c), pressed(s))
            },
            ..PLAIN
        },
    );
    within_errors(&found, "threshold", 0.77);
}

/// Motion of its own at each sample, 20 mrad rms: nothing is seen along the circle.
fn shaken(t: f64, _: f64) -> f64 {
    let sample = (t * 50e3).round() as i64 as u64;
    let mixed = sample.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    0.07 * ((mixed >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
}

/// A third harmonic that turns backwards does to the radius what a fifth does that turns forwards: the motion tells them, and where it
/// hides both, either order is said.
#[test]
fn an_order_that_may_be_another() {
    let backwards = Case {
        channels: |c, s, _, a, _| {
            let third = 3.0 * a + 1.2;
            (c + 4e-4 * third.cos(), s - 4e-4 * third.sin())
        },
        ..PLAIN
    };
    let seen = finds(Cause::SpatialHarmonic, &backwards);
    assert_eq!(seen.findings[0].parameter("order"), Some(3.0));
    assert_eq!(seen.findings[0].parameter("other_order"), None);
    let hidden = Case {
        motion: shaken,
        ..backwards
    };
    let hidden = finds(Cause::SpatialHarmonic, &hidden);
    let finding = &hidden.findings[0];
    let mut orders = ["order", "other_order"].map(|name| finding.parameter(name));
    orders.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    assert_eq!(orders, [Some(3.0), Some(5.0)], "{}", finding.evidence);
    assert!(
        finding.evidence.contains("explains it as well"),
        "{}",
        finding.evidence
    );
}

/// One rail of one channel, far above the noise: the other rails have nothing.
#[test]
fn one_rail_of_one_channel() {
    let found = finds(
        Cause::Saturation,
        &Case {
            channels: |c, s, _, _, _| (c, s + 0.3 * (-s - 0.874).max(0.0)),
            ..PLAIN
        },
    );
    of_cause(&found, Cause::Saturation, "threshold", 0.874);
    of_cause(&found, Cause::Saturation, "compression_sin_lower", 0.3);
    of_cause(&found, Cause::Saturation, "compression_sin_upper", 0.0);
}
