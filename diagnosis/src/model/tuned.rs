//! Numbers of a cause that are no amounts, as a frequency or a threshold, are fitted.
//!
//! A shape depends on them otherwise than by a factor, so they are fitted in steps: each is one linear fit of the amounts and of what
//! small changes of the numbers do, whose slopes are differences of shapes that are made on either side.

use crate::causes::candidate::Exact;
use crate::model::{System, atoms_of};
use crate::numerics::solve::Solution;
use crate::select::beside::Beside;
use crate::select::selection::Accepted;
use crate::shapes::library::{Library, Shape};

/// Gain in log-likelihood from which on inner numbers can be fitted.
pub(crate) const FITTED: f64 = 30.0;
/// Steps of a fit of them.
const STEPS: usize = 8;
/// Share of what its shapes explained that those of a number that is known twice have to explain once it is fitted.
const AS_MUCH: f64 = 0.9;
/// Standard errors from which on a number is told from zero.
const TOLD: f64 = 3.0;
/// Small changes that one step may go.
const REACH: f64 = 12.0;
/// Share of its standard error by which a number may still move when its fit ends.
const AT_REST: f64 = 0.2;

/// Fits the inner numbers of a cause beside a fit; its shapes are new functions of the system then.
pub(crate) fn tuned(system: &mut System, fit: &[Shape], cause: &mut Accepted, gain: f64) {
    let Some(exact) = cause.candidate.exact.clone() else {
        return;
    };
    if gain < FITTED || exact.inner.is_empty() {
        return;
    }
    match fitted(system, fit, &exact) {
        Inner::Untold => {}
        Inner::Good(errors) => cause.inner_error = errors.or(cause.inner_error.take()),
        Inner::Found(inner, errors) => {
            let shapes = (exact.make)(&inner, &mut system.samples.library);
            system.extend();
            if !went_astray(system, fit, cause, &exact, &shapes) {
                cause.candidate.shapes = shapes;
                cause.inner_error = errors;
                cause.candidate.exact = Some(Exact { inner, ..exact });
            }
        }
    }
}

/// Whether a fit went astray: its shapes explain less than those of the cause did. Where the number is known twice, shapes of a wrong one
/// with an amount that is not it may explain a little more than right ones, as the tangents of a large cause are off.
fn went_astray(
    system: &System,
    fit: &[Shape],
    cause: &Accepted,
    exact: &Exact,
    shapes: &[Shape],
) -> bool {
    let share = if exact.follows { AS_MUCH } else { 1.0 };
    let beside = Beside::new(&system.total, fit);
    beside.gain(shapes).0 < share * beside.gain(&cause.candidate.shapes).0 - 1.0
}

/// What a fit of inner numbers says. Standard errors are there where the shapes tell the numbers.
enum Inner {
    /// A number is not told from none, and its fit would run away.
    Untold,
    /// The shapes are good as they are: standard errors.
    Good(Option<Vec<f64>>),
    /// The numbers, and standard errors.
    Found(Vec<f64>, Option<Vec<f64>>),
}

/// Goes on from step to step until the numbers rest.
fn fitted(system: &mut System, fit: &[Shape], exact: &Exact) -> Inner {
    let mut inner = exact.inner.clone();
    let mut errors = None;
    let by_shapes = !exact.steps.is_empty();
    for step in 0..STEPS {
        let moves = Linear::of(system, fit, exact, &inner).moves(exact, &inner);
        if moves.iter().any(|m| !m.0.is_finite()) {
            break;
        }
        let (by, error) = moves[0];
        if inner == [0.0] && by_shapes && by.abs() < TOLD * error {
            return Inner::Untold;
        }
        if by_shapes {
            errors = Some(moves.iter().map(|m| m.1).collect());
        }
        let rests = moves.iter().all(|(by, error)| by.abs() < AT_REST * error);
        if rests && step == 0 {
            return Inner::Good(errors);
        }
        for (value, (by, _)) in inner.iter_mut().zip(&moves) {
            *value += by;
        }
        if rests {
            break;
        }
    }
    Inner::Found(inner, errors)
}

