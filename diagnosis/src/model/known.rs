//! What causes that are known do to the channels, sample by sample: it is taken off the signals.

use crate::causes::Catalogue;
use crate::causes::candidate::Domain;
use crate::context::Context;
use crate::finding::Cause;
use crate::model::exact::enter;
use crate::model::sweep::Samples;
use crate::model::{amounts, atoms_of};
use crate::select::selection::Accepted;
use crate::shapes::library::{Library, Row};
use crate::shapes::trig::Trig;

/// What is known of a recording, one value per sample.
pub(crate) struct Known {
    /// Added along the radius, in amplitudes; of what the gains are gains of.
    pub(crate) radial: Vec<f64>,
    /// Added along the circle, in amplitudes; of that, too.
    pub(crate) tangential: Vec<f64>,
    /// Added by the electronics along the radius and along the circle, in amplitudes, whatever the gains are.
    pub(crate) behind: [Vec<f64>; 2],
    /// Gains of both channels, less one.
    pub(crate) gain: Vec<f64>,
    /// Errors of the angle, radians.
    pub(crate) angle: Vec<f64>,
    /// Fast real motion, radians.
    pub(crate) fast: Vec<f64>,
}

/// What the causes add to the channels in every period.
pub(super) fn periodic(context: &Context, carried: &[Accepted]) -> [Trig; 2] {
    let beta = context.ellipse.beta;
    let known = carried.iter().filter(|a| a.is_taken_off());
    let all = known.filter_map(|a| Some(a.candidate.adds.as_ref()?(beta, &a.x)));
    let nothing = [(); 2].map(|()| Trig::constant(0.0));
    all.fold(nothing, |[c, s], [more_c, more_s]| {
        [c.plus(&more_c), s.plus(&more_s)]
    })
}

/// How a cause comes into the signals.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// It moves the axis.
    Moves,
    /// It stands along the circle alone, and is an error of the angle, as a graduation's is.
    Turns,
    /// It stands along the radius alone and does not go with the speed: a gain of both channels, of all that is in them.
    Gains,
    /// The electronics add it, whatever the gains are.
    Behind,
    /// It is added to the channels, and the gains are gains of it, too.
    Added,
}

impl Way {
    fn of(one: &Accepted, library: &Library) -> Self {
        let candidate = &one.candidate;
        let atoms = atoms_of(&candidate.shapes);
        let all = |row: Row| atoms.iter().all(|i| library.atoms[*i].row == row);
        if candidate.motion {
            Self::Moves
        } else if all(Row::Tangential) {
            Self::Turns
        } else if candidate.domain != Domain::Speed && all(Row::Radial) {
            Self::Gains
        } else if [Cause::Hysteresis, Cause::OffsetDrift, Cause::Interference]
            .contains(&candidate.name)
        {
            Self::Behind
        } else {
            Self::Added
        }
    }
}

/// What the causes do at the angles of a context. A graduation's errors turn what the channels see, and theirs are those of that angle.
pub(super) fn effects(context: &Context, carried: &mut [Accepted], with_motion: bool) -> Known {
    let known = effects_at(context, carried, with_motion);
    if known.angle.iter().all(|error| *error == 0.0) {
        return known;
    }
    let seen = context.turned_by(&known.angle);
    // The axis moves as it does.
    Known {
        angle: known.angle,
        fast: known.fast,
        ..effects_at(&seen, carried, with_motion)
    }
}

/// The same, where the channels see the angle that the context has.
fn effects_at(context: &Context, carried: &mut [Accepted], with_motion: bool) -> Known {
    let mut catalogue = Catalogue::new(context, with_motion);
    enter(carried, &mut catalogue);
    let library = std::mem::take(&mut catalogue.library);
    let samples = Samples::new(context, library, Default::default(), 1);
    let of = |way: Way, row: Row| {
        let chosen = (carried.iter()).filter(|a| Way::of(a, &samples.library) == way);
        let amounts: Vec<(usize, f64)> = chosen.flat_map(Accepted::amounts).collect();
        samples.sum(&amounts, row, 1)
    };
    let fast = if with_motion {
        Row::Motion
    } else {
        Row::Tangential
    };
    let [mut radial, mut tangential] =
        [Row::Radial, Row::Tangential].map(|row| of(Way::Added, row));
    for one in carried.iter() {
        let (Some(factor), [first, ..]) = (one.candidate.factor, &*one.candidate.shapes) else {
            continue;
        };
        let first = amounts(std::slice::from_ref(first), &one.x);
        let [r, t] = [Row::Radial, Row::Tangential].map(|row| samples.sum(&first, row, 1));
        for (k, (r, t)) in r.iter().zip(&t).enumerate() {
            let added = factor(*r, *t) - 1.0;
            radial[k] += added.re - r;
            tangential[k] += added.im - t;
        }
    }
    Known {
        radial,
        tangential,
        angle: of(Way::Turns, Row::Tangential),
        behind: [Row::Radial, Row::Tangential].map(|row| of(Way::Behind, row)),
        gain: of(Way::Gains, Row::Radial),
        fast: of(Way::Moves, fast),
    }
}
