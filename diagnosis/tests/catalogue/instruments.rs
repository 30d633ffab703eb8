//! Recordings as instruments and axes of other kinds make them: an oscilloscope that does not say how many bits it has, a counter as
//! reference, few samples a period, a mirror that stays within a period, an axis that stands on one code.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, Chip, Finding, OTHER_ORDER, diagnose, sensor_toml};
use nonius_kept::every;
use nonius_recording::{Overrides, Recording};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::harness::names;
use crate::instrument::{Damage, Instrument, LENGTH, PLAIN, RATE, SAMPLES, off, swept};

/// Moves from place to place, with rests between.
fn served(t: f64) -> f64 {
    const PLACES: [f64; 6] = [0.0, 4.3, 7.0, 1.6, 5.2, 11.7];
    let x = t / LENGTH * PLACES.len() as f64;
    let (k, x) = ((x as usize).min(PLACES.len() - 1), x.fract());
    let from = PLACES[k.saturating_sub(1)];
    let x = (x / 0.4).min(1.0);
    TAU * (from + (PLACES[k] - from) * x * x * x * (10.0 - 15.0 * x + 6.0 * x * x))
}

/// To and fro over 6 periods, and shakes by 2 mrad up to 300 Hz, as a servo does.
fn shaken(t: f64) -> f64 {
    let shake = (1..=24).map(|i| {
        let hertz = 12.7 * f64::from(i);
        6e-4 * (TAU * hertz * t + f64::from(i * i) * 1.7).sin()
    });
    6.0 * TAU * (TAU * 0.9 * t / LENGTH).sin() + shake.sum::<f64>()
}

/// Eight bits of which noise moves a tenth, in volts, with nothing said about them: what their codes err is no error of the sensor.
#[test]
fn an_oscilloscope_of_eight_bits() {
    for axis in [swept, |t: f64| 40.0 * TAU * t / LENGTH] {
        let scope = Instrument {
            axis,
            noise: 0.0012,
            bits: 8,
            unit: 0.04,
            ..PLAIN
        };
        scope.shows(&[]);
        scope.bent();
    }
}

/// A bit that never changes is one in codes of which nothing is said, too.
#[test]
fn a_stuck_bit_of_an_adc_that_is_not_described() {
    let stuck = Instrument {
        damage: |_, [c, s]| [c & !(1 << 6), s],
        ..PLAIN
    };
    stuck.shows(&[Cause::StuckBit]);
    // What is left is not white, and nobody says that it is noise alone.
    let left = stuck.diagnosed(0).unexplained.signature;
    assert!(left.ends_with("what codes that err leave"), "{left}");
}

/// What a counter rounds is no error of the sensor.
#[test]
fn a_counter_as_reference() {
    for counts in [256.0, 1024.0, 4096.0] {
        for axis in [swept, served] {
            let counted = Instrument {
                axis,
                counts: Some(counts),
                header: "# adc_bits: 14\n# full_scale: 8192\n",
                ..PLAIN
            };
            counted.shows(&[]);
            let found = counted.bent();
            let told = found.notes.iter().any(|n| n.contains("moves in steps of"));
            assert!(told, "{counts}: {:?}", found.notes);
        }
    }
}

/// Samples that are off are found at four and five samples a period and where an axis slows down from there, each of them.
#[test]
fn glitches_of_a_fast_axis() {
    const OFF: [usize; 6] = [700, 3001, 6500, 8123, 11_900, 15_000];
    let axes: [fn(f64) -> f64; 3] = [
        |t| TAU * (RATE / 5.3) * t,
        |t| TAU * (RATE / 4.3) * t * t / (2.0 * LENGTH),
        |t| RATE / 5.0 * LENGTH * (TAU * t / LENGTH).sin(),
    ];
    for axis in axes {
        let fast = Instrument {
            axis,
            damage: |k, [c, s]| [c + if OFF.contains(&k) { 260 } else { 0 }, s],
            ..PLAIN
        };
        fast.shows(&[Cause::Glitches]);
        let found = fast.diagnosed(1);
        let share = found.findings[0].parameters[0].value;
        assert!((share * SAMPLES as f64 - OFF.len() as f64).abs() < 1e-9);
    }
}

/// A mirror that trembles within a third of a period: within one, the angle is a function of its place in the period, and is motion all
/// the same.
#[test]
fn a_mirror_within_a_period() {
    let mirror = Instrument {
        axis: |t| {
            let waves = [(0.5, 310.0, 0.0), (0.3, 457.0, 1.0), (0.25, 633.0, 2.0)];
            waves
                .iter()
                .map(|(a, f, p)| a * (TAU * f * t + p).sin())
                .sum()
        },
        ..PLAIN
    };
    for seed in every(3, 0..3) {
        let found = mirror.diagnosed(seed);
        let residual = found.extended.residual_rms;
        assert!(residual < 1.1 * mirror.noise, "{residual}");
        let sensor = |f: &&nonius_diagnosis::Finding| f.cause != Cause::Vibration;
        assert_eq!(
            found.findings.iter().filter(sensor).count(),
            0,
            "{:?}",
            names(&found)
        );
    }
}

