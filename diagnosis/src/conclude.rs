//! Findings, gains and positions of a search that has come to its end.

use crate::checks::Checked;
use crate::checks::repair::Repaired;
use crate::context::Context;
use crate::diagnose::{Diagnosis, Extended, sort};
use crate::doubt::curves;
use crate::drifts::channels::Channels;
use crate::finding::units;
use crate::finding::{Cause, Finding};
use crate::model::exact;
use crate::model::{Fit, Residual, System};
use crate::noise;
use crate::noise::flicker::Flicker;
use crate::select::selection::Selection;
use crate::shapes::library::Row;
use crate::simulation::motion::{self, Motion};
use crate::simulation::simulation;
use crate::unnamed::left;
use crate::unnamed::unexplained::{Unexplained, Unnamed};
use crate::unnamed::whereabouts::Left;

/// The diagnosis of a recording; the context that it is made with is the system's own, and is not kept twice.
pub(crate) fn conclude(
    system: &mut System,
    selection: &Selection,
    checked: &Checked,
    repaired: &Repaired,
) -> impl FnOnce(Context) -> Diagnosis + use<> {
    let extended = selection.named(system);
    let all = [selection.base.shapes.as_slice(), &extended.fit.shapes].concat();
    let halves = system.halves(&all);
    let system = &*system;
    let own = selection.base.shapes.len();
    let held_out = |fit: &Fit| {
        (
            halves.held_out(fit, own, 0),
            halves.position_error(fit, own, 0),
        )
    };
    let (held_before, position_before) = held_out(&selection.base);
    let (held_after, position_after) = held_out(&extended.fit);
    let nameless = Nameless::of(system, selection, &extended);
    let beside = |found: &[Finding], residual: f64, position: Option<f64>| {
        let mut found = found.to_vec();
        for finding in &mut found {
            finding.gain = finding.gain.beside(residual, position);
        }
        found
    };
    let ellipse = exact::ellipse(&system.context.ellipse, &extended.fit.solution.x);
    let mut digital = checked.findings.clone();
    for finding in &mut digital {
        // Where a rail is depends on the offset and the amplitude that its channel has beside all causes.
        if let Some(rail) = checked.rails.iter().find(|rail| rail.is_of(finding)) {
            *finding = rail.finding(&system.context.adc, &ellipse);
        }
    }
    let mut findings = beside(&digital, held_before, position_before);
    findings.extend(extended.findings(system, &halves));
    findings.extend(beside(&nameless.noise, held_after, position_after));
    sort(&mut findings);
    let was = system.residual(&selection.base);
    let left = system.residual(&extended.fit);
    let nothing = if system.context.is_too_short() {
        Unexplained::not_looked_for()
    } else {
        Unexplained::nothing(&findings)
    };
    let unexplained = nameless.unexplained(system, &left, nothing);
    let simulation = simulation(
        &selection.base,
        system,
        held_before,
        halves.rms(&selection.base),
        position_before,
        units::of_columns(&repaired.recording),
    );
    let model = Extended {
        residual_rms: halves.rms(&extended.fit),
        held_out_residual_rms: held_after,
        position_error_rms_rad: position_after,
    };
    let motion = Motion::of(system.context, &angle(system, selection, &extended));
    let sure = extended.sure(system);
    let angle = angle(system, selection, sure.as_ref().unwrap_or(&extended));
    let own = repaired.place.iter();
    let positions = own.map(|&k| angle[k] / std::f64::consts::TAU).collect();
    let notes = repaired.recording.notes.clone();
    let residuals = [(was.radial, was.tangential), (left.radial, left.tangential)];
    let left_motion = left.motion;
    move |mut context| {
        context.ellipse = ellipse;
        Diagnosis {
            simulation,
            findings,
            unexplained,
            extended: model,
            positions,
            motion,
            periods_travelled: context.periods_travelled(),
            context,
            residuals,
            left_motion,
            notes,
        }
    }
}

