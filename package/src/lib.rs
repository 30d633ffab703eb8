//! Everything that `nonius build` writes, and writing it whole or not at all.

mod channel_skew;
mod coefficient;
mod curves;
mod design_json;
mod diagram;
mod harmonics;
mod progress;
mod pull_in;
mod report;
mod sensor;
mod signals;
mod simulation;
mod sine;
mod slow_lock;
mod tracking;
mod write;

pub use coefficient::{Coefficient, coefficients};
pub use design_json::DesignJson;
pub use progress::{Event, Progress, silent};
pub use pull_in::{BOTH_WAYS, PullIn, Worst, pull_in, pull_in_followed};
pub use signals::{Signal, signals};
pub use simulation::{Accuracy, Simulation, simulate, simulate_weakest};
pub use sine::{SineError, sine_error};
pub use slow_lock::SlowLock;
pub use write::{WriteError, may_write, write};

use nonius_model::chip::Chip;
use nonius_model::design::{Design, DesignError};
use nonius_testvectors::stimulus::{self, Stimulus};
use nonius_testvectors::vectors;
use nonius_testvectors::waves::{Waves, gtkw};

/// The files of a chip and what there is to say about it.
pub struct Package {
    /// Path below the output folder, content.
    pub files: Vec<(String, Vec<u8>)>,
    /// What `design.json` says.
    pub json: DesignJson,
}

/// Why a package cannot be made: but for a name, a defect and not a design.
#[derive(Debug, thiserror::Error)]
pub enum PackageError {
    /// A template does not render.
    #[error("a template does not render: {0}")]
    Template(#[from] askama::Error),
    /// The module is called like one of its signals: linters would say that one hides the other.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// JSON cannot be written.
    #[error("JSON cannot be written: {0}")]
    Json(#[from] serde_json::Error),
    /// Waves cannot be written.
    #[error("waves cannot be written: {0}")]
    Waves(#[from] std::io::Error),
}

/// Samples of each named stimulus, unless asked otherwise.
pub const ROWS: usize = 2000;

/// Makes the package of a design with `rows` samples of each named stimulus.
///
/// # Errors
/// A name that a signal has, and defects of the generator.
pub fn package(design: &Design, rows: usize) -> Result<Package, PackageError> {
    package_with(design, stimulus::named(design, rows), "sweep")
}

/// The same with other stimuli; `shown` is the one whose waves are written.
///
/// # Errors
/// A name that a signal has, and defects of the generator.
pub fn package_with(
    design: &Design,
    stimuli: Vec<Stimulus>,
    shown: &str,
) -> Result<Package, PackageError> {
    package_followed(design, stimuli, shown, &silent)
}

/// The same; `progress` hears what is being done.
///
/// # Errors
/// A name that a signal has, and defects of the generator.
pub fn package_followed(
    design: &Design,
    stimuli: Vec<Stimulus>,
    shown: &str,
    progress: Progress,
) -> Result<Package, PackageError> {
    progress(Event::Generating);
    let names: Vec<_> = stimuli
        .iter()
        .map(|s| (s.name.clone(), s.samples.len()))
        .collect();
    let hash = nonius_codegen::hash(design);
    let chip = nonius_codegen::generate(design, &hash, &names)?;
    let name = &design.spec.name;
    let rtl = chip.files.iter().find(|f| f.0 == format!("rtl/{name}.v"));
    if rtl.is_some_and(|(_, text)| nonius_codegen::declared(text).contains(name.as_str())) {
        return Err(DesignError::name_of_a_signal(name).into());
    }
    progress(Event::Simulating);
    let simulation = simulate(design);
    let accuracies = [simulation.accuracy, simulate_weakest(design)];
    let pull_in = pull_in_followed(design, &BOTH_WAYS, progress);
    let slow_lock = SlowLock::of(design);
    progress(Event::Writing);
    let size = (chip.clocks, chip.multipliers);
    let json = DesignJson::of(design, &hash, size, accuracies, pull_in, slow_lock);
    let mut files: Vec<(String, Vec<u8>)> = chip
        .files
        .into_iter()
        .map(|(path, text)| (path, text.into_bytes()))
        .collect();
    for one in &stimuli {
        let rows = vectors::rows(design, one, &chip.columns);
        files.push((format!("vectors/{}.vec", one.name), rows.into_bytes()));
    }
    if let Some(shown) = stimuli.iter().find(|s| s.name == shown).or(stimuli.first()) {
        let name = &shown.name;
        let mut bytes = vec![];
        let mut waves = Waves::new(&mut bytes, design, &chip.columns, chip.clocks)?;
        let mut model = Chip::bit_true(design);
        for s in &shown.samples {
            let probes = model.step_codes(s.cos, s.sin, s.preset, s.calibrate);
            waves.sample(s, &probes, &model)?;
        }
        waves.finish()?;
        let save = gtkw(name, design, &chip.columns, chip.clocks);
        files.push((format!("waves/{name}.vcd"), bytes));
        files.push((format!("waves/{name}.gtkw"), save.into_bytes()));
    }
    let text = serde_json::to_string_pretty(&json)? + "\n";
    files.push(("design.json".into(), text.into_bytes()));
    let page = report::page(design, &json, &simulation, &files)?;
    files.push(("report.html".into(), page.into_bytes()));
    Ok(Package { files, json })
}
