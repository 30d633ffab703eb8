//! Errors that grow with speed: delays, bandwidths, hysteresis.

use std::cell::RefCell;
use std::rc::Rc;

use rustfft::num_complex::Complex;

use super::{ACCELERATION_GAIN, Catalogue, HYSTERESIS, Modulated, modulated};
use crate::block::Block;
use crate::cause::{Candidate, Domain, Exact, Sign, each};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::{Library, Shape, Use};
use crate::trig::{Trig, channel, derivatives, normalised};

/// Share of the speed that has to change for its effects to be told from a phase error.
const CHANGE: f64 = 0.02;

/// Products of the largest speed and a time constant that are tried.
const REACHES: [f64; 5] = [0.003, 0.02, 0.1, 0.4, 1.0];

/// Scale periods of travel that ac coupling needs to be told from shapes of the angle.
const FEWEST: f64 = 6.0;

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

/// What a first-order low pass of time constant `tau` does to a channel, over `tau`: its response at the speed of the
/// moment, and the next term, with the acceleration.
fn low_pass(block: &Block, which: usize, tau: f64) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    (0..block.len())
        .map(|k| {
            let one = Complex::new(1.0, block.speed[k] * tau);
            let turn = Complex::new(0.0, block.acceleration[k] * tau * tau);
            let change = one.inv() - 1.0 + turn / (one * one * one);
            (change.re * u[k] + change.im * slope[k]) / tau
        })
        .collect()
}

/// A channel `delay` seconds later less itself, over `delay`.
fn later(block: &Block, which: usize, delay: f64) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    let pairs = block.speed.iter().zip(block.acceleration);
    pairs
        .enumerate()
        .map(|(k, (v, a))| {
            if delay == 0.0 {
                return v * slope[k];
            }
            let (sin, cos) = (v * delay + 0.5 * a * delay * delay).sin_cos();
            (u[k] * (cos - 1.0) + slope[k] * sin) / delay
        })
        .collect()
}

/// What a low pass in both channels takes from the radius, over the square of its time constant `tau2`: its response at
/// the speed that is seen, which is late too, and the next term, with the acceleration.
fn falls(block: &Block, tau2: f64) -> Vec<f64> {
    let tau = tau2.max(0.0).sqrt();
    let pairs = block.speed.iter().zip(block.acceleration);
    pairs
        .map(|(v, a)| {
            let one = 1.0 + v * v * tau2.max(0.0);
            let root = one.sqrt();
            // Free of cancellation where little is lost.
            -v * v / (root * (1.0 + root)) + v * a * tau / (root * one * one)
        })
        .collect()
}

/// What the same low pass of time constant `tau` in both channels does against a reference, over `tau`: the radius falls,
/// and the angle is late.
fn falls_behind(block: &Block, tau: f64, out: &mut [f64]) {
    let (radius, angle) = out.split_at_mut(block.len());
    for (k, v) in block.speed.iter().enumerate() {
        let x = v * tau;
        let root = (1.0 + x * x).sqrt();
        radius[k] = -v * x / (root * (1.0 + root));
        angle[k] = if x == 0.0 { -v } else { -x.atan() / tau };
    }
}

/// The direction of motion; at rest, the one in which it came. What the speed is below a small share of the largest is its
/// sign only if it goes on to more.
fn sides(context: &Context, top: f64) -> Vec<f64> {
    const REST: f64 = 0.01;
    let speed = &context.speed;
    let moves = |v: &f64| v.abs() > REST * top;
    let mut side = speed.iter().find(|v| moves(v)).map_or(1.0, |v| v.signum());
    let mut list = vec![side; speed.len()];
    for k in 0..speed.len() {
        if moves(&speed[k]) && speed[k].signum() != side {
            side = speed[k].signum();
            // It turned where the speed last was zero.
            let turned = speed[..k].iter().rposition(|v| v.signum() != side);
            list[turned.map_or(0, |t| t + 1)..k].fill(side);
        }
        list[k] = side;
    }
    list
}

/// A shape that is made anew with the size of its amount.
fn follows(inner: f64, make: impl Fn(f64, &mut Library) -> Vec<Shape> + 'static) -> Option<Exact> {
    Some(Exact {
        make: Rc::new(move |inner, library| make(inner[0], library)),
        inner: vec![inner],
        steps: vec![],
        follows: true,
    })
}

