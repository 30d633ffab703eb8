//! What a cause would look like if it were not what its name says: the open-set check's generic bases.
//!
//! A name claims more than a shape at one moment. A line claims to be steady, a harmonic to depend on the angle alone, a
//! drift to be slow, a delay to grow with the speed and with nothing else. Each claim is tested with a basis that holds the
//! cause and its neighbourhood: if that explains far more, the name is wrong however much it explains.

use std::rc::Rc;

use crate::causes::candidate::{Candidate, Domain};
use crate::causes::{line_wave, speed_varies};
use crate::context::Context;
use crate::finding::Cause;
use crate::shapes::block::Block;
use crate::shapes::library::{Group, Library, Row, Shape, Use};

/// A name must hold this share of what a generic basis around it explains.
pub(crate) const HOLDS: f64 = 0.75;
/// Knots over the recording of an amount that may change with time: for a line, as many lines around it in the spectrum.
const TIMES: usize = 12;
/// The same of what is static, beside what depends on speed and direction.
const SLOW: usize = 8;
/// Knots of a slow change of any shape.
const DRIFT: usize = 40;
/// Knots over the range of speeds.
const SPEEDS: usize = 12;

/// Knots over the sizes of the speed.
const SIZES: usize = 6;

/// Functions of a block that amounts are multiplied by: which of them, its values.
pub(crate) type Modulation = Rc<dyn Fn(&Block, usize, &mut [f64])>;

/// A piecewise linear function that is one at knot `i` of `count` on 0 … 1 and zero at the others.
pub(crate) fn hat(count: usize, i: usize, x: f64) -> f64 {
    (1.0 - (x * (count - 1) as f64 - i as f64).abs()).max(0.0)
}

/// Knots in time.
fn in_time(context: &Context, count: usize) -> Modulation {
    let last = context.time.last().copied().unwrap_or(1.0).max(1e-300);
    Rc::new(move |block, i, out| {
        let pairs = out.iter_mut().zip(block.time);
        pairs.for_each(|(o, t)| *o = hat(count, i, t / last));
    })
}

/// Knots in time, at most so many, by which a change of what repeats every `periods` scale periods can be told from it: one
/// for each two repetitions. With fewer than two knots nothing can.
fn told(context: &Context, periods: f64, most: usize) -> usize {
    let times = context.periods_travelled() / periods;
    let knots = ((times / 2.0) as usize).min(most);
    if knots < 2 { 0 } else { knots }
}

/// Knots in time, then powers of the speed and the direction.
fn in_time_and_speed(context: &Context, knots: usize) -> Modulation {
    let (time, top) = (in_time(context, knots), context.top_speed());
    Rc::new(move |block, i, out| {
        let by: fn(f64) -> f64 = match i.checked_sub(knots) {
            None => return time(block, i, out),
            Some(0) => f64::signum,
            Some(1) => |v| v,
            Some(2) => |v| v.abs(),
            Some(_) => |v| v.powi(3),
        };
        let pairs = out.iter_mut().zip(block.speed);
        pairs.for_each(|(o, v)| *o = by(v / top));
    })
}

/// What shapes take from a group.
struct Taken {
    group: Group,
    /// Which shape, whether along the circle, the function, its share.
    members: Vec<(usize, bool, usize, f64)>,
}

impl Taken {
    /// Of all these shapes.
    fn of(shapes: &[Shape], library: &Library) -> Vec<Self> {
        let mut parts: Vec<Self> = vec![];
        let mut known: Vec<usize> = vec![];
        for (which, shape) in shapes.iter().enumerate() {
            for (atom, share) in &shape.0 {
                let atom = library.atoms[*atom];
                let at = known.iter().position(|g| *g == atom.group);
                let at = at.unwrap_or_else(|| {
                    known.push(atom.group);
                    parts.push(Self {
                        group: library.groups[atom.group].clone(),
                        members: vec![],
                    });
                    known.len() - 1
                });
                let part = (which, atom.row != Row::Radial, atom.function, *share);
                parts[at].members.push(part);
            }
        }
        parts
    }

