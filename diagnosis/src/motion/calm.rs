//! The stretches of a recording in which its drive is calm. Where a drive starts, stops and turns back, its angle has corners
//! that only close knots follow; they would hide a vibration or cogging that goes on all the time. Away from the corners, wide
//! knots do; and without any, where hardly anything but that needs close ones.

use crate::causes::highest_order;
use crate::context::Context;
use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding};
use crate::model::exact;
use crate::motion::spline::Spline;
use crate::numerics::lines::{median, spectrum, strongest, window};

/// A stretch with more than so many times the power of the usual one has a corner in it.
const CORNER: f64 = 4.0;
/// So many times the power of the rest the line has: noise alone and what corners leave have lines, too.
const LOUD: f64 = 0.5;
/// So many times the power of the rest a line has that needs no corners beside it: it is why the knots are close.
const ALONE: f64 = 4.0;
/// So many times what is usual near it in the spectrum a line stands whatever else there is: a resonance of the axis is broad.
const HIGH: f64 = 150.0;
/// The same of an order of the revolution: what a drive leaves stands at no one of them.
const HIGH_ORDER: f64 = 60.0;
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
    /// What stands there.
    pub(crate) mark: Mark,
    /// It is told by how high it stands in a spectrum alone.
    high: bool,
}

/// What stands out of a motion.
#[derive(Clone, Copy)]
pub(crate) enum Mark {
    /// A line, of that frequency: hertz, or cycles per mean where means are looked at.
    Line(f64),
    /// An order of the revolution.
    Order(usize),
}

impl Mark {
    /// Whether another is the same but for what is seen of it.
    fn is(self, other: Self) -> bool {
        match (self, other) {
            (Self::Line(a), Self::Line(b)) => (a / b - 1.0).abs() < SAME,
            (Self::Order(a), Self::Order(b)) => a == b,
            _ => false,
        }
    }

    /// What a finding says that it is, if it says so.
    fn of(finding: &Finding) -> Option<Self> {
        match finding.cause {
            Cause::Vibration => finding.parameter("frequency_hz").map(Self::Line),
            Cause::Cogging => finding.parameter("order").map(|o| Self::Order(o as usize)),
            _ => None,
        }
    }
}

impl Calm {
    /// What is calm where corners need closer knots than a line beside them lets show.
    pub(crate) fn of(context: &Context) -> Option<Self> {
        let motion = context.spline.as_ref()?.spacing();
        let widest = (context.samples() as f64 / FEWEST).min(FARTHEST * motion);
        let angle = Angle::new(context, ((motion / SHORT) as usize).max(1));
        let spacings = (0..).map(|i| widest / 2f64.powf(0.5 * f64::from(i)));
        let spacings = spacings.take_while(|spacing| *spacing > WIDER * motion);
        let looks: Vec<Looks> = spacings.map(|spacing| angle.look(spacing)).collect();
        let lines: Vec<&Look> = looks.iter().map(|l| &l.line).collect();
        let orders: Vec<&Look> = looks.iter().filter_map(|l| l.order.as_ref()).collect();
        let (best, spacing) = told(&lines).or_else(|| told(&orders))?;
        let corner = |k: usize| best.corners[k / angle.every / best.length];
        Some(Self {
            high: !best.stands_alone(),
            corners: (0..context.samples()).map(corner).collect(),
            spacing,
            mark: match best.mark {
                Mark::Line(line) => Mark::Line(line / angle.every as f64 * context.rate),
                order => order,
            },
        })
    }

    /// Whether it is worth a look, which takes as long as the first: in a long recording, what any known cause leaves in the
    /// angle may stand high in its spectrum.
    pub(crate) fn is_worth_it(&self, found: &Diagnosis) -> bool {
        !self.high || exact::every(self.corners.len()) == 1 || found.findings.is_empty()
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
        let finer = context.followed().map(|spline| make(spline.spacing()));
        (context.spline, context.finer) = (Some(make(self.spacing)), finer);
        context.calm = true;
        let (c, s) = (context.c.clone(), context.s.clone());
        context.set_pair(c, s, reference);
        context
    }
}

/// The look that tells most, and how far apart knots may be then. What stands out does so whatever the knots; what is left of
/// the drive does not, and what it leaves at an order of the revolution is gone with the next knots.
fn told<'a>(looks: &[&'a Look]) -> Option<(&'a Look, f64)> {
    let same = |pair: &&[&Look]| {
        let order = matches!(pair[0].mark, Mark::Order(_));
        pair[0].mark.is(pair[1].mark) && (!order || pair.iter().all(|look| look.tells()))
    };
    let pairs = looks.windows(2).filter(same);
    let each = pairs.flat_map(|pair| pair.iter().map(|look| (*look, pair[1].spacing)));
    let told = each.filter(|(look, _)| look.tells());
    let best = |look: &Look| match look.mark {
        Mark::Line(_) => look.contrast,
        Mark::Order(_) => look.height,
    };
    told.max_by(|a, b| best(a.0).total_cmp(&best(b.0)))
}