/// One linear fit of a cause beside the others.
struct Linear {
    /// The amounts, at the inner numbers as they are.
    x: Vec<f64>,
    /// The amounts, and behind them what each inner number is off.
    solution: Solution,
}

impl Linear {
    /// Where the inner numbers are these. The functions that it takes are left out of the system again.
    fn of(system: &mut System, fit: &[Shape], exact: &Exact, inner: &[f64]) -> Self {
        let library = &mut system.samples.library;
        let mark = library.atoms.len();
        let own = (exact.make)(inner, library);
        let differences = differences(exact, inner, library);
        let all: Vec<Shape> = differences
            .iter()
            .flat_map(|d| d.plus.iter().chain(&d.minus))
            .chain(&own)
            .chain(fit)
            .cloned()
            .collect();
        let atoms = atoms_of(&all);
        let whole = system.among(&atoms);
        let among = |shapes: &[Shape]| Shape::all_among(shapes, &atoms);
        let beside = Beside::new(&whole, &among(fit));
        let mut shapes = among(&own);
        let x = beside.solve(&shapes).x;
        shapes.extend(differences.iter().map(|d| d.slope(&x, among)));
        let solution = beside.solve(&shapes);
        system.retain(|i| i < mark);
        Self { x, solution }
    }

    /// By how much each inner number moves, and its standard error.
    fn moves(&self, exact: &Exact, inner: &[f64]) -> Vec<(f64, f64)> {
        if !exact.follows {
            let within_reach = |j: usize| {
                let ((by, error), most) = (self.off(j), REACH * exact.steps[j]);
                (by.clamp(-most, most), error)
            };
            return (0..inner.len()).map(within_reach).collect();
        }
        let by_amount = (self.x[0] - inner[0], self.error(0));
        if exact.steps.is_empty() {
            return vec![by_amount];
        }
        // The number is known twice, as an amount and by the shapes.
        let (by, error) = weighted_mean(&[by_amount, self.off(0)]);
        let most = 0.5 * inner[0];
        vec![(by.clamp(-most, most), error)]
    }

    /// What inner number `j` is off by the shapes, and its standard error.
    fn off(&self, j: usize) -> (f64, f64) {
        let i = self.x.len() + j;
        (self.solution.x[i], self.error(i))
    }

    /// Standard error of one number of the solution.
    fn error(&self, i: usize) -> f64 {
        self.solution.covariance[(i, i)].max(0.0).sqrt()
    }
}

/// The mean of what is known with these standard errors, and its own.
fn weighted_mean(known: &[(f64, f64)]) -> (f64, f64) {
    let weight = |error: f64| error.powi(-2).min(1e30);
    let total: f64 = known.iter().map(|k| weight(k.1)).sum();
    let mean = known.iter().map(|k| k.0 * weight(k.1)).sum::<f64>() / total;
    (mean, total.sqrt().recip())
}

/// Shapes on either side of an inner number.
struct Difference {
    plus: Vec<Shape>,
    minus: Vec<Shape>,
    /// How far away they are.
    small: f64,
}

/// Of each inner number; new functions of the library.
fn differences(exact: &Exact, inner: &[f64], library: &mut Library) -> Vec<Difference> {
    let mut list = vec![];
    for (j, small) in exact.steps.iter().enumerate() {
        let mut made = |by: f64| {
            let mut moved = inner.to_vec();
            moved[j] += by;
            (exact.make)(&moved, library)
        };
        list.push(Difference {
            plus: made(*small),
            minus: made(-small),
            small: *small,
        });
    }
    list
}

impl Difference {
    /// What one unit more of the number does where the shapes have the amounts `x`, in the atoms that `among` takes.
    fn slope(&self, x: &[f64], among: impl Fn(&[Shape]) -> Vec<Shape>) -> Shape {
        let sides = among(&self.plus).into_iter().zip(among(&self.minus));
        sides
            .zip(x)
            .fold(Shape::default(), |slope, ((plus, minus), x)| {
                let by = x / (2.0 * self.small);
                slope.plus(&plus.scaled(by)).plus(&minus.scaled(-by))
            })
    }
}
