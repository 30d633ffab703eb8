//! Generic bases: what any cause of a domain could look like. They measure the noise that no cause explains, and tell
//! whether a named cause has the shape it claims.

use crate::cause::Domain;
use crate::causes::speed_varies;
use crate::column::Shape;
use crate::context::Context;

/// Highest order of the scale period.
const ORDERS: i32 = 8;

fn both(context: &Context, values: &[f64]) -> [Shape; 2] {
    [
        Shape::radial(values, &context.cos, &context.sin),
        Shape::tangential(values, &context.cos, &context.sin),
    ]
}

fn waves(angle: &[f64], order: f64) -> [Vec<f64>; 2] {
    [
        angle.iter().map(|a| (order * a).cos()).collect(),
        angle.iter().map(|a| (order * a).sin()).collect(),
    ]
}

/// The basis of a domain; empty where it has none.
pub(crate) fn basis(context: &Context, domain: Domain) -> Vec<Shape> {
    let mut list = vec![];
    match domain {
        // What depends on the code depends on the angle too.
        Domain::Angle | Domain::Code => {
            for order in 1..=ORDERS {
                for wave in waves(&context.alpha, order.into()) {
                    list.extend(both(context, &wave));
                }
            }
        }
        Domain::Speed if speed_varies(context) => {
            let top = context
                .speed
                .iter()
                .fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
            let odd: Vec<f64> = context.speed.iter().map(|v| v / top).collect();
            let sign: Vec<f64> = context.speed.iter().map(|v| v.signum()).collect();
            let even: Vec<f64> = odd.iter().map(|v| v * v).collect();
            for speed in [&odd, &even, &sign] {
                list.extend(both(context, speed));
                for order in 1..=2 {
                    for wave in waves(&context.alpha, order.into()) {
                        let shape: Vec<f64> = wave.iter().zip(speed).map(|(w, v)| w * v).collect();
                        list.extend(both(context, &shape));
                    }
                }
            }
        }
        Domain::Time => {
            for polynomial in crate::causes_time(context, 6) {
                list.push(Shape::radial(&polynomial, &context.cos, &context.sin));
                for wave in waves(&context.alpha, 1.0)
                    .iter()
                    .chain(&waves(&context.alpha, 2.0))
                {
                    let shape: Vec<f64> =
                        wave.iter().zip(&polynomial).map(|(w, p)| w * p).collect();
                    list.extend(both(context, &shape));
                }
            }
        }
        Domain::Revolution => {
            if let Some(phi) = &context.phi {
                for order in 1..=12 {
                    for wave in waves(phi, f64::from(order)) {
                        list.push(Shape::radial(&wave, &context.cos, &context.sin));
                        if context.against_reference.is_some() {
                            list.push(Shape::tangential(&wave, &context.cos, &context.sin));
                        }
                    }
                }
            }
        }
        _ => {}
    }
    list
}

/// Everything that any cause of any domain could explain.
pub(crate) fn saturated(context: &Context) -> Vec<Shape> {
    let mut all = context.parameters();
    for domain in [
        Domain::Angle,
        Domain::Speed,
        Domain::Time,
        Domain::Revolution,
    ] {
        all.extend(basis(context, domain));
    }
    all
}
