//! Static errors of a channel: they repeat with the scale period.

use crate::cause::{Candidate, Domain, channel, each, normalised, polar, raw};
use crate::context::Context;
use crate::finding::{Chip, Parameter};

const THRESHOLDS: [f64; 7] = [0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95];

pub(crate) fn candidates(context: &Context) -> Vec<Candidate> {
    let u = normalised(context);
    let power = |which: usize, n: i32| -> Vec<f64> { u[which].iter().map(|v| v.powi(n)).collect() };
    let per_channel = |n: i32| {
        vec![
            channel(context, 0, power(0, n)),
            channel(context, 1, power(1, n)),
        ]
    };
    let of = |name, shapes, what: &'static str| Candidate {
        name,
        domain: Domain::Angle,
        trials: 2.0,
        shapes,
        motion: false,
        refine: None,
        positive: false,
        chip: Chip::CannotCorrect,
        parameters: each(&["k_cos", "k_sin"], "amplitude"),
        evidence: Box::new(move |p| {
            format!(
                "the channels bend as {what}, by {:.3} % (cos) and {:.3} % (sin) of the amplitude",
                p[0].value * 100.0,
                p[1].value * 100.0
            )
        }),
    };
    let mut list = vec![
        of("even_nonlinearity", per_channel(2), "y + k y^2"),
        of("odd_nonlinearity", per_channel(3), "y + k y^3"),
    ];
    for order in 2..=7 {
        let wave = |f: fn(f64) -> f64| -> Vec<f64> {
            context
                .alpha
                .iter()
                .map(|a| f(f64::from(order) * a))
                .collect()
        };
        let shapes = vec![
            channel(context, 0, wave(f64::cos)),
            channel(context, 0, wave(f64::sin)),
            channel(context, 1, wave(f64::cos)),
            channel(context, 1, wave(f64::sin)),
        ];
        list.push(Candidate {
            name: "spatial_harmonic",
            domain: Domain::Angle,
            trials: 6.0,
            shapes,
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
            parameters: Box::new(move |e| {
                let (a_c, d_c, p_c, e_c) = polar(&e.x[..2], &e.error[..2]);
                let (a_s, d_s, p_s, e_s) = polar(&e.x[2..], &e.error[2..]);
                vec![
                    Parameter::exact("order", f64::from(order), "1"),
                    Parameter::measured("amplitude_cos", a_c, d_c, "amplitude"),
                    Parameter::measured("phase_cos", p_c, e_c, "rad"),
                    Parameter::measured("amplitude_sin", a_s, d_s, "amplitude"),
                    Parameter::measured("phase_sin", p_s, e_s, "rad"),
                ]
            }),
            evidence: Box::new(move |p| {
                format!("order {order} of the scale period stands in the channels with {:.3} % (cos) and {:.3} % (sin) of the amplitude", p[1].value * 100.0, p[3].value * 100.0)
            }),
        });
    }
    for threshold in THRESHOLDS {
        let over = |v: f64, sign: f64| -(v * sign - threshold).max(0.0) * sign;
        let rail = |which: usize, sign: f64| -> Vec<f64> {
            u[which].iter().map(|v| over(*v, sign)).collect()
        };
        let both = |which: usize| -> Vec<f64> {
            u[which]
                .iter()
                .map(|v| over(*v, 1.0) + over(*v, -1.0))
                .collect()
        };
        let variants: [(&'static str, Vec<crate::column::Shape>); 4] = [
            ("both rails", vec![raw(context, both(0), both(1))]),
            (
                "the upper rail",
                vec![raw(context, rail(0, 1.0), rail(1, 1.0))],
            ),
            (
                "the lower rail",
                vec![raw(context, rail(0, -1.0), rail(1, -1.0))],
            ),
            (
                "the rails, each by itself",
                vec![
                    channel(context, 0, rail(0, 1.0)),
                    channel(context, 0, rail(0, -1.0)),
                    channel(context, 1, rail(1, 1.0)),
                    channel(context, 1, rail(1, -1.0)),
                ],
            ),
        ];
        for (where_, shapes) in variants {
            list.push(Candidate {
                name: "saturation",
                domain: Domain::Angle,
                trials: 4.0 * THRESHOLDS.len() as f64,
                shapes,
                motion: false,
                refine: None,
                positive: true,
                chip: Chip::CannotCorrect,
                parameters: Box::new(move |e| {
                    let most = e.x.iter().copied().fold(0.0, f64::max);
                    let error = e.error.iter().copied().fold(0.0, f64::max);
                    vec![
                        Parameter::exact("threshold", threshold, "amplitude"),
                        Parameter::measured("compression", most, error, "1"),
                    ]
                }),
                evidence: Box::new(move |p| {
                    format!("the signals are compressed at {where_}, from {threshold} of the amplitude on by {:.2} % of what is beyond", p[1].value * 100.0)
                }),
            });
        }
    }
    list
}
