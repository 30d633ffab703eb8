//! The blind campaign: fresh seeds on all cores, truths sealed, a table of what was found.
//!
//!     cargo run --release -p nonius-blind --example campaign -- --cases 2000 --seed 1000000 --docs docs
//!
//! prints, for every case, the hash of its sealed truth before the verdict and the truth after it; then the table.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use nonius_blind::{Case, Drive, Kind, Score, page, page_of_many, seal, verdict};
use rayon::prelude::*;

/// Hides causes in simulated recordings and scores what the diagnosis says.
#[derive(Parser)]
struct Arguments {
    /// Recordings.
    #[arg(long, default_value_t = 200)]
    cases: u64,
    /// Seed of the first; the others follow.
    #[arg(long)]
    seed: u64,
    /// Samples of each.
    #[arg(long, default_value_t = 20_000)]
    samples: usize,
    /// Only seeds that stand for this kind of case: nothing, one, wild, two or stranger; or many, three to five causes each, for
    /// which every seed stands.
    #[arg(long, value_parser = kind)]
    kind: Option<Kind>,
    /// Only recordings of this drive: constant, sweeping, reversing or stopandgo, the others are drawn and left out; or hand, by which a
    /// scale is turned over a few periods: then all are.
    #[arg(long, value_parser = ["constant", "sweeping", "reversing", "stopandgo", "hand"])]
    drive: Option<String>,
    /// Only seeds of which the first cause has this name; may be repeated.
    #[arg(long, value_name = "NAME", value_parser = cause, conflicts_with = "docs")]
    cause: Vec<String>,
    /// Only recordings of which the first cause has a smaller SNR; the others are drawn and left out.
    #[arg(long, value_name = "SNR", conflicts_with = "docs")]
    below: Option<f64>,
    /// Folder for blind.md, or blind-DRIVE.md of one drive, or blind-many.md.
    #[arg(long)]
    docs: Option<PathBuf>,
    /// Folder for the sealed truths; a temporary one if none is given.
    #[arg(long)]
    truths: Option<PathBuf>,
    /// Writes the recording of each case there.
    #[arg(long)]
    recordings: Option<PathBuf>,
}

impl Arguments {
    /// What kind of case a seed stands for.
    fn kind_of(&self, seed: u64) -> Kind {
        match self.kind {
            Some(Kind::Many) => Kind::Many,
            _ => Kind::of_seed(seed),
        }
    }
}

fn kind(word: &str) -> Result<Kind, serde_json::Error> {
    serde_json::from_value(word.into())
}

