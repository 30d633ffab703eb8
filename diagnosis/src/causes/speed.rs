//! Errors that grow with speed: delays, bandwidths, hysteresis.

use std::cell::RefCell;
use std::rc::Rc;

use super::{Catalogue, Modulated, modulated};
use crate::block::Block;
use crate::cause::{Candidate, Domain, each};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::Shape;
use crate::trig::{Trig, channel, derivatives};

/// Share of the speed that has to change for its effects to be told from a phase error.
const CHANGE: f64 = 0.02;

/// Whether the speed changes enough to show what depends on it.
pub(crate) fn varies(context: &Context) -> bool {
    let n = context.samples() as f64;
    let mean = context.speed.iter().sum::<f64>() / n;
    let square = context.speed.iter().map(|v| v * v).sum::<f64>() / n;
    let spread = (square - mean * mean).max(0.0).sqrt();
    spread > CHANGE * square.sqrt() && square > 0.0
}

fn reverses(context: &Context) -> bool {
    let top = context.speed.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let share = |sign: f64| {
        let with = context
            .speed
            .iter()
            .filter(|v| **v * sign > 0.02 * top)
            .count();
        with as f64 / context.samples() as f64
    };
    share(1.0) > 0.01 && share(-1.0) > 0.01
}

/// What a first-order low pass of time constant `tau` takes from a channel, over `tau`.
fn low_pass(block: &Block, which: usize, tau: f64) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    (0..block.len())
        .map(|k| {
            let w = block.speed[k] * tau;
            let lost = -w * slope[k] - w * w * u[k];
            lost / (1.0 + w * w) / tau
        })
        .collect()
}

/// Numbers of the modulations.
const ODD: usize = 0;
const EVEN: usize = 1;
const SIGN: usize = 2;

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let beta = context.ellipse.beta;
    let top = context
        .speed
        .iter()
        .fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let speed = Modulated(modulated(&mut catalogue.library, 3, move |block, which| {
        let by = |f: fn(f64) -> f64| block.speed.iter().map(|v| f(v / top)).collect();
        match which {
            ODD => by(|v| v),
            EVEN => by(|v| v * v),
            _ => by(f64::signum),
        }
    }));
    if varies(context) {
        let orders = [ODD, EVEN, SIGN]
            .into_iter()
            .flat_map(|by| (0..=2).flat_map(move |order| speed.generic(by, order)));
        catalogue.generic(Domain::Speed, orders);
    }
    let (zero, one_) = (Trig::constant(0.0), Trig::constant(1.0));
    let scaled = |shape: Shape, by: f64| Shape(shape.0.iter().map(|(i, x)| (*i, x * by)).collect());
    // The speed times a change of one channel.
    let times =
        |which: usize, change: &Trig| scaled(speed.shape(ODD, &channel(beta, which, change)), top);
    let slope = derivatives(beta);
    let one = |name,
               shape: Shape,
               parameter: &'static [&'static str],
               unit,
               chip,
               positive,
               say: fn(f64) -> String| Candidate {
        name,
        domain: Domain::Speed,
        trials: 1.0,
        shapes: vec![shape],
        motion: false,
        refine: None,
        positive,
        chip,
        parameters: each(parameter, unit),
        evidence: Rc::new(move |p| say(p[0].value)),
    };
    let list = &mut catalogue.candidates;
    if context.against_reference.is_some() {
        // Late by d: the angle shown is that of d before.
        list.push(one(
            "latency",
            scaled(speed.shape(ODD, &[zero.clone(), one_.clone()]), -top),
            &["delay_s"],
            "s",
            Chip::Corrects,
            false,
            |d| {
                format!(
                    "both channels are late against the reference by {:.3e} s",
                    d
                )
            },
        ));
    }
    if varies(context) {
        list.push(one(
            "channel_skew",
            times(1, &slope[1]),
            &["delay_s"],
            "s",
            Chip::CannotCorrect,
            false,
            |d| {
                format!(
                    "the phase error grows with speed: sin is sampled {:.3e} s later than cos",
                    d
                )
            },
        ));
        for which in [0, 1] {
            for reach in [0.003, 0.02, 0.1, 0.4, 1.0] {
                let tau = reach / top;
                let name: [&'static [&'static str]; 2] = [&["tau_cos_s"], &["tau_sin_s"]];
                let shape = catalogue.library.pair(move |block: &Block, c, s| {
                    block.channel(which, &low_pass(block, which, tau), c, s);
                });
                let mut candidate = one(
                    "bandwidth_mismatch",
                    shape,
                    name[which],
                    "s",
                    Chip::CannotCorrect,
                    true,
                    |t| {
                        format!(
                            "phase and amplitude of one channel fall with speed as behind a low pass of {:.3e} s that the other does not have",
                            t
                        )
                    },
                );
                candidate.trials = 10.0;
                candidate.refine = Some(Rc::new(
                    move |block: &Block, inner: &[f64], c: &mut [f64], s: &mut [f64]| {
                        block.channel(which, &low_pass(block, which, inner[0]), c, s);
                    },
                ));
                list.push(candidate);
            }
        }
        let falls = scaled(speed.shape(EVEN, &[one_, zero]), -0.5 * top * top);
        list.push(Candidate {
            parameters: Rc::new(|e| {
                let tau = e.x[0].max(0.0).sqrt();
                vec![Parameter::measured("tau_s", tau, e.error[0] / (2.0 * tau).max(f64::MIN_POSITIVE), "s")]
            }),
            ..one(
                "common_bandwidth",
                falls,
                &["tau_s"],
                "s",
                Chip::CannotCorrect,
                true,
                |t| format!("the radius falls with the square of the speed, as behind a low pass of {:.3e} s in both channels", t),
            )
        });
        list.push(Candidate {
            shapes: vec![times(0, &slope[1]), times(1, &slope[0])],
            parameters: Rc::new(|e| {
                vec![
                    Parameter::measured("product_into_cos_s", -e.x[0], e.error[0], "s"),
                    Parameter::measured("product_into_sin_s", -e.x[1], e.error[1], "s"),
                ]
            }),
            evidence: Rc::new(|p| {
                format!("a part of the other channel arrives delayed: fraction times delay {:.3e} s into cos, {:.3e} s into sin", p[0].value, p[1].value)
            }),
            ..one("delayed_crosstalk", Shape::default(), &["product"], "s", Chip::CannotCorrect, false, |_| String::new())
        });
    }
    if reverses(context) {
        list.push(Candidate {
            shapes: [0, 1]
                .map(|which| speed.shape(SIGN, &channel(beta, which, &Trig::constant(1.0))))
                .into(),
            parameters: each(&["offset_cos", "offset_sin"], "amplitude"),
            evidence: Rc::new(|p| {
                format!("the offsets change with the direction of motion by {:.4} % (cos) and {:.4} % (sin) of the amplitude", p[0].value * 200.0, p[1].value * 200.0)
            }),
            ..one("hysteresis", Shape::default(), &["offset"], "amplitude", Chip::CannotCorrect, false, |_| String::new())
        });
    }
    ac_coupling(context, catalogue);
}

