//! Static errors of a channel: they repeat with the scale period.

use std::rc::Rc;

use super::{Catalogue, ORDERS};
use crate::block::Block;
use crate::cause::{Candidate, Domain, each, polar};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::{Shape, Use};
use crate::trig::{Trig, channel, normalised};

const THRESHOLDS: [f64; 7] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95];

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let beta = context.ellipse.beta;
    let angle = catalogue.library.add(
        2 * ORDERS + 1,
        Use::Both,
        Rc::new(|block, out| block.waves(ORDERS, None, out)),
    );
    catalogue.parameters = super::parameters(&angle);
    let basis = (1..=2 * ORDERS).flat_map(|i| [angle.radial(i), angle.tangential(i)]);
    catalogue.generic(Domain::Angle, basis);
    let of_channel =
        |which: usize, change: &Trig| angle.waves(&channel(beta, which, change), 0, ORDERS);
    let u = normalised(beta);
    let per_channel = |n: usize| (0..2).map(|i| of_channel(i, &u[i].power(n))).collect();
    let of = |name, shapes: Vec<Shape>, what: &'static str| Candidate {
        name,
        domain: Domain::Angle,
        trials: 2.0,
        shapes,
        motion: false,
        refine: None,
        positive: false,
        chip: Chip::CannotCorrect,
        parameters: each(&["k_cos", "k_sin"], "amplitude"),
        evidence: Rc::new(move |p| {
            format!(
                "the channels bend as {what}, by {:.3} % (cos) and {:.3} % (sin) of the amplitude",
                p[0].value * 100.0,
                p[1].value * 100.0
            )
        }),
    };
    let list = &mut catalogue.candidates;
    list.extend([
        of("even_nonlinearity", per_channel(2), "y + k y^2"),
        of("odd_nonlinearity", per_channel(3), "y + k y^3"),
    ]);
    for order in 2..=7 {
        let shapes = (0..2)
            .flat_map(|which| {
                [Trig::cos(order, 0.0), Trig::sin(order, 0.0)].map(|wave| of_channel(which, &wave))
            })
            .collect();
        list.push(Candidate {
            name: "spatial_harmonic",
            domain: Domain::Angle,
            trials: 6.0,
            shapes,
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
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
                format!("order {order} of the scale period stands in the channels with {:.3} % (cos) and {:.3} % (sin) of the amplitude", p[1].value * 100.0, p[3].value * 100.0)
            }),
        });
    }
    for threshold in THRESHOLDS {
        // Each channel, each rail.
        let rails: Vec<Shape> = (0..4)
            .map(|i| {
                let (which, sign) = (i / 2, if i % 2 == 0 { 1.0 } else { -1.0 });
                catalogue.library.pair(move |block: &Block, c, s| {
                    let u = block.u[which];
                    let over = |v: &f64| -(v * sign - threshold).max(0.0) * sign;
                    block.channel(which, &u.iter().map(over).collect::<Vec<_>>(), c, s);
                })
            })
            .collect();
        let (upper, lower) = (rails[0].plus(&rails[2]), rails[1].plus(&rails[3]));
        let variants: [(&'static str, Vec<Shape>); 4] = [
            ("both rails", vec![upper.plus(&lower)]),
            ("the upper rail", vec![upper]),
            ("the lower rail", vec![lower]),
            ("the rails, each by itself", rails),
        ];
        for (where_, shapes) in variants {
            catalogue.candidates.push(Candidate {
                name: "saturation",
                domain: Domain::Angle,
                trials: 4.0 * THRESHOLDS.len() as f64,
                shapes,
                motion: false,
                refine: None,
                positive: true,
                chip: Chip::CannotCorrect,
                parameters: Rc::new(move |e| {
                    let most = e.x.iter().copied().fold(0.0, f64::max);
                    let error = e.error.iter().copied().fold(0.0, f64::max);
                    vec![
                        Parameter::exact("threshold", threshold, "amplitude"),
                        Parameter::measured("compression", most, error, "1"),
                    ]
                }),
                evidence: Rc::new(move |p| {
                    format!("the signals are compressed at {where_}, from {threshold} of the amplitude on by {:.2} % of what is beyond", p[1].value * 100.0)
                }),
            });
        }
    }
}
