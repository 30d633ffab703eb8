//! Slow changes, in time or with temperature.

use crate::cause::{Candidate, Domain, channel, normalised};
use crate::context::Context;
use crate::finding::{Chip, Parameter};

/// Legendre polynomials of the time, −1 … 1 over the recording, from the first degree on.
pub(crate) fn polynomials(context: &Context, degree: usize) -> Vec<Vec<f64>> {
    let last = context
        .time
        .last()
        .copied()
        .unwrap_or(1.0)
        .max(f64::MIN_POSITIVE);
    let x: Vec<f64> = context.time.iter().map(|t| 2.0 * t / last - 1.0).collect();
    let mut all = vec![vec![1.0; x.len()], x.clone()];
    for n in 1..degree {
        let next = (0..x.len())
            .map(|k| {
                let (n, before, now) = (n as f64, all[all.len() - 2][k], all[all.len() - 1][k]);
                ((2.0 * n + 1.0) * x[k] * now - n * before) / (n + 1.0)
            })
            .collect();
        all.push(next);
    }
    all.remove(0);
    all.truncate(degree);
    all
}

pub(crate) fn candidates(context: &Context) -> Vec<Candidate> {
    let u = normalised(context);
    // Over a period or two, time and angle are one, and a polynomial of time is any shape of the angle.
    let way: f64 = context.speed.iter().map(|v| v.abs()).sum();
    let periods = way / context.rate / std::f64::consts::TAU;
    let mut drivers: Vec<(&'static str, Vec<Vec<f64>>)> = [1, 3, 6]
        .into_iter()
        .filter(|degree| periods >= 3.0 * *degree as f64)
        .map(|degree| ("time", polynomials(context, degree)))
        .collect();
    if drivers.is_empty() {
        return vec![];
    }
    if let Some(temperature) = &context.temperature {
        drivers.push(("temperature", vec![temperature.clone()]));
    }
    let trials = drivers.len() as f64;
    let mut list = vec![];
    for (driver, shapes) in drivers {
        for gain in [false, true] {
            let mut all = vec![];
            for which in [0, 1] {
                for shape in &shapes {
                    let change = if gain {
                        shape.iter().zip(&u[which]).map(|(s, u)| s * u).collect()
                    } else {
                        shape.clone()
                    };
                    all.push(channel(context, which, change));
                }
            }
            let per = shapes.len();
            list.push(Candidate {
                name: if gain { "gain_drift" } else { "offset_drift" },
                domain: Domain::Time,
                trials,
                shapes: all,
                motion: false,
                refine: None,
                positive: false,
                chip: Chip::Corrects,
                parameters: Box::new(move |e| {
                    // From one end of the recording to the other: twice the odd polynomials.
                    let total = |from: usize| {
                        let odd = (0..per).step_by(2).map(|i| from + i);
                        let value: f64 = odd.clone().map(|i| 2.0 * e.x[i]).sum();
                        let error = odd.map(|i| (2.0 * e.error[i]).powi(2)).sum::<f64>().sqrt();
                        (value, error)
                    };
                    let ((c, dc), (s, ds)) = (total(0), total(per));
                    vec![
                        Parameter::measured("change_cos", c, dc, "amplitude"),
                        Parameter::measured("change_sin", s, ds, "amplitude"),
                    ]
                }),
                evidence: Box::new(move |p| {
                    let what = if gain { "gains" } else { "offsets" };
                    format!("the {what} drift with {driver}, by {:.3} % (cos) and {:.3} % (sin) of the amplitude from one end to the other", p[0].value * 100.0, p[1].value * 100.0)
                }),
            });
        }
    }
    list
}
