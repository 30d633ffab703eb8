//! Errors of the ADC as a function of its code.

use statrs::function::erf::erf;

use crate::cause::{Candidate, Domain, channel, normalised};
use crate::context::Context;
use crate::finding::{Chip, Parameter};

pub(crate) fn candidates(context: &Context) -> Vec<Candidate> {
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
        return vec![];
    }
    let levels = [0, 1].map(|which| Levels::of(context, which));
    let mut list = vec![];
    // The highest bit is the step in the middle of the range.
    for bit in (0..context.bits.min(40)).rev().take(8) {
        let step = (1i64 << bit) as f64;
        // Noise wider than the steps leaves nothing of them.
        let lost = levels.iter().any(|l| l.blur > step);
        if (1i64 << bit) > reach || step < 8.0 || lost {
            continue;
        }
        let weight = |which: usize| levels[which].bit(step, half as f64);
        let shapes = vec![
            channel(context, 0, weight(0)),
            channel(context, 1, weight(1)),
        ];
        list.push(Candidate {
            name: "adc_nonlinearity",
            domain: Domain::Code,
            trials: 8.0,
            shapes,
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
            parameters: Box::new(move |e| {
                vec![
                    Parameter::exact("bit", f64::from(bit), "1"),
                    Parameter::measured("step_cos", e.x[0], e.error[0], "amplitude"),
                    Parameter::measured("step_sin", e.x[1], e.error[1], "amplitude"),
                ]
            }),
            evidence: Box::new(move |p| {
                format!("the ADC's bit {bit} is off by {:.4} % (cos) and {:.4} % (sin) of the amplitude", p[1].value * 100.0, p[2].value * 100.0)
            }),
        });
    }
    list
}

/// Codes without their noise: a shape made of codes with it would hold the noise that it is to explain.
struct Levels {
    /// Code of the smooth motion, not rounded.
    codes: Vec<f64>,
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
        let smooth = &normalised(context)[which];
        let code = |u: &f64| low.1 + per_unit * (a * u + b - low.0);
        let codes: Vec<f64> = smooth.iter().map(code).collect();
        let off = codes.iter().zip(measured).zip(&context.weight);
        let square: f64 = off.map(|((x, c), w)| w * (x - *c as f64).powi(2)).sum();
        let count: f64 = context.weight.iter().sum();
        Self {
            codes,
            blur: (square / count.max(1.0)).sqrt().max(0.3),
        }
    }

    /// How often the bit of weight `step` is set, less a half: the edges of its code, as wide as the noise.
    fn bit(&self, step: f64, half: f64) -> Vec<f64> {
        const POINTS: usize = 1024;
        let width = self.blur * 2f64.sqrt();
        let set = |x: f64| -> f64 {
            // Up at odd multiples of the step, down at even ones; half a code below, as codes are rounded.
            let edge = |k: i32| {
                let up = if k % 2 == 0 { -0.5 } else { 0.5 };
                up * erf((x - f64::from(k) * step) / width)
            };
            (-7..=8).map(edge).sum::<f64>() - 0.5
        };
        let period = 2.0 * step;
        let table: Vec<f64> = (0..=POINTS)
            .map(|k| set(period * k as f64 / POINTS as f64))
            .collect();
        let read = |code: &f64| {
            let place = ((code + half + 0.5) / period).rem_euclid(1.0) * POINTS as f64;
            let at = (place as usize).min(POINTS - 1);
            table[at] + (table[at + 1] - table[at]) * (place - at as f64)
        };
        self.codes.iter().map(read).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Levels;

    #[test]
    fn edges_stand_where_the_bit_changes() {
        let codes: Vec<f64> = (-64..64).map(f64::from).collect();
        let levels = Levels {
            codes: codes.clone(),
            blur: 0.3,
        };
        for (code, set) in codes.iter().zip(levels.bit(16.0, 64.0)) {
            let bit = (*code as i64 + 64) >> 4 & 1;
            assert!((set - (bit as f64 - 0.5)).abs() < 0.06, "{code}: {set}");
        }
    }

    #[test]
    fn noise_wears_the_edges_down() {
        let levels = Levels {
            codes: (0..512).map(f64::from).collect(),
            blur: 16.0,
        };
        // What is left of a square wave is its first harmonic, by exp(-(pi blur / step)^2 / 2).
        let top = levels.bit(16.0, 0.0).into_iter().fold(0.0, f64::max);
        let expected = 2.0 / std::f64::consts::PI * (-std::f64::consts::PI.powi(2) / 2.0).exp();
        assert!((top - expected).abs() < 1e-4, "{top} {expected}");
    }
}
