//! Causes in the data: samples that are off, lost or doubled, and noise with the signal.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, diagnose};
use nonius_recording::{Overrides, Recording};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::harness::{
    Case, LSB, NOISE, PLAIN, Rows, damaged, farthest, finds, finds_nothing, names, near, shows,
    shows_in,
};

/// Four times as noisy.
const NOISY: Case = Case {
    noise: |_, _, _, n| 4.0 * NOISE * n[0],
    ..PLAIN
};

/// How far the scale moves from sample to sample, radians.
fn moves(rows: &Rows, k: usize) -> f64 {
    (rows[k + 1][3] - rows[k - 1][3]).abs() / 2.0
}

/// No gap in time tells what was lost or put in.
fn at_even_times(rows: &mut Rows) {
    for (k, row) in rows.iter_mut().enumerate() {
        row[0] = k as f64 / 50e3;
    }
}

#[test]
fn samples() {
    shows(Cause::Glitches, |rows| {
        for k in [500, 4321, 9000, 15_000] {
            rows[k][1] += 0.2;
        }
    });
    shows(Cause::DroppedSamples, |rows| {
        for k in [15_000, 9000, 4321, 500] {
            rows.remove(k);
        }
    });
    shows(Cause::RepeatedSamples, |rows| {
        for k in [500, 4321, 9000, 12_000, 15_000, 17_000] {
            let before = rows[k - 1];
            rows[k][1] = before[1];
            rows[k][2] = before[2];
        }
    });
}

/// A logger that takes a sample an hour: no frequency of the mains is within its spectrum.
#[test]
fn a_sample_an_hour() {
    let found = damaged(&PLAIN, |rows| {
        rows.iter_mut().for_each(|row| row[0] *= 3600.0 * 50e3);
    });
    assert_eq!(names(&found), []);
}

/// No other sample is near it in value: how large noise is there, only its neighbours can tell.
#[test]
fn a_glitch_beyond_every_other_value() {
    shows(Cause::Glitches, |rows| {
        let lowest = (10..rows.len() - 10).min_by(|a, b| rows[*a][2].total_cmp(&rows[*b][2]));
        rows[lowest.expect("samples")][2] -= 0.15;
    });
}

/// A longer curve through the neighbours holds less noise than the sample itself.
#[test]
fn a_glitch_of_eight_standard_deviations() {
    for k in [4321, 12_345] {
        for sense in [1.0, -1.0] {
            // Of an amplitude of about 0.8.
            shows(Cause::Glitches, |rows| {
                rows[k][1] += sense * 8.0 * 0.8 * NOISE
            });
        }
    }
}

/// A sample that is off and a filter behind it: the next swings back by four tenths, and both together are half a step.
#[test]
fn a_glitch_that_rings() {
    for sense in [1.0, -1.0] {
        shows(Cause::Glitches, |rows| {
            for k in [2523, 8613, 14_766] {
                rows[k][1] += sense * 0.02;
                rows[k + 1][1] -= sense * 0.008;
            }
        });
    }
}

/// Every sample on the codes of a converter with steps of so many, one bit of which never changes.
pub(crate) fn on_steps(rows: &mut Rows, step: i64, stuck: Option<u32>) {
    for v in rows.iter_mut().flat_map(|row| &mut row[1..3]) {
        let code = (*v / LSB).round() as i64 + (1 << 13);
        let code = code.div_euclid(step) * step;
        let code = stuck.map_or(code, |bit| code & !(1 << bit));
        *v = (code - (1 << 13)) as f64 * LSB;
    }
}

/// What a converter does wrong may be two things, and a few codes that are off by themselves hide neither.
#[test]
fn coarse_steps_a_stuck_bit_and_stray_codes() {
    let both = damaged(&PLAIN, |rows| on_steps(rows, 8, Some(5)));
    let (steps, bit) = (Cause::CoarseQuantisation, Cause::StuckBit);
    assert_eq!(names(&both)[..4], [steps, bit, steps, bit]);
    let stray = damaged(&PLAIN, |rows| {
        on_steps(rows, 16, None);
        for k in [700, 5011, 12_345] {
            rows[k][2] += 5.0 * LSB;
        }
    });
    assert_eq!(names(&stray), [steps, steps]);
}

/// Even where the scale moves by little more than the noise from sample to sample: chance hardly brings both codes back.
#[test]
fn samples_repeated_in_noise() {
    shows_in(&NOISY, Cause::RepeatedSamples, |rows| {
        // Where it moves by six times the noise, not by more.
        let fast: Vec<usize> = (1000..19_000)
            .step_by(700)
            .filter(|k| (0.025..0.03).contains(&moves(rows, *k)))
            .collect();
        assert!(fast.len() > 2);
        for k in fast {
            let before = rows[k - 1];
            rows[k][1] = before[1];
            rows[k][2] = before[2];
        }
    });
}

