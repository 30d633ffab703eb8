//! Static errors of a channel: they repeat with the scale period.

use std::rc::Rc;

use super::{Catalogue, ORDERS};
use nonius_quantity::ordinal;

use crate::causes::candidate::{Adds, Candidate, Domain, Estimate, Exact, Sign, each, polar};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::shapes::block::Block;
use crate::shapes::library::{Library, Place, Shape, Use};
use crate::shapes::trig::{Trig, normalised, raw};

/// Orders of the scale period that have a name.
pub(crate) const HARMONICS: std::ops::RangeInclusive<usize> = 2..=7;
const THRESHOLDS: [f64; 7] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95];

/// How far a threshold may be off its grid.
const GRID: f64 = 0.05;

/// Rails at which the signals saturate.
#[derive(Clone, Copy, PartialEq)]
enum Rails {
    /// All, alike.
    Both,
    Upper,
    Lower,
    /// All, each at its own rate.
    Each,
}

impl Rails {
    const ALL: [Self; 4] = [Self::Both, Self::Upper, Self::Lower, Self::Each];

    /// What sentences call them.
    fn words(self) -> &'static str {
        match self {
            Self::Both => "both rails",
            Self::Upper => "the upper rail",
            Self::Lower => "the lower rail",
            Self::Each => "the rails, each at its own rate",
        }
    }

    /// Their shapes, of each channel's upper and lower rail.
    fn shapes(self, r: &[Shape]) -> Vec<Shape> {
        match self {
            Self::Both => vec![r[0].plus(&r[2]).plus(&r[1].plus(&r[3]))],
            Self::Upper => vec![r[0].plus(&r[2])],
            Self::Lower => vec![r[1].plus(&r[3])],
            Self::Each => r.to_vec(),
        }
    }

    /// Compressions of single rails, as parameters.
    fn single(self, e: &Estimate) -> Vec<Parameter> {
        let one = |rail: &str, x: f64, error: f64| {
            Parameter::measured(&format!("compression_{rail}"), x, error, "1")
        };
        match self {
            Self::Both => vec![],
            Self::Upper => vec![one("lower", 0.0, 0.0)],
            Self::Lower => vec![one("upper", 0.0, 0.0)],
            Self::Each => {
                let names = ["cos_upper", "cos_lower", "sin_upper", "sin_lower"];
                let rails = names.iter().zip(e.x).zip(e.error);
                let rails = rails.map(|((name, x), error)| one(name, *x, *error));
                rails.collect()
            }
        }
    }
}

/// What is beyond a threshold, in amplitudes: cos above, cos below, sin above, sin below.
fn rails(threshold: f64, library: &mut Library) -> Vec<Shape> {
    let rail = |i: usize| {
        let (which, sign) = (i / 2, if i.is_multiple_of(2) { 1.0 } else { -1.0 });
        library.pair(move |block: &Block, c, s| {
            let over = |v: &f64| -(v * sign - threshold).max(0.0) * sign;
            let change: Vec<f64> = block.u[which].iter().map(over).collect();
            block.channel(which, &change, c, s);
        })
    };
    (0..4).map(rail).collect()
}

/// What a compression does beyond its threshold.
fn loses(compression: &Parameter, at_most: bool) -> String {
    /// Standard errors by which a slope may be off zero and be none.
    const NEAR: f64 = 3.0;
    if compression.value > 1.0 - NEAR * compression.std_error.max(0.005) {
        return "they are clipped".into();
    }
    let most = if at_most { "up to " } else { "" };
    format!("the slope is {most}{} lower", compression.brief())
}

/// A power of each channel, by its amount.
fn powers(n: usize) -> Adds {
    Rc::new(move |beta, x| {
        let u = normalised(beta);
        std::array::from_fn(|which| u[which].power(n).scaled(x[which]))
    })
}

/// Cosine and sine of an order, by their amounts in each channel.
fn waves(order: usize) -> Adds {
    Rc::new(move |_, x| {
        std::array::from_fn(|which| {
            let [cos, sin] = [x[2 * which], x[2 * which + 1]];
            let wave = Trig::cos(order, 0.0).scaled(cos);
            wave.plus(&Trig::sin(order, 0.0).scaled(sin))
        })
    })
}

/// Whether amounts of a second harmonic, of cosine and sine in either channel, are those of a circle that is drawn twice a period. Beside
/// offsets that is a motion of the axis once a period, and no sensor draws a large one: its channels have harmonics of their own. Where the
/// axis vibrates, a third harmonic may be one, too: beside other gains and phase, a motion twice a period.
pub(crate) fn is_a_circle(candidate: &Candidate, x: &[f64], vibrates: bool) -> bool {
    /// In amplitudes: what is smaller moves no position far.
    const LARGE: f64 = 0.02;
    /// So many times as large as the circle that is drawn the other way, which the radius sees.
    const TIMES: f64 = 10.0;
    if candidate.order != Some(2) && !(vibrates && candidate.order == Some(3)) {
        return false;
    }
    let turns = (x[0] + x[3]).hypot(x[2] - x[1]) / 2.0;
    let other = (x[0] - x[3]).hypot(x[1] + x[2]) / 2.0;
    turns > LARGE && turns > TIMES * other
}

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let angle = catalogue.library.add(
        2 * ORDERS + 1,
        Use::Both,
        Rc::new(|block, out| block.waves(ORDERS, None, out)),
    );
    catalogue.parameters = super::parameters(&angle);
    let basis = (1..=2 * ORDERS).flat_map(|i| [angle.radial(i), angle.tangential(i)]);
    catalogue.generic(Domain::Angle, basis);
    let beta = context.ellipse.beta;
    catalogue.candidates.extend(bends(beta, &angle));
    catalogue.candidates.extend(harmonics(beta, &angle));
    let saturations = saturations(&mut catalogue.library);
    catalogue.candidates.extend(saturations);
}

