//! What the diagnosis said of each case of the short campaign.

use std::path::Path;

use nonius_blind::Score;

/// What is said of each case is what was said of it: on a machine with another sine, one that hangs on its last digits may differ.
pub(crate) fn verdicts_are_kept(scores: &[Score]) {
    const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-blind short_campaign";
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/short_campaign/verdicts.txt");
    let said: String = scores.iter().map(said).collect();
    if nonius_kept::blessed() {
        nonius_kept::same(&file, &said, HOW);
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_else(|why| panic!("{why}; {HOW}"));
    assert_eq!(kept.lines().count(), said.lines().count(), "{HOW}");
    let both = kept.lines().zip(said.lines());
    let other: Vec<(&str, &str)> = both.filter(|(kept, said)| kept != said).collect();
    assert!(other.len() <= 1, "kept, and said now: {other:#?}; {HOW}");
}

/// What was hidden in a case, and what was said of it, in a line.
fn said(score: &Score) -> String {
    let truth = &score.truth;
    let hidden = truth
        .hidden
        .iter()
        .map(|h| format!("{} ({:.1})", h.name, h.snr));
    let hidden: Vec<String> = hidden.collect();
    let left = if score.unexplained {
        ", unexplained"
    } else {
        ""
    };
    format!(
        "{} {:?} [{}]: {:?}, first {}, wrong {:?}, motion {:?}{left}\n",
        truth.seed,
        truth.kind,
        hidden.join(", "),
        score.outcomes,
        score.first,
        score.wrong,
        score.motions,
    )
}
