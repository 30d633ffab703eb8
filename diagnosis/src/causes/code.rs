//! Errors of the ADC as a function of its code.

use crate::cause::{Candidate, Domain, channel};
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
    let mut list = vec![];
    // The highest bit is the step in the middle of the range.
    for bit in (0..context.bits.min(40)).rev().take(8) {
        if (1i64 << bit) > reach || (1i64 << bit) < 8 {
            continue;
        }
        let weight = |which: usize| -> Vec<f64> {
            let set = |c: &i64| ((c + half) >> bit & 1) as f64 - 0.5;
            context.codes[which].iter().map(set).collect()
        };
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
