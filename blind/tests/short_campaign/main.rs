//! The campaign in short, on fixed seeds: what must hold whatever else does not hold yet.
//!
//! The long one, with its table: `cargo run --release -p nonius-blind --example campaign -- --help`.

mod by_hand;
mod independent;
mod kept;
mod regressions;

use nonius_blind::{Case, Kind, Outcome, Score, Summary, page, seal, verdict};
use rayon::prelude::*;

const SEEDS: std::ops::Range<u64> = 40_000..40_060;
const SAMPLES: usize = 10_000;

#[test]
fn short_campaign() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scores: Vec<Score> = SEEDS
        .into_par_iter()
        .map(|seed| {
            let case = Case::draw(seed, SAMPLES).expect("a case can be drawn");
            let sealed = seal(&case.truth, folder.path()).expect("a truth can be sealed");
            println!("{seed} sealed: {}", sealed.hash);
            let verdict = verdict(&case.csv()).unwrap_or_else(|why| panic!("{seed}: {why}"));
            Score::of(sealed.open().expect("an untouched truth"), &case, &verdict)
        })
        .collect();
    println!("{}", page(&scores));
    let all = Summary::new(scores.iter());
    let seeds = |so: &dyn Fn(&Score) -> bool| -> Vec<u64> {
        let bad = scores.iter().filter(|s| so(s));
        bad.map(|s| s.truth.seed).collect()
    };
    // The targets that are met: a name where nothing is hidden costs an engineer a week.
    let alarms = seeds(&|s| s.truth.kind == Kind::Nothing && !s.wrong.is_empty());
    assert!(alarms.is_empty(), "false alarms: {alarms:?}");
    assert_eq!(all.motion_blamed().hits, 0, "motion called a sensor error");
    assert!(all.coverage().fraction() >= 0.9, "{}", all.coverage());
    kept::verdicts_are_kept(&scores);
}

/// The score itself: silence, a wrong name, a group.
#[test]
fn silence_a_wrong_name_and_a_group_are_scored_as_such() {
    let seed = (0..)
        .find(|s| {
            Case::draw(*s, 3000)
                .expect("a case can be drawn")
                .truth
                .kind
                == Kind::One
        })
        .expect("one cause in some seed");
    let case = Case::draw(seed, 3000).expect("a case can be drawn");
    let silent = says(vec![]);
    let score = Score::of(case.truth.clone(), &case, &silent);
    assert_eq!(score.outcomes, [nonius_blind::Outcome::Silent]);
    assert_eq!(score.first, "nothing");
    let wrong = nonius_blind::Named {
        cause: "graduation_error".into(),
        confounded_with: vec![],
        parameters: vec![],
        motion: false,
    };
    let mut guess = silent;
    guess.named.push(wrong);
    let score = Score::of(case.truth.clone(), &case, &guess);
    assert_eq!(score.wrong, ["graduation_error"]);
    guess.named[0]
        .confounded_with
        .push(case.truth.hidden[0].name.clone());
    let score = Score::of(case.truth.clone(), &case, &guess);
    assert_eq!(score.outcomes, [nonius_blind::Outcome::Group]);
    assert!(score.wrong.is_empty());
}

/// Another order is another cause, and so is another line: with the right number the same name is right.
#[test]
fn a_name_of_another_order_or_frequency_is_wrong() {
    for (name, number) in [("runout", "order"), ("interference", "frequency_hz")] {
        let hides = |seed: &u64| {
            let truth = Case::draw(*seed, 3000).expect("a case can be drawn").truth;
            let own = |h: &nonius_blind::HiddenCause| {
                h.name == name && h.parameters.iter().any(|p| p.name == number)
            };
            truth.hidden.len() == 1 && own(&truth.hidden[0])
        };
        let seed = (0..).find(hides).expect("such a cause in some seed");
        let case = Case::draw(seed, 3000).expect("a case can be drawn");
        let own = case.truth.hidden[0].parameters.iter();
        let own = own
            .clone()
            .find(|p| p.name == number)
            .expect("its number")
            .value;
        let resolved = case.truth.rate / 3000.0;
        for (shown, right) in [(own, true), (own + 2.0 * resolved.max(1.0), false)] {
            let verdict = says(vec![nonius_blind::Named {
                cause: name.into(),
                confounded_with: vec![],
                parameters: vec![(number.into(), shown, 0.0)],
                motion: false,
            }]);
            let score = Score::of(case.truth.clone(), &case, &verdict);
            let outcome = if right {
                Outcome::First
            } else {
                Outcome::Misnamed
            };
            assert_eq!(score.outcomes, [outcome], "{name} {shown}");
            assert_eq!(score.wrong.is_empty(), right, "{name} {shown}");
        }
    }
}

/// A verdict on 3000 samples that names these.
fn says(named: Vec<nonius_blind::Named>) -> nonius_blind::Verdict {
    nonius_blind::Verdict {
        named,
        unexplained: false,
        signature: String::new(),
        positions: vec![0.0; 3000],
        seconds: 0.0,
    }
}

/// Low passes of both channels that are not the same are one in common, too: naming that beside the mismatch is right, and not enough alone.
#[test]
fn what_a_cause_brings_is_no_wrong_name_and_not_its_own() {
    let brings = |seed: &u64| {
        let truth = Case::draw(*seed, 3000).expect("a case can be drawn").truth;
        truth.hidden.iter().any(|h| !h.brings.is_empty())
    };
    let seed = (0..2000).find(brings).expect("such a cause in some seed");
    let case = Case::draw(seed, 3000).expect("a case can be drawn");
    let name = |cause: &str, with: &[&str]| nonius_blind::Named {
        cause: cause.into(),
        confounded_with: with.iter().map(|&name| name.into()).collect(),
        parameters: vec![],
        motion: false,
    };
    let common = name("latency", &["common_bandwidth"]);
    let own = name("bandwidth_mismatch", &["channel_skew"]);
    for (named, outcome) in [
        (vec![common.clone(), own], Outcome::First),
        (vec![common], Outcome::Misnamed),
    ] {
        let score = Score::of(case.truth.clone(), &case, &says(named));
        assert_eq!(score.outcomes, [outcome]);
        assert!(score.wrong.is_empty(), "{:?}", score.wrong);
    }
    let delay = says(vec![name("latency", &[])]);
    let score = Score::of(case.truth.clone(), &case, &delay);
    assert_eq!(score.wrong, ["latency"]);
}