/// A step motor that moves on once a period, over twelve of them: beside offsets, that is a second harmonic that draws a circle, which
/// none of a sensor does. The bend of the channels is what its radius shows.
#[test]
fn a_step_motor_bends_no_sensor() {
    const BEND: f64 = 0.004;
    let stepping = Instrument {
        axis: |t| {
            let x = 12.0 * TAU * (t / LENGTH) * (0.6 + 0.4 * t / LENGTH);
            x - 0.35 * x.sin()
        },
        error: |alpha| [0.0, BEND * alpha.sin().powi(2)],
        noise: 1.5e-3,
        ..PLAIN
    };
    for seed in every(3, 0..3) {
        let found = stepping.diagnosed(seed);
        let left = &found.unexplained.signature;
        assert_eq!(names(&found), [Cause::EvenNonlinearity], "{seed}: {left}");
        assert!(!found.unexplained.significant, "{seed}: {left}");
        crate::harness::near(&found, "k_sin", BEND);
    }
}

/// An axis that rests on one code after the other: their error goes on for long, and is no slow noise.
#[test]
fn an_axis_that_rests_on_a_code() {
    let resting = Instrument {
        axis: served,
        noise: 2e-4,
        bits: 10,
        header: "# adc_bits: 10\n# full_scale: 512\n",
        ..PLAIN
    };
    resting.shows(&[]);
    resting.bent();
}

/// What a third harmonic does to the radius of a slow axis that shakes, a fifth does that turns the other way, and what either does along the
/// circle the axis may do: the order is not sure, the chip corrects nothing, and positions are those of the ellipse.
#[test]
fn a_harmonic_whose_order_the_motion_hides_moves_no_position() {
    let harmonics: [fn(f64) -> [f64; 2]; 3] = [
        |a| {
            [
                0.0065 * (3.0 * a - 0.66).cos(),
                0.0104 * (3.0 * a - 2.46).cos(),
            ]
        },
        |a| {
            [
                0.0097 * (3.0 * a - 2.03).cos(),
                0.0110 * (3.0 * a - 2.03).cos(),
            ]
        },
        |a| {
            [
                0.0067 * (3.0 * a - 0.88).cos(),
                0.0071 * (3.0 * a - 2.30).cos(),
            ]
        },
    ];
    for error in harmonics {
        let instrument = Instrument {
            axis: shaken,
            error,
            ..PLAIN
        };
        let recording = instrument.recorded(5);
        let found = instrument.diagnosed_of(&recording);
        let [own, by_ellipse] = instrument.position_errors(&recording, &found);
        let sure = |f: &Finding| f.chip == Chip::Corrects && f.parameter(OTHER_ORDER).is_none();
        assert!(!found.findings.iter().any(sure), "{:?}", names(&found));
        assert!(
            own < 1.1 * by_ellipse,
            "{own} of {by_ellipse}: {:?}",
            names(&found)
        );
    }
}

/// At a speed that stays as it is, a reference that is as fine as can be is equally far further with each sample: no counter.
#[test]
fn a_reference_at_constant_speed_is_no_counter() {
    let steady = Instrument {
        axis: |t| 171.3 * TAU * t,
        counts: Some(1e8),
        ..PLAIN
    };
    let found = steady.diagnosed(3);
    let counts = |note: &String| note.contains("moves in steps");
    assert!(!found.notes.iter().any(counts), "{:?}", found.notes);
    // One that stands most of the time is one.
    let slow = Instrument {
        axis: |t| 0.4 * TAU * t,
        counts: Some(400.0),
        ..PLAIN
    };
    let found = slow.diagnosed(3);
    assert!(found.notes.iter().any(counts), "{:?}", found.notes);
}

/// What codes lose on the average is in the offset of the fit; the simulated converter loses it again, so its sensor has it not.
#[test]
fn codes_that_err_do_not_move_the_offset_of_the_sensor() {
    let damages: [(Cause, Damage); 3] = [
        (Cause::StuckBit, |_, [c, s]| [c & !8, s]),
        (Cause::StuckBit, |_, [c, s]| [c | 8, s]),
        (Cause::CoarseQuantisation, |_, [c, s]| {
            [c.div_euclid(16) * 16, s]
        }),
    ];
    for (cause, damage) in damages {
        let instrument = Instrument {
            damage,
            header: "# adc_bits: 14\n# full_scale: 8192\n",
            ..PLAIN
        };
        let recording = instrument.recorded(4);
        let found = instrument.diagnosed_of(&recording);
        assert!(names(&found).contains(&cause), "{:?}", names(&found));
        let text = sensor_toml(&found, &recording);
        let value = |line: &str| {
            line.split(['=', '#'])
                .nth(1)
                .and_then(|v| v.trim().parse::<f64>().ok())
        };
        let offset = text.lines().find(|l| l.starts_with("b_c ")).and_then(value);
        let (offset, truth) = (offset.expect("an offset"), 0.02 * 8192.0);
        assert!(
            (offset - truth).abs() < 0.7,
            "{cause:?}: {offset} of {truth}"
        );
    }
}