fn cause(word: &str) -> Result<String, String> {
    let mut all = nonius_blind::names().chain(nonius_blind::stranger_names());
    match all.any(|name| name == word) {
        true => Ok(word.into()),
        false => Err("no cause that is ever hidden".into()),
    }
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("campaign: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<()> {
    let temporary = tempfile::tempdir()?;
    let folder = arguments.truths.as_deref().unwrap_or(temporary.path());
    for folder in std::iter::once(folder).chain(arguments.recordings.as_deref()) {
        std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let many = arguments.kind == Some(Kind::Many);
    if arguments.docs.is_some() && arguments.kind.is_some() && !many {
        bail!("--docs takes all kinds together, or many: leave --kind away");
    }
    let seeds = arguments.seed..arguments.seed.saturating_add(arguments.cases);
    let wanted = |seed: &u64| {
        arguments
            .kind
            .is_none_or(|kind| kind == arguments.kind_of(*seed))
            && (arguments.cause.is_empty() || hides(*seed, arguments))
    };
    let seeds: Vec<u64> = seeds.filter(wanted).collect();
    let bar = ProgressBar::new(seeds.len() as u64).with_style(ProgressStyle::with_template(
        "{bar:40} {pos}/{len} {elapsed} ({eta} left)",
    )?);
    let results: Vec<Result<Score>> = seeds
        .into_par_iter()
        .filter_map(|seed| {
            let score = case(seed, arguments, folder).transpose();
            bar.suspend(|| match &score {
                Some(Ok(score)) => println!("{seed} opened: {}", line(score)),
                Some(Err(error)) => println!("{seed} not scored: {error:#}"),
                None => {}
            });
            bar.inc(1);
            score
        })
        .collect();
    bar.finish_and_clear();
    let refused: Vec<String> = results
        .iter()
        .filter_map(|r| r.as_ref().err())
        .map(|e| format!("{e:#}"))
        .collect();
    let scores: Vec<Score> = results.into_iter().flatten().collect();
    let mut text = if many {
        page_of_many(&scores)
    } else {
        page(&scores)
    };
    if !refused.is_empty() {
        text += "\n## Not scored\n\n";
        for why in &refused {
            text += &format!("- {why}\n");
        }
    }
    println!("\n{text}");
    if let Some(docs) = &arguments.docs {
        write(docs, arguments, &text)?;
    }
    Ok(())
}

/// Whether a seed hides one of the wanted causes first.
fn hides(seed: u64, arguments: &Arguments) -> bool {
    let wanted = |first| arguments.cause.iter().any(|name| name == first);
    Case::first_of_seed(seed, arguments.kind_of(seed)).is_some_and(wanted)
}

/// One case: sealed, judged, opened, scored; `None` if another drive is wanted.
fn case(seed: u64, arguments: &Arguments, folder: &Path) -> Result<Option<Score>> {
    let by_hand = arguments.drive.as_deref() == Some("hand");
    let drive = by_hand.then_some(Drive::Hand);
    let case = Case::of_kind(arguments.kind_of(seed), drive, seed, arguments.samples)?;
    let wanted = arguments.drive.as_ref();
    let first = case.truth.hidden.first();
    let weak = |below: f64| first.is_some_and(|hidden| hidden.snr < below);
    if wanted.is_some_and(|drive| *drive != case.truth.drive)
        || arguments.below.is_some_and(|below| !weak(below))
    {
        return Ok(None);
    }
    let sealed = seal(&case.truth, folder)?;
    println!("{seed} sealed: {}", sealed.hash);
    let csv = case.csv();
    if let Some(folder) = &arguments.recordings {
        std::fs::write(folder.join(format!("{seed}.csv")), &csv)?;
    }
    let verdict = verdict(&csv).map_err(|why| anyhow::anyhow!("seed {seed}: refused: {why}"))?;
    Ok(Some(Score::of(sealed.open()?, &case, &verdict)))
}

fn line(score: &Score) -> String {
    let hidden: Vec<String> = score
        .truth
        .hidden
        .iter()
        .map(|h| {
            let twin = h.twin.map_or(String::new(), |twin| {
                format!(", {:.1} from its twin", twin.distance)
            });
            format!("{} (SNR {:.1}{twin})", h.name, h.snr)
        })
        .collect();
    let mut text = format!(
        "{:?} {} [{}{}{}]: {:?}, first {}",
        score.truth.kind,
        hidden.join(" and "),
        score.truth.drive,
        if score.truth.reference {
            ", reference"
        } else {
            ""
        },
        if score.truth.vibration_rad.is_some() {
            ", vibrating"
        } else {
            ""
        },
        score.outcomes,
        score.first
    );
    if !score.wrong.is_empty() {
        text += &format!(", WRONG {:?}", score.wrong);
    }
    if !score.motions.is_empty() {
        text += &format!(", motion {:?}", score.motions);
    }
    for p in &score.parameters {
        text += &format!(", {} off {:.1} errors", p.name, p.stated);
        if let Some(bound) = p.bound {
            text += &format!(" ({bound:.1} bounds)");
        }
    }
    if score.unexplained {
        text += &format!(", left: {}", score.signature);
    }
    text
}

/// Writes the page beside its place, then moves it there.
fn write(docs: &Path, arguments: &Arguments, text: &str) -> Result<()> {
    let last = arguments.seed + arguments.cases.saturating_sub(1);
    let (mut option, mut only, mut name) = (String::new(), String::new(), "blind".to_owned());
    if arguments.kind.is_some() {
        option += " --kind many";
        name += "-many";
    }
    if let Some(drive) = &arguments.drive {
        option += &format!(" --drive {drive}");
        only = format!(", those of {drive} drives");
        name += &format!("-{drive}");
    }
    let page = format!(
        "# Blind campaign\n\n<!-- Written by the command below; do not edit. -->\n\n    cargo run --release -p nonius-blind \
         --example campaign -- --cases {} --seed {} --samples {}{option} --docs docs\n\nSeeds {} to {last}{only}, {} samples each. \
         What is hidden, and how its SNR is defined, stands in `blind/src/`.\n\n{text}",
        arguments.cases, arguments.seed, arguments.samples, arguments.seed, arguments.samples
    );
    std::fs::create_dir_all(docs)?;
    let mut file = tempfile::NamedTempFile::new_in(docs)?;
    std::io::Write::write_all(&mut file, page.as_bytes())?;
    file.persist(docs.join(name + ".md"))?;
    Ok(())
}
