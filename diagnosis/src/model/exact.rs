//! Large effects: the recording is looked at anew where a cause stands.
//!
//! Shapes are tangents. Where a cause is large, its second order is above the noise and would be given the name of
//! something else: then what it does is taken off the signals themselves, the angle followed again, and the tangents
//! made there.

use nonius_calibration::Ellipse;
use nonius_recording::Recording;

use crate::causes::Catalogue;
use crate::context::{Context, unwrapped};
use crate::model::known::{effects, periodic};
use crate::model::{Fit, System, above_motion};
use crate::motion::spline::Spline;
use crate::select::selection::Accepted;
use crate::shapes::library::Row;

/// Samples that are enough to find what is large, and to see the colour of the noise.
const ENOUGH: usize = 25_000;
/// Detection SNR of a remainder from which on a recording is looked at anew before anything else can be named for it.
pub(crate) const NAMED: f64 = 3.0;
/// The same once the search is at its end.
pub(crate) const SEEN: f64 = 1.0;
/// The same once it was looked at anew: below, estimates are right to a part of their errors.
const SETTLED: f64 = 0.3;
/// Times that the angle is followed anew with the same amounts; most times where something turns the pair that may be large.
const FOLLOWED: (usize, usize) = (3, 20);
/// Change of the angle, radians rms, below which it has come to rest.
const STILL: f64 = 1e-5;

/// What a cause does, along the radius and along the circle, where functions are tried.
fn effect(system: &System, amounts: &[(usize, f64)]) -> [Vec<f64>; 2] {
    [Row::Radial, Row::Tangential].map(|row| system.samples.sum(amounts, row, system.tried()))
}

/// Detection SNR of the product of two effects, where functions are tried: what second order leaves.
fn product(system: &System, a: &[Vec<f64>; 2], b: &[Vec<f64>; 2]) -> f64 {
    let square = |e: &[Vec<f64>; 2], k: usize| e[0][k].powi(2) + e[1][k].powi(2);
    let sum: f64 = (0..system.context.samples())
        .map(|k| system.context.weight[k] * square(a, k) * square(b, k))
        .sum();
    sum.sqrt() / system.noise()
}

/// Whether tangents do for causes of these amounts: the difference to where they were made leaves nothing that is seen,
/// and for causes that are not known yet nothing of a detection SNR of `least`.
pub(crate) fn tangents_do(system: &System, fit: &Fit, accepted: &[Accepted], least: f64) -> bool {
    let (mut middle, mut moved, mut moved_known) = (vec![], vec![], vec![]);
    for one in accepted {
        let known = one.is_taken_off();
        let x = &fit.solution.x[one.range()];
        for ((shape, x), x0) in one.candidate.shapes.iter().zip(x).zip(&one.x) {
            // ½ x² less what the tangent at x₀ has of it: (x − x₀) times the middle of both.
            middle.extend(shape.scaled(0.5 * (x + x0)).0);
            let by = shape.scaled(x - x0).0;
            if known {
                moved_known.extend(by);
            } else {
                moved.extend(by);
            }
        }
    }
    let middle = effect(system, &middle);
    let seen = |moved: &[(usize, f64)], every: usize, least: f64| {
        let left = || product(system, &middle, &effect(system, moved));
        !moved.is_empty() && left() * (every as f64).sqrt() > least
    };
    // Amounts that all samples gave, a part of them gives with a larger error: that is not to be seen in it.
    !seen(&moved, system.tried(), least) && !seen(&moved_known, 1, SETTLED)
}

/// What is known of a recording: the ellipse, and causes with their amounts.
#[derive(Clone)]
pub(crate) struct Start {
    ellipse: Ellipse,
    pub(crate) carried: Vec<Accepted>,
}

impl Start {
    /// What is off the signals of a context, but for these causes, whose amounts are known.
    pub(crate) fn of(context: &Context, carried: Vec<Accepted>) -> Self {
        Self {
            ellipse: context.ellipse,
            carried,
        }
    }
}

/// Detection SNR of the product of what two causes do that are taken off: what one does to the other.
pub(crate) fn seen_together(system: &System, a: &Accepted, b: &Accepted) -> f64 {
    let [a, b] = [a, b].map(|one| effect(system, &one.amounts()));
    product(system, &a, &b) * (system.tried() as f64).sqrt()
}