    /// The shapes themselves at a block, `all` of them: along the radius, then along the circle.
    fn shapes(parts: &[Self], all: usize, block: &Block) -> Vec<f64> {
        let n = block.len();
        let mut plain = vec![0.0; 2 * all * n];
        let mut scratch = vec![];
        for Self { group, members } in parts {
            scratch.clear();
            scratch.resize(group.way.values() * group.count * n, 0.0);
            group.write(block, &mut scratch);
            for (which, along, function, share) in members {
                let second = *along && group.way.values() > 1;
                let from = (if second { group.count } else { 0 } + function) * n;
                let to = (if *along { all } else { 0 } + which) * n;
                let pairs = plain[to..to + n].iter_mut().zip(&scratch[from..from + n]);
                pairs.for_each(|(p, v)| *p += share * v);
            }
        }
        plain
    }

    fn is_radial(parts: &[Self]) -> bool {
        parts.iter().all(|p| p.members.iter().all(|m| !m.1))
    }
}

/// Shapes times each of `count` functions.
fn modulated(
    shapes: &[Shape],
    count: usize,
    by: Modulation,
    motion: bool,
    library: &mut Library,
) -> Vec<Shape> {
    let parts = Taken::of(shapes, library);
    let all = shapes.len();
    let way = if motion {
        Use::Motion
    } else if Taken::is_radial(&parts) {
        Use::Radial
    } else {
        Use::Rows
    };
    let fill = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let plain = Taken::shapes(&parts, all, block);
        let rows = match way {
            Use::Radial => &plain[..all * n],
            Use::Motion => &plain[all * n..],
            _ => &plain[..],
        };
        let mut factor = vec![0.0; n];
        for i in 0..count {
            by(block, i, &mut factor);
            for (row, values) in rows.chunks(n).enumerate() {
                let to = (row * count + i) * n;
                for ((o, v), f) in out[to..to + n].iter_mut().zip(values).zip(&factor) {
                    *o = v * f;
                }
            }
        }
    };
    let place = library.add(all * count, way, Rc::new(fill));
    (0..all * count).map(|i| place.both(i)).collect()
}

/// Functions of each channel: its gain, its phase, its offset.
#[derive(Clone, Copy)]
pub(crate) enum Of {
    Gain,
    Phase,
    Offset,
}

/// Both channels.
pub(crate) const BOTH: &[usize] = &[0, 1];

/// What each of these channels has of these, times each of `count` functions.
pub(crate) fn per_channel(
    (channels, of): (&'static [usize], &'static [Of]),
    count: usize,
    by: Modulation,
    library: &mut Library,
) -> Vec<Shape> {
    let total = channels.len() * of.len() * count;
    let fill = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let (c, s) = out.split_at_mut(total * n);
        let (mut factor, mut change) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..count {
            by(block, i, &mut factor);
            for (j, one) in of.iter().enumerate() {
                for (at, &which) in channels.iter().enumerate() {
                    let of_angle = |k: usize| match one {
                        Of::Gain => block.u[which][k],
                        Of::Phase => block.slope[which][k],
                        Of::Offset => 1.0,
                    };
                    for k in 0..n {
                        change[k] = factor[k] * of_angle(k);
                    }
                    let at = ((j * channels.len() + at) * count + i) * n;
                    block.channel(which, &change, &mut c[at..at + n], &mut s[at..at + n]);
                }
            }
        }
    };
    let place = library.add(total, Use::Pairs, Rc::new(fill));
    (0..total).map(|i| place.both(i)).collect()
}

/// Of what changes the amplitude of both channels, the same in each by itself.
fn gains_apart(shapes: &[Shape], library: &mut Library) -> Vec<Shape> {
    let parts = Taken::of(shapes, library);
    let count = shapes.len();
    if !Taken::is_radial(&parts) {
        return vec![];
    }
    let by: Modulation = Rc::new(move |block, i, out| {
        let n = block.len();
        let all = Taken::shapes(&parts, count, block);
        out.copy_from_slice(&all[i * n..(i + 1) * n]);
    });
    per_channel((BOTH, &[Of::Gain]), count, by, library)
}

