//! Every word length that the analysis chooses may be overridden; what cannot be is refused with its limits.

use std::collections::BTreeSet;

use crate::graph_support::graph_equals_chip;
use crate::support::shipped::variants::{self, with_every_word};
use crate::support::shipped::words::{all_said, key, say, with};
use crate::support::{codes, optical, wrapped};
use nonius_model::chip::Chip;
use nonius_model::design::{Design, DesignError};
use nonius_model::kernel::Input;
use nonius_model::spec::{CalibrationMethod, Overrides};
use proptest::prelude::*;

#[test]
fn what_the_analysis_chooses_may_be_said() {
    let mut seen = BTreeSet::new();
    for chip in with_every_word() {
        let chosen = chip.design();
        let said = Design::new(&all_said(&chosen)).expect("the same words");
        assert_eq!(said.structure, chosen.structure, "{}", chip.what);
        assert_eq!(said.constants, chosen.constants, "{}", chip.what);
        assert_eq!(said.graph, chosen.graph, "{}", chip.what);
        assert_eq!(said.budget, chosen.budget, "{}", chip.what);
        for word in chosen.word_lengths() {
            assert!(
                (word.lowest..=word.highest).contains(&word.value),
                "{word:?}"
            );
            assert!(!word.overridden && !word.meaning.is_empty(), "{word:?}");
            seen.insert(key(&word).to_owned());
        }
        assert!(said.word_lengths().iter().all(|word| word.overridden));
    }
    let all: BTreeSet<_> = Overrides::KEYS.iter().map(ToString::to_string).collect();
    assert_eq!(seen, all);
}

/// A delay that moves the sine by less than a last bit has words of two or three bits, which may be said like any other.
#[test]
fn the_shortest_words_of_a_small_skew_may_be_said() {
    let mut spec = optical();
    spec.sensor.amplitude = 0.7;
    spec.sensor.speed_max_periods_per_s = 6000.0;
    spec.adc.bits = 16;
    spec.adc.full_scale = 1.6;
    spec.adc.sample_rate_hz = 5e6;
    spec.tracking.bandwidth_hz = 100e3;
    spec.accuracy.rms_periods = 1.43e-2;
    spec.accuracy.arithmetic_share = 0.77;
    for delay in [3e-8, 1e-9] {
        spec.correction.channel_skew_s = delay;
        let chosen = Design::new(&spec).expect("a design that works");
        let words = chosen.word_lengths();
        let short = words.iter().filter(|word| word.value < 4).count();
        assert!(short > 0, "{words:?}");
        for word in words {
            let within = word.lowest..=word.highest;
            assert!(within.contains(&word.value), "{word:?}");
        }
        let said = Design::new(&all_said(&chosen)).expect("the same words");
        assert_eq!(said.graph, chosen.graph);
    }
}

/// Another value makes another chip, whose graph is the chip in every bit.
#[test]
fn each_key_changes_its_word() {
    for chip in with_every_word() {
        let chosen = chip.design();
        let said = all_said(&chosen);
        for word in chosen.word_lengths() {
            let mut built = 0;
            for value in [word.lowest, word.value - 1, word.value + 1, word.highest] {
                if value == word.value || !(word.lowest..=word.highest).contains(&value) {
                    continue;
                }
                let Some(design) = with(&said, key(&word), value) else {
                    continue;
                };
                built += 1;
                let same =
                    design.structure == chosen.structure && design.constants == chosen.constants;
                assert!(!same, "{}: {} = {value}", chip.what, word.key);
                graph_equals_chip(&design, codes(&design.spec), 40);
            }
            assert!(built > 0, "{}: {word:?}", chip.what);
        }
    }
}

/// Rms difference of the bit-true chip from the unrounded one, periods, once both have locked.
fn rounding(design: &Design) -> f64 {
    let bits = design.spec.adc.bits;
    let (mut chip, mut real) = (Chip::bit_true(design), Chip::unrounded(design));
    let codes = codes(&design.spec);
    let (mut sum, samples) = (0.0, 12_000);
    for k in 0..samples {
        let [cos, sin] = codes(k);
        chip.step_codes(cos, sin, false, true);
        let [adc_cos, adc_sin] = [cos, sin].map(|code| code as f64 / 2f64.powi(bits as i32));
        real.step(&Input {
            adc_cos,
            adc_sin,
            preset: false,
            calibrate: true,
        });
        if k >= samples / 2 {
            sum += wrapped(chip.position() - real.position()).powi(2);
        }
    }
    assert!(chip.state.locked && real.state.locked, "not locked");
    (sum / f64::from(samples / 2)).sqrt()
}

/// Whatever word is shortened by three bits, the chip differs from the unrounded one by no more than its budget says.
#[test]
fn a_shorter_word_costs_what_the_budget_says() {
    let mut sum_of_squares = optical();
    sum_of_squares.calibration.method = CalibrationMethod::SumOfSquares;
    let mut late = optical();
    late.correction.channel_skew_s = 1e-7;
    let mut nine = optical();
    nine.calibration.parameters = 9;
    let mut wavy = optical();
    wavy.correction.harmonics = variants::third_and_fifth();
    let mut exact = optical();
    exact.calibration.method = CalibrationMethod::Exact;
    for spec in [optical(), sum_of_squares, late, nine, wavy, exact] {
        let chosen = Design::new(&spec).expect("a design that works");
        let said = all_said(&chosen);
        for word in chosen.word_lengths() {
            let value = (word.value - 3).max(word.lowest);
            let design = with(&said, key(&word), value).expect("a shorter word");
            let (found, budget) = (rounding(&design), design.budget.arithmetic());
            println!(
                "{}: {:.2e} found, {:.2e} in the budget",
                word.key, found, budget
            );
            assert!(
                found <= 2.0 * budget,
                "{}: {found:e} of {budget:e}",
                word.key
            );
        }
    }
}

