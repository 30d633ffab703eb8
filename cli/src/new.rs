//! `nonius new`: a commented design, on its own or fitted to a recording.

mod draft;
mod fitted;
mod promise;
mod text;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::Spec;
use nonius_package::{BOTH_WAYS, pull_in};
use nonius_quantity::periods_per_second;
use nonius_recording::{Recording, Survey};

use crate::recording_args::RecordingArgs;
use crate::target::Target;
use draft::{Draft, plain, rounded_up};
use fitted::{fitted, turns};
use promise::Promise;

/// A new design.
#[derive(Args)]
pub(crate) struct New {
    /// Name of the design and of its Verilog module; ./NAME.toml is written.
    name: String,
    /// Fits ADC range, offset, rate and speed to a recording, so that the design can follow it.
    #[arg(long, value_name = "RECORDING.csv")]
    from: Option<PathBuf>,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

/// Asked over found: calibration noise and loop noise add up.
const MARGIN: f64 = 1.1;
/// Accuracies that are tried, from the finest, until the sensor and its ADC allow one.
const FINEST: f64 = 1e-6;
const COARSEST: f64 = 0.1;

pub(crate) fn run(args: &New) -> Result<()> {
    let path = PathBuf::from(format!("{}.toml", args.name));
    if path.exists() {
        bail!(
            "{} exists and is left as it is; choose another name, or move it away",
            path.display()
        );
    }
    let mut draft = match &args.from {
        None => plain(&args.name),
        Some(file) => {
            let recording = Recording::read(file, &args.recording_args.overrides())?;
            let survey = Survey::of(&recording);
            crate::notes(&recording.notes);
            turns(file, &recording, &survey)?;
            crate::notes(&survey.notes);
            fitted(&args.name, file, &recording, &survey)?
        }
    };
    let design = settle(&mut draft)?;
    let target = Target::new(&path)?;
    target
        .file()
        .write_all(draft.toml().as_bytes())
        .with_context(|| format!("cannot write {}", path.display()))?;
    target.keep_new()?;
    say!(
        "{}: accuracy {:.2e} periods rms predicted, speed to {}",
        path.display(),
        design.budget.total(),
        periods_per_second(draft.speed_max.0)
    );
    crate::notes(not_held(&draft));
    let pull_in = pull_in(&design, &BOTH_WAYS);
    if let Some(missed) = pull_in.missed() {
        eprintln!("note: {missed}; {}", pull_in.advice());
    }
    say!("next: nonius build {} -o out/{}", path.display(), args.name);
    Ok(())
}

/// The text of a design fitted to a recording, and what it cannot promise of what the recording shows.
///
/// # Errors
/// No design can follow the recording.
pub fn fitted_text(
    name: &str,
    file: &Path,
    recording: &Recording,
) -> Result<(String, Vec<String>)> {
    let survey = Survey::of(recording);
    turns(file, recording, &survey)?;
    let mut draft = fitted(name, file, recording, &survey)?;
    settle(&mut draft)?;
    Ok((draft.toml(), not_held(&draft)))
}

/// A sentence for each promise that does not hold what was measured.
fn not_held(draft: &Draft) -> Vec<String> {
    let said = |(key, promise): (_, &Promise)| {
        let why = promise.missed()?;
        Some(format!(
            "sensor.{key} does not hold what the recording shows: {why}"
        ))
    };
    draft.promises().into_iter().filter_map(said).collect()
}

/// The finest accuracy that the rest of the draft allows and that the bit-true chip reaches, with a tenth to spare.
fn settle(draft: &mut Draft) -> Result<Design> {
    draft.accuracy = FINEST;
    loop {
        match designed(draft) {
            Ok(design) => {
                let usual = nonius_package::simulate(&design).accuracy.rms_periods;
                let weakest = nonius_package::simulate_weakest(&design).rms_periods;
                let reached = usual.max(weakest);
                let spared = rounded_up(MARGIN * draft.accuracy.max(reached.min(COARSEST)));
                if spared <= MARGIN * MARGIN * draft.accuracy {
                    draft.accuracy = spared;
                    return designed(draft);
                }
                draft.accuracy = rounded_up(spared / MARGIN);
            }
            // A name is no number, and says itself what is wrong.
            Err(error) if is_of(&error, "name") => return Err(error),
            Err(error) if is_of(&error, "accuracy.") && draft.accuracy < COARSEST => {
                draft.accuracy = rounded_up(draft.accuracy * 1.1);
            }
            Err(error) => {
                return Err(error).context("no design can follow this; the number at fault is");
            }
        }
    }
}

/// Whether a field of this beginning is refused.
fn is_of(error: &anyhow::Error, beginning: &str) -> bool {
    let field = error.downcast_ref::<DesignError>();
    matches!(field, Some(DesignError::Field { field, .. }) if field.starts_with(beginning))
}

fn designed(draft: &Draft) -> Result<Design> {
    let spec = Spec::from_toml(&draft.toml(), &format!("{}.toml", draft.name))?;
    Ok(Design::new(&spec)?)
}
