//! The whole diagnosis of a recording.

use nonius_recording::Recording;
use serde::Serialize;

use crate::checks;
use crate::context::{Context, ContextError, unwrapped};
use crate::finding::{Finding, Parameter};
use crate::generic;
use crate::model::{System, above_motion};
use crate::noise;
use crate::repair::repair;
use crate::select::select;

/// Most samples that are searched for causes; positions are made of all.
const MOST: usize = 200_000;

/// The sensor with its five fitted parameters and white noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Simulation {
    /// What it holds.
    pub causes: Vec<SimulatedCause>,
    /// Rms of radial and tangential residual, in fractions of the amplitude.
    pub residual_rms: f64,
    /// The same on data that was not fitted.
    pub held_out_residual_rms: f64,
    /// Against the reference, radians.
    pub position_error_rms_rad: Option<f64>,
}

/// A cause that every simulation has.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatedCause {
    /// Its name.
    pub cause: &'static str,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

/// What no cause explains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unexplained {
    /// p < 0.001 after all trials.
    pub significant: bool,
    /// The smallest.
    pub p_value: f64,
    /// Where it lives and what it looks like.
    pub signature: String,
}

/// The model with the causes that were found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extended {
    /// Rms of radial and tangential residual, in fractions of the amplitude.
    pub residual_rms: f64,
    /// The same on data that was not fitted.
    pub held_out_residual_rms: f64,
    /// Against the reference, radians.
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
    /// Scale periods travelled, to and fro.
    pub periods_travelled: f64,
    /// The context, for plots.
    pub context: Context,
    /// Radial and tangential residual before and after, for plots.
    pub residuals: [(Vec<f64>, Vec<f64>); 2],
    /// Sentences that go with the result.
    pub notes: Vec<String>,
}

/// Diagnoses a recording.
///
/// # Errors
/// Where the signals draw no ellipse.
pub fn diagnose(recording: &Recording) -> Result<Diagnosis, ContextError> {
    let checked = checks::check(recording);
    let repaired = repair(recording, &checked.weight, &checked.gaps);
    let recording = &repaired.recording;
    let mut context = Context::new(recording, repaired.weight.clone())?;
    let mut notes = recording.notes.clone();
    let whole = context.samples();
    if whole > MOST {
        notes.push(format!(
            "causes were searched in the first {MOST} of {whole} samples"
        ));
    }
    let first = limited(&context, recording);
    let reference = recording
        .reference_rad
        .as_ref()
        .map(|r| &r[..first.samples()]);
    let motion = reference.map(|r| above_motion(&first, &unwrapped(r.to_vec())));
    let system = System::new(&first, motion, &generic::saturated(&first));
    let selection = select(&first, &system);
    let mut findings = checked.findings;
    let named = selection.findings(&system);
    let left = selection.fit.left(&system);
    // Only what is noise can be noise of a kind.
    let noisy = if selection.unnamed.is_empty() {
        noise::findings(&first, &system.residual(&left))
    } else {
        vec![]
    };
    let (held_before, held_after) = (
        selection.base.held_out(&system),
        selection.fit.held_out(&system),
    );
    let (position_before, position_after) = (
        selection.base.position_error(&system),
        selection.fit.position_error(&system),
    );
    for finding in &mut findings {
        finding.gain.held_out_residual_rms_before = held_before;
        finding.gain.held_out_residual_rms_after = held_before;
        finding.gain.position_error_rms_before_rad = position_before;
        finding.gain.position_error_rms_after_rad = position_before;
    }
    findings.extend(named);
    for mut finding in noisy {
        finding.gain.held_out_residual_rms_before = held_after;
        finding.gain.held_out_residual_rms_after = held_after;
        finding.gain.position_error_rms_before_rad = position_after;
        finding.gain.position_error_rms_after_rad = position_after;
        findings.push(finding);
    }
    let signature: Vec<String> = selection
        .unnamed
        .iter()
        .map(|u| u.signature.clone())
        .collect();
    let p_value = selection
        .unnamed
        .iter()
        .map(|u| u.log_p)
        .fold(0.0, f64::min)
        .exp();
    let unexplained = Unexplained {
        significant: !signature.is_empty(),
        p_value,
        signature: if signature.is_empty() {
            "nothing significant is left: the residue is noise".into()
        } else {
            signature.join("; ")
        },
    };
    let n = first.samples();
    let split = |left: &[f64]| (left[..n].to_vec(), left[n..2 * n].to_vec());
    let residuals = [split(&selection.base.left(&system)), split(&left)];
    let simulation = simulation(
        &context,
        &system,
        held_before,
        &selection.base,
        position_before,
    );
    let extended = Extended {
        residual_rms: selection.fit.rms(&system),
        held_out_residual_rms: held_after,
        position_error_rms_rad: position_after,
    };
    // The corrected pair, by everything that is no motion.
    let mut change = vec![0.0; n];
    let tangential = selection.sensor_shapes(&first);
    for (shape, x) in tangential {
        let (_, along) = shape.rotated(&first.cos, &first.sin);
        for (c, a) in change.iter_mut().zip(along) {
            *c += x * a;
        }
    }
    let positions = (0..whole)
        .filter(|k| repaired.original[*k])
        .map(|k| {
            let off = change.get(k).copied().unwrap_or(0.0);
            (context.measured[k] - off) / std::f64::consts::TAU
        })
        .collect();
    let periods_travelled = travelled(&context);
    context.phi = first.phi.clone();
    Ok(Diagnosis {
        simulation,
        findings,
        unexplained,
        extended,
        positions,
        periods_travelled,
        context: first.clone(),
        residuals,
        notes,
    })
}

