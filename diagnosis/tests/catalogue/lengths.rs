//! Recordings of any length: short ones, and those whose last block of samples is nearly empty.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, diagnose, unseen};
use nonius_kept::every;
use nonius_recording::{Overrides, Recording};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::harness::{PLAIN, diagnosed_of, names};

#[test]
fn every_length_is_diagnosed_or_refused() {
    // Blocks of 1024 samples, twenty parts of a recording, and a few samples more; every sixth but in the long form.
    let edges = (20_478..20_488).chain([20_500, 20_580, 40_980, 41_000]);
    let mut refused = vec![];
    for samples in every(6, (16..200).chain(edges)) {
        match diagnosed_of(&PLAIN, samples) {
            Ok(found) => assert_eq!(found.positions.len(), samples),
            Err(_) => refused.push(samples),
        }
    }
    // So few draw no ellipse.
    assert!(refused.iter().all(|samples| *samples < 40), "{refused:?}");
}

/// A plain sensor at an even speed, or nearly: scale periods, share of all its way by which it runs ahead and behind.
fn plain(samples: usize, periods: f64, ahead: f64, seed: u64) -> Recording {
    const RATE: f64 = 10e3;
    let mut random = StdRng::seed_from_u64(seed);
    let noise = 10f64.powf(random.random_range(-3.5..-2.3));
    let bits = [10, 12, 14, 16][random.random_range(0..4)];
    let (start, beta) = (
        random.random_range(0.0..TAU),
        random.random_range(-0.05..0.05),
    );
    let (gain, offset) = (
        random.random_range(0.9..1.1),
        random.random_range(-0.05..0.05),
    );
    let code = 2.0 / 2f64.powi(bits);
    let mut rounded = |value: f64, middle: f64| {
        let own: f64 = StandardNormal.sample(&mut random);
        let value = 0.8 * (value + noise * own) + middle;
        (value / code).round() * code
    };
    let pairs = (0..samples).map(|k| {
        let part = k as f64 / samples as f64;
        let alpha = start + TAU * periods * (part + ahead * (8.2 * part + start).sin());
        let cos = rounded(alpha.cos(), offset);
        (cos, rounded(gain * (alpha - beta).sin(), -offset))
    });
    let (cos, sin) = pairs.unzip();
    let time = (0..samples).map(|k| k as f64 / RATE).collect();
    let overrides = Overrides {
        adc_bits: Some(bits as u32),
        full_scale: Some(1.0),
        ..Overrides::default()
    };
    Recording::from_samples(time, cos, sin, &overrides).expect("a recording")
}

/// What five parameters and white noise explain has no name, however few samples there are and however little the scale moves: noise
/// that shapes have explained is no quieter, motion over a period or two is no harmonic, and where codes come again and again to few
/// places no bit is stuck. Of 200 recordings one may be named, and two said to hold something, as of long ones. Every eleventh; in the
/// long form all.
#[test]
fn a_short_recording_of_a_plain_sensor_has_nothing() {
    let kinds = [300, 1000, 3000].into_iter().flat_map(|samples| {
        let of = [1.3, 3.0, 12.0, 60.0].map(move |periods| (samples, periods));
        of.into_iter()
            .flat_map(|(n, p)| (0..120).map(move |seed| (n, p, seed)))
    });
    let (mut all, mut named, mut left) = (0, vec![], vec![]);
    for (samples, periods, seed) in every(11, kinds) {
        let ahead = [0.0, 0.002, 0.02][seed as usize % 3];
        let found = diagnose(&plain(samples, periods, ahead, seed)).expect("an ellipse");
        let which = format!("{samples} samples, {periods} periods, seed {seed}");
        all += 1;
        if let Some(first) = found.findings.first() {
            named.push(format!("{which}: {}", first.cause));
        }
        if found.unexplained.significant {
            left.push(format!("{which}: {}", found.unexplained.signature));
        }
    }
    assert!(named.len() <= all / 200 + 1, "of {all}: {named:#?}");
    assert!(left.len() <= all / 100 + 1, "of {all}: {left:#?}");
}

/// One period of clipped signals, as a table of a sensor's averaged readings is: what goes with the angle has a spectrum, and none of
/// its lines is one of time.
#[test]
fn within_a_period_nothing_is_a_line() {
    for (beyond, skew) in [(0.52, 0.0), (0.6, 0.05), (0.75, 0.1)] {
        let mut random = StdRng::seed_from_u64(4);
        let [mut time, mut cos, mut sin] = [vec![], vec![], vec![]];
        for k in 0..512 {
            let alpha = TAU * f64::from(k) / 512.0;
            let mut code = |u: f64| {
                let own: f64 = StandardNormal.sample(&mut random);
                let bent = u + skew * (2.0 * alpha).cos() + 0.02 * (9.0 * alpha).sin();
                (600.0 * bent.clamp(-beyond, beyond) + 0.5 * own).round()
            };
            cos.push(code(alpha.cos()));
            sin.push(code(alpha.sin()));
            time.push(f64::from(k) / 512.0);
        }
        let recording = Recording::from_samples(time, cos, sin, &Overrides::default());
        let found = diagnose(&recording.expect("a recording")).expect("an ellipse");
        let lines = [
            Cause::Interference,
            Cause::AmplitudeRipple,
            Cause::Vibration,
        ];
        let named = names(&found);
        assert!(!named.iter().any(|n| lines.contains(n)), "{named:?}");
        let left = &found.unexplained.signature;
        assert!(!left.contains("a fixed frequency"), "{left}");
    }
}

/// What double precision leaves of a calculated circle is no error of a sensor.
#[test]
fn the_rounding_of_calculated_numbers_is_nothing() {
    for swing in [0.0, 40.0] {
        let angle = |k: u32| {
            let t = f64::from(k) / 4000.0;
            swing * (TAU * t).sin() + if swing > 0.0 { 8.0 * t } else { 200.0 * t }
        };
        let time = (0..20_000).map(|k| f64::from(k) * 2e-5).collect();
        let cos = (0..20_000).map(|k| angle(k).cos()).collect();
        let sin = (0..20_000).map(|k| angle(k).sin()).collect();
        let recording = Recording::from_samples(time, cos, sin, &Overrides::default());
        let found = diagnose(&recording.expect("a recording")).expect("an ellipse");
        assert!(names(&found).is_empty(), "{:?}", names(&found));
        assert!(
            !found.unexplained.significant,
            "{}",
            found.unexplained.signature
        );
    }
}

/// Of fewer than 150 samples motion, five parameters and noise leave too little to tell a cause by: none is looked for, and that is
/// said. One more, and a large one is found.
#[test]
fn too_few_samples_name_no_cause() {
    let bent = |samples: usize| {
        let plain = plain(samples, 6.0, 0.0, 3);
        let bend = |values: &[f64]| values.iter().map(|v| v + 0.05 * v * v).collect();
        let (cos, sin) = (bend(&plain.cos), bend(&plain.sin));
        let recording = Recording::from_samples(plain.time_s, cos, sin, &Overrides::default());
        diagnose(&recording.expect("a recording")).expect("an ellipse")
    };
    let found = bent(149);
    assert_eq!(names(&found), []);
    assert!(!found.unexplained.significant);
    assert!(found.unexplained.signature.contains("too few samples"));
    assert!(found.nothing_named().contains("too few samples"));
    assert!(unseen(&found)[0].contains("of 149 samples"));
    let found = bent(150);
    assert_eq!(names(&found), [Cause::EvenNonlinearity]);
    assert!(!unseen(&found).iter().any(|s| s.contains("of 150 samples")));
}
