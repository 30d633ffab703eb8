//! The whole diagnosis of a recording.

use nonius_recording::Recording;
use serde::Serialize;

use crate::checks::reference;
use crate::checks::repair::Repaired;
use crate::checks::silent;
use crate::checks::slips::Looked;
use crate::checks::{self, Checked, TimeBase};
use crate::conclude::conclude;
use crate::context::{Context, ContextError};
use crate::doubt::codes;
use crate::doubt::steps;
use crate::finding::{Cause, Finding};
use crate::model::exact;
use crate::motion::calm;
use crate::noise::flicker::{self, Flicker};
use crate::numerics::statistics;
use crate::select::rounds::Rounds;
use crate::select::score::KINDS;
use crate::select::select;
use crate::select::selection::Accepted;
use crate::select::{choice, speed_anew};
use crate::simulation::Simulation;
use crate::simulation::motion::Motion;
use crate::unnamed::unexplained::Unexplained;

/// The model with the causes that were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extended {
    /// Rms of radial and tangential residual, in fractions of the amplitude.
    pub residual_rms: f64,
    /// The same on data that was not fitted.
    pub held_out_residual_rms: f64,
    /// Against the reference, on data that was not fitted, radians.
    pub position_error_rms_rad: Option<f64>,
}

/// A diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The simulation that is put to the test.
    pub simulation: Simulation,
    /// What it gets wrong, and why; the one that explains most first.
    pub findings: Vec<Finding>,
    /// What is left.
    pub unexplained: Unexplained,
    /// What the extended model leaves.
    pub extended: Extended,
    /// Positions in periods by the extended model, one per sample, continuous.
    pub positions: Vec<f64>,
    /// Where the axis is by all of the extended model, as a spline.
    pub(crate) motion: Motion,
    /// Scale periods travelled, to and fro.
    pub periods_travelled: f64,
    /// The context, for plots.
    pub context: Context,
    /// Radial and tangential residual before and after, for plots.
    pub residuals: [(Vec<f64>, Vec<f64>); 2],
    /// What is left of real motion, where that is no part of the tangential residual, for plots.
    pub left_motion: Option<Vec<f64>>,
    /// Sentences that go with the result.
    pub notes: Vec<String>,
}

impl Diagnosis {
    /// What is said where no cause is named.
    #[must_use]
    pub fn nothing_named(&self) -> &'static str {
        if self.context.is_too_short() {
            "no cause of the catalogue was looked for: there are too few samples"
        } else if self.unexplained.significant {
            "no cause of the catalogue was found, but something is left"
        } else {
            "nothing but the five parameters and white noise was found"
        }
    }

    /// One more finding, which takes nothing off the signals.
    pub(crate) fn add(&mut self, mut finding: Finding) {
        let model = &self.extended;
        finding.gain =
            (finding.gain).beside(model.held_out_residual_rms, model.position_error_rms_rad);
        self.findings.push(finding);
        sort(&mut self.findings);
    }
}

/// Diagnoses a recording.
///
/// # Errors
/// Where the signals draw no ellipse.
pub fn diagnose(recording: &Recording) -> Result<Diagnosis, ContextError> {
    let heard = silent::left_out(recording);
    let (recording, weight) = match &heard {
        Some(heard) => (&heard.recording, heard.weight.clone()),
        None => (recording, vec![1.0; recording.samples()]),
    };
    let recording = &*reference::checked(recording);
    let checked = checks::check(recording, weight.clone(), TimeBase::Searched);
    let looked = Looked::at(recording, checked)?.without_slips(recording, weight);
    let Looked {
        found,
        checked,
        repaired,
        calm,
    } = looked;
    let Some(calm) = calm.filter(|calm| calm.is_worth_it(&found)) else {
        return Ok(found);
    };
    let reference = repaired.recording.reference_rad.as_deref();
    let mark = calm.mark;
    let calm = calm.without_corners(repaired.context()?, reference);
    let (calm, _) = search(calm, &checked, &repaired, true);
    Ok(calm::beside(found, calm, mark))
}