/// The same of samples that were put in, which make all that follows late.
#[test]
fn samples_put_in_in_noise() {
    shows_in(&NOISY, Cause::RepeatedSamples, |rows| {
        put_in(rows, 0.025..0.03, 700)
    });
}

/// Puts rows in where the scale moves by so much, at such places at least so many samples apart.
fn put_in(rows: &mut Rows, moving: std::ops::Range<f64>, apart: usize) {
    let mut places: Vec<usize> = (1000..19_000)
        .step_by(apart)
        .filter(|k| moving.contains(&moves(rows, *k)))
        .collect();
    assert!(places.len() > 2);
    while let Some(k) = places.pop() {
        let again = rows[k - 1];
        rows.insert(k, again);
    }
    at_even_times(rows);
}

/// Where noise could have brought the codes back, the angle tells: from there on it is late by what it moves in a sample.
#[test]
fn samples_put_in_that_the_angle_shows() {
    shows_in(&NOISY, Cause::RepeatedSamples, |rows| {
        put_in(rows, 0.008..0.02, 700)
    });
}

/// The same by a small part of the noise.
fn put_in_slowly(rows: &mut Rows) {
    put_in(rows, 0.0..0.001, 20);
}

/// Where the angle does not tell either, the reference does: it hardly ever repeats itself without them.
#[test]
fn samples_put_in_that_a_reference_shows() {
    assert_eq!(names(&damaged(&NOISY, put_in_slowly)), []);
    let with_reference = Case {
        reference: true,
        ..NOISY
    };
    shows_in(&with_reference, Cause::RepeatedSamples, put_in_slowly);
}

/// A lost sample makes a step, and its edge lies as far off the curve through its neighbours as a glitch does.
#[test]
fn a_lost_sample_is_no_glitch() {
    let noisy = Case {
        noise: |_, _, _, n| 1.5 * NOISE * n[0],
        ..PLAIN
    };
    shows_in(&noisy, Cause::DroppedSamples, |rows| {
        let mut fast: Vec<usize> = (1000..19_000)
            .step_by(300)
            .filter(|k| (0.025..0.035).contains(&moves(rows, *k)))
            .collect();
        assert!(fast.len() > 5);
        while let Some(k) = fast.pop() {
            rows.remove(k);
        }
        at_even_times(rows);
    });
}

/// A single one that was put in where the axis turns back: its speed is late there, and a corner of just that size is none of the
/// drive's.
#[test]
fn a_sample_put_in_where_the_axis_turns_back() {
    shows_in(&PLAIN, Cause::RepeatedSamples, |rows| {
        let inside = 2000..rows.len() - 2000;
        let turns = inside.min_by(|a, b| moves(rows, *a).total_cmp(&moves(rows, *b)));
        let turns = turns.expect("samples");
        rows.insert(turns, rows[turns - 1]);
        at_even_times(rows);
    });
}

/// A single one, where the scale hardly moves from sample to sample: only long curves on either side show that all is late.
#[test]
fn a_sample_lost_on_a_slow_axis() {
    let found = damaged(&PLAIN, |rows| {
        let slow = |k: &usize| (moves(rows, *k) - 1.7 * NOISE).abs();
        let inside = 1000..rows.len() - 1000;
        let lost = inside.min_by(|a, b| slow(a).total_cmp(&slow(b)));
        rows.remove(lost.expect("samples"));
        at_even_times(rows);
    });
    assert_eq!(names(&found), [Cause::DroppedSamples]);
    let count = found.findings[0].parameter("count");
    assert_eq!(count, Some(1.0), "{}", found.findings[0].evidence);
}

/// A sample that is lost from sensor and reference alike, where the sensor's noise alone would hide it.
fn lost_in_noise(rows: &mut Rows) {
    let slow = (5000..15_000).find(|k| (0.0019..0.0022).contains(&moves(rows, *k)));
    rows.remove(slow.expect("a place where it moves by less than the noise"));
    at_even_times(rows);
}

#[test]
fn a_lost_sample_that_a_reference_shows() {
    assert_eq!(names(&damaged(&NOISY, lost_in_noise)), []);
    let with_reference = Case {
        reference: true,
        ..NOISY
    };
    shows_in(&with_reference, Cause::DroppedSamples, lost_in_noise);
}

/// Angle of a drive that goes to and fro at an even speed, speeding up and slowing down evenly in between.
fn ramps(t: f64) -> f64 {
    const TURN: f64 = 0.1;
    const RAMP: f64 = 0.00804;
    const SPEED: f64 = 2500.0;
    let after = |corner: f64| 0.5 * SPEED / RAMP * (t - corner).max(0.0).powi(2);
    let turn = |k: i32| {
        let at = TURN * f64::from(k);
        let sense = if k % 2 == 0 { 1.0 } else { -1.0 };
        sense * (after(at - RAMP) - after(at + RAMP))
    };
    after(0.0) - after(RAMP) + (1..=4).map(turn).sum::<f64>()
}

