//! Errors that grow with speed: delays and bandwidths.

use std::rc::Rc;

use nonius_fourier::Complex;

use super::direction;
use super::lag::{falls, falls_behind, later, low_pass};
use super::sides::directions;
use super::{Catalogue, Modulated, modulated};
use crate::causes::candidate::{Candidate, Domain, Exact, Sign, each};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::shapes::block::Block;
use crate::shapes::library::{Library, Shape, Use};
use crate::shapes::trig::{Trig, channel, derivatives};

/// Share of the speed that has to change for its effects to be told from a phase error.
const CHANGE: f64 = 5e-4;
/// Share that shows most of them.
const MUCH: f64 = 0.02;

/// Products of the largest speed and a time constant that are tried.
const REACHES: [f64; 5] = [0.003, 0.02, 0.1, 0.4, 1.0];

/// Share of the speed that changes, rms.
fn change(context: &Context) -> f64 {
    let n = context.samples() as f64;
    let mean = context.speed.iter().sum::<f64>() / n;
    let square = context.speed.iter().map(|v| v * v).sum::<f64>() / n;
    if square > 0.0 {
        ((square - mean * mean).max(0.0) / square).sqrt()
    } else {
        0.0
    }
}

/// Whether the speed changes enough to show what depends on it.
pub(crate) fn varies(context: &Context) -> bool {
    change(context) > CHANGE
}

/// Whether it changes so much that most of what depends on it is seen.
pub(crate) fn varies_much(context: &Context) -> bool {
    change(context) > MUCH
}

/// Whether a recording can show what low passes and delays alike in both channels do. Against a reference, what a latency leaves where
/// the speed hardly changes looks like them; not like one channel that is late by itself.
pub(crate) fn both_can_be_shown(context: &Context) -> bool {
    varies(context) && (context.against_reference.is_none() || varies_much(context))
}

/// A shape that is made anew with the size of its amount.
pub(super) fn follows(
    inner: f64,
    make: impl Fn(f64, &mut Library) -> Vec<Shape> + 'static,
) -> Option<Exact> {
    Some(Exact {
        make: Rc::new(move |inner, library| make(inner[0], library)),
        inner: vec![inner],
        steps: vec![],
        follows: true,
    })
}

/// Numbers of the modulations: the speed, its square, its sign, the same turning over softly, the acceleration; and the sign where the
/// scale came the other way to the rest at which a recording begins.
const ODD: usize = 0;
const EVEN: usize = 1;
pub(super) const SIGN: usize = 2;
pub(super) const SOFT: usize = 3;
pub(super) const ACCELERATION: usize = 4;
pub(super) const STARTED_BACK: usize = 5;

/// What causes of speed are made of.
pub(super) struct Speed {
    pub(super) by: Modulated,
    /// Phase error of the recording's ellipse, radians.
    pub(super) beta: f64,
    /// Largest speed, radians per second.
    top: f64,
    /// The recording begins at rest, to which the scale may have come the other way than it goes on.
    pub(super) may_have_started_back: bool,
    /// Nothing is known of the channels but that they are sines.
    sines: bool,
}

impl Speed {
    fn new(context: &Context, library: &mut Library) -> Self {
        let top = context.top_speed();
        let mut acceleration = context.drive_acceleration();
        let steepest = acceleration.iter().map(|a| a.abs());
        let steepest = steepest.fold(f64::MIN_POSITIVE, f64::max);
        acceleration.iter_mut().for_each(|a| *a /= steepest);
        let directions = Rc::new(directions(context));
        let may_have_started_back = directions.len() > 1;
        let count = STARTED_BACK + usize::from(may_have_started_back);
        let functions = move |block: &Block, which| {
            let by = |f: fn(f64) -> f64| block.speed.iter().map(|v| f(v / top)).collect();
            match which {
                ODD => by(|v| v),
                EVEN => by(|v| v * v),
                SIGN => directions[0][block.start..][..block.len()].to_vec(),
                STARTED_BACK => directions[1][block.start..][..block.len()].to_vec(),
                // It takes some way, and so some speed, to turn over.
                SOFT => by(|v| v / (v * v + 0.05 * 0.05).sqrt()),
                _ => acceleration[block.start..][..block.len()].to_vec(),
            }
        };
        Self {
            by: Modulated(modulated(library, count, functions)),
            beta: context.ellipse.beta,
            top,
            may_have_started_back,
            sines: context.periodic.iter().all(Trig::is_constant),
        }
    }