/// The angle, less what everything that is no motion does to it, radians; what has no name any longer is off the signals, and comes
/// back.
fn angle(system: &System, selection: &Selection, extended: &Selection) -> Vec<f64> {
    let context = system.context;
    let mut amounts = extended.sensor_amounts();
    amounts.extend(selection.taken_back(extended));
    let change = system.samples.sum(&amounts, Row::Tangential, 1);
    let pairs = context.measured.iter().zip(&change);
    let mut angle: Vec<f64> = pairs.map(|(measured, change)| measured - change).collect();
    motion::bridge(context, &mut angle);
    angle
}

/// What is left beside the causes: noise of a kind, and what has no name.
#[derive(Default)]
struct Nameless {
    noise: Vec<Finding>,
    /// What could not be named, in the order in which it is told.
    unnamed: Vec<Unnamed>,
}

impl Nameless {
    /// What a selection leaves; `extended` has those of its causes that keep their names.
    fn of(system: &System, selection: &Selection, extended: &Selection) -> Self {
        if system.context.is_too_short() {
            return Self::default();
        }
        let residual = system.residual(&selection.fit);
        // Only what is noise can be noise of a kind.
        let (mut noise, mut strange) = if selection.unnamed.is_empty() {
            noise::findings(system, &residual, (selection.stepped, selection.coded))
        } else {
            (vec![], vec![])
        };
        let mut rest = selection.left.as_slice();
        if noise::is_the_reason(&noise, rest) {
            rest = &[];
        } else if !rest.is_empty() {
            (noise, strange) = (vec![], vec![]);
        }
        if let Some(single) = left::single_samples(system.context, &residual.radial) {
            noise.retain(|noise| noise.cause != Cause::AmplitudeNoise);
            strange.push(single);
        }
        let mut unnamed = [selection.unnamed.as_slice(), rest].concat();
        let flicker = flicker(system, selection, &residual, &unnamed);
        let silent = unnamed.is_empty() && noise.is_empty() && strange.is_empty();
        if silent && !selection.stepped && flicker.is_none() {
            let radial = system.residual(&extended.fit).radial;
            strange = left::no_noise(system.context, &radial, selection.coded);
        }
        let traces = |f: &Flicker| curves::instead_of_noise(system, selection, f.gain);
        match flicker.map(|f| traces(&f).map_or_else(|| f.finding(), Err)) {
            Some(Ok(finding)) => noise.push(finding),
            Some(Err(one)) if !selection.stepped => strange.push(one),
            _ => {}
        }
        unnamed.extend(strange);
        Self { noise, unnamed }
    }

    /// What is told of it: of each domain the first, where it lives and what it looks like.
    fn unexplained(&self, system: &System, left: &Residual, mut told: Unexplained) -> Unexplained {
        let seen = Left {
            context: system.context,
            radial: &left.radial,
            tangential: &left.tangential,
        };
        let mut domains = vec![];
        for one in &self.unnamed {
            let domain = one.domain();
            if domain.is_some() && domains.contains(&domain) {
                continue;
            }
            domains.push(domain);
            told.add(one.log_p, one.sentence(&seen, system.noise()));
        }
        told
    }
}

/// Flicker noise of the channels in what is left, unless it is part of what has no name.
fn flicker(
    system: &System,
    selection: &Selection,
    left: &Residual,
    unnamed: &[Unnamed],
) -> Option<Flicker> {
    // What looked like it before anything was known may have got a name.
    let flicker = match &system.flicker {
        Some(known) if !selection.accepted.is_empty() => known.again(Channels::of(system, left)),
        known => known.clone(),
    };
    // What is left of an unknown shape can look like anything.
    let unknown = unnamed.iter().map(|u| u.gain).fold(0.0, f64::max);
    flicker.filter(|f| !f.is_part_of(unknown) && system.size(f.gain) > selection.coded_slowly)
}