/// Where the acceleration is another at once, no sample is lost; one that is lost there is found.
#[test]
fn corners_of_a_drive_are_no_lost_samples() {
    let cornered = Case {
        motion: |t, smooth| ramps(t) - smooth,
        ..PLAIN
    };
    for seed in 0..3 {
        finds_nothing(&cornered, seed);
    }
    shows_in(&cornered, Cause::DroppedSamples, |rows| {
        rows.remove(17_000);
        rows.remove(15_402);
        at_even_times(rows);
    });
}

/// What jumps in the reference alone is no sample that was lost.
#[test]
fn a_reference_that_jumps_alone() {
    let with_reference = Case {
        reference: true,
        ..PLAIN
    };
    let found = damaged(&with_reference, |rows| {
        let moves = rows[9000][3] - rows[8999][3];
        rows[9000..].iter_mut().for_each(|row| row[3] += moves);
    });
    let names = names(&found);
    assert!(!names.contains(&Cause::DroppedSamples), "{names:?}");
}

#[test]
fn noise_with_the_signal() {
    let found = finds(
        Cause::AmplitudeNoise,
        &Case {
            noise: |u, _, _, n| NOISE * n[0] + 0.002 * u * n[1],
            ..PLAIN
        },
    );
    near(&found, "rms", 0.002);
}

/// More samples are off than are left out, a few per cent of one channel: no noise that goes with the signal, and something is left.
#[test]
fn many_wild_samples_are_no_noise() {
    for (every, size) in [(20, 0.45), (10, 0.15)] {
        let found = damaged(&PLAIN, |rows| {
            let mut random = StdRng::seed_from_u64(5);
            for row in rows.iter_mut() {
                if random.random_ratio(1, every) {
                    row[1] += if random.random() { size } else { -size };
                }
            }
        });
        let named = names(&found);
        let left = &found.unexplained;
        assert!(!named.contains(&Cause::AmplitudeNoise), "{named:?}");
        assert!(left.significant, "{named:?} {}", left.signature);
        let said = "glitches, but they are too many to be left out";
        assert!(left.signature.contains(said), "{}", left.signature);
    }
}

/// Where the axis turns round a code comes again by chance. A wild sample before it is no motion, so none was put in; and the positions go
/// straight on where samples are wild.
#[test]
fn a_wild_sample_beside_one_that_comes_again() {
    let mut rows_then = vec![];
    let found = damaged(&PLAIN, |rows| {
        let turns = |k: &usize| {
            let [before, now, after] = [k - 1, *k, k + 1].map(|k| rows[k][3]);
            (now - before) * (after - now) <= 0.0
        };
        let turning: Vec<usize> = (100..rows.len() - 100).filter(turns).collect();
        assert!(!turning.is_empty());
        rows_then.clone_from(rows);
        for k in turning {
            let [_, c, s, _] = rows[k - 1];
            (rows[k][1], rows[k][2]) = (c, s);
            rows[k - 2][1] += 0.25;
        }
        for k in (500..rows.len() - 500).step_by(1000) {
            rows[k][2] -= 0.3;
        }
    });
    assert_eq!(
        names(&found),
        [Cause::Glitches],
        "{}",
        found.unexplained.signature
    );
    let (most, rms) = farthest(&found, &rows_then);
    assert!(most < 6.0 * NOISE && rms < 1.1 * NOISE, "{most} {rms}");
}

/// A channel with codes a tenth of the other's, or so: what is thirty of them off is a glitch, be it three of the other's.
#[test]
fn a_glitch_is_told_by_the_codes_of_its_own_channel() {
    let mut random = StdRng::seed_from_u64(5);
    let mut channel = |code: f64, quarter: f64| {
        let value = |k: u32| {
            let noise: f64 = StandardNormal.sample(&mut random);
            let turns = f64::from(k) / 97.3 - quarter;
            code * (500.0 * (TAU * turns).cos() + 0.5 * noise).round()
        };
        (0..8000).map(value).collect::<Vec<f64>>()
    };
    let (cos, mut sin) = (channel(0.0104, 0.0), channel(0.001, 0.25));
    sin[2345] += 0.03;
    let time = (0..8000).map(|k| f64::from(k) * 1e-4).collect();
    let recording = Recording::from_samples(time, cos, sin, &Overrides::default());
    let found = diagnose(&recording.expect("a recording")).expect("an ellipse");
    assert_eq!(names(&found), [Cause::Glitches]);
}