/// The slow part of a channel, block after block.
fn slow(block: &Block, which: usize, rate: f64, state: &RefCell<(usize, f64)>) -> Vec<f64> {
    let mut state = state.borrow_mut();
    if block.start != state.0 {
        *state = (block.start, 0.0);
    }
    let mut now = state.1;
    let values = block.u[which]
        .iter()
        .map(|v| {
            now += rate * (v - now);
            -now
        })
        .collect();
    *state = (block.start + block.len(), now);
    values
}

/// A first-order high pass takes the slow part of the signals away.
fn ac_coupling(context: &Context, catalogue: &mut Catalogue) {
    let duration = context.samples() as f64 / context.rate;
    let mut corner = 0.3 / duration;
    let corners = (context.rate / 30.0 / corner).log(3.0).floor().max(1.0);
    while corner < context.rate / 30.0 {
        let rate = (std::f64::consts::TAU * corner / context.rate).min(0.5);
        let states: [RefCell<(usize, f64)>; 2] = Default::default();
        let shape = catalogue.library.pair(move |block: &Block, c, s| {
            let [cos, sin] = [0, 1].map(|which| slow(block, which, rate, &states[which]));
            block.raw(&cos, &sin, c, s);
        });
        let now = corner;
        catalogue.candidates.push(Candidate {
            name: "ac_coupling",
            domain: Domain::Speed,
            trials: corners,
            shapes: vec![shape],
            motion: false,
            refine: None,
            positive: true,
            chip: Chip::CannotCorrect,
            parameters: Rc::new(move |e| {
                vec![Parameter::measured(
                    "corner_hz",
                    e.x[0] * now,
                    e.error[0] * now,
                    "Hz",
                )]
            }),
            evidence: Rc::new(|p| {
                format!(
                    "slow parts of the signals are missing, as behind a high pass of {:.3e} Hz",
                    p[0].value
                )
            }),
        });
        corner *= 3.0;
    }
}