/// Numbers of the modulations.
const ODD: usize = 0;
const EVEN: usize = 1;
const SIGN: usize = 2;
const SOFT: usize = 3;
const ACCELERATION: usize = 4;

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let beta = context.ellipse.beta;
    let top = context
        .speed
        .iter()
        .fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let steepest = context.acceleration.iter();
    let top_acceleration = steepest.fold(f64::MIN_POSITIVE, |m, a| m.max(a.abs()));
    let sides = Rc::new(sides(context, top));
    let speed = Modulated(modulated(&mut catalogue.library, 5, move |block, which| {
        let by = |f: fn(f64) -> f64| block.speed.iter().map(|v| f(v / top)).collect();
        match which {
            ODD => by(|v| v),
            EVEN => by(|v| v * v),
            SIGN => sides[block.start..][..block.len()].to_vec(),
            // It takes some way, and so some speed, to turn over.
            SOFT => by(|v| v / (v * v + 0.05 * 0.05).sqrt()),
            _ => {
                let most = block.acceleration.iter();
                most.map(|a| a / top_acceleration).collect()
            }
        }
    }));
    if varies(context) {
        let orders = [ODD, EVEN, SIGN]
            .into_iter()
            .flat_map(|by| (0..=2).flat_map(move |order| speed.generic(by, order)));
        catalogue.generic(Domain::Speed, orders);
    }
    let (zero, one_) = (Trig::constant(0.0), Trig::constant(1.0));
    let scaled = |shape: Shape, by: f64| shape.scaled(by);
    // The speed times a change of one channel.
    let times =
        |which: usize, change: &Trig| scaled(speed.shape(ODD, &channel(beta, which, change)), top);
    let slope = derivatives(beta);
    let one = |name,
               shape: Shape,
               parameter: &'static [&'static str],
               unit,
               chip,
               sign: Sign,
               say: fn(f64) -> String| Candidate {
        name,
        domain: Domain::Speed,
        trials: 1.0,
        shapes: vec![shape],
        motion: false,
        id: 0,
        exact: None,
        sign,
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
            Sign::Any,
            |d| {
                format!(
                    "both channels are late against the reference by {:.3e} s",
                    d
                )
            },
        ));
        for reach in REACHES {
            let make = |tau: f64, library: &mut Library| {
                let fill = move |block: &Block, out: &mut [f64]| falls_behind(block, tau, out);
                vec![library.add(1, Use::Rows, Rc::new(fill)).both(0)]
            };
            let tau = reach / top;
            let shape = make(tau, &mut catalogue.library).swap_remove(0);
            list.push(Candidate {
                trials: REACHES.len() as f64,
                exact: follows(tau, make),
                ..one(
                    "common_bandwidth",
                    shape,
                    &["tau_s"],
                    "s",
                    Chip::CannotCorrect,
                    Sign::Positive,
                    |t| format!("both channels are late against the reference, and their amplitude falls with speed, as behind a low pass of {t:.3e} s"),
                )
            });
        }
    }
    if varies(context) {
        list.push(one(
            "channel_skew",
            times(1, &slope[1]),
            &["delay_s"],
            "s",
            Chip::Corrects,
            Sign::Any,
            |d| {
                format!(
                    "the phase error grows with speed: sin is sampled {:.3e} s later than cos",
                    d
                )
            },
        ));
        if let Some(skew) = list.last_mut() {
            skew.exact = follows(0.0, |delay, library| {
                vec![library.pair(move |block: &Block, c, s| {
                    block.channel(1, &later(block, 1, delay), c, s);
                })]
            });
        }
        for which in [0, 1] {
            for reach in REACHES {
                let tau = reach / top;
                let name: [&'static [&'static str]; 2] = [&["tau_cos_s"], &["tau_sin_s"]];
                let make = move |tau: f64, library: &mut Library| {
                    vec![library.pair(move |block: &Block, c, s| {
                        block.channel(which, &low_pass(block, which, tau), c, s);
                    })]
                };
                let shape = make(tau, &mut catalogue.library).swap_remove(0);
                let mut candidate = one(
                    "bandwidth_mismatch",
                    shape,
                    name[which],
                    "s",
                    Chip::CannotCorrect,
                    Sign::Positive,
                    |t| {
                        format!(
                            "phase and amplitude of one channel fall with speed as behind a low pass of {:.3e} s that the other does not have",
                            t
                        )
                    },
                );
                candidate.trials = 10.0;
                candidate.exact = follows(tau, make);
                list.push(candidate);
            }
        }
        let square = scaled(speed.shape(EVEN, &[one_, zero]), -0.5 * top * top);
        list.push(Candidate {
            exact: follows(0.0, |tau2, library| {
                let place = library.add(
                    1,
                    Use::Radial,
                    Rc::new(move |block, out| out.copy_from_slice(&falls(block, tau2))),
                );
                vec![place.radial(0)]
            }),
            parameters: Rc::new(|e| {
                let tau = e.x[0].max(0.0).sqrt();
                vec![Parameter::measured("tau_s", tau, e.error[0] / (2.0 * tau).max(f64::MIN_POSITIVE), "s")]
            }),
            ..one(
                "common_bandwidth",
                square,
                &["tau_s"],
                "s",
                Chip::CannotCorrect,
                Sign::Positive,
                |t| format!("the radius falls with the square of the speed, as behind a low pass of {:.3e} s in both channels", t),
            )
        });
        list.push(Candidate {
            shapes: vec![times(0, &slope[1]), times(1, &slope[0])],
            exact: Some(Exact {
                make: Rc::new(|inner, library| {
                    let delay = inner[0];
                    (0..2)
                        .map(|which| {
                            library.pair(move |block: &Block, c, s| {
                                block.channel(which, &later(block, 1 - which, -delay), c, s);
                            })
                        })
                        .collect()
                }),
                inner: vec![0.0],
                steps: vec![0.01 / top],
                follows: false,
            }),
            parameters: Rc::new(|e| {
                vec![
                    Parameter::measured("product_into_cos_s", -e.x[0], e.error[0], "s"),
                    Parameter::measured("product_into_sin_s", -e.x[1], e.error[1], "s"),
                ]
            }),
            evidence: Rc::new(|p| {
                format!("a part of the other channel arrives delayed: fraction times delay {:.3e} s into cos, {:.3e} s into sin", p[0].value, p[1].value)
            }),
            ..one("delayed_crosstalk", Shape::default(), &["product"], "s", Chip::CannotCorrect, Sign::Any, |_| String::new())
        });
    }
    let turnings: &[usize] = if reverses(context) {
        &[SIGN, SOFT]
    } else {
        &[]
    };
    for turning in turnings {
        list.push(Candidate {
            trials: turnings.len() as f64,
            shapes: [0, 1]
                .map(|which| speed.shape(*turning, &channel(beta, which, &Trig::constant(1.0))))
                .into(),
            parameters: each(&["offset_cos", "offset_sin"], "amplitude"),
            evidence: Rc::new(|p| {
                format!("the offsets change with the direction of motion by {:.4} % (cos) and {:.4} % (sin) of the amplitude", p[0].value * 200.0, p[1].value * 200.0)
            }),
            ..one(HYSTERESIS, Shape::default(), &["offset"], "amplitude", Chip::CannotCorrect, Sign::Any, |_| String::new())
        });
    }
    // A head that tilts with the acceleration is no cause of the catalogue, and must not be taken for one.
    list.push(Candidate {
        shapes: [0, 1]
            .map(|which| {
                let own = channel(beta, which, &normalised(beta)[which]);
                speed.shape(ACCELERATION, &own)
            })
            .into(),
        ..one(
            ACCELERATION_GAIN,
            Shape::default(),
            &["gain"],
            "1",
            Chip::CannotCorrect,
            Sign::Any,
            |_| String::new(),
        )
    });
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