/// The first samples of a context, as many as are searched; with the reference.
fn limited(context: &Context, recording: &Recording) -> Context {
    let n = context.samples().min(MOST);
    let mut part = context.clone();
    part.time.truncate(n);
    part.weight.truncate(n);
    for values in &mut part.raw {
        values.truncate(n);
    }
    for codes in &mut part.codes {
        codes.truncate(n);
    }
    if let Some(t) = &mut part.temperature {
        t.truncate(n);
    }
    if n < context.samples() {
        part.spline = None;
    }
    let (c, s) = (context.c[..n].to_vec(), context.s[..n].to_vec());
    let reference = recording.reference_rad.as_ref().map(|r| &r[..n]);
    part.set_pair(c, s, reference);
    part
}

fn simulation(
    context: &Context,
    system: &System,
    held_out: f64,
    base: &crate::model::Fit,
    position: Option<f64>,
) -> Simulation {
    let e = context.ellipse;
    let n = context.samples() as f64;
    let noise = system.noise();
    // Of an average over that many samples with that noise.
    let amplitude = noise * (2.0 / n).sqrt() * e.amplitude();
    let p = Parameter::measured;
    Simulation {
        causes: vec![
            SimulatedCause {
                cause: "offset",
                parameters: vec![
                    p("b_c", e.b_c, amplitude, "column"),
                    p("b_s", e.b_s, amplitude, "column"),
                ],
            },
            SimulatedCause {
                cause: "gain_mismatch",
                parameters: vec![
                    p("a_c", e.a_c, amplitude, "column"),
                    p("a_s", e.a_s, amplitude, "column"),
                ],
            },
            SimulatedCause {
                cause: "quadrature_error",
                parameters: vec![p("beta", e.beta, noise * (4.0 / n).sqrt(), "rad")],
            },
            SimulatedCause {
                cause: "white_noise",
                parameters: vec![p("rms", noise, noise / (2.0 * n).sqrt(), "amplitude")],
            },
        ],
        residual_rms: base.rms(system),
        held_out_residual_rms: held_out,
        position_error_rms_rad: position,
    }
}

fn travelled(context: &Context) -> f64 {
    let way: f64 = context.speed.iter().map(|v| v.abs()).sum();
    way / context.rate / std::f64::consts::TAU
}
