//! The catalogue: one file per kind of cause.

pub(crate) mod angle;
pub(crate) mod candidate;
mod code;
pub(crate) mod direction;
mod frequencies;
pub(crate) mod high_pass;
mod lag;
mod line;
mod mains;
mod mirror;
mod place;
pub(crate) mod revolution;
mod settling;
mod sides;
pub(crate) mod speed;
mod steady;
pub(crate) mod time;

use std::rc::Rc;

use std::collections::BTreeMap;

use crate::causes::candidate::{Candidate, Domain};
use crate::context::Context;
use crate::finding::Cause;
use crate::model::{Residual, Weighed, atoms_of};
use crate::shapes::block::Block;
use crate::shapes::library::{Library, Place, Shape, Use};
use crate::shapes::trig::{Trig, rotated};

pub(crate) use line::{crawls, has_harmonics, wave as line_wave};
pub(crate) use place::{highest_order, order_waves, strongest_order, without_cogging};
pub(crate) use settling::settling;
pub(crate) use speed::{varies as speed_varies, varies_much as speed_varies_much};
pub(crate) use steady::is_one_of_many;
pub(crate) use time::tells;

/// Highest order of the scale period.
pub(crate) const ORDERS: usize = 8;

/// What does not depend on what is left of the recording: functions, causes, and generic bases.
#[derive(Default)]
pub(crate) struct Catalogue {
    pub(crate) library: Library,
    /// The five parameters.
    pub(crate) parameters: Vec<Shape>,
    /// Every cause with every choice of its discrete parameters.
    pub(crate) candidates: Vec<Candidate>,
    /// What any cause of a domain could look like. They measure the noise that no cause explains, and tell whether a
    /// named cause has the shape it claims.
    pub(crate) generic: BTreeMap<Domain, Vec<Shape>>,
    /// All atoms of the generic bases.
    pub(crate) broad: Vec<usize>,
    /// Number of atoms that the catalogue itself has.
    pub(crate) atoms: usize,
}

impl Catalogue {
    /// The catalogue for a recording.
    pub(crate) fn new(context: &Context, with_motion: bool) -> Self {
        let mut this = Self::default();
        this.library.with_motion = with_motion;
        angle::enter(context, &mut this);
        code::enter(context, &mut this);
        speed::enter(context, &mut this);
        high_pass::enter(context, &mut this);
        time::enter(context, &mut this);
        revolution::enter(context, &mut this);
        revolution::enter_apart(context, &mut this);
        let mut so_far: BTreeMap<Cause, usize> = BTreeMap::new();
        for candidate in &mut this.candidates {
            let count = so_far.entry(candidate.name).or_default();
            candidate.id = *count;
            *count += 1;
        }
        this.broad = atoms_of(this.generic.values().flatten().chain(&this.parameters));
        this.atoms = this.library.atoms.len();
        this
    }

    /// The basis of a domain; empty where it has none.
    pub(crate) fn basis(&self, domain: Domain) -> &[Shape] {
        self.generic.get(&domain.home()).map_or(&[], |list| list)
    }

    /// The cause of a name that has a number among those of that name.
    pub(crate) fn cause(&self, name: Cause, id: usize) -> Option<&Candidate> {
        let mut all = self.candidates.iter();
        all.find(|c| c.name == name && c.id == id)
    }

    fn generic(&mut self, domain: Domain, shapes: impl IntoIterator<Item = Shape>) {
        self.generic.entry(domain).or_default().extend(shapes);
    }
}

/// Causes that are looked for where the residual shows something, with functions of their own; where noise is
/// `coloured`, lines have to stand out of what is near them.
pub(crate) fn shown(
    context: &Context,
    residual: &Residual,
    coloured: bool,
    library: &mut Library,
) -> Vec<Candidate> {
    let mut list = line::candidates(context, residual, coloured, library);
    list.extend(place::candidates(context, residual, library));
    list
}

/// The same where the axis vibrates, and its spectrum is no level.
pub(crate) fn shown_weighed(
    context: &Context,
    weighed: &Weighed,
    coloured: bool,
    library: &mut Library,
) -> Vec<Candidate> {
    let mut list = line::weighed(context, weighed, coloured, library);
    list.extend(place::weighed(context, weighed, library));
    list
}

/// Functions of time, speed or temperature, each times waves of the angle up to the second order.
fn modulated(
    library: &mut Library,
    count: usize,
    modulations: impl Fn(&Block, usize) -> Vec<f64> + 'static,
) -> Place {
    const TOP: usize = 2;
    let per = 2 * TOP + 1;
    library.add(
        count * per,
        Use::Both,
        Rc::new(move |block, out| {
            for (i, part) in out.chunks_mut(per * block.len()).enumerate() {
                block.waves(TOP, Some(&modulations(block, i)), part);
            }
        }),
    )
}

/// The modulations that [`modulated`] entered: shapes of them.
#[derive(Clone, Copy)]
struct Modulated(Place);

impl Modulated {
    fn shape(self, by: usize, parts: &[Trig; 2]) -> Shape {
        self.0.waves(parts, by, 2)
    }

    /// Waves of an order along the radius and along the circle.
    fn generic(self, by: usize, order: usize) -> Vec<Shape> {
        let (zero, mut list) = (Trig::constant(0.0), vec![]);
        let waves = if order == 0 {
            vec![Trig::constant(1.0)]
        } else {
            vec![Trig::cos(order, 0.0), Trig::sin(order, 0.0)]
        };
        for wave in waves {
            list.push(self.shape(by, &[wave.clone(), zero.clone()]));
            list.push(self.shape(by, &[zero.clone(), wave]));
        }
        list
    }
}

/// A course of the time in cos and in sin: of their gains or else of their offsets, in amplitudes.
fn in_time(gain: bool, course: impl Fn(f64) -> f64 + 'static, library: &mut Library) -> [Shape; 2] {
    let pairs = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let course: Vec<f64> = block.time.iter().map(|t| course(*t)).collect();
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
    [0, 1].map(|which| place.both(which))
}

/// The five parameters: cos into c, 1 into c, sin into s, 1 into s, cos into s.
fn parameters(angle: &Place) -> Vec<Shape> {
    let (cos, sin) = (Trig::cos(1, 0.0), Trig::sin(1, 0.0));
    let (one, zero) = (Trig::constant(1.0), Trig::constant(0.0));
    [
        [&cos, &zero],
        [&one, &zero],
        [&zero, &sin],
        [&zero, &one],
        [&zero, &cos],
    ]
    .map(|[c, s]| angle.waves(&rotated(c, s), 0, ORDERS))
    .into()
}