/// A ninth harmonic is beyond the catalogue. What it does along the circle is no cogging of the axis at eight times the scale period.
#[test]
fn a_harmonic_beyond_the_catalogue_is_no_motion() {
    let ninth = Instrument {
        error: |a| [0.006 * (9.0 * a + 0.7).cos(), 0.005 * (9.0 * a - 1.9).cos()],
        header: "# periods_per_revolution: 16\n",
        ..PLAIN
    };
    let found = ninth.diagnosed(6);
    assert_eq!(names(&found), []);
    assert!(found.unexplained.significant);
    let signature = &found.unexplained.signature;
    assert!(
        signature.contains("repeats with the scale period"),
        "{signature}"
    );
}

/// Of channels that are clipped for a fourth of each period a harmonic has its own order, and each rail stands where the offset and the
/// amplitude beside that harmonic put it.
#[test]
fn a_harmonic_beside_clipped_channels() {
    let clipped = Instrument {
        error: |a| [0.02 * (2.0 * a + 0.7).cos(), 0.02 * (2.0 * a - 1.3).cos()],
        damage: |_, [c, s]| [c.min(4800), s.max(-4700)],
        ..PLAIN
    };
    let recording = clipped.recorded(3);
    let found = clipped.diagnosed_of(&recording);
    let all = [Cause::Saturation, Cause::Saturation, Cause::SpatialHarmonic];
    let mut named = names(&found);
    named.sort_by_key(|name| all.iter().position(|one| one == name));
    assert_eq!(named, all);
    assert!(!found.unexplained.significant);
    let [ours, _] = clipped.position_errors(&recording, &found);
    assert!(ours < 1.4 * clipped.noise, "{ours}");
    let number = |f: &Finding, name: &str| f.parameter(name).expect("a number");
    for finding in &found.findings {
        if finding.cause == Cause::SpatialHarmonic {
            assert_eq!(number(finding, "order"), 2.0);
            let amplitude = number(finding, "amplitude_cos");
            assert!((amplitude - 0.02).abs() < 5e-4, "{amplitude}");
            continue;
        }
        let half = 8192.0;
        let (rail, middle, amplitude) = match number(finding, "compression_cos_upper") {
            1.0 => (4800.0, 0.02 * half, 0.8 * half),
            _ => (4700.0, 0.03 * half, 0.78 * half),
        };
        // The lower one is as far below.
        let expected = (rail - middle) / amplitude;
        let threshold = number(finding, "threshold");
        assert!(
            (threshold - expected).abs() < 1e-3,
            "{threshold} {expected}"
        );
    }
}

/// Over four periods a scale that a hand moves hardly tells a harmonic from motion along the circle. What is known of it to half of its size
/// moves no position: the third harmonic of a hundredth had a tenth.
#[test]
fn what_is_vague_moves_no_position() {
    // Speeds in periods over the whole recording, by waves of it.
    const WAVES: [(f64, f64); 4] = [
        (0.0415, 5.8691),
        (-0.673, 4.5209),
        (-0.1482, 1.8477),
        (-0.223, 5.4867),
    ];
    fn hand(t: f64) -> f64 {
        let wave = |((size, phase), k): (&(f64, f64), u8)| {
            let cycles = 0.7 * TAU * f64::from(k);
            size * (phase.cos() - (cycles * t / LENGTH + phase).cos()) / cycles
        };
        10.0 * TAU * WAVES.iter().zip(1..).map(wave).sum::<f64>()
    }
    const COUNT: usize = 5000;
    let angle = |k: usize| hand(LENGTH * k as f64 / COUNT as f64) + 1.2;
    let mut random = StdRng::seed_from_u64(3);
    let mut own = || -> f64 { StandardNormal.sample(&mut random) };
    let [mut time, mut cos, mut sin] = [vec![], vec![], vec![]];
    // The mean of sixteen sweeps of eight bits.
    let step = 3.2 / 256.0;
    let mut seen = |value: f64| {
        let code = |_| ((value + 0.006 * own()) / step).round() * step;
        (0..16).map(code).sum::<f64>() / 16.0
    };
    for k in 0..COUNT {
        let a = angle(k);
        let third = |a: f64| 0.01 * (3.0 * a + 3.943).cos();
        time.push(k as f64 * 1e-5);
        cos.push(seen(0.03 + a.cos() + third(a)));
        sin.push(seen(
            -0.02 + 0.95 * ((a + 0.05).sin() + third(a - 0.25 * TAU)),
        ));
    }
    let recording = Recording::from_samples(time, cos, sin, &Overrides::default());
    let found = diagnose(&recording.expect("a recording")).expect("an ellipse");
    let rms = off(&found.positions, angle);
    // The nearest ellipse leaves 7.2 mrad.
    assert!(rms < 0.009, "{rms} {:?}", names(&found));
}
