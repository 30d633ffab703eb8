//! The stretches of a recording in which its drive is calm. Where a drive starts, stops and turns back, its angle has corners
//! that only close knots follow; they would hide a vibration that goes on all the time. Away from the corners, wide knots do;
//! and without any, where hardly anything but a line needs close ones.

use std::f64::consts::PI;

use crate::causes::VIBRATION;
use crate::context::Context;
use crate::diagnose::Diagnosis;
use crate::finding::Finding;
use crate::lines::{median, spectrum, strongest};
use crate::spline::Spline;

/// A stretch with more than so many times the power of the usual one has a corner in it.
const CORNER: f64 = 4.0;
/// So many times the power of the rest the line has: noise alone and what corners leave have lines, too.
const LOUD: f64 = 0.5;
/// So many times the power of the rest a line has that needs no corners beside it: it is why the knots are close.
const ALONE: f64 = 4.0;
/// So many times what is usual near it in the spectrum a line stands whatever else there is: a resonance of the axis is broad.
const HIGH: f64 = 150.0;
/// Cycles of the line between two knots: of a slower one, which such knots follow, the drive itself leaves something.
const FAST: f64 = 0.6;
/// Radians rms that may be left: of more, it is the drive that swings.
const SMALL: f64 = 0.1;
/// So many times what is usual the corners leave on the average.
const CONTRAST: f64 = 2.0;
/// By so much of its frequency a line may seem to move with the knots.
const SAME: f64 = 0.01;
/// Most of a recording that may be corners.
const MOST: f64 = 0.6;
/// Fewest knots over the recording.
const FEWEST: f64 = 12.0;
/// So many times as far apart as in all of the recording, knots have to be away from the corners.
const WIDER: f64 = 1.5;
/// No knots are tried that are more than so many times as far apart.
const FARTHEST: f64 = 64.0;
/// Corners are looked for in means of so many to a knot.
const SHORT: f64 = 8.0;
/// What a sample of a corner counts: enough for the angle to be followed there, too little to be seen.
const CORNERS: f64 = 1e-3;

/// Where a recording is calm.
pub(crate) struct Calm {
    /// Which samples are in corners.
    corners: Vec<bool>,
    /// Samples between the knots that do elsewhere.
    spacing: f64,
    /// Frequency of the line that stands there.
    pub(crate) hertz: f64,
}

impl Calm {
    /// What is calm where corners need closer knots than a line beside them lets show.
    pub(crate) fn of(context: &Context) -> Option<Self> {
        let motion = context.spline.as_ref()?.spacing();
        let widest = (context.samples() as f64 / FEWEST).min(FARTHEST * motion);
        let angle = Angle::new(context, ((motion / SHORT) as usize).max(1));
        let spacings = (0..).map(|i| widest / 2f64.powf(0.5 * f64::from(i)));
        let spacings = spacings.take_while(|spacing| *spacing > WIDER * motion);
        let looks: Vec<Look> = spacings.map(|spacing| angle.look(spacing)).collect();
        // A line stands where it is whatever the knots; what is left of the drive does not.
        let same = |pair: &[Look]| (pair[0].line / pair[1].line - 1.0).abs() < SAME;
        let pairs = looks.windows(2).filter(|pair| same(pair));
        let each = pairs.flat_map(|pair| pair.iter().map(|look| (look, pair[1].spacing)));
        let told = each.filter(|(look, _)| look.tells());
        let (best, spacing) = told.max_by(|a, b| a.0.contrast.total_cmp(&b.0.contrast))?;
        let corner = |k: usize| best.corners[k / angle.every / best.length];
        Some(Self {
            corners: (0..context.samples()).map(corner).collect(),
            spacing,
            hertz: best.line / angle.every as f64 * context.rate,
        })
    }

    /// The recording with hardly anything counted of its corners, and wider knots.
    pub(crate) fn without_corners(
        self,
        mut context: Context,
        reference: Option<&[f64]>,
    ) -> Context {
        let weights = context.weight.iter_mut().zip(self.corners);
        let marked = weights.filter(|(_, corner)| *corner);
        marked.for_each(|(weight, _)| *weight *= CORNERS);
        let make = |spacing: f64| Spline::new(context.samples(), spacing, &context.weight);
        let followed = context.finer.as_ref().or(context.spline.as_ref());
        let finer = followed.map(|spline| make(spline.spacing()));
        (context.spline, context.finer) = (Some(make(self.spacing)), finer);
        context.calm = true;
        let (c, s) = (context.c.clone(), context.s.clone());
        context.set_pair(c, s, reference);
        context
    }
}

