//! The table, with the targets beside, as a page of Markdown.

use std::fmt::Write as _;

use crate::score::Score;
use crate::summary::{BINS, Summary};
use crate::truth::Kind;

/// The page: table, efficiency, confusion, every wrong name with its seed.
#[must_use]
pub fn page(scores: &[Score]) -> String {
    let mut text = String::new();
    let all = Summary::new(scores.iter());
    let reversing = Summary::new(scores.iter().filter(|s| s.truth.drive == "reversing"));
    let first = all
        .scores
        .first()
        .map_or("reversing", |s| s.truth.drive.as_str());
    let columns = if all.scores.iter().all(|s| s.truth.drive == first) {
        vec![(first, &all)]
    } else {
        vec![("all drives", &all), ("reversing", &reversing)]
    };
    let mut row = |what: &str, target: &str, cell: &dyn Fn(&(&str, &Summary)) -> String| {
        let cells: Vec<String> = columns.iter().map(cell).collect();
        let _ = writeln!(text, "| {what} | {target} | {} |", cells.join(" | "));
    };
    row("", "target", &|(name, _)| (*name).into());
    row("---", "---", &|_| "---".into());
    for (what, target, ask) in QUESTIONS {
        row(what, target, &|(_, scores)| ask(scores));
    }
    text +=
        "\n## Found, by detection SNR\n\nRight name first or in a group of two; single causes.\n\n";
    text += "| SNR | textbook's waveform | the world's |\n|---|---|---|\n";
    let (one, wild) = (all.efficiency(Kind::One), all.efficiency(Kind::Wild));
    for (k, bin) in BINS.windows(2).enumerate() {
        let _ = writeln!(
            text,
            "| {:.0} – {:.0} | {} | {} |",
            bin[0], bin[1], one[k], wild[k]
        );
    }
    text += "\n## What came first\n\nSingle causes of SNR 8 and more, and causes that the catalogue does not hold.\n\n";
    text += "| hidden | named first |\n|---|---|\n";
    for (hidden, named) in all.confusion() {
        let list: Vec<String> = named.iter().map(|(n, k)| format!("{n} {k}")).collect();
        let _ = writeln!(text, "| {hidden} | {} |", list.join(", "));
    }
    text + &wrong_names(scores)
}

/// Every wrong name with its seed.
pub(crate) fn wrong_names(scores: &[Score]) -> String {
    let mut text = String::from(
        "\n## Sensor causes named that are not there\n\n| seed | hidden (SNR) | named |\n|---|---|---|\n",
    );
    for score in scores.iter().filter(|s| !s.wrong.is_empty()) {
        let _ = writeln!(
            text,
            "| {} | {} | {} |",
            score.truth.seed,
            score.truth.listed(),
            score.wrong.join(", ")
        );
    }
    text
}

type Question = (&'static str, &'static str, fn(&Summary) -> String);

const QUESTIONS: [Question; 20] = [
    ("recordings", "", |s| s.scores.len().to_string()),
    ("right name first, SNR ≥ 8", "≥ 95 %", |s| {
        s.first(Kind::One).to_string()
    }),
    (
        "the most that any namer can expect of that: a low pass far above the signals is a delay",
        "",
        |s| match s.first_at_most(Kind::One) {
            share if share.is_nan() => "none drawn".into(),
            share => format!("at most {:.1} %", 100.0 * share),
        },
    ),
    (
        "right name, or in a declared group of two, SNR ≥ 8",
        "≥ 99 %",
        |s| s.group(Kind::One).to_string(),
    ),
    (
        "the same, with a waveform that is not the textbook's",
        "",
        |s| s.group(Kind::Wild).to_string(),
    ),
    ("wrong sensor cause named, SNR ≥ 8", "≤ 0.5 %", |s| {
        s.wrong().to_string()
    }),
    ("half are found at SNR", "≤ 5.5", |s| {
        s.half_found()
            .map_or("too few".into(), |snr| format!("{snr:.1}"))
    }),
    ("nothing hidden: a sensor cause named", "≤ 0.5 %", |s| {
        s.false_alarms().to_string()
    }),
    ("nothing hidden: unexplained", "≤ 1 %", |s| {
        s.nothing_unexplained().to_string()
    }),
    ("nothing hidden, axis still: motion named", "", |s| {
        s.imagined_motion().to_string()
    }),
    ("real motion called a sensor error", "never", |s| {
        s.motion_blamed().to_string()
    }),
    (
        "vibration or cogging named as motion, SNR ≥ 8",
        "≥ 95 %",
        |s| s.motion_named().to_string(),
    ),
    (
        "with a reference: latency, graduation error",
        "≥ 99 %",
        |s| s.against_reference().to_string(),
    ),
    (
        "a cause outside the library given a name, SNR = 40",
        "≤ 10 %",
        |s| s.strangers_named().to_string(),
    ),
    ("the same said to be unexplained", "", |s| {
        s.strangers_seen().to_string()
    }),
    ("two causes (SNR 60 and 30): both named", "≥ 95 %", |s| {
        s.both().to_string()
    }),
    (
        "parameters: standard deviation over Cramér–Rao bound",
        "≤ 1.10",
        |s| {
            let (spread, count) = s.spread();
            if count == 0 {
                return "none".into();
            }
            format!("{spread:.2} ({count} parameters)")
        },
    ),
    ("coverage of the 95 % interval", "93–97 %", |s| {
        s.coverage().to_string()
    }),
    (
        "position error removed (systematic, electrical causes, median)",
        "≥ 90 %",
        |s| {
            let (share, count) = s.removed();
            if count == 0 {
                return "none".into();
            }
            format!("{:.1} % ({count} recordings)", 100.0 * share)
        },
    ),
    ("median time of a diagnosis, s", "", |s| {
        format!("{:.2}", s.seconds())
    }),
];
