//! The words that the analysis chooses are as short as the budget lets them be, and longer where more is asked.

use std::collections::{BTreeMap, BTreeSet};

use crate::support::codes;
use crate::support::shipped::variants::with_every_word;
use crate::support::shipped::words::{all_said, key, say, with};
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::spec::{Overrides, Spec};
use proptest::prelude::*;

/// One bit less than chosen, of any word of any chip, misses the budget or cannot be built, as values of a table coarser than what
/// is read of them. What costs no accuracy has what else decides it.
#[test]
fn each_word_is_the_shortest() {
    let mut misses = BTreeSet::new();
    for chip in with_every_word() {
        let (chosen, what) = (chip.design(), &chip.what);
        let found = words_that_miss(&chosen).unwrap_or_else(|enough| panic!("{what}: {enough}"));
        misses.extend(found);
        others_have_another_reason(&chosen, what);
    }
    let never = Overrides::KEYS.iter().filter(|key| !misses.contains(**key));
    let never: Vec<_> = never.copied().collect();
    println!("never a matter of the budget: {never:?}");
    assert_eq!(
        never,
        [
            "sine_value_fraction",
            "harmonic_value_fraction",
            "gain_range_log2",
            "offset_range_log2",
            "cross_range_log2",
            "bend_range_log2",
            "rate_high_bits",
            "lock_level_bits"
        ]
    );
}

/// Whether a shorter word of `key` costs accuracy.
fn costs(key: &str) -> bool {
    !is_range(&key) && !matches!(key, "rate_high_bits" | "lock_level_bits")
}

/// The words of which one bit less misses the budget; or one that is neither one of these nor the shortest that can be.
fn words_that_miss(chosen: &Design) -> Result<Vec<String>, String> {
    let (said, allowed) = (all_said(chosen), chosen.budget.allowed);
    if chosen.budget.arithmetic() > allowed {
        return Err("the words chosen miss the budget".into());
    }
    let mut misses = vec![];
    for word in chosen.word_lengths() {
        let name = key(&word);
        if !costs(name) {
            continue;
        }
        match with(&said, name, word.value - 1) {
            Some(shorter) if shorter.budget.arithmetic() > allowed => misses.push(name.to_owned()),
            None if word.value == word.lowest => {}
            _ => return Err(format!("{name} = {} is enough", word.value - 1)),
        }
    }
    Ok(misses)
}

fn others_have_another_reason(chosen: &Design, what: &str) {
    let said = all_said(chosen);
    for word in chosen.word_lengths() {
        let name = key(&word);
        let with_one_less = |spec: &Spec| with(spec, name, word.value - 1);
        if is_range(&name) {
            let more = with_one_less(&promising_more(&said));
            assert!(more.is_none(), "{what}: {name} holds a third more");
        } else if name == "lock_level_bits" {
            let settled = 4.0 / chosen.tracking.omega;
            let full = 2f64.powi(word.value as i32);
            assert!(full >= settled.min(4096.0), "{what}: {name}");
            let shorter = with_one_less(&said);
            assert!(full / 2.0 < settled || shorter.is_none(), "{what}: {name}");
        } else if name == "rate_high_bits" {
            let shorter = with_one_less(&said).expect("another place to part the rate at");
            same_outputs(chosen, &shorter);
        }
    }
}

/// Sensors a third worse than promised, which ranges hold no more where they are shorter.
fn promising_more(spec: &Spec) -> Spec {
    let mut spec = spec.clone();
    let s = &mut spec.sensor;
    for promise in [
        &mut s.amplitude_tolerance,
        &mut s.offset_max,
        &mut s.phase_error_max_deg,
        &mut s.bend_max,
    ] {
        *promise *= 4.0 / 3.0;
    }
    spec
}

