//! Every named signal says by which key its format is overridden, and docs/word-lengths.md says it of all of them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use crate::shipped;
use crate::shipped::variants::{self, type_1};
use crate::shipped::words::{all_said, key, say};
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, Overrides};
use nonius_package::{Signal, signals};

/// A chip that has every word: a loop of type 1, nine parameters that gather and are completed, a sine that is sampled later,
/// stored harmonics.
fn everything() -> Design {
    let mut spec = shipped::optical();
    type_1(&mut spec);
    spec.calibration.parameters = 9;
    spec.calibration.method = CalibrationMethod::SumOfSquares;
    spec.correction.channel_skew_s = 3e-7;
    spec.correction.harmonics = variants::third_and_fifth();
    Design::new(&spec).expect("a design that works")
}

/// What is rounded or cut says the key, what is exact follows from its operands.
fn own_formats(design: &Design) -> BTreeMap<String, Signal> {
    let list = signals(design).into_iter();
    list.filter(|s| !s.why.starts_with("exact"))
        .map(|s| (s.name.clone(), s))
        .collect()
}

#[test]
fn a_key_changes_the_formats_that_name_it_and_no_other() {
    for kind in variants::kinds() {
        check(&kind.what, &kind.design());
    }
    check("everything", &everything());
}

fn check(what: &str, chosen: &Design) {
    let (said, before) = (all_said(chosen), own_formats(chosen));
    for word in chosen.word_lengths() {
        for value in [word.value - 1, word.value + 1] {
            let mut spec = said.clone();
            say(&mut spec, key(&word), value);
            // Outside its limits, or other words stand on it.
            let Ok(design) = Design::new(&spec) else {
                continue;
            };
            for (name, after) in own_formats(&design) {
                let Some(was) = before.get(&name) else {
                    continue;
                };
                let changed = was.format != after.format;
                assert!(
                    !changed || was.set_by.contains(&word.key),
                    "{what}: {} = {value} changed {name}, which names {:?}",
                    word.key,
                    was.set_by
                );
            }
        }
    }
    // Tables have rows, and coefficients have no signal of their own: gains are such where nothing is calibrated.
    let mut apart = vec!["sine_rows_log2", "harmonic_rows_log2", "coefficient_bits"];
    if !chosen.spec.calibration.is_on() {
        apart.push("gain_bits");
    }
    for word in chosen.word_lengths() {
        let named = before.values().any(|s| s.set_by.contains(&word.key));
        assert!(named || apart.contains(&key(&word)), "{what}: {}", word.key);
    }
}

const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-package words::";

const WHAT_THEY_ARE: &str =
    "Every word length that the analysis chooses may be said
in `[formats]` of the design:

    [formats]
    signal_fraction = 18      # two bits more than the analysis takes for optical

Each is the shortest with which all errors together keep to the budget: one bit less, with the others as they are, misses it
or cannot be built. Twice the accuracy takes longer words and no shorter one but slopes of a table that gets more rows, by no
more bits than these (`model/tests/shortest_words.rs`, for every kind of chip and any accuracy). A step of less than two that
makes signals or rows longer may shorten another word by a bit; so may any where a word that is said misses the budget, which
the others then do not fill.
Signals and rows of the tables take their share of the budget first; the others are shortened from the longest on, always the
one that adds least, until a bit of any would be too many. No accuracy is in the ranges of parameters, which hold the promise
and a quarter more, in `rate_high_bits`, which parts a factor in two, and in `lock_level_bits`, by which lock takes as long as
the loop takes to settle. The budget takes roundings for independent, which those of very short words are less: `build`
simulates what comes of it.

The others are chosen around what you say. A word that misses the budget is built, with a note of what it adds. One that
cannot be is refused with all that it may be beside the other words that are said, a range that does not hold the promised
sensor with the parameter and the sensor's worst case. Within the limits everything fits: interval analysis shows it for every
value of the chip. Words that a chip does not have are refused: a chip without harmonics has no table of them. `design.json`
holds them under `budget.words`, what they add under `budget.terms`, and names beside each signal the keys that set its format
(`set_by`).

Chosen for the shipped designs, and for optical with a loop of type 1, nine parameters by the sum of squares, skew and
harmonics (what they may be is of the last one, with its other words as they are):

| key | what it is | optical | magnetic | interferometer | with everything | may be |
|---|---|---|---|---|---|---|
";

#[test]
fn the_page_of_word_lengths_is_fresh() {
    let designs: Vec<Design> = shipped::NAMES.map(shipped::design).into();
    let all = everything();
    let mut page = format!("# Word lengths\n\nWritten by `{HOW}`; do not edit. {WHAT_THEY_ARE}");
    let of =
        |design: &Design, name: &str| design.word_lengths().into_iter().find(|w| key(w) == name);
    for name in Overrides::KEYS {
        let widest = of(&all, name).expect("this chip has every word");
        let _ = write!(page, "| `{name}` | {} |", widest.meaning);
        for design in designs.iter().chain([&all]) {
            let value = of(design, name).map_or("–".to_owned(), |w| w.value.to_string());
            let _ = write!(page, " {value} |");
        }
        let _ = writeln!(page, " {} … {} |", widest.lowest, widest.highest);
    }
    page += "\nNo freedom is in the others:\n\n\
             - What is summed, multiplied or selected without rounding is as wide as its operands make it, by interval\n  \
             analysis.\n\
             - Signals and sensitivities have one integer bit beside the sign, gathered gradients what they can reach: the \
             algorithm holds\n  them there, in `f64` too.\n\
             - Increments of the phase reach a quarter of a turn, half a turn where the largest speed comes near it, and \
             are as fine as the phase.\n\
             - Thresholds are constants of few bits: their comparators are short, and where they stand is no \
             accuracy.\n\
             - These follow from numbers of the design or from the algorithm:\n\n| signals | why | keys |\n|---|---|---|\n";
    let mut rows: BTreeMap<String, (Vec<String>, String)> = BTreeMap::new();
    let every = own_formats(&all).into_values();
    let started = variants::searches()
        .into_iter()
        .filter(|v| v.what.contains("started"));
    let started = started.flat_map(|v| own_formats(&v.design()).into_values());
    for signal in every.chain(started) {
        if signal.set_by.iter().any(|key| key.starts_with("formats.")) {
            continue;
        }
        let keys: Vec<_> = signal.set_by.iter().map(|key| format!("`{key}`")).collect();
        let row = rows.entry(signal.why).or_insert((vec![], keys.join(", ")));
        let name = format!("`{}`", signal.name);
        if !row.0.contains(&name) {
            row.0.push(name);
        }
    }
    for (why, (names, keys)) in rows {
        let keys = if keys.is_empty() { "–" } else { &keys };
        let _ = writeln!(page, "| {} | {why} | {keys} |", names.join(", "));
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/word-lengths.md");
    nonius_kept::same(Path::new(file), &page, HOW);
}
