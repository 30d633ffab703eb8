//! Scales that are turned by hand over a few periods. The hand trembles, and what it does along the circle must not decide which error the
//! radius shows.

use nonius_blind::{Case, Drive, Kind, Outcome, Score};
use rayon::prelude::*;

use crate::regressions::scored_as;

/// How the case of a seed scores where the scale is turned by hand.
fn scored(seed: u64) -> Score {
    let case = Case::of_kind(Kind::of_seed(seed), Some(Drive::Hand), seed, 20_000);
    scored_as(&case.expect("a case can be drawn"))
}

/// Cases that had the name of a harmonic of another order, which what is real motion along the circle preferred: a bend has its own
/// name, and a harmonic stands with the bend that does the same to the radius.
#[test]
fn a_hand_that_trembles_does_not_make_a_bend_another_harmonic() {
    const NAMED: [u64; 5] = [188000372, 188000870, 188001284, 188001290, 188002692];
    const IN_A_GROUP: [u64; 1] = [188000295];
    const NOT_NAMED_WRONG: [u64; 2] = [188001127, 188002035];
    let seeds = [&NAMED[..], &IN_A_GROUP, &NOT_NAMED_WRONG].concat();
    let failed: Vec<String> = seeds
        .into_par_iter()
        .filter_map(|seed| {
            let score = scored(seed);
            let right = match &score.outcomes[..] {
                [Outcome::First] => !IN_A_GROUP.contains(&seed),
                [Outcome::Group] => IN_A_GROUP.contains(&seed),
                _ => NOT_NAMED_WRONG.contains(&seed),
            };
            let holds = right && score.wrong.is_empty();
            (!holds).then(|| format!("{seed}: {:?}, wrong {:?}", score.outcomes, score.wrong))
        })
        .collect();
    assert!(failed.is_empty(), "{failed:?}");
}

/// Recordings that hide nothing. What a spline leaves of a hand that shakes grew with the speed, and was a clock that wanders at 0 Hz; and noise
/// of the angle is in the errors against a reference as in the acceleration.
#[test]
fn where_nothing_is_hidden_nothing_is_left() {
    let seeds = [189_500_011, 189_500_377, 189_500_046, 189_500_266];
    seeds.into_par_iter().for_each(|seed| {
        let score = scored(seed);
        assert!(score.outcomes.is_empty(), "{seed}: {:?}", score.outcomes);
        assert!(score.wrong.is_empty(), "{seed}: {:?}", score.wrong);
        assert!(!score.unexplained, "{seed}");
    });
}