/// Both chips say the same at every sample.
fn same_outputs(one: &Design, other: &Design) {
    let codes = codes(&one.spec);
    let (mut one, mut other) = (Chip::bit_true(one), Chip::bit_true(other));
    for k in 0..2000 {
        let [cos, sin] = codes(k);
        for chip in [&mut one, &mut other] {
            chip.step_codes(cos, sin, false, true);
        }
        assert_eq!(one.position().to_bits(), other.position().to_bits(), "{k}");
    }
}

/// Asked for twice the accuracy, or four times, of its arithmetic, a chip of any kind has longer words and none that is shorter.
/// Slopes are read between rows: where there are more of these, the finer segments may take the bit.
#[test]
fn twice_the_accuracy_takes_longer_words() {
    let mut longer = BTreeSet::new();
    for chip in with_every_word() {
        let asking = |share: f64| {
            let mut spec = chip.spec.clone();
            spec.accuracy.arithmetic_share *= share;
            Design::new(&spec).expect("a design that works")
        };
        for [once, more] in [[1.0, 0.5], [4.0, 1.0]] {
            let words = longer_words(&asking(once), &asking(more));
            longer.extend(words.unwrap_or_else(|shorter| panic!("{}: {shorter}", chip.what)));
        }
    }
    for name in Overrides::KEYS {
        let free = is_range(name) || *name == "lock_level_bits";
        assert!(free || longer.contains(*name), "{name} is never longer");
    }
}

/// The words that are longer in the finer design, or one that is shorter.
fn longer_words(coarse: &Design, finer: &Design) -> Result<Vec<String>, String> {
    let of = |design: &Design| -> BTreeMap<String, i64> {
        let words = design.word_lengths();
        words.iter().map(|w| (key(w).to_owned(), w.value)).collect()
    };
    let (once, twice) = (of(coarse), of(finer));
    let more = |name: &str| twice.get(name).unwrap_or(&0) - once.get(name).unwrap_or(&0);
    for name in once.keys() {
        let rows = match name.as_str() {
            "sine_slope_fraction" => more("sine_rows_log2"),
            "harmonic_slope_fraction" => more("harmonic_rows_log2"),
            _ => 0,
        };
        if more(name) + rows < 0 {
            return Err(format!("{name} is shorter: {once:?} {twice:?}"));
        }
    }
    Ok(once.keys().filter(|name| more(name) > 0).cloned().collect())
}

fn is_range(key: &&str) -> bool {
    key.ends_with("_range_log2")
}

fn ranges() -> Vec<&'static str> {
    Overrides::KEYS.iter().copied().filter(is_range).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever is asked of whatever chip, with a range of its parameters said or not.
    #[test]
    fn so_it_is_for_any_accuracy(
        chip in 0..64usize,
        rms_log2 in 0.0..6.0f64,
        share_log2 in -8.0..-0.5f64,
        bits in 8..=18u32,
        noise in prop_oneof![Just(0.0), 1e-4..1e-2f64],
        bandwidth_log2 in -2.0..1.0f64,
        range in prop_oneof![
            3 => Just(None),
            1 => (prop::sample::select(ranges()), -2..=4i64).prop_map(Some),
        ],
    ) {
        let chips = with_every_word();
        let mut spec = chips[chip % chips.len()].spec.clone();
        spec.adc.bits = bits;
        spec.sensor.noise_rms = noise;
        spec.tracking.bandwidth_hz *= bandwidth_log2.exp2();
        spec.accuracy.rms_periods *= rms_log2.exp2();
        spec.accuracy.arithmetic_share = share_log2.exp2();
        if let Some((range, wide)) = range {
            say(&mut spec, range, wide);
        }
        let mut finer = spec.clone();
        finer.accuracy.arithmetic_share /= 2.0;
        if let Ok(chosen) = Design::new(&spec) {
            prop_assert_eq!(words_that_miss(&chosen).err(), None);
            if let Ok(finer) = Design::new(&finer) {
                prop_assert_eq!(longer_words(&chosen, &finer).err(), None);
            }
        }
    }
}
