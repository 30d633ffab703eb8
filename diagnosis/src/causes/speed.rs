//! Errors that grow with speed: delays, bandwidths, hysteresis.

use crate::cause::{Candidate, Domain, channel, derivatives, each, normalised, raw};
use crate::column::Shape;
use crate::context::Context;
use crate::finding::{Chip, Parameter};

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
fn low_pass(context: &Context, which: usize, tau: f64) -> Vec<f64> {
    let (u, slope) = (normalised(context), derivatives(context));
    (0..context.samples())
        .map(|k| {
            let w = context.speed[k] * tau;
            let lost = -w * slope[which][k] - w * w * u[which][k];
            lost / (1.0 + w * w) / tau
        })
        .collect()
}

pub(crate) fn candidates(context: &Context) -> Vec<Candidate> {
    let mut list = vec![];
    let v = &context.speed;
    let slope = derivatives(context);
    let times = |f: &[f64]| -> Vec<f64> { f.iter().zip(v).map(|(f, v)| f * v).collect() };
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
        evidence: Box::new(move |p| say(p[0].value)),
    };
    if let Some(reference) = &context.against_reference {
        let _ = reference;
        // Late by d: the angle shown is that of d before.
        let late: Vec<f64> = v.iter().map(|v| -v).collect();
        list.push(one(
            "latency",
            Shape::tangential(&late, &context.cos, &context.sin),
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
            channel(context, 1, times(&slope[1])),
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
        let top = v.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
        for which in [0, 1] {
            for reach in [0.003, 0.02, 0.1, 0.4, 1.0] {
                let tau = reach / top;
                let name: [&'static [&'static str]; 2] = [&["tau_cos_s"], &["tau_sin_s"]];
                let mut candidate = one(
                    "bandwidth_mismatch",
                    channel(context, which, low_pass(context, which, tau)),
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
                candidate.refine = Some(Box::new(move |context, x| {
                    vec![channel(context, which, low_pass(context, which, x[0]))]
                }));
                list.push(candidate);
            }
        }
        let falls: Vec<f64> = v.iter().map(|v| -0.5 * v * v).collect();
        list.push(Candidate {
            parameters: Box::new(|e| {
                let tau = e.x[0].max(0.0).sqrt();
                vec![Parameter::measured("tau_s", tau, e.error[0] / (2.0 * tau).max(f64::MIN_POSITIVE), "s")]
            }),
            ..one(
                "common_bandwidth",
                Shape::radial(&falls, &context.cos, &context.sin),
                &["tau_s"],
                "s",
                Chip::CannotCorrect,
                true,
                |t| format!("the radius falls with the square of the speed, as behind a low pass of {:.3e} s in both channels", t),
            )
        });
        list.push(Candidate {
            shapes: vec![channel(context, 0, times(&slope[1])), channel(context, 1, times(&slope[0]))],
            parameters: Box::new(|e| {
                vec![
                    Parameter::measured("product_into_cos_s", -e.x[0], e.error[0], "s"),
                    Parameter::measured("product_into_sin_s", -e.x[1], e.error[1], "s"),
                ]
            }),
            evidence: Box::new(|p| {
                format!("a part of the other channel arrives delayed: fraction times delay {:.3e} s into cos, {:.3e} s into sin", p[0].value, p[1].value)
            }),
            ..one("delayed_crosstalk", Shape::zero(0), &["product"], "s", Chip::CannotCorrect, false, |_| String::new())
        });
    }
    if reverses(context) {
        let sign: Vec<f64> = v.iter().map(|v| v.signum()).collect();
        list.push(Candidate {
            shapes: vec![channel(context, 0, sign.clone()), channel(context, 1, sign)],
            parameters: each(&["offset_cos", "offset_sin"], "amplitude"),
            evidence: Box::new(|p| {
                format!("the offsets change with the direction of motion by {:.4} % (cos) and {:.4} % (sin) of the amplitude", p[0].value * 200.0, p[1].value * 200.0)
            }),
            ..one("hysteresis", Shape::zero(0), &["offset"], "amplitude", Chip::CannotCorrect, false, |_| String::new())
        });
    }
    list.extend(ac_coupling(context));
    list
}

/// A first-order high pass takes the slow part of the signals away.
fn ac_coupling(context: &Context) -> Vec<Candidate> {
    let u = normalised(context);
    let duration = context.samples() as f64 / context.rate;
    let mut list = vec![];
    let mut corner = 0.3 / duration;
    let corners = (context.rate / 30.0 / corner).log(3.0).floor().max(1.0);
    while corner < context.rate / 30.0 {
        let rate = (std::f64::consts::TAU * corner / context.rate).min(0.5);
        let slow = |which: usize| -> Vec<f64> {
            let mut state = 0.0;
            u[which]
                .iter()
                .map(|v| {
                    state += rate * (v - state);
                    -state
                })
                .collect()
        };
        let now = corner;
        list.push(Candidate {
            name: "ac_coupling",
            domain: Domain::Speed,
            trials: corners,
            shapes: vec![raw(context, slow(0), slow(1))],
            motion: false,
            refine: None,
            positive: true,
            chip: Chip::CannotCorrect,
            parameters: Box::new(move |e| {
                vec![Parameter::measured(
                    "corner_hz",
                    e.x[0] * now,
                    e.error[0] * now,
                    "Hz",
                )]
            }),
            evidence: Box::new(|p| {
                format!(
                    "slow parts of the signals are missing, as behind a high pass of {:.3e} Hz",
                    p[0].value
                )
            }),
        });
        corner *= 3.0;
    }
    list
}