/// The angle, mean by mean of so many samples.
struct Angle {
    every: usize,
    angle: Vec<f64>,
    weight: Vec<f64>,
}

impl Angle {
    fn new(context: &Context, every: usize) -> Self {
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        let means = |of: &[f64]| of.chunks(every).map(mean).collect();
        Self {
            every,
            angle: means(&context.measured),
            weight: means(&context.weight),
        }
    }

    /// What a spline with such knots leaves.
    fn look(&self, spacing: f64) -> Look {
        let apart = spacing / self.every as f64;
        let spline = Spline::new(self.angle.len(), apart, &self.weight);
        let left = spline.residual(&self.angle, &self.weight);
        let all = left;
        let (line, left) = strongest(&all);
        let length = (apart / 2.0).ceil() as usize;
        let mean = |of: &[f64]| of.iter().map(|v| v * v).sum::<f64>() / of.len() as f64;
        let power: Vec<f64> = left.chunks(length).map(mean).collect();
        let usual = median(&power).max(f64::MIN_POSITIVE);
        // A corner is seen a knot's distance away.
        let near = |i: usize| i.saturating_sub(2)..(i + 3).min(power.len());
        let corners: Vec<bool> = (0..power.len())
            .map(|i| power[near(i)].iter().any(|p| *p > CORNER * usual))
            .collect();
        Look {
            spacing,
            line,
            loudness: mean(&all) / mean(&left) - 1.0,
            height: height(&all, line),
            rms: mean(&all).sqrt(),
            knots: apart,
            contrast: mean(&left) / usual,
            share: corners.iter().filter(|c| **c).count() as f64 / corners.len() as f64,
            corners,
            length,
        }
    }
}

/// What a spline leaves.
struct Look {
    /// Samples between its knots.
    spacing: f64,
    /// Frequency of the strongest line, in cycles per mean.
    line: f64,
    /// Means between the knots.
    knots: f64,
    /// Rms of all that is left, radians.
    rms: f64,
    /// Its power over that of the rest.
    loudness: f64,
    /// Its power in the spectrum over what is usual near it.
    height: f64,
    /// Mean power of the rest over that of the usual stretch.
    contrast: f64,
    /// Which stretches have far more than the usual one, or stand beside such: there the motion has corners.
    corners: Vec<bool>,
    share: f64,
    /// Means in a stretch.
    length: usize,
}

impl Look {
    /// Whether there are corners, not too many, and a line beside them; or hardly anything but a line.
    fn tells(&self) -> bool {
        let fast = self.line * self.knots > FAST;
        let small = self.rms < SMALL;
        let beside = self.contrast > CONTRAST && self.loudness > LOUD;
        let alone = self.loudness > ALONE || self.height > HIGH;
        (beside || alone) && self.share <= MOST && fast && small
    }
}

/// How high a line stands in the spectrum of values over what is usual near it.
fn height(values: &[f64], line: f64) -> f64 {
    /// Lines of the spectrum on either side that are the line's own through the window, and that are near.
    const OWN: usize = 4;
    const NEAR: usize = 40;
    let n = values.len() as f64;
    let windowed = values.iter().enumerate();
    let windowed: Vec<f64> = windowed
        .map(|(k, v)| v * (PI * (k as f64 + 0.5) / n).sin().powi(2))
        .collect();
    let (power, length) = spectrum(&windowed);
    let at = ((line * length as f64).round() as usize).min(power.len() - 1);
    // A spectrum of values padded to so many times their number has as many lines for one.
    let each = length / values.len().max(1);
    let near = |from: usize, to: usize| power.get(from..to.min(power.len())).unwrap_or_default();
    let below = near(
        at.saturating_sub(NEAR * each),
        at.saturating_sub(OWN * each),
    );
    let above = near(at + OWN * each, at + NEAR * each);
    power[at] / median(&[below, above].concat()).max(f64::MIN_POSITIVE)
}

/// Adds the vibration that only the calm stretches show: at the frequency of the line for which they were looked at.
pub(crate) fn beside(mut found: Diagnosis, calm: Diagnosis, hertz: f64) -> Diagnosis {
    let known = |f: &Finding| f.cause == VIBRATION;
    if found.findings.iter().any(known) {
        return found;
    }
    let near = |f: &Finding| {
        let own = f.parameter("frequency_hz");
        known(f) && own.is_some_and(|own| (own / hertz - 1.0).abs() < SAME)
    };
    if let Some(mut finding) = calm.findings.into_iter().find(near) {
        finding.evidence +=
            ", where the motion is followed with wider knots, away from its corners";
        finding.gain = found.unchanged();
        found.findings.push(finding);
    }
    found
}
