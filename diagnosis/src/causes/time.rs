//! Slow changes, in time or with temperature.

use std::rc::Rc;

use super::{Catalogue, Modulated, modulated};
use crate::causes::candidate::{Candidate, Domain, Estimate};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::numerics::polynomial::{DEGREE, legendre};
use crate::shapes::library::Shape;
use crate::shapes::trig::{Trig, channel, normalised};

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let beta = context.ellipse.beta;
    let last = context
        .time
        .last()
        .copied()
        .unwrap_or(1.0)
        .max(f64::MIN_POSITIVE);
    let time = Modulated(modulated(
        &mut catalogue.library,
        DEGREE,
        move |block, i| {
            let at = |t: &f64| legendre(i + 1, 2.0 * t / last - 1.0);
            block.time.iter().map(at).collect()
        },
    ));
    for by in 0..DEGREE {
        // Along the circle and free of the angle it is motion.
        let mut orders = time.generic(by, 0);
        orders.truncate(1);
        orders.extend((1..=2).flat_map(|order| time.generic(by, order)));
        catalogue.generic(Domain::Time, orders);
    }
    if !can_be_shown(context) {
        return;
    }
    let mut drivers: Vec<(&'static str, Modulated, usize)> = [1, 3, DEGREE]
        .into_iter()
        .filter(|degree| tells(context, *degree))
        .map(|degree| ("time", time, degree))
        .collect();
    if context.temperature.is_some() {
        let temperature = modulated(&mut catalogue.library, 1, |block, _| {
            block.temperature.map_or_else(Vec::new, <[f64]>::to_vec)
        });
        drivers.push(("temperature", Modulated(temperature), 1));
    }
    let trials = drivers.len() as f64;
    for (driver, modulations, per) in drivers {
        for gain in [false, true] {
            let all: Vec<Shape> = (0..2)
                .flat_map(|which| {
                    let change = if gain {
                        normalised(beta)[which].clone()
                    } else {
                        Trig::constant(1.0)
                    };
                    let parts = channel(beta, which, &change);
                    (0..per).map(move |by| modulations.shape(by, &parts))
                })
                .collect();
            let how = if driver == "time" {
                "time: from the start of the recording to its end"
            } else {
                "temperature: from one standard deviation below its mean to one above"
            };
            catalogue.candidates.push(Candidate {
                trials,
                parameters: Rc::new(move |e| numbers(e, per)),
                ..drift(gain, |_| how.to_owned(), all)
            });
        }
    }
}

/// Whether a recording can show drifts: of the first degree at least.
pub(crate) fn can_be_shown(context: &Context) -> bool {
    tells(context, 1)
}

/// Whether a recording tells a polynomial of the time of that degree from shapes of the angle: over a period or two, time and angle
/// are one.
pub(crate) fn tells(context: &Context, degree: usize) -> bool {
    context.periods_travelled() >= 3.0 * degree as f64
}

/// A drift of the gains or else of the offsets, whose first two parameters are the changes of cos and sin; `how` says with what it drifts,
/// and from where to where.
pub(super) fn drift(
    gain: bool,
    how: impl Fn(&[Parameter]) -> String + 'static,
    all: Vec<Shape>,
) -> Candidate {
    let (name, what, of) = if gain {
        (Cause::GainDrift, "gains", "")
    } else {
        (Cause::OffsetDrift, "offsets", " of the amplitude")
    };
    Candidate {
        chip: Chip::Corrects,
        evidence: Rc::new(move |p| {
            let (how, cos, sin) = (how(p), p[0].brief(), p[1].brief());
            format!("the {what} drift with {how}, they change by {cos} (cos) and {sin} (sin){of}")
        }),
        ..Candidate::new(name, Domain::Time, all)
    }
}

/// The parameters of a drift along so many Legendre polynomials.
fn numbers(e: &Estimate, per: usize) -> Vec<Parameter> {
    // From one end of the recording to the other: twice the odd polynomials.
    let total = |from: usize| {
        let odd = (0..per).step_by(2).map(|i| from + i);
        let value: f64 = odd.clone().map(|i| 2.0 * e.x[i]).sum();
        let error = odd.map(|i| (2.0 * e.error[i]).powi(2)).sum::<f64>().sqrt();
        (value, error)
    };
    let ((c, dc), (s, ds)) = (total(0), total(per));
    let mut all = vec![
        Parameter::measured("change_cos", c, dc, "amplitude"),
        Parameter::measured("change_sin", s, ds, "amplitude"),
    ];
    for (i, (x, error)) in e.x.iter().zip(e.error).enumerate() {
        let (channel, degree) = (["cos", "sin"][i / per], i % per + 1);
        if degree > 1 {
            let name = format!("curve_{channel}_{degree}");
            all.push(Parameter::measured(&name, *x, *error, "amplitude"));
        }
    }
    all
}
