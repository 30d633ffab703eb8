//! `nonius diagnose`: what a recording's simulation gets wrong, why, and what naming it gains.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use nonius_diagnosis::{Diagnosis, Extended, Finding, Simulation, Unexplained, diagnose};
use nonius_quantity::{Unit, before_after, digits};
use nonius_recording::Recording;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::corrections::Outcome;
use crate::progress::Busy;
use crate::recording_args::RecordingArgs;

/// What to diagnose.
#[derive(Args)]
pub(crate) struct Diagnose {
    /// The recording (CSV).
    recording: PathBuf,
    /// Folder to write: findings.json, positions.csv, sensor.toml, motion.csv, design.toml, report.html.
    #[arg(short)]
    output: PathBuf,
    /// The design that runs on this sensor; one is fitted if none is given.
    #[arg(long, value_name = "DESIGN.toml")]
    design: Option<PathBuf>,
    /// Exit code 1 if something significant stays unexplained.
    #[arg(long)]
    strict: bool,
    /// Prints findings.json too.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

#[derive(Serialize)]
struct Findings<'a> {
    schema: &'static str,
    recording: About,
    simulation: &'a Simulation,
    findings: &'a [Finding],
    unexplained: &'a Unexplained,
    extended: &'a Extended,
}

#[derive(Serialize)]
struct About {
    /// `sha256:` and the hash of the content.
    file: String,
    samples: usize,
    sample_rate_hz: f64,
    periods_travelled: f64,
    has_reference: bool,
}

pub(crate) fn run(args: &Diagnose) -> Result<bool> {
    nonius_package::may_write(&args.output)?;
    let (recording, hash) = read(args)?;
    let given = args.design.as_deref();
    let design = given.map(crate::design_file::read).transpose()?;
    let busy = Busy::new(format!("diagnoses {} samples", recording.samples()));
    let mut found = diagnose(&recording)
        .map_err(|error| anyhow::anyhow!("{}: {error}", args.recording.display()))?;
    drop(busy);
    crate::notes(&found.notes);
    let design = match design {
        Some((design, text)) => {
            crate::play::compare(&design.spec, &recording);
            Ok(text)
        }
        None => crate::new::fitted_text("fitted", &args.recording, &recording)
            .inspect(|(_, not_held)| crate::notes(not_held))
            .map(|(text, _)| text),
    };
    let (design, outcomes) = match design {
        Ok(text) => {
            let (text, outcomes) = crate::corrections::switch_on(&text, &found)?;
            (Some(text), outcomes)
        }
        Err(why) => {
            let outcome = crate::corrections::without_design(&found, &why);
            (None, vec![outcome])
        }
    };
    for outcome in &outcomes {
        outcome.tell(&mut found);
    }
    crate::notes(outcomes.iter().map(Outcome::sentence));
    let json = serde_json::to_string_pretty(&Findings {
        schema: "nonius.findings/1",
        recording: About {
            file: format!("sha256:{hash}"),
            samples: recording.samples(),
            sample_rate_hz: recording.metadata.sample_rate_hz,
            periods_travelled: found.periods_travelled,
            has_reference: found.context.against_reference.is_some(),
        },
        simulation: &found.simulation,
        findings: &found.findings,
        unexplained: &found.unexplained,
        extended: &found.extended,
    })? + "\n";
    let mut files: Vec<(String, Vec<u8>)> = vec![
        ("findings.json".into(), json.clone().into_bytes()),
        (
            "positions.csv".into(),
            positions(&recording, &found).into_bytes(),
        ),
        (
            "sensor.toml".into(),
            nonius_diagnosis::sensor_toml(&found, &recording).into_bytes(),
        ),
        (
            nonius_diagnosis::MOTION.into(),
            nonius_diagnosis::motion_csv(&found, &recording).into_bytes(),
        ),
        (
            "report.html".into(),
            nonius_diagnosis::report(&found, &recording, &hash, env!("CARGO_PKG_VERSION"))?
                .into_bytes(),
        ),
    ];
    if let Some(text) = design {
        files.push(("design.toml".into(), text.into_bytes()));
    }
    nonius_package::write(&files, &args.output)?;
    if args.json {
        say_as_it_is!("{json}");
    } else {
        summary(&found, &args.output);
    }
    Ok(!(args.strict && found.unexplained.significant))
}

/// The recording and the SHA-256 of its file, which is read once: a pipe has no second time.
fn read(args: &Diagnose) -> Result<(Recording, String)> {
    let name = args.recording.display().to_string();
    let file = File::open(&args.recording).with_context(|| name.clone())?;
    let mut hashed = Hashed {
        source: file,
        digest: Sha256::new(),
    };
    let recording = Recording::read_from(
        BufReader::new(&mut hashed),
        &name,
        &args.recording_args.overrides(),
    )?;
    io::copy(&mut hashed, &mut io::sink()).with_context(|| name)?;
    let bytes = hashed.digest.finalize();
    let hash = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    Ok((recording, hash))
}

/// Hashes what is read through it.
struct Hashed<R> {
    source: R,
    digest: Sha256,
}

impl<R: Read> Read for Hashed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.source.read(buffer)?;
        self.digest.update(&buffer[..length]);
        Ok(length)
    }
}

fn positions(recording: &Recording, found: &Diagnosis) -> String {
    let mut out = String::from("time_s,position_periods\n");
    for (time, position) in recording.time_s.iter().zip(&found.positions) {
        let _ = writeln!(out, "{time:.9},{position:.12}");
    }
    out
}

fn summary(found: &Diagnosis, output: &Path) {
    if found.findings.is_empty() {
        say!("{}", found.nothing_named());
    }
    for finding in &found.findings {
        let snr = match finding.gain.detection_snr {
            Some(snr) => format!(" (SNR {})", digits(snr, 3)),
            None => String::new(),
        };
        say!("{}{snr}", finding.named_evidence());
    }
    match found.unexplained.parts.as_slice() {
        [] => say!("{}", found.unexplained.signature),
        parts => parts.iter().for_each(|part| say!("unexplained: {part}")),
    }
    for sentence in nonius_diagnosis::unseen(found) {
        say!("cannot be seen here: {sentence}");
    }
    let (before, after) = before_after(
        found.simulation.held_out_residual_rms,
        found.extended.held_out_residual_rms,
        Unit::Percent,
    );
    say!("residual on held-out data: {before} → {after} of the amplitude, rms");
    if let (Some(before), Some(after)) = (
        found.simulation.position_error_rms_rad,
        found.extended.position_error_rms_rad,
    ) {
        let degrees = [before, after].map(f64::to_degrees);
        let (before, after) = before_after(degrees[0], degrees[1], Unit::Plain("°"));
        say!(
            "angle error against the reference, on held-out data: {before} → {after} rms (electrical)"
        );
    }
    say!("written: {}/", output.display());
}