/// A line whose amplitude and phase depend on the angle, along the radius and along the circle.
fn with_angle(hertz: f64, library: &mut Library) -> Vec<Shape> {
    const TOP: usize = 2;
    const PER: usize = 2 * TOP + 1;
    let wave = line_wave(hertz);
    let fill = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let mut waves = vec![0.0; 2 * n];
        wave(block, &mut waves);
        for (wave, part) in waves.chunks(n).zip(out.chunks_mut(PER * n)) {
            block.waves(TOP, Some(wave), part);
        }
    };
    let place = library.add(2 * PER, Use::Both, Rc::new(fill));
    let functions = 0..2 * PER;
    functions
        .flat_map(|i| [place.radial(i), place.tangential(i)])
        .collect()
}

/// What a line may do and still be one: its frequency is steady to this many hertz.
const STEADY: f64 = 1.0;

/// A line that wanders no further than a line may.
pub(crate) fn steady(
    context: &Context,
    candidate: &Candidate,
    library: &mut Library,
) -> Vec<Shape> {
    let duration = context.samples() as f64 / context.rate;
    let knots = ((2.0 * STEADY * duration) as usize + 1).min(TIMES / 2);
    if candidate.domain != Domain::Line || knots < 2 {
        return vec![];
    }
    let first = &candidate.shapes[..candidate.shapes.len().min(4)];
    modulated(first, knots, in_time(context, knots), false, library)
}

/// What a cause does that goes with the speed of the moment, growing with its size in any way: what its name claims of that
/// is tested.
pub(crate) fn at_any_speed(
    context: &Context,
    candidate: &Candidate,
    library: &mut Library,
) -> Vec<Shape> {
    let now = candidate.domain == Domain::Speed && candidate.name != Cause::AcCoupling;
    if !now || !speed_varies(context) {
        return vec![];
    }
    let top = context.top_speed();
    let by: Modulation = Rc::new(move |block, i, out| {
        let pairs = out.iter_mut().zip(block.speed);
        pairs.for_each(|(o, v)| *o = hat(SIZES, i, v.abs() / top));
    });
    modulated(&candidate.shapes, SIZES, by, false, library)
}

/// A basis that holds a cause and what is near it, beside the catalogue's basis of the domain.
pub(crate) fn around(
    context: &Context,
    candidate: &Candidate,
    library: &mut Library,
) -> Vec<Shape> {
    let own = &candidate.shapes;
    match candidate.domain {
        // Its harmonics wander as it does.
        Domain::Line => {
            let first = &own[..own.len().min(4)];
            let mut all = modulated(first, TIMES, in_time(context, TIMES), false, library);
            // Over a few periods, what goes with the angle is a frequency that wanders.
            let turns = told(context, 1.0, TIMES) == TIMES;
            if let Some(exact) = candidate.exact.as_ref().filter(|_| turns) {
                all.extend(with_angle(exact.inner[0], library));
            }
            all
        }
        Domain::Motion => modulated(own, TIMES, in_time(context, TIMES), true, library),
        Domain::Revolution => {
            let per = context.periods_per_revolution.map_or(1.0, f64::from);
            let count = told(context, per, TIMES);
            let mut all = modulated(own, count, in_time(context, count), false, library);
            all.extend(gains_apart(own, library));
            all
        }
        Domain::Angle | Domain::Code => {
            let knots = told(context, 1.0, SLOW);
            let count = if knots == 0 {
                0
            } else if speed_varies(context) {
                knots + 4
            } else {
                knots
            };
            modulated(
                own,
                count,
                in_time_and_speed(context, knots),
                false,
                library,
            )
        }
        Domain::Time => {
            let of: &[Of] = if candidate.name == Cause::GainDrift {
                &[Of::Gain]
            } else {
                &[Of::Offset]
            };
            per_channel((BOTH, of), DRIFT, in_time(context, DRIFT), library)
        }
        Domain::Speed if speed_varies(context) => {
            let top = context.top_speed();
            let knots: Modulation = Rc::new(move |block, i, out| {
                let pairs = out.iter_mut().zip(block.speed);
                pairs.for_each(|(o, v)| *o = hat(SPEEDS, i, 0.5 + 0.5 * v / top));
            });
            let of = &[Of::Gain, Of::Phase, Of::Offset];
            per_channel((BOTH, of), SPEEDS, knots, library)
        }
        Domain::Speed => vec![],
    }
}
