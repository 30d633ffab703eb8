//! What repeats with the revolution: run-out, contamination, graduation, cogging.

use std::f64::consts::TAU;

use crate::cause::{Candidate, Domain, each, polar};
use crate::column::Shape;
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::model::Residual;

/// Orders of the revolution that are tried for cogging.
const ORDERS: u32 = 64;
const PLACES: usize = 72;

fn waves(phi: &[f64], order: f64) -> [Vec<f64>; 2] {
    [
        phi.iter().map(|p| (order * p).cos()).collect(),
        phi.iter().map(|p| (order * p).sin()).collect(),
    ]
}

pub(crate) fn candidates(context: &Context, residual: &Residual) -> Vec<Candidate> {
    let Some(phi) = &context.phi else {
        return vec![];
    };
    let per = context.periods_per_revolution.unwrap_or(1);
    let travelled = {
        let ends = phi
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), p| (a.min(*p), b.max(*p)));
        (ends.1 - ends.0) / TAU
    };
    let (cos, sin) = (&context.cos, &context.sin);
    let mut list = vec![];
    if travelled < 0.9 {
        return list;
    }
    for order in 1..=3u32 {
        let shapes = waves(phi, order.into()).map(|w| Shape::radial(&w, cos, sin));
        list.push(Candidate {
            name: "runout",
            domain: Domain::Revolution,
            trials: 3.0,
            shapes: shapes.into(),
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
            parameters: harmonic(order, "depth", "1"),
            evidence: Box::new(move |p| format!("the amplitude of both channels changes {order} time(s) per revolution, by {:.3} %", p[1].value * 100.0)),
        });
    }
    if context.against_reference.is_some() {
        for order in 1..=12u32 {
            let shapes = waves(phi, order.into()).map(|w| Shape::tangential(&w, cos, sin));
            list.push(Candidate {
                name: "graduation_error",
                domain: Domain::Revolution,
                trials: 12.0,
                shapes: shapes.into(),
                motion: false,
                refine: None,
                positive: false,
                chip: Chip::CannotCorrect,
                parameters: harmonic(order, "amplitude", "rad"),
                evidence: Box::new(move |p| format!("against the reference the angle is off by {:.3e} rad of a scale period, {order} time(s) per revolution", p[1].value)),
            });
        }
    }
    list.extend(contamination(context, phi, residual));
    // Real motion; multiples of the scale period could be the sensor's.
    let best = (1..=ORDERS)
        .filter(|order| order % per != 0)
        .map(|order| {
            let [c, s] = waves(phi, order.into());
            let along = |w: &[f64]| {
                w.iter()
                    .zip(&residual.motion)
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            };
            let norm = |w: &[f64]| w.iter().map(|a| a * a).sum::<f64>();
            (
                along(&c).powi(2) / norm(&c) + along(&s).powi(2) / norm(&s).max(1e-9),
                order,
            )
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((_, order)) = best {
        let shapes = waves(phi, order.into()).map(|w| Shape::tangential(&w, cos, sin));
        list.push(Candidate {
            name: "cogging",
            domain: Domain::Motion,
            trials: f64::from(ORDERS),
            shapes: shapes.into(),
            motion: true,
            refine: None,
            positive: false,
            chip: Chip::NotASensorError,
            parameters: harmonic(order, "amplitude", "rad"),
            evidence: Box::new(move |p| format!("the axis really moves unevenly, {order} times per revolution by {:.3e} rad of a scale period, without any change of the radius", p[1].value)),
        });
    }
    list
}

fn harmonic(order: u32, name: &'static str, unit: &'static str) -> crate::cause::Reads {
    Box::new(move |e| {
        let (a, d, p, ep) = polar(e.x, e.error);
        vec![
            Parameter::exact("order", f64::from(order), "1"),
            Parameter::measured(name, a, d, unit),
            Parameter::measured("phase", p, ep, "rad"),
        ]
    })
}

/// A dip of the amplitude at one place, every revolution.
fn contamination(context: &Context, phi: &[f64], residual: &Residual) -> Vec<Candidate> {
    let place = |p: f64| ((p.rem_euclid(TAU) / TAU * PLACES as f64) as usize).min(PLACES - 1);
    let (mut sum, mut count) = (vec![0.0; PLACES], vec![0.0; PLACES]);
    for (p, r) in phi.iter().zip(&residual.radial) {
        sum[place(*p)] += r;
        count[place(*p)] += 1.0;
    }
    let mean: Vec<f64> = sum
        .iter()
        .zip(&count)
        .map(|(s, c): (&f64, &f64)| s / c.max(1.0))
        .collect();
    let Some(lowest) = (0..PLACES).min_by(|a, b| mean[*a].total_cmp(&mean[*b])) else {
        return vec![];
    };
    let mut list = vec![];
    for shift in [-0.5, 0.0, 0.5] {
        for width in [0.02, 0.04, 0.08, 0.16, 0.3] {
            let centre = (lowest as f64 + 0.5 + shift) / PLACES as f64 * TAU;
            let dip: Vec<f64> = phi
                .iter()
                .map(|p| {
                    let off = (p - centre + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                    -(-0.5 * (off / width).powi(2)).exp()
                })
                .collect();
            list.push(Candidate {
                name: "contamination",
                domain: Domain::Revolution,
                trials: PLACES as f64 * 5.0,
                shapes: vec![Shape::radial(&dip, &context.cos, &context.sin)],
                motion: false,
                refine: None,
                positive: true,
                chip: Chip::CannotCorrect,
                parameters: Box::new(move |e| {
                    let mut all = each(&["depth"], "1")(e);
                    all.push(Parameter::measured(
                        "place",
                        centre,
                        width * e.error[0] / e.x[0].abs().max(1e-12),
                        "rad",
                    ));
                    all.push(Parameter::measured(
                        "width",
                        width,
                        width * e.error[0] / e.x[0].abs().max(1e-12),
                        "rad",
                    ));
                    all
                }),
                evidence: Box::new(|p| {
                    format!(
                        "the amplitude dips by {:.3} % at {:.3} rad of the revolution, every time",
                        p[0].value * 100.0,
                        p[1].value
                    )
                }),
            });
        }
    }
    list
}