    /// The time constants on the grid, seconds, each with the least that it stands for. It is known twice, by how much there is of it and
    /// by its law; a little of a long one is none.
    fn time_constants(&self) -> impl Iterator<Item = (f64, f64)> {
        let least = std::iter::once(0.0).chain(REACHES);
        let top = self.top;
        REACHES
            .into_iter()
            .zip(least)
            .map(move |(reach, least)| (reach / top, least / top))
    }

    /// The speed times a change of one channel.
    fn times(&self, which: usize, change: &Trig) -> Shape {
        let shape = self.by.shape(ODD, &channel(self.beta, which, change));
        shape.scaled(self.top)
    }
}

/// A cause of this domain, of which nothing but shapes and parameters is special.
pub(super) fn cause(
    name: Cause,
    shapes: Vec<Shape>,
    parameters: &'static [&'static str],
    unit: &'static str,
) -> Candidate {
    Candidate {
        parameters: each(parameters, unit),
        ..Candidate::new(name, Domain::Speed, shapes)
    }
}

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let speed = Speed::new(context, &mut catalogue.library);
    let both = both_can_be_shown(context);
    if both {
        let orders = [ODD, EVEN, SIGN]
            .into_iter()
            .flat_map(|by| (0..=2).flat_map(move |order| speed.by.generic(by, order)));
        catalogue.generic(Domain::Speed, orders);
    }
    let mut list = vec![];
    if context.against_reference.is_some() {
        list.push(latency(&speed));
        list.extend(late_bandwidths(&speed, &mut catalogue.library));
    }
    if varies(context) {
        list.push(skew(&speed, &mut catalogue.library));
        list.extend(mismatches(&speed, &mut catalogue.library));
    }
    if both {
        list.push(common_bandwidth(&speed));
        list.push(crosstalk(&speed, &mut catalogue.library));
    }
    list.extend(direction::hysteresis(context, &speed));
    list.push(direction::tilt(&speed));
    catalogue.candidates.extend(list);
}

/// A time constant and the corner that belongs to it.
fn time_constant(tau: &Parameter) -> String {
    let corner = 1.0 / (std::f64::consts::TAU * tau.value);
    let share = tau.std_error / tau.value;
    let corner = Parameter::measured("corner_hz", corner, corner * share, "Hz");
    format!(
        "a time constant of {} (corner at {})",
        tau.brief(),
        corner.brief()
    )
}

/// Late by d: the angle shown is that of d before.
fn latency(speed: &Speed) -> Candidate {
    let angle = [Trig::constant(0.0), Trig::constant(1.0)];
    let shape = speed.by.shape(ODD, &angle).scaled(-speed.top);
    Candidate {
        evidence: Rc::new(|p| format!("both channels lag the reference by {}", p[0].brief())),
        ..cause(Cause::Latency, vec![shape], &["delay_s"], "s")
    }
}

/// A low pass in both channels, seen against a reference.
fn late_bandwidths(speed: &Speed, library: &mut Library) -> Vec<Candidate> {
    let one = |(tau, least): (f64, f64)| {
        let make = |tau: f64, library: &mut Library| {
            let fill = move |block: &Block, out: &mut [f64]| falls_behind(block, tau, out);
            vec![library.add(1, Use::Rows, Rc::new(fill)).both(0)]
        };
        let shapes = make(tau, library);
        Candidate {
            trials: REACHES.len() as f64,
            exact: follows(tau, make),
            sign: Sign::Known(least),
            factor: Some(|less, angle| Complex::from_polar(1.0 + less, angle)),
            evidence: Rc::new(|p| {
                format!(
                    "both channels lag the reference and lose amplitude with speed, as behind a low pass with {}",
                    time_constant(&p[0])
                )
            }),
            ..cause(Cause::CommonBandwidth, shapes, &["tau_s"], "s")
        }
    };
    speed.time_constants().map(one).collect()
}

