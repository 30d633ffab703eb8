//! Errors of the ADC as a function of its code.

use std::rc::Rc;

use statrs::function::erf::erf;

use super::Catalogue;
use crate::block::Block;
use crate::cause::{Candidate, Domain};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::Shape;

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    let half = 1i64 << (context.bits.min(40) - 1);
    let span = |which: usize| {
        let codes = &context.codes[which];
        let (low, high) = (codes.iter().min(), codes.iter().max());
        high.copied().unwrap_or(0) - low.copied().unwrap_or(0)
    };
    let reach = span(0).min(span(1));
    // The last bits of coarse codes never move.
    let coarse = (0..2)
        .map(|which| {
            let all = context.codes[which]
                .iter()
                .fold(0, |bits, c| bits | (c - context.codes[which][0]));
            1i64 << all.trailing_zeros().min(40)
        })
        .max()
        .unwrap_or(1);
    // Coarse steps with little noise are errors of the code themselves.
    if coarse > 1 {
        return;
    }
    let levels = [0, 1].map(|which| Levels::of(context, which));
    // The highest bit is the step in the middle of the range.
    for bit in (0..context.bits.min(40)).rev().take(8) {
        let step = (1i64 << bit) as f64;
        // Noise wider than the steps leaves nothing of them.
        let lost = levels.iter().any(|l| l.blur > step);
        if (1i64 << bit) > reach || step < 8.0 || lost {
            continue;
        }
        let shapes: Vec<Shape> = (0..2)
            .map(|which| {
                let edges = levels[which].edges(step, half as f64);
                catalogue.library.pair(move |block: &Block, c, s| {
                    let smooth = &block.normalised()[which];
                    let set: Vec<f64> = smooth.iter().map(|u| edges.at(*u)).collect();
                    block.channel(which, &set, c, s);
                })
            })
            .collect();
        catalogue.candidates.push(Candidate {
            name: "adc_nonlinearity",
            domain: Domain::Code,
            trials: 8.0,
            shapes,
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
            parameters: Rc::new(move |e| {
                vec![
                    Parameter::exact("bit", f64::from(bit), "1"),
                    Parameter::measured("step_cos", e.x[0], e.error[0], "amplitude"),
                    Parameter::measured("step_sin", e.x[1], e.error[1], "amplitude"),
                ]
            }),
            evidence: Rc::new(move |p| {
                format!("the ADC's bit {bit} is off by {:.4} % (cos) and {:.4} % (sin) of the amplitude", p[1].value * 100.0, p[2].value * 100.0)
            }),
        });
    }
}

/// Codes of the smooth motion: a shape made of measured codes would hold the noise that it is to explain.
struct Levels {
    /// Code of a normalised channel: offset and slope.
    code: (f64, f64),
    /// What the measured codes scatter about it, rms: noise, and motion that is not smooth.
    blur: f64,
}

impl Levels {
    fn of(context: &Context, which: usize) -> Self {
        let e = &context.ellipse;
        let (a, b) = [(e.a_c, e.b_c), (e.a_s, e.b_s)][which];
        let (raw, measured) = (&context.raw[which], &context.codes[which]);
        let ends = |k: usize| (raw[k], measured[k] as f64);
        let by_code = |x: &usize, y: &usize| measured[*x].cmp(&measured[*y]);
        let low = (0..raw.len()).min_by(by_code).map_or((0.0, 0.0), ends);
        let high = (0..raw.len()).max_by(by_code).map_or((1.0, 1.0), ends);
        let per_unit = (high.1 - low.1) / (high.0 - low.0).max(f64::MIN_POSITIVE);
        let code = (low.1 + per_unit * (b - low.0), per_unit * a);
        let smooth = &context.block(0..context.samples()).normalised()[which];
        let off = smooth.iter().zip(measured).zip(&context.weight);
        let square: f64 = off
            .map(|((u, c), w)| w * (code.0 + code.1 * u - *c as f64).powi(2))
            .sum();
        let count: f64 = context.weight.iter().sum();
        Self {
            code,
            blur: (square / count.max(1.0)).sqrt().max(0.3),
        }
    }

    /// Of the bit of weight `step`, with codes that count from `-half`.
    fn edges(&self, step: f64, half: f64) -> Edges {
        let width = self.blur * 2f64.sqrt();
        let set = |x: f64| -> f64 {
            // Up at odd multiples of the step, down at even ones.
            let edge = |k: i32| {
                let up = if k % 2 == 0 { -0.5 } else { 0.5 };
                up * erf((x - f64::from(k) * step) / width)
            };
            (-7..=8).map(edge).sum::<f64>() - 0.5
        };
        let period = 2.0 * step;
        let point = |k: usize| set(period * k as f64 / POINTS as f64);
        Edges {
            // Codes are rounded: each begins half a step of the ADC below itself.
            offset: (self.code.0 + half + 0.5) / period,
            slope: self.code.1 / period,
            table: (0..=POINTS).map(point).collect(),
        }
    }
}

/// Points over one period of a bit.
const POINTS: usize = 1024;

/// How often a bit is set, less a half, by the normalised channel: its edges, as wide as the noise.
struct Edges {
    offset: f64,
    slope: f64,
    table: Vec<f64>,
}

impl Edges {
    fn at(&self, u: f64) -> f64 {
        let place = (self.offset + self.slope * u).rem_euclid(1.0) * POINTS as f64;
        let at = (place as usize).min(POINTS - 1);
        self.table[at] + (self.table[at + 1] - self.table[at]) * (place - at as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::Levels;

    #[test]
    fn edges_stand_where_the_bit_changes() {
        let levels = Levels {
            code: (0.0, 1.0),
            blur: 0.3,
        };
        let edges = levels.edges(16.0, 64.0);
        for code in -64..64 {
            let bit = (code + 64) >> 4 & 1;
            let set = edges.at(f64::from(code));
            assert!((set - (f64::from(bit) - 0.5)).abs() < 0.06, "{code}: {set}");
        }
    }

    #[test]
    fn noise_wears_the_edges_down() {
        let levels = Levels {
            code: (0.0, 1.0),
            blur: 16.0,
        };
        let edges = levels.edges(16.0, 0.0);
        // What is left of a square wave is its first harmonic, by exp(-(pi blur / step)^2 / 2).
        let top = (0..32)
            .map(|code| edges.at(f64::from(code)))
            .fold(0.0, f64::max);
        let expected = 2.0 / std::f64::consts::PI * (-std::f64::consts::PI.powi(2) / 2.0).exp();
        assert!((top - expected).abs() < 1e-4, "{top} {expected}");
    }
}
