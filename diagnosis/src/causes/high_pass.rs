//! AC coupling: a first-order high pass takes the slow part of the signals away.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::rc::Rc;

use nonius_fourier::Complex;

use super::speed::follows;
use super::{Catalogue, in_time};
use crate::causes::candidate::{Candidate, Domain, Estimate, Exact, Sign};
use crate::context::Context;
use crate::finding::{Cause, Parameter};
use crate::shapes::block::Block;
use crate::shapes::library::{Library, Shape};

/// Scale periods of travel that ac coupling needs to be told from shapes of the angle.
const FEWEST: f64 = 6.0;

/// Share of the top speed below which the scale hardly moves.
const AT_REST: f64 = 0.1;

/// Where a low pass is between blocks.
#[derive(Default)]
struct Charged {
    /// The sample that comes next.
    next: usize,
    /// What went in and what came out last.
    last: [Complex<f64>; 2],
}

/// The pair behind a low pass of a time constant, seconds, block after block, as a part of the pair itself; exact where the scale
/// turns evenly from sample to sample. It begins as if the scale had always moved as it does then, or discharged where it is
/// not as fast as `moving`, radians per second: had it always stood still, there would be no signal. What was before is the charges'.
fn slow(
    block: &Block,
    rate: f64,
    moving: f64,
    tau: f64,
    state: &RefCell<Charged>,
) -> Vec<Complex<f64>> {
    let mut state = state.borrow_mut();
    let response = |k: usize| Complex::new(1.0, block.speed[k] * tau).inv();
    if block.start != state.next || block.start == 0 {
        let pair = Complex::new(block.cos[0], block.sin[0]);
        let share = if block.speed[0].abs() > moving {
            response(0)
        } else {
            Complex::ZERO
        };
        state.last = [pair, pair * share];
    }
    let decay = (-1.0 / (rate * tau)).exp();
    let [mut before, mut now] = state.last;
    let pairs = block.cos.iter().zip(block.sin);
    let values = pairs
        .enumerate()
        .map(|(k, (c, s))| {
            let pair = Complex::new(*c, *s);
            let response = response(k);
            now = pair * response + (now - before * response) * decay;
            before = pair;
            now * pair.conj()
        })
        .collect();
    *state = Charged {
        next: block.start + block.len(),
        last: [before, now],
    };
    values
}

/// Share of the angle of what is left that is told, by its radius: where that is hardly anything, its angle says nothing.
fn seen(radius: f64) -> f64 {
    (2.0 * radius).min(1.0)
}

/// The angle of a number, by a series where that is as exact: most of a recording loses little.
fn angle(number: Complex<f64>) -> f64 {
    let tan = number.im / number.re;
    // The next of the series is below a rounding error.
    if number.re > 0.0 && tan.abs() < 0.01 {
        let square = tan * tan;
        tan * (1.0 - square * (1.0 / 3.0 - square * (1.0 / 5.0 - square / 7.0)))
    } else {
        number.arg()
    }
}

/// What is left, by what its shape tells.
fn factor(less: f64, told: f64) -> Complex<f64> {
    let radius = 1.0 + less;
    let share = seen(radius);
    Complex::from_polar(radius, if share > 0.0 { told / share } else { 0.0 })
}

/// What a high pass takes away, over its corner frequency in hertz. The same filter in both channels is one of the corrected
/// pair; its radius and its angle, as they are and not in first order: where the corner is a fourth of the signals'
/// frequency, the angle is turned so far that half of what the radius loses is second order.
fn high_pass(sample_rate: f64, moving: f64) -> impl Fn(f64, &mut Library) -> Vec<Shape> + 'static {
    move |corner, library| {
        let corner: f64 = f64::max(corner, 1e-300);
        let state: RefCell<Charged> = RefCell::default();
        let mut shapes = vec![library.pair(move |block: &Block, c, s| {
            let lost = slow(block, sample_rate, moving, 1.0 / (TAU * corner), &state);
            for (k, lost) in lost.into_iter().enumerate() {
                let left = 1.0 - lost;
                let (radius, angle) = (left.norm_sqr().sqrt(), angle(left));
                let change = Complex::new(radius - 1.0, angle * seen(radius));
                let change = change * Complex::new(block.cos[k], block.sin[k]) / corner;
                (c[k], s[k]) = (change.re, change.im);
            }
        })];
        // The charge of either capacitor when the recording begins is anything; it leaks away.
        shapes.extend(charges(corner, library));
        shapes
    }
}