fn skew(speed: &Speed, library: &mut Library) -> Candidate {
    let make = |delay, library: &mut Library| {
        vec![library.pair(move |block: &Block, c, s| {
            block.channel(1, &later(block, 1, delay), c, s);
        })]
    };
    let shapes = if speed.sines {
        vec![speed.times(1, &derivatives(speed.beta)[1])]
    } else {
        make(0.0, library)
    };
    Candidate {
        chip: Chip::Corrects,
        exact: follows(0.0, make),
        evidence: Rc::new(|p| {
            let (late, [first, second]) = if p[0].value < 0.0 {
                (-1.0, ["sin", "cos"])
            } else {
                (1.0, ["cos", "sin"])
            };
            let delay = p[0].times(late).brief();
            format!(
                "the phase error grows in proportion to speed, as if {second} were sampled {delay} after {first}"
            )
        }),
        ..cause(Cause::ChannelSkew, shapes, &["delay_s"], "s")
    }
}

/// A low pass in one channel.
fn mismatches(speed: &Speed, library: &mut Library) -> Vec<Candidate> {
    let names: [&'static [&'static str]; 2] = [&["tau_cos_s"], &["tau_sin_s"]];
    let mut one = |which: usize, (tau, least): (f64, f64)| {
        let make = move |tau: f64, library: &mut Library| {
            vec![library.pair(move |block: &Block, c, s| {
                block.channel(which, &low_pass(block, which, tau), c, s);
            })]
        };
        let shapes = make(tau, library);
        Candidate {
            trials: (2 * REACHES.len()) as f64,
            exact: follows(tau, make),
            sign: Sign::Known(least),
            evidence: Rc::new(move |p| {
                let [own, other] = [["cos", "sin"], ["sin", "cos"]][which];
                format!(
                    "{own} loses phase and amplitude with speed, as behind a low pass with {} that {other} does not have",
                    time_constant(&p[0])
                )
            }),
            ..cause(Cause::BandwidthMismatch, shapes, names[which], "s")
        }
    };
    let all = [0, 1]
        .into_iter()
        .flat_map(|which| speed.time_constants().map(move |tau| (which, tau)));
    all.map(|(which, tau)| one(which, tau)).collect()
}

/// A low pass in both channels, seen in the radius.
fn common_bandwidth(speed: &Speed) -> Candidate {
    let radius = [Trig::constant(1.0), Trig::constant(0.0)];
    let square = speed.by.shape(EVEN, &radius);
    Candidate {
        exact: follows(0.0, |tau2, library| {
            let fill = move |block: &Block, out: &mut [f64]| {
                out.copy_from_slice(&falls(block, tau2));
            };
            vec![library.add(1, Use::Radial, Rc::new(fill)).radial(0)]
        }),
        sign: Sign::Positive,
        parameters: Rc::new(|e| {
            let tau = e.x[0].max(0.0).sqrt();
            let error = e.error[0] / (2.0 * tau).max(f64::MIN_POSITIVE);
            vec![Parameter::measured("tau_s", tau, error, "s")]
        }),
        evidence: Rc::new(|p| {
            format!(
                "the amplitude of both channels falls with the square of the speed, as behind a low pass with {}",
                time_constant(&p[0])
            )
        }),
        ..cause(
            Cause::CommonBandwidth,
            vec![square.scaled(-0.5 * speed.top * speed.top)],
            &[],
            "s",
        )
    }
}

fn crosstalk(speed: &Speed, library: &mut Library) -> Candidate {
    let make = |inner: &[f64], library: &mut Library| {
        let delay = inner[0];
        let into = |which: usize| {
            library.pair(move |block: &Block, c, s| {
                block.channel(which, &later(block, 1 - which, -delay), c, s);
            })
        };
        [0, 1].map(into).into()
    };
    let slope = derivatives(speed.beta);
    let shapes = if speed.sines {
        vec![speed.times(0, &slope[1]), speed.times(1, &slope[0])]
    } else {
        make(&[0.0], library)
    };
    Candidate {
        exact: Some(Exact {
            make: Rc::new(make),
            inner: vec![0.0],
            steps: vec![0.01 / speed.top],
            follows: false,
        }),
        parameters: Rc::new(|e| {
            let product = |name, i: usize| Parameter::measured(name, -e.x[i], e.error[i], "s");
            vec![
                product("product_into_cos_s", 0),
                product("product_into_sin_s", 1),
            ]
        }),
        evidence: Rc::new(|p| {
            format!(
                "a delayed fraction of each channel appears in the other: fraction times delay is {} into cos and {} into sin",
                p[0].brief(),
                p[1].brief()
            )
        }),
        ..cause(Cause::DelayedCrosstalk, shapes, &[], "s")
    }
}