/// Shapes of so many amounts, each of them one, by the phase error in radians.
fn shapes(adds: &Adds, amounts: usize, beta: f64, angle: &Place) -> Vec<Shape> {
    let unit = |j: usize| {
        (0..amounts)
            .map(|i| f64::from(i == j))
            .collect::<Vec<f64>>()
    };
    let added = (0..amounts).map(|j| adds(beta, &unit(j)));
    added
        .map(|[cos, sin]| angle.waves(&raw(beta, &cos, &sin), 0, ORDERS))
        .collect()
}

/// Squares and cubes of the channels.
fn bends(beta: f64, angle: &Place) -> [Candidate; 2] {
    let of = |name, adds: Adds, what: &'static str| Candidate {
        trials: 2.0,
        // By the bends of 8 and 9 parameters, or by the table of harmonics.
        chip: Chip::Corrects,
        adds: Some(adds.clone()),
        parameters: each(&["k_cos", "k_sin"], "amplitude"),
        evidence: Rc::new(move |p| {
            format!(
                "the channels follow {what} instead of y, with k = {} (cos) and {} (sin) for y in amplitudes",
                p[0].brief(),
                p[1].brief()
            )
        }),
        ..Candidate::new(name, Domain::Angle, shapes(&adds, 2, beta, angle))
    };
    [
        of(Cause::EvenNonlinearity, powers(2), "y + k·y²"),
        of(Cause::OddNonlinearity, powers(3), "y + k·y³"),
    ]
}

/// Harmonics of the scale period, of each channel by itself.
fn harmonics(beta: f64, angle: &Place) -> impl Iterator<Item = Candidate> {
    HARMONICS.map(move |order| {
        let adds = waves(order);
        let shapes = shapes(&adds, 4, beta, angle);
        Candidate {
            trials: HARMONICS.count() as f64,
            order: Some(order),
            adds: Some(adds),
            chip: Chip::Corrects,
            parameters: Rc::new(move |e| {
                let (a_c, d_c, p_c, e_c) = polar(&e.x[..2], &e.error[..2]);
                let (a_s, d_s, p_s, e_s) = polar(&e.x[2..], &e.error[2..]);
                vec![
                    Parameter::exact("order", order as f64, "1"),
                    Parameter::measured("amplitude_cos", a_c, d_c, "amplitude"),
                    Parameter::measured("phase_cos", p_c, e_c, "rad"),
                    Parameter::measured("amplitude_sin", a_s, d_s, "amplitude"),
                    Parameter::measured("phase_sin", p_s, e_s, "rad"),
                ]
            }),
            evidence: Rc::new(move |p| {
                format!(
                    "the channels carry a {} harmonic of the scale period: {} (cos) and {} (sin) of the amplitude",
                    ordinal(order),
                    p[1].brief(),
                    p[3].brief()
                )
            }),
            ..Candidate::new(Cause::SpatialHarmonic, Domain::Angle, shapes)
        }
    })
}

/// Rails at which the channels bend, from each threshold on.
fn saturations(library: &mut Library) -> Vec<Candidate> {
    let trials = Rails::ALL.len() * THRESHOLDS.len();
    let mut list = vec![];
    for threshold in THRESHOLDS {
        let each = rails(threshold, library);
        let one = |at: Rails| Candidate {
            trials: trials as f64,
            exact: Some(Exact {
                make: Rc::new(move |inner, library| at.shapes(&rails(inner[0], library))),
                inner: vec![threshold],
                steps: vec![0.005],
                follows: false,
            }),
            sign: Sign::Positive,
            parameters: Rc::new(move |e| {
                let most = e.x.iter().copied().fold(0.0, f64::max);
                let error = e.error.iter().copied().fold(0.0, f64::max);
                let mut all = vec![
                    Parameter::measured(
                        "threshold",
                        e.inner[0],
                        e.inner_error.map_or(GRID, |d| d[0]),
                        "amplitude",
                    ),
                    Parameter::measured("compression", most, error, "1"),
                ];
                all.extend(at.single(e));
                all
            }),
            evidence: Rc::new(move |p| {
                format!(
                    "the signals saturate at {}: beyond {} of the amplitude {}",
                    at.words(),
                    p[0].brief(),
                    loses(&p[1], at == Rails::Each)
                )
            }),
            ..Candidate::new(Cause::Saturation, Domain::Angle, at.shapes(&each))
        };
        list.extend(Rails::ALL.map(one));
    }
    list
}