/// The charge of either capacitor, leaking away from the beginning of the recording on.
fn charges(corner: f64, library: &mut Library) -> [Shape; 2] {
    let left = move |t: f64| {
        let x = TAU * corner * t;
        // Smaller than any rounding, and slow to compute.
        if x < 40.0 { (-x).exp() } else { 0.0 }
    };
    in_time(false, left, library)
}

/// The corner, and its error, as fitted or else as it is `known`.
fn corner_hz(e: &Estimate, known: (f64, f64)) -> Vec<Parameter> {
    let fitted = e.inner_error.map(|error| (e.inner[0], error[0]));
    let (value, error) = fitted.unwrap_or(known);
    vec![Parameter::measured("corner_hz", value, error, "Hz")]
}

/// Whether a recording can show ac coupling: over a few periods, what leaks away is any shape of the angle.
pub(crate) fn can_be_shown(context: &Context) -> bool {
    context.periods_travelled() >= FEWEST
}

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let duration = context.samples() as f64 / context.rate;
    if !can_be_shown(context) {
        return;
    }
    // At the lowest corner a charge leaks away along a line, as it does at any below.
    let (mut corner, mut least) = (0.03 / duration, 0.0);
    let corners = (context.rate / 30.0 / corner).log(3.0).floor().max(1.0);
    while corner < context.rate / 30.0 {
        let make = high_pass(context.rate, AT_REST * context.top_speed());
        let shapes = make(corner, &mut catalogue.library);
        let leaking = shapes[1..].to_vec();
        catalogue.candidates.push(Candidate {
            trials: corners,
            exact: follows(corner, make).map(|e| Exact {
                steps: vec![0.01 * corner],
                ..e
            }),
            sign: Sign::Known(least),
            factor: Some(factor),
            parameters: Rc::new(|e| corner_hz(e, (e.x[0], e.error[0]))),
            evidence: Rc::new(|p| {
                format!(
                    "the channels lose their slow parts, as behind a high pass with its corner at {}",
                    p[0].brief()
                )
            }),
            ..Candidate::new(Cause::AcCoupling, Domain::Speed, shapes)
        });
        // At constant speed nothing else of a high pass is seen.
        catalogue.candidates.push(Candidate {
            trials: corners,
            exact: Some(Exact {
                make: Rc::new(|inner, library| charges(inner[0], library).into()),
                inner: vec![corner],
                steps: vec![0.01 * corner],
                follows: false,
            }),
            as_drift: true,
            // As it stands on the grid.
            parameters: Rc::new(|e| corner_hz(e, (e.inner[0], e.inner[0]))),
            evidence: Rc::new(|p| {
                format!(
                    "the offsets decay from the start of the recording on, as behind a high pass with its corner at {}",
                    p[0].brief()
                )
            }),
            ..Candidate::new(Cause::AcCoupling, Domain::Time, leaking)
        });
        least = corner;
        corner *= 3.0;
    }
}

#[cfg(test)]
mod tests {
    use nonius_fourier::Complex;

    use super::angle;

    /// To two roundings, on either side of where the series ends, and behind the origin.
    #[test]
    fn the_series_is_as_exact_as_the_arc_tangent() {
        for step in 0..4000 {
            let size = 1e-9 * 1.006f64.powi(step);
            for number in [(1.0, size), (0.7, -size), (-0.2, size)] {
                let number = Complex::new(number.0, number.1);
                let (found, exact) = (angle(number), number.arg());
                assert!(
                    (found - exact).abs() <= 4e-16 * exact.abs(),
                    "{number}: {found} {exact}"
                );
            }
        }
    }
}