/// The angle, mean by mean of so many samples.
struct Angle {
    every: usize,
    angle: Vec<f64>,
    weight: Vec<f64>,
    /// Periods per revolution, and the angle of the revolution in the middle of each mean.
    revolution: Option<(u32, Vec<f64>)>,
}

impl Angle {
    fn new(context: &Context, every: usize) -> Self {
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
        let means = |of: &[f64]| of.chunks(every).map(mean).collect();
        let middle = |phi: &Vec<f64>| -> Vec<f64> {
            let chunks = phi.chunks(every);
            chunks.map(|chunk| chunk[chunk.len() / 2]).collect()
        };
        let revolution = context.periods_per_revolution.zip(context.phi.as_ref());
        Self {
            every,
            angle: means(&context.measured),
            weight: means(&context.weight),
            revolution: revolution.map(|(per, phi)| (per, middle(phi))),
        }
    }

    /// What a spline with such knots leaves.
    fn look(&self, spacing: f64) -> Looks {
        let apart = spacing / self.every as f64;
        let spline = Spline::new(self.angle.len(), apart, &self.weight);
        let all = spline.residual(&self.angle, &self.weight);
        let (line, left) = strongest(&all);
        let of_line = Look::new(
            spacing,
            apart,
            &all,
            &left,
            Mark::Line(line),
            height(&all, line),
        );
        let of_order = self.revolution.as_ref().and_then(|(per, phi)| {
            let (order, height, left) = highest_order(*per, phi, &all)?;
            Some(Look::new(
                spacing,
                apart,
                &all,
                &left,
                Mark::Order(order),
                height,
            ))
        });
        Looks {
            line: of_line,
            order: of_order,
        }
    }
}

/// What a spline leaves, and the strongest line and order of the revolution in it.
struct Looks {
    line: Look,
    order: Option<Look>,
}

/// What a spline leaves, and what stands out of it.
struct Look {
    /// Samples between its knots.
    spacing: f64,
    mark: Mark,
    /// Means between the knots.
    knots: f64,
    /// Rms of all that is left, radians.
    rms: f64,
    /// Power of what stands out over that of the rest.
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
    /// Of all that is left by knots `spacing` samples and `apart` means apart, and of what is left without the mark.
    fn new(spacing: f64, apart: f64, all: &[f64], left: &[f64], mark: Mark, height: f64) -> Self {
        let length = (apart / 2.0).ceil() as usize;
        let mean = |of: &[f64]| of.iter().map(|v| v * v).sum::<f64>() / of.len() as f64;
        let power: Vec<f64> = left.chunks(length).map(mean).collect();
        let usual = median(&power).max(f64::MIN_POSITIVE);
        // A corner is seen a knot's distance away.
        let near = |i: usize| i.saturating_sub(2)..(i + 3).min(power.len());
        let corners: Vec<bool> = (0..power.len())
            .map(|i| power[near(i)].iter().any(|p| *p > CORNER * usual))
            .collect();
        Self {
            spacing,
            mark,
            loudness: mean(all) / mean(left) - 1.0,
            height,
            rms: mean(all).sqrt(),
            knots: apart,
            contrast: mean(left) / usual,
            share: corners.iter().filter(|c| **c).count() as f64 / corners.len() as f64,
            corners,
            length,
        }
    }

    /// Whether there are corners, not too many, and a line beside them, or hardly anything but a line; or whether a line or an
    /// order of the revolution stands high above the rest of the spectrum.
    fn tells(&self) -> bool {
        let shows = match self.mark {
            Mark::Line(line) => {
                (self.stands_alone() || self.height > HIGH) && line * self.knots > FAST
            }
            Mark::Order(_) => self.height > HIGH_ORDER,
        };
        shows && self.share <= MOST && self.rms < SMALL
    }

    /// Whether it is a line beside corners, or hardly anything but a line.
    fn stands_alone(&self) -> bool {
        let beside = self.contrast > CONTRAST && self.loudness > LOUD;
        matches!(self.mark, Mark::Line(_)) && (beside || self.loudness > ALONE)
    }
}

/// How high a line stands in the spectrum of values over what is usual near it.
fn height(values: &[f64], line: f64) -> f64 {
    /// Lines of the spectrum on either side that are the line's own through the window, and that are near.
    const OWN: usize = 4;
    const NEAR: usize = 40;
    let n = values.len();
    let windowed = values.iter().enumerate();
    let windowed: Vec<f64> = windowed.map(|(k, v)| v * window(k, n)).collect();
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

/// Adds the vibration or cogging that only the calm stretches show: what they were looked at for.
pub(crate) fn beside(mut found: Diagnosis, calm: Diagnosis, mark: Mark) -> Diagnosis {
    let one = |f: &Finding| Mark::of(f).is_some_and(|own| own.is(mark));
    let kind = match mark {
        Mark::Line(_) => Cause::Vibration,
        Mark::Order(_) => Cause::Cogging,
    };
    if found.findings.iter().any(|f| f.cause == kind) {
        return found;
    }
    if let Some(mut finding) = calm.findings.into_iter().find(one) {
        finding.evidence += "; it shows away from the starts, stops and reversals of the drive";
        found.add(finding);
    }
    found
}
