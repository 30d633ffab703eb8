//! Where a recording holds no signal.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, diagnose};
use nonius_recording::{Overrides, Recording};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use crate::harness::{PLAIN, damaged, names, shows};

/// Rows of zeros hold no signal: a logger shows them before its ADC has begun, after it has ended, and while its link is down.
/// They are left out, the notes say how many, and neither they nor the samples beside them are a cause.
#[test]
fn rows_of_zeros_hold_no_signal() {
    let last = 19_999;
    for zeros in [
        0..1,
        0..5,
        0..400,
        last..last + 1,
        last - 300..last + 1,
        9000..9002,
        9000..9300,
    ] {
        let found = damaged(&PLAIN, |rows| {
            for row in &mut rows[zeros.clone()] {
                (row[1], row[2]) = (0.0, 0.0);
            }
        });
        let left = &found.unexplained;
        assert!(names(&found).is_empty(), "{zeros:?}: {:?}", names(&found));
        assert!(!left.significant, "{zeros:?}: {}", left.signature);
        let said = format!("{} row", zeros.len());
        assert!(
            found.notes.iter().any(|n| n.starts_with(&said)),
            "{:?}",
            found.notes
        );
    }
}

/// A glitch leaves out itself and its neighbours, not the rows without signal that were left out before it.
#[test]
fn a_glitch_beside_rows_of_zeros_counts_its_own_samples() {
    let found = damaged(&PLAIN, |rows| {
        for row in &mut rows[..400] {
            (row[1], row[2]) = (0.0, 0.0);
        }
        rows[9000][1] += 0.2;
    });
    assert_eq!(names(&found), [Cause::Glitches]);
    assert_eq!(found.findings[0].gain.repaired_samples, Some(3));
}

/// A single row of zeros within a recording is a sample that is far off like any other.
#[test]
fn a_single_row_of_zeros_is_a_glitch() {
    shows(Cause::Glitches, |rows| {
        (rows[9000][1], rows[9000][2]) = (0.0, 0.0)
    });
}

/// An axis that swings by up to a fifth of a period per sample, and a link that is down for up to so many rows every now and then. Periods
/// pass meanwhile, and none is lost; a harmonic beside it has its name, and positions are as good as elsewhere.
fn periods_pass(longest: usize, apart: usize, worst: f64) {
    const COUNT: usize = 20_000;
    let angle = |k: usize| 40.0 * TAU * (TAU * 24.0 * k as f64 / 50e3).sin() + 1.0;
    let mut random = StdRng::seed_from_u64(7);
    let [mut time, mut cos, mut sin] = [vec![], vec![], vec![]];
    let mut down = 0..0;
    for k in 0..COUNT {
        if k > down.end {
            let from = k + 1 + random.random_range(0..2 * apart);
            down = from..from + random.random_range(1..=longest);
        }
        let a = angle(k);
        let mut seen = |value: f64| -> f64 {
            let noise: f64 = StandardNormal.sample(&mut random);
            if down.contains(&k) {
                0.0
            } else {
                value + 1e-3 * noise
            }
        };
        time.push(k as f64 / 50e3);
        cos.push(seen(0.02 + a.cos() + 0.02 * (2.0 * a + 1.0).cos()));
        sin.push(seen(0.9 * (a + 0.03).sin() - 0.03));
    }
    let recording = Recording::from_samples(time, cos, sin, &Overrides::default());
    let found = diagnose(&recording.expect("a recording")).expect("an ellipse");
    let named = names(&found);
    assert!(named.contains(&Cause::SpatialHarmonic), "{named:?}");
    let off = found.positions.iter().enumerate();
    let off: Vec<f64> = off.map(|(k, p)| p * TAU - angle(k)).collect();
    let mean = off.iter().sum::<f64>() / COUNT as f64;
    let farthest = off
        .iter()
        .fold(0.0, |most: f64, off| most.max((off - mean).abs()));
    assert!(farthest < worst, "{farthest} {named:?}");
}

#[test]
fn periods_pass_while_there_is_no_signal() {
    // Noise alone is 5 mrad off now and then.
    periods_pass(8, 60, 0.01);
    periods_pass(40, 800, 0.04);
}
