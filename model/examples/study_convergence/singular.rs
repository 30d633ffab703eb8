//! The direction that no radius shows, drawn: what it does round the period, and how order 2 of the angle error fares
//! with and without the completion.

use std::f64::consts::TAU;

use nonius_model::reference::gate::Gate;
use nonius_model::reference::gradient::{Form, Observation};
use nonius_model::reference::interpolator::Search;
use nonius_model::reference::{Config, Parameters, Reference, Sensor, Theta};
use plotters::chart::SeriesLabelPosition;

use crate::method::{COMPLETION, config};
use crate::plot::{COLOURS, Line, lines};
use crate::scenario::SPEED;

/// Radial and tangential effect of v, per unit, against α; with β = 0 and 5°.
pub(crate) fn effect() -> Result<String, Box<dyn std::error::Error>> {
    let set = Parameters::ChebyshevNine;
    let mut drawn = Vec::new();
    for (beta, dashed) in [(0.0f64, false), (5.0, true)] {
        let sensor = Sensor {
            beta: beta.to_radians(),
            ..Sensor::IDEAL
        };
        let theta = set.from_five(sensor.theta());
        let v = set.null_direction(&theta).ok_or("nine have a cubic")?;
        let at = |degrees: u32| {
            let alpha = f64::from(degrees).to_radians();
            let seen = Observation::new(set, &theta, sensor.signals(alpha), alpha);
            let moved = seen.m * v;
            let radial = moved.x * alpha.cos() + moved.y * alpha.sin();
            (f64::from(degrees), radial, (seen.w() * v).x)
        };
        let points: Vec<_> = (0..=360).step_by(3).map(at).collect();
        for (name, colour, of) in [("angle", COLOURS[1], 2), ("radius", COLOURS[0], 1)] {
            drawn.push(Line {
                name: format!(
                    "{name}, beta = {beta} degrees{}",
                    if dashed { " (dashed)" } else { "" }
                ),
                colour,
                dashed,
                width: 2,
                points: points
                    .iter()
                    .map(|p| (p.0, if of == 1 { p.1 } else { p.2 }))
                    .collect(),
            });
        }
    }
    lines(
        "What one unit of v does to the corrected pair",
        ["alpha, degrees", "change, radians or radii"],
        (0.0..360.0, -0.6..1.1),
        SeriesLabelPosition::UpperRight,
        &drawn,
    )
}

/// Order 2 of the angle error while calibrating on signals with 3 % of third harmonics.
pub(crate) fn order_2() -> Result<String, Box<dyn std::error::Error>> {
    let signals = |a: f64| {
        [
            a.cos() + 0.03 * (3.0 * a).cos(),
            a.sin() + 0.03 * (3.0 * a).sin(),
        ]
    };
    let radius = Search::Residual(Form::Final);
    let mut drawn = Vec::new();
    for (i, (name, set, search, completion)) in [
        ("five, radial", Parameters::Five, radius, None),
        ("eight, radial", Parameters::Eight, radius, None),
        (
            "eight, exact gradient (11)",
            Parameters::ChebyshevEight,
            Search::Residual(Form::Exact),
            None,
        ),
        (
            "eight, completed",
            Parameters::ChebyshevEight,
            radius,
            Some(COMPLETION),
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let mut reference = Reference::new(Config {
            completion,
            ..config(set, search, Gate::EverySample)
        })?;
        let mut points = Vec::new();
        for k in 0..25_000 {
            let alpha = SPEED * f64::from(k);
            let y = signals(alpha);
            reference.step(y[0], y[1]);
            if k % 200 == 0 {
                points.push((
                    alpha / TAU,
                    1e3 * amplitude(set, reference.theta(), signals),
                ));
            }
        }
        drawn.push(Line {
            name: name.into(),
            colour: COLOURS[i],
            dashed: false,
            width: 2,
            points,
        });
    }
    lines(
        "Third harmonics of 3 %: order 2 of the angle error",
        ["periods travelled", "mrad"],
        (0.0..200.0, 0.0..80.0),
        SeriesLabelPosition::MiddleRight,
        &drawn,
    )
}

/// Order 2 of the angle of the corrected pair less α, radians.
fn amplitude(set: Parameters, theta: &Theta, signals: impl Fn(f64) -> [f64; 2]) -> f64 {
    const POINTS: u32 = 180;
    let (mut re, mut im) = (0.0, 0.0);
    for i in 0..POINTS {
        let alpha = TAU * f64::from(i) / f64::from(POINTS);
        let [c, s] = set.corrected(theta, signals(alpha));
        let error = crate::table::wrapped(s.atan2(c) - alpha);
        re += error * (2.0 * alpha).cos();
        im += error * (2.0 * alpha).sin();
    }
    re.hypot(im) * 2.0 / f64::from(POINTS)
}
