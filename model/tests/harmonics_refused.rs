//! Harmonics that no table mends are refused with their field and its line.

use crate::support::shipped::variants::third_and_fifth;
use crate::support::{optical, shipped};
use nonius_model::design::{Design, DesignError, ORDER_MAX};
use nonius_model::spec::{Harmonic, Place, Spec};
use proptest::prelude::*;

fn text() -> String {
    shipped::text("optical")
}

const ENTRY: &str = "[[correction.harmonics]]\norder = 3\namplitude_cos = 0.01\nphase_cos = 0.5\namplitude_sin = 0.02\nphase_sin = -1.0\n";

/// Two entries behind the shipped design; where the second begins, lines counted from 1.
fn two() -> (String, usize) {
    let second = ENTRY.replace("order = 3", "order = 4");
    let text = format!("{}\n{ENTRY}{second}", text());
    let line = text.lines().count() - second.lines().count() + 1;
    (text, line)
}

fn refused(spec: &Spec) -> (String, String) {
    match Design::new(spec) {
        Err(DesignError::Field { field, reason, .. }) => (field.into_owned(), reason),
        other => panic!("not refused: {:?}", other.err()),
    }
}

#[test]
fn a_misspelt_key_of_the_second_entry_is_named_with_its_line() {
    let (text, line) = two();
    let at = text.rfind("phase_cos").expect("a key");
    let wrong = format!("{}phase_coss{}", &text[..at], &text[at + 9..]);
    let message = Spec::from_toml(&wrong, "d.toml")
        .expect_err("a misspelt key")
        .to_string();
    assert_eq!(
        message,
        format!(
            "d.toml:{}:1: unknown key `correction.harmonics[2].phase_coss`; did you mean `phase_cos`?",
            line + 3
        )
    );
}

#[test]
fn a_missing_key_and_a_wrong_kind_are_told() {
    let (text, _) = two();
    for (was, is, expected) in [
        ("phase_sin = -1.0\n", "", "missing field `phase_sin`"),
        ("order = 4", "order = 4.0", "expected a whole number"),
        ("order = 4", "order = -4", "expected a whole number"),
    ] {
        let at = text.rfind(was).expect("a key");
        let wrong = format!("{}{is}{}", &text[..at], &text[at + was.len()..]);
        let message = Spec::from_toml(&wrong, "d.toml")
            .expect_err("refused")
            .to_string();
        assert!(message.contains(expected), "{message}");
    }
}

fn line_of(text: &str, field: &str) -> Option<usize> {
    Place::of_field(text, field).map(|place| place.line)
}

#[test]
fn what_cannot_work_names_entry_and_line() {
    type Change = fn(&mut Harmonic);
    let cases: [(&str, usize, Change); 9] = [
        ("order", 1, |h| h.order = 1),
        ("order", 1, |h| h.order = ORDER_MAX + 1),
        // That of the first.
        ("order", 1, |h| h.order = 3),
        ("amplitude_cos", 2, |h| h.amplitude_cos = -0.01),
        ("amplitude_cos", 2, |h| h.amplitude_cos = f64::NAN),
        ("amplitude_sin", 4, |h| h.amplitude_sin = 0.3),
        ("amplitude_sin", 4, |h| h.amplitude_sin = f64::INFINITY),
        ("phase_cos", 3, |h| h.phase_cos = 400.0),
        ("phase_sin", 5, |h| h.phase_sin = f64::NAN),
    ];
    let (text, line) = two();
    for (key, below, change) in cases {
        let mut spec = Spec::from_toml(&text, "d.toml").expect("a design");
        change(&mut spec.correction.harmonics[1]);
        let (field, reason) = refused(&spec);
        assert_eq!(field, format!("correction.harmonics[2].{key}"), "{reason}");
        assert_eq!(line_of(&text, &field), Some(line + below));
    }
}

#[test]
fn sums_and_slopes_are_bounded() {
    let (text, line) = two();
    for (amplitude, expected) in [(0.11, "near a circle"), (0.09, "bandwidth")] {
        let mut spec = Spec::from_toml(&text, "d.toml").expect("a design");
        for h in &mut spec.correction.harmonics {
            (h.amplitude_cos, h.amplitude_sin, h.phase_sin) = (amplitude, amplitude, 2.0);
        }
        let (field, reason) = refused(&spec);
        assert!(reason.contains(expected), "{reason}");
        assert_eq!(field, "correction.harmonics");
        // The first header.
        let first = line - ENTRY.lines().count();
        assert_eq!(line_of(&text, &field), Some(first));
    }
    let inline = format!(
        "{}\n[correction]\nharmonics = [{{order = 3}}]\n",
        self::text()
    );
    let last = inline.lines().count();
    assert_eq!(line_of(&inline, "correction.harmonics"), Some(last));
}

/// What a file says is read back.
#[test]
fn an_entry_is_read_as_it_is_written() {
    let (text, _) = two();
    let spec = Spec::from_toml(&text, "d.toml").expect("a design");
    let first = Harmonic {
        order: 3,
        amplitude_cos: 0.01,
        phase_cos: 0.5,
        amplitude_sin: 0.02,
        phase_sin: -1.0,
    };
    assert_eq!(
        spec.correction.harmonics,
        [first, Harmonic { order: 4, ..first }]
    );
    let mut none = optical();
    assert!(none.correction.is_none());
    none.correction.harmonics = third_and_fifth();
    assert!(!none.correction.is_none() && !none.correction.has_skew());
}

fn any_harmonic() -> impl Strategy<Value = Harmonic> {
    let amplitude = || prop_oneof![8 => 0.0..0.08f64, 1 => Just(f64::NAN), 1 => -0.1..0.4f64];
    let phase = || prop_oneof![9 => -4.0..4.0f64, 1 => Just(f64::NEG_INFINITY)];
    (0u32..19, amplitude(), phase(), amplitude(), phase()).prop_map(
        |(order, amplitude_cos, phase_cos, amplitude_sin, phase_sin)| Harmonic {
            order,
            amplitude_cos,
            phase_cos,
            amplitude_sin,
            phase_sin,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    /// Any list is a design or a refusal of the harmonics; where it is a design, one angle has one pair: the angle of the
    /// pair rises with that of the scale everywhere.
    #[test]
    fn any_list_is_a_design_or_a_refusal(list in prop::collection::vec(any_harmonic(), 0..5)) {
        let mut spec = optical();
        spec.correction.harmonics = list.clone();
        match Design::new(&spec) {
            Ok(design) => {
                prop_assert_eq!(design.structure.harmonics.is_some(), !list.is_empty());
                for i in 0..3000 {
                    let alpha = std::f64::consts::TAU * f64::from(i) / 3000.0;
                    let (sin, cos) = alpha.sin_cos();
                    let [c, s] = [0, 1].map(|which| {
                        list.iter().fold((0.0, 0.0), |all, h| {
                            let one = h.at(which, alpha);
                            (all.0 + one.0, all.1 + one.1)
                        })
                    });
                    let (x, y) = (cos + c.0, sin + s.0);
                    let rises = x * (cos + s.1) - y * (c.1 - sin);
                    prop_assert!(rises > 0.0, "at {alpha}: {rises}");
                }
            }
            Err(DesignError::Field { field, .. }) => {
                prop_assert!(field.starts_with("correction.harmonics"), "{field}");
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }
}
