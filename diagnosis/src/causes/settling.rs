//! What warms up: offsets or gains that go to their end as an exponential does.

use std::rc::Rc;

use super::in_time;
use super::time::drift;
use crate::causes::candidate::{Candidate, Estimate, Exact, Make, each};
use crate::drifts::warming::{COURSES, Warming};
use crate::finding::Parameter;
use crate::shapes::library::{Library, Shape};

/// How a course differs from others that are tried near it: its time constant by so much of itself, its start by so much of the recording.
const STEPS: [f64; 2] = [0.03, 0.01];

/// The change of either channel by one amplitude from one end of the recording, which ends `last` seconds after it began, to the other.
fn shapes(gain: bool, last: f64, tau: f64, start: f64, library: &mut Library) -> Vec<Shape> {
    let gone = move |t: f64| -(-(t - start).max(0.0) / tau).exp_m1();
    let all = gone(last).max(f64::MIN_POSITIVE);
    in_time(gain, move |t| gone(t) / all - 0.5, library).into()
}

/// The changes, and time constant and start, seconds, with their errors.
fn numbers(e: &Estimate) -> Vec<Parameter> {
    let mut all = each(&["change_cos", "change_sin"], "amplitude")(e);
    let error = |i: usize| e.inner_error.map_or(0.0, |error| error[i]);
    let tau = e.inner[0].exp();
    all.push(Parameter::measured("tau_s", tau, tau * error(0), "s"));
    if let Some(start) = e.inner.get(1) {
        all.push(Parameter::measured("start_s", *start, error(1), "s"));
    }
    all
}

/// With what it drifts, and from when on.
fn how(p: &[Parameter]) -> String {
    let from = p.get(3).map_or_else(
        || "from the start of the recording on".to_owned(),
        |start| format!("from {} on", start.brief()),
    );
    let tau = p[2].brief();
    format!("time as what warms up does: {from}, with a time constant of {tau}")
}

/// Offsets, or gains, that warm up from the beginning of the recording on, which ends `last` seconds later; and from some moment on.
pub(crate) fn settling(
    gain: bool,
    last: f64,
    like: Warming,
    library: &mut Library,
) -> Vec<Candidate> {
    let inner = [(like.tau * last).ln(), like.start * last];
    let steps = [STEPS[0], STEPS[1] * last];
    let make: Make = Rc::new(move |inner, library| {
        let start = inner.get(1).copied().unwrap_or(0.0);
        shapes(gain, last, inner[0].exp(), start, library)
    });
    let kinds = if like.start > 0.0 { 1..=2 } else { 1..=1 };
    let kind = |numbered: usize| {
        let inner = inner[..numbered].to_vec();
        let own = make(&inner, library);
        Candidate {
            trials: COURSES,
            exact: Some(Exact {
                make: make.clone(),
                inner,
                steps: steps[..numbered].to_vec(),
                follows: false,
            }),
            parameters: Rc::new(numbers),
            ..drift(gain, how, own)
        }
    };
    kinds.map(kind).collect()
}