/// What a fit knows.
pub(crate) fn start(system: &System, fit: &Fit, accepted: &[Accepted]) -> Start {
    let mut carried = accepted.to_vec();
    let off = &fit.solution.x;
    for one in &mut carried {
        one.x = fit.solution.x[one.range()].to_vec();
        if one.candidate.adds.is_some() {
            // Of the amplitudes that were: half of them of the cosine's.
            let half = one.x.len() / 2;
            let (of_cos, of_sin) = one.x.split_at_mut(half);
            of_cos.iter_mut().for_each(|x| *x /= 1.0 + off[0]);
            of_sin.iter_mut().for_each(|x| *x /= 1.0 + off[2]);
        }
        let amount = one.x.first().copied();
        if let Some(exact) = one
            .candidate
            .exact
            .as_mut()
            .filter(|e| e.follows && e.steps.is_empty())
        {
            exact.inner = amount.into_iter().collect();
        }
    }
    Start {
        ellipse: ellipse(&system.context.ellipse, off),
        carried,
    }
}

/// A context in which this is off the signals, and the angle followed without it, by a spline of the given spacing of
/// knots or of its own choice; where only what is calm counts, by the one that it has.
pub(crate) fn followed(
    context: &Context,
    start: &Start,
    recording: &Recording,
    spacing: Option<f64>,
) -> Context {
    let mut context = context.clone();
    let reference = recording.reference_rad.as_deref();
    let turned = start.carried.iter().any(|a| a.candidate.factor.is_some());
    let most = if turned { FOLLOWED.1 } else { FOLLOWED.0 };
    for round in 0..most {
        let before = (round >= FOLLOWED.0).then(|| context.measured.clone());
        context.periodic = periodic(&context, &start.carried);
        let known = effects(&context, &mut start.carried.clone(), reference.is_some());
        // Closer knots may have been needed for what is known now.
        if round == 0 && !context.calm {
            context.spline = spacing.map(|s| Spline::new(context.samples(), s, &context.weight));
            context.finer = context.finer.filter(|_| spacing.is_some());
        }
        context.without(start.ellipse, known, reference);
        // What is large is taken off at an angle that it has turned itself.
        if before.is_some_and(|before| context.moved_since(&before) < STILL) {
            break;
        }
    }
    context
}

/// Of so many blocks of samples one is enough at first.
pub(crate) fn every(samples: usize) -> usize {
    (samples / ENOUGH).max(1)
}

/// The functions and sums of a context, the causes that are known among them; for a long recording, of a part of it.
pub(crate) fn look<'a>(
    context: &'a Context,
    carried: &mut [Accepted],
    recording: &Recording,
) -> (System<'a>, Catalogue) {
    let reference = recording.reference_rad.as_ref();
    let motion = reference.map(|r| above_motion(context, &unwrapped(r.clone())));
    let mut catalogue = Catalogue::new(context, motion.is_some());
    enter(carried, &mut catalogue);
    let counts: f64 = context.weight.iter().sum();
    let every = every(counts as usize);
    let system = System::new(context, motion, &mut catalogue, carried, every);
    (system, catalogue)
}

/// Gives causes their shapes in another catalogue; the ones that it does not hold are left out by their lack of shapes.
pub(crate) fn enter(carried: &mut [Accepted], catalogue: &mut Catalogue) {
    for one in carried {
        let candidate = &mut one.candidate;
        candidate.shapes = match &candidate.exact {
            Some(exact) => (exact.make)(&exact.inner, &mut catalogue.library),
            None => catalogue
                .cause(candidate.name, candidate.id)
                .map_or_else(Vec::new, |c| c.shapes.clone()),
        };
    }
}

/// The ellipse with what its five parameters were found to be off: cos into c, 1 into c, sin into s, 1 into s, cos into s.
pub(crate) fn ellipse(e: &Ellipse, off: &[f64]) -> Ellipse {
    let [c, one_c, s, one_s, cross] = [off[0], off[1], off[2], off[3], off[4]];
    let (sin, cos) = e.beta.sin_cos();
    // y_s = a_s (s cos β − c sin β) + b_s with c and s as they are: a sum of sin α, cos α and 1.
    let along = e.a_s * (1.0 + s) * cos;
    let across = e.a_s * ((1.0 + c) * sin - cross * cos);
    Ellipse {
        a_c: e.a_c * (1.0 + c),
        b_c: e.b_c + e.a_c * one_c,
        a_s: along.hypot(across),
        b_s: e.b_s + e.a_s * (one_s * cos - one_c * sin),
        beta: across.atan2(along),
    }
}