/// Diagnoses all of a recording.
pub(crate) fn whole(
    context: Context,
    checked: &Checked,
    repaired: &Repaired,
) -> Result<Diagnosis, ContextError> {
    let (found, noise) = search(context, checked, repaired, true);
    let Some(noise) = noise else {
        return Ok(found);
    };
    // A cause that is slow looks like flicker noise before it is known: names that explain it all are preferred.
    let context = repaired.context()?;
    let (other, _) = search(context, checked, repaired, false);
    let known = |name: Cause| found.findings.iter().any(|f| f.cause == name);
    let more: Vec<&Finding> = other.findings.iter().filter(|f| !known(f.cause)).collect();
    let numbers: usize = more.iter().map(|f| f.parameters.len()).sum();
    let drifts = more.iter().all(|f| f.cause.is_drift());
    if numbers == 0 || drifts && noise.is_instead_of_a_change() {
        return Ok(found);
    }
    let left = flicker::find_beside(&other.context, &other.residuals[1].0);
    if left.is_none() && !other.unexplained.significant {
        return Ok(other);
    }
    // Beside flicker noise, names have to be worth their numbers.
    let likelihood = |d: &Diagnosis| flicker::likelihood_of(&d.context, &d.residuals[1].0);
    let n = other.context.samples() as f64;
    let price = statistics::price(n) * numbers as f64 + KINDS.ln();
    let worth = match (likelihood(&other), likelihood(&found)) {
        (Some(with), Some(without)) => with - without > price,
        _ => false,
    };
    Ok(if worth { beside(other, left) } else { found })
}

/// A diagnosis with flicker noise beside its names, where there is any.
fn beside(mut with: Diagnosis, noise: Option<Flicker>) -> Diagnosis {
    match noise.as_ref().map(Flicker::finding) {
        Some(Ok(finding)) => {
            with.add(finding);
        }
        Some(Err(unnamed)) => {
            with.unexplained.add(unnamed.log_p, unnamed.what.said());
        }
        None => {}
    }
    with
}

/// The one that explains most first.
pub(crate) fn sort(findings: &mut [Finding]) {
    findings.sort_by(|a, b| b.weight.total_cmp(&a.weight));
}

/// Looks at a recording until nothing new is found in it, and what is like flicker noise then; `coloured`: there may be such.
fn search(
    mut context: Context,
    checked: &Checked,
    repaired: &Repaired,
    coloured: bool,
) -> (Diagnosis, Option<Flicker>) {
    let recording = &repaired.recording;
    let mut carried: Vec<Accepted> = vec![];
    // Large causes are taken off the signals themselves, and what is left is looked at anew.
    let mut rounds = Rounds::default();
    loop {
        let (mut system, catalogue) = exact::look(&context, &mut carried, recording);
        if !coloured {
            system.flicker = None;
            system.only_white = true;
        }
        let anew = rounds.begin();
        let mut selection = select(&mut system, &catalogue, carried.clone(), anew);
        if selection.again.is_empty() {
            let noise = system.flicker.clone();
            let notes = [
                codes::beside(&system, &mut selection, &checked.findings),
                steps::beside(&system, &mut selection, recording),
            ];
            let concluded = conclude(&mut system, &selection, checked, repaired);
            drop(system);
            let mut found = concluded(context);
            found.notes.extend(notes.into_iter().flatten());
            return (found, noise);
        }
        // Its samples are not needed any longer, and the next look has its own.
        drop(system);
        let Some(known) = choice::best(&context, selection.again, recording) else {
            rounds.end();
            continue;
        };
        let other = (known.1.len() > carried.len())
            .then(|| speed_anew::decided_anew(&known.0, &known.1, recording))
            .flatten();
        let known = match other {
            Some(other) if !worse(&other, &context) => other,
            _ => known,
        };
        if worse(&known, &context) {
            rounds.went_astray(&known.1);
        } else if rounds.goes_on(&known.1, left_of(&known.0, &known.1)) {
            (context, carried) = known;
        }
    }
}

/// Power that a context leaves of the radius. What turns the pair far changes the ellipse, too, which the next look finds.
fn left_of(context: &Context, known: &[Accepted]) -> f64 {
    let turned = known.iter().any(|one| one.candidate.factor.is_some());
    match turned {
        true => context.power_off_the_ellipse(),
        false => context.radial().iter().map(|r| r * r).sum(),
    }
}

/// Whether a context leaves clearly more of the radius than another one did.
fn worse((new, known): &(Context, Vec<Accepted>), old: &Context) -> bool {
    const CLEARLY: f64 = 1.5;
    let (new, old) = (left_of(new, known), left_of(old, known));
    !new.is_finite() || new > CLEARLY * CLEARLY * old
}
