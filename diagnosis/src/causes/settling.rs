//! What warms up: offsets or gains that go to their end as an exponential does.

use std::rc::Rc;

use crate::block::Block;
use crate::cause::{Candidate, Domain, Estimate, Exact, Make};
use crate::finding::{Chip, Parameter};
use crate::library::{Library, Shape, Use};
use crate::warming::{COURSES, Warming};

/// How a course differs from others that are tried near it: its time constant by so much of itself, its start by so much of the recording.
const STEPS: [f64; 2] = [0.03, 0.01];

/// The change of either channel by one amplitude from one end of the recording, which ends `last` seconds after it began, to the other.
fn shapes(gain: bool, last: f64, tau: f64, start: f64, library: &mut Library) -> Vec<Shape> {
    let pairs = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let gone = |t: f64| -(-(t - start).max(0.0) / tau).exp_m1();
        let all = gone(last).max(f64::MIN_POSITIVE);
        let course: Vec<f64> = block.time.iter().map(|t| gone(*t) / all - 0.5).collect();
        let (c, s) = out.split_at_mut(2 * n);
        for (which, (c, s)) in c.chunks_mut(n).zip(s.chunks_mut(n)).enumerate() {
            if gain {
                let changes = course.iter().zip(block.u[which]).map(|(x, u)| x * u);
                block.channel(which, &changes.collect::<Vec<f64>>(), c, s);
            } else {
                block.channel(which, &course, c, s);
            }
        }
    };
    let place = library.add(2, Use::Pairs, Rc::new(pairs));
    [0, 1].map(|which| place.both(which)).into()
}

/// Time constant and start, seconds, with their errors.
fn places(e: &Estimate) -> Vec<Parameter> {
    let error = |i: usize| e.inner_error.map_or(0.0, |error| error[i]);
    let tau = e.inner[0].exp();
    let mut all = vec![Parameter::measured("tau_s", tau, tau * error(0), "s")];
    if let Some(start) = e.inner.get(1) {
        all.push(Parameter::measured("start_s", *start, error(1), "s"));
    }
    all
}

/// Offsets, or gains, that warm up from the beginning of the recording on, which ends `last` seconds later; and from some moment on.
pub(crate) fn settling(
    gain: bool,
    last: f64,
    like: Warming,
    library: &mut Library,
) -> Vec<Candidate> {
    let name = if gain { "gain_drift" } else { "offset_drift" };
    let inner = [(like.tau * last).ln(), like.start * last];
    let steps = [STEPS[0], STEPS[1] * last];
    let kinds = if like.start > 0.0 { 1..=2 } else { 1..=1 };
    let kind = |numbers: usize| {
        let make: Make = Rc::new(move |inner, library| {
            let start = inner.get(1).copied().unwrap_or(0.0);
            shapes(gain, last, inner[0].exp(), start, library)
        });
        let inner = inner[..numbers].to_vec();
        let own = make(&inner, library);
        Candidate {
            trials: COURSES,
            chip: Chip::Corrects,
            exact: Some(Exact {
                make,
                inner,
                steps: steps[..numbers].to_vec(),
                follows: false,
            }),
            parameters: Rc::new(|e| {
                let changes = ["change_cos", "change_sin"].into_iter();
                let measured = changes.zip(e.x.iter().zip(e.error));
                let changes = measured
                    .map(|(name, (x, error))| Parameter::measured(name, *x, *error, "amplitude"));
                changes.chain(places(e)).collect()
            }),
            evidence: Rc::new(move |p| {
                let what = if gain { "gains" } else { "offsets" };
                let of = if gain { "" } else { " of the amplitude" };
                let from = p.get(3).map_or_else(
                    || "from the start of the recording on".to_owned(),
                    |start| format!("from {} on", start.brief()),
                );
                format!(
                    "the {what} drift with time as what warms up does: {from}, with a time constant of {}, they change by {} (cos) and {} (sin){of}",
                    p[2].brief(),
                    p[0].brief(),
                    p[1].brief()
                )
            }),
            ..Candidate::new(name, Domain::Time, own)
        }
    };
    kinds.map(kind).collect()
}
