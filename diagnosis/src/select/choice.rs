//! Which of several large causes it is: each is looked at anew where it stands, until it has come to rest, and what they leave is compared.

use nonius_calibration::Ellipse;
use nonius_recording::Recording;

use crate::causes::candidate::Candidate;
use crate::context::Context;
use crate::finding::Cause;
use crate::model::exact::{Start, followed, look};
use crate::motion::spline::Spline;
use crate::numerics::statistics::price;
use crate::select::selection::Accepted;
use crate::select::{anew, begin};

/// Looks at a recording until what is known of it has come to rest.
const SETTLING: usize = 6;

/// Log-likelihood, what other splines and noise free make of it included, that does not tell one cause from another once both have
/// come to rest.
const ALIKE: f64 = 5.0;

/// A start whose causes have come to rest.
struct Settled {
    score: f64,
    /// The same of the radius alone, where along the circle most of what is left is the axis at work.
    of_radius: Option<f64>,
    context: Context,
    start: Start,
}

impl Settled {
    /// The cause that was tried.
    fn last(&self) -> Option<&Candidate> {
        Some(&self.start.carried.last()?.candidate)
    }

    /// Whether another that scores less is as likely. Neither a delay nor a low pass follows an axis that shakes, and what is left of that
    /// along the circle may prefer the wrong one: where the radius does not prefer the same one, they are not told apart.
    fn is_hardly_likelier_than(&self, other: &Self) -> bool {
        let domain = |s: &Self| s.last().map(|c| c.domain);
        let radius = self.of_radius.zip(other.of_radius);
        let undecided = radius.is_some_and(|(own, other)| other > own - ALIKE);
        other.score > self.score - ALIKE || undecided && domain(self) == domain(other)
    }
}

/// Looks from a start until its causes have come to rest. Amplitudes are compared with these.
fn settled(
    context: &Context,
    mut start: Start,
    recording: &Recording,
    (spacing, beside): (Option<f64>, Ellipse),
) -> Settled {
    let mut context = followed(context, &start, recording, spacing);
    let (mut score, mut of_radius) = (f64::MIN, None);
    for _ in 0..SETTLING {
        let mut carried = start.carried.clone();
        let (mut system, catalogue) = look(&context, &mut carried, recording);
        system.try_on_all();
        let mut found = begin(&mut system, &catalogue, carried);
        found.fit = system.fit_tried(found.fit.shapes);
        let left = system.residual(&found.fit).radial;
        let amplitude = log_amplitude(&context, &beside, &left);
        let halves = system.halves(&found.fit.shapes);
        // Free numbers and trials are paid for.
        let price = price(context.samples() as f64);
        let paid = |a: &Accepted| price * a.x.len() as f64 + a.candidate.trials.ln();
        let paid = found.accepted.iter().map(paid).sum::<f64>();
        score = halves.log_likelihood(&found.fit, amplitude) - paid;
        let radius = || halves.log_likelihood_of_radius(&found.fit, amplitude) - paid;
        of_radius = system.vibrates().then(radius);
        let Some(next) = anew(&system, &found) else {
            break;
        };
        start = next;
        let next = followed(&context, &start, recording, spacing);
        drop(system);
        context = next;
    }
    Settled {
        score,
        of_radius,
        context,
        start,
    }
}

/// Logarithm of the amplitude of both channels over another, each by its share of the noise that is left along the radius: of that
/// of the cosine 3/8 show with cos² and 1/8 with sin², of that of the sine the other way round.
fn log_amplitude(context: &Context, beside: &Ellipse, radial: &[f64]) -> f64 {
    let (mut with_cos, mut with_sin) = (0.0, 0.0);
    for (k, left) in radial.iter().enumerate() {
        let square = context.weight[k] * left * left;
        with_cos += square * context.cos[k].powi(2);
        with_sin += square * context.sin[k].powi(2);
    }
    let [of_cos, of_sin] =
        [3.0 * with_cos - with_sin, 3.0 * with_sin - with_cos].map(|s| s.max(0.0));
    let all = of_cos + of_sin;
    let share = if all > 0.0 { of_cos / all } else { 0.5 };
    // Of neither share more than a small part of this is known.
    let own = &context.ellipse;
    share * (own.a_c / beside.a_c).ln() + (1.0 - share) * (own.a_s / beside.a_s).ln()
}

/// Where to go on from: of several starts, the one that explains most once its causes have come to rest.
pub(crate) fn best(
    context: &Context,
    mut starts: Vec<Start>,
    recording: &Recording,
) -> Option<(Context, Vec<Accepted>)> {
    if starts.len() == 1 {
        let start = starts.remove(0);
        return Some((followed(context, &start, recording, None), start.carried));
    }
    let all: Vec<Settled> = starts
        .into_iter()
        .map(|start| settled(context, start, recording, (None, context.ellipse)))
        .collect();
    // Likelihoods of splines with other knots cannot be compared.
    let spacing = |s: &Settled| s.context.spline.as_ref().map_or(0.0, Spline::spacing);
    let common = all.iter().map(&spacing).fold(0.0, f64::max);
    let mut all: Vec<Settled> = all
        .into_iter()
        .map(|one| {
            if spacing(&one) < common {
                settled(
                    &one.context,
                    one.start,
                    recording,
                    (Some(common), context.ellipse),
                )
            } else {
                one
            }
        })
        .collect();
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut all = all.into_iter();
    let mut best = all.next()?;
    let nearly = all.filter(|other| best.is_hardly_likelier_than(other));
    let names: Vec<(Cause, Option<usize>)> = nearly
        .filter_map(|other| Some((other.last()?.name, other.last()?.order)))
        .collect();
    if let Some(last) = best.start.carried.last_mut() {
        let own = last.candidate.name;
        let alike = names.iter().find(|(name, _)| *name == own);
        last.other_order = last.other_order.or(alike.and_then(|(_, order)| *order));
        for (name, _) in names {
            if name != own && !last.confounded.contains(&name) {
                last.confounded.push(name);
            }
        }
    }
    Some((best.context, best.start.carried))
}