/// What a high pass takes away, over its corner frequency in hertz.
fn high_pass(sample_rate: f64) -> impl Fn(f64, &mut Library) -> Vec<Shape> + 'static {
    move |corner, library| {
        let rate = (std::f64::consts::TAU * corner / sample_rate).clamp(0.0, 0.5);
        let states: [RefCell<(usize, f64)>; 2] = Default::default();
        let mut shapes = vec![library.pair(move |block: &Block, c, s| {
            let [cos, sin] = [0, 1].map(|which| {
                let mut lost = slow(block, which, rate, &states[which]);
                lost.iter_mut().for_each(|v| *v /= corner.max(1e-300));
                lost
            });
            block.raw(&cos, &sin, c, s);
        })];
        // The charge of either capacitor when the recording begins is anything; it leaks away.
        shapes.extend([0, 1].map(|which| {
            library.pair(move |block: &Block, c, s| {
                let left = |t: &f64| (-std::f64::consts::TAU * corner * t).exp();
                let change: Vec<f64> = block.time.iter().map(left).collect();
                block.channel(which, &change, c, s);
            })
        }));
        shapes
    }
}

/// A first-order high pass takes the slow part of the signals away.
fn ac_coupling(context: &Context, catalogue: &mut Catalogue) {
    let duration = context.samples() as f64 / context.rate;
    // Over a few periods, what leaks away is any shape of the angle.
    let way: f64 = context.speed.iter().map(|v| v.abs()).sum();
    if way / context.rate < FEWEST * std::f64::consts::TAU {
        return;
    }
    // At the lowest corner a charge leaks away along a line, as it does at any below.
    let (mut corner, mut least) = (0.03 / duration, 0.0);
    let corners = (context.rate / 30.0 / corner).log(3.0).floor().max(1.0);
    while corner < context.rate / 30.0 {
        let make = high_pass(context.rate);
        let shapes = make(corner, &mut catalogue.library);
        catalogue.candidates.push(Candidate {
            name: "ac_coupling",
            domain: Domain::Speed,
            trials: corners,
            shapes,
            motion: false,
            id: 0,
            exact: follows(corner, make).map(|e| Exact {
                steps: vec![0.01 * corner],
                ..e
            }),
            sign: Sign::Known(least),
            chip: Chip::CannotCorrect,
            parameters: Rc::new(move |e| {
                let (value, error) = match e.inner_error {
                    Some(error) => (e.inner[0], error[0]),
                    None => (e.x[0], e.error[0]),
                };
                vec![Parameter::measured("corner_hz", value, error, "Hz")]
            }),
            evidence: Rc::new(|p| {
                format!(
                    "slow parts of the signals are missing, as behind a high pass of {:.3e} Hz",
                    p[0].value
                )
            }),
        });
        least = corner;
        corner *= 3.0;
    }
}
