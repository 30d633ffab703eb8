//! The generator: what is asked for is what is in the recording.

use std::collections::{BTreeMap, BTreeSet};

use nonius_blind::{Case, Drive, Kind, Truth, names, seal, stranger_names};
use rayon::prelude::*;

const SAMPLES: usize = 5000;
const CHOSEN: [&str; 4] = [
    "stuck_bit",
    "coarse_quantisation",
    "dropped_samples",
    "repeated_samples",
];

/// The kinds go round every twenty seeds and the names with them: this many hold every name and every stranger.
const ROUND: u64 = 240;

#[test]
fn every_name_has_the_snr_asked_for() {
    let mut seen = BTreeSet::new();
    let mut kinds = BTreeMap::<Kind, usize>::new();
    let draw = |seed| {
        let case = Case::draw(seed, SAMPLES).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(case.rows.len(), SAMPLES);
        case.truth
    };
    let truths: Vec<Truth> = (0..ROUND).into_par_iter().map(draw).collect();
    for Truth {
        seed, kind, hidden, ..
    } in &truths
    {
        *kinds.entry(*kind).or_default() += 1;
        let first = hidden.first().map(|h| h.name.as_str());
        assert_eq!(Case::first_of_seed(*seed, Kind::of_seed(*seed)), first);
        for hidden in hidden {
            seen.insert(hidden.name.clone());
            // A bit or a place can only be chosen, not scaled.
            if !CHOSEN.contains(&hidden.name.as_str()) {
                let off = (hidden.snr / hidden.snr_asked - 1.0).abs();
                assert!(off < 0.01, "{seed}: {hidden:?}");
            }
            let delay = ["channel_skew", "bandwidth_mismatch", "latency"];
            let delay = delay.contains(&hidden.name.as_str());
            // A low pass in both channels has one against a reference.
            let may = delay || hidden.name == "common_bandwidth";
            let alone = *kind == Kind::One;
            assert!(hidden.twin.is_none() || alone && may, "{hidden:?}");
            assert!(hidden.twin.is_some() || !(alone && delay), "{hidden:?}");
            assert!(hidden.snr > 1.0 && hidden.magnitude > 0.0, "{hidden:?}");
        }
    }
    for name in names().chain(stranger_names()) {
        assert!(seen.contains(name), "{name} never came");
    }
    assert!(kinds[&Kind::Nothing] as f64 >= 0.3 * ROUND as f64);
    assert_eq!(kinds.len(), 5);
}

#[test]
fn a_seed_is_a_recording() {
    for seed in [1, 4, 8] {
        let [a, b] = [(); 2].map(|()| Case::draw(seed, SAMPLES).expect("a case can be drawn"));
        assert_eq!(a.csv(), b.csv());
        assert_eq!(a.truth, b.truth);
    }
    let [a, b] = [0, 3].map(|seed| Case::draw(seed, SAMPLES).expect("a case can be drawn"));
    assert_eq!(a.truth.kind, Kind::Nothing);
    assert_ne!(a.csv(), b.csv());
}

#[test]
fn a_broken_seal_is_seen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = Case::draw(1, SAMPLES).expect("a case can be drawn");
    let sealed = seal(&case.truth, folder.path()).expect("a truth can be sealed");
    assert_eq!(sealed.open().expect("an untouched truth"), case.truth);
    let file = std::fs::read_dir(folder.path())
        .expect("the folder")
        .next()
        .expect("one truth")
        .expect("its entry");
    std::fs::write(file.path(), "{}").expect("the file can be written");
    assert!(
        sealed
            .open()
            .expect_err("a broken seal")
            .to_string()
            .contains("changed")
    );
}

/// What is left of a recording without its channels' shape is the noise that was drawn.
#[test]
fn the_noise_is_the_one_drawn() {
    for seed in [0, 3, 6] {
        let case = Case::draw(seed, SAMPLES).expect("a case can be drawn");
        let world = &case.world;
        for channel in [0, 1] {
            let off = (0..SAMPLES).map(|k| {
                let alpha = case.rows.alpha[k];
                let u = [alpha.cos(), (alpha - world.beta).sin()][channel];
                let clean = world.amplitude[channel] * u + world.offset[channel];
                (case.rows.volts[channel][k] - clean).powi(2)
            });
            let rms = (off.sum::<f64>() / SAMPLES as f64).sqrt();
            let share = rms / world.mean_amplitude() / case.truth.noise;
            // Standard error of the share: 0.009.
            assert!((share - 1.0).abs() < 0.04, "{seed}: {share}");
        }
    }
}

/// The reference shows the true angle: either direction, any zero, wrapped or not.
#[test]
fn the_reference_shows_the_axis() {
    let mut shown = BTreeSet::new();
    for seed in 0..60 {
        let case = Case::draw(seed, 1000).expect("a case can be drawn");
        let (Some(r), Some(column)) = (case.world.reference, &case.rows.reference) else {
            continue;
        };
        shown.insert((r.sign > 0.0, r.wrapped));
        if matches!(case.truth.kind, Kind::Nothing) {
            for (alpha, value) in case.rows.alpha.iter().zip(column) {
                let off = r.sign * alpha + r.offset - value;
                let turns = off / std::f64::consts::TAU;
                assert!((turns - turns.round()).abs() < 1e-3, "{seed}");
                assert!(r.wrapped || turns.round() == 0.0);
            }
        }
    }
    assert_eq!(shown.len(), 4);
}

/// A hand goes a few periods; any other case of the seed is not driven by one.
#[test]
fn a_scale_is_turned_by_hand_over_a_few_periods() {
    for seed in [0, 3, 7] {
        let kind = Kind::of_seed(seed);
        let case = Case::of_kind(kind, Some(Drive::Hand), seed, SAMPLES);
        let case = case.expect("a case can be drawn");
        assert_eq!(case.truth.drive, "hand");
        let alpha = case.rows.alpha.iter();
        let (least, most) = alpha.fold((f64::MAX, f64::MIN), |(l, m), a| (l.min(*a), m.max(*a)));
        let periods = (most - least) / std::f64::consts::TAU;
        assert!((0.2..15.0).contains(&periods), "{seed}: {periods} periods");
        let driven = Case::draw(seed, SAMPLES).expect("a case can be drawn");
        assert_ne!(driven.truth.drive, "hand");
    }
}