/// What is said of a table's values decides how long the signals are that are made of them, not the other way round.
#[test]
fn a_word_that_is_said_has_its_place() {
    let chosen = Design::new(&optical()).expect("a shipped design");
    for fraction in 9..=32 {
        let mut spec = optical();
        spec.formats.sine_value_fraction = Some(fraction);
        let design = Design::new(&spec).expect("signals that fit it");
        let signal = design.words.signal_fraction;
        assert!((signal + 1..=signal + 8).contains(&fraction));
        if fraction <= chosen.followers.sine_value_fraction {
            assert_eq!(signal, fraction - 1);
        }
    }
}

/// Refused at its ends, with both of them.
#[test]
fn what_cannot_be_is_refused_with_its_limits() {
    for chip in with_every_word() {
        let chosen = chip.design();
        let said = all_said(&chosen);
        for word in chosen.word_lengths() {
            for value in [word.lowest - 1, word.highest + 1] {
                let mut spec = said.clone();
                say(&mut spec, key(&word), value);
                let refused = Design::new(&spec).expect_err("outside its limits");
                let message = refused.to_string();
                let DesignError::Field { field, limit, .. } = refused else {
                    panic!("{message}");
                };
                assert_eq!(field, word.key, "{message}");
                let end = if value < word.lowest {
                    word.lowest
                } else {
                    word.highest
                };
                assert!(limit.contains(&end.to_string()), "{message}");
            }
        }
    }
}

/// Of a word that is said alone, the limits are those of every chip that can be built around it: no more is accepted, and no less.
#[test]
fn the_limits_of_a_word_are_all_that_is_accepted() {
    let mut seen = BTreeSet::new();
    for chip in with_every_word() {
        for word in chip.design().word_lengths() {
            // Each once.
            if !seen.insert(word.key.clone()) {
                continue;
            }
            let saying = |value: i64| {
                let mut spec = chip.spec.clone();
                say(&mut spec, key(&word), value);
                Design::new(&spec).map_err(|refused| match refused {
                    DesignError::Field { field, limit, .. } if field == word.key => limit,
                    other => panic!("{}: {other}", chip.what),
                })
            };
            let limits = |value: i64| saying(value).err().unwrap_or_else(|| panic!("{value}"));
            let absurd = if word.key.ends_with("_range_log2") {
                -100
            } else {
                0
            };
            let said = limits(absurd);
            let ends: Vec<i64> = said.split(" … ").flat_map(str::parse).collect();
            let [lowest, highest] = ends[..] else {
                panic!("{said}");
            };
            assert!(lowest <= word.lowest && word.highest <= highest, "{said}");
            for beyond in [absurd, lowest - 1, highest + 1, 100] {
                assert_eq!(limits(beyond), said, "{}: {word:?}", chip.what);
            }
            for within in lowest..=highest {
                assert!(saying(within).is_ok(), "{}: {word:?}: {within}", chip.what);
            }
        }
    }
}

/// Ranges that do not hold what is promised name the registers and the worst case.
#[test]
fn a_range_that_does_not_hold_the_promise_names_the_parameter_and_the_sensor() {
    let mut spec = optical();
    spec.formats.gain_range_log2 = Some(-4);
    let message = Design::new(&spec).expect_err("too narrow").to_string();
    for part in [
        "formats.gain_range_log2 = -4",
        "theta_1_deviation and theta_3_deviation reach 0.226",
        "sensor.amplitude_tolerance is 0.15 and sensor.phase_error_max_deg is 5",
        "limit: -2 … 4",
    ] {
        assert!(message.contains(part), "{message}");
    }
}

/// A word that the chip does not have is refused with the reason.
#[test]
fn a_word_without_effect_is_refused() {
    let chosen = Design::new(&optical()).expect("a shipped design");
    let held = chosen.word_lengths();
    let mut absent = 0;
    for name in Overrides::KEYS {
        if held.iter().any(|word| key(word) == *name) {
            continue;
        }
        absent += 1;
        let mut spec = optical();
        say(&mut spec, name, 9);
        let message = Design::new(&spec).expect_err("no such word").to_string();
        let said = format!("formats.{name} = 9: this chip has no such word: ");
        assert!(message.starts_with(&said), "{message}");
    }
    assert!(absent > 5, "{absent}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Any words together are a chip whose graph is the chip in every bit, or a refusal that names one of them: within their limits
    /// every value fits.
    #[test]
    fn any_words_are_a_chip_or_a_refusal(
        chip in 0..64usize,
        said in prop::collection::vec((0..Overrides::KEYS.len(), prop_oneof![
            4 => (0..=1000i64).prop_map(|share| (true, share)),
            1 => (-70..70i64).prop_map(|value| (false, value)),
        ]), 0..10),
    ) {
        let chips = with_every_word();
        let chosen = chips[chip % chips.len()].design();
        let held = chosen.word_lengths();
        let mut spec = chosen.spec.clone();
        for (n, (within, value)) in said {
            // Mostly within the limits of a word that the chip has.
            let word = &held[n % held.len()];
            let (key, value) = if within {
                (key(word), word.lowest + (word.highest - word.lowest) * value / 1000)
            } else {
                (Overrides::KEYS[n], value)
            };
            // Where it can be said at all.
            let _ = spec.formats.set(key, Some(value));
        }
        match Design::new(&spec) {
            Ok(design) => graph_equals_chip(&design, codes(&spec), 25),
            Err(error) => prop_assert!(error.field().starts_with("formats."), "{}", error),
        }
    }
}
