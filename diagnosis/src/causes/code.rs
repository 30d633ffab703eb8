//! Errors of the ADC as a function of its code.

use std::rc::Rc;

use super::Catalogue;
use crate::causes::candidate::{Candidate, Domain};
use crate::context::Context;
use crate::finding::{Cause, Parameter};
use crate::shapes::block::Block;
use crate::shapes::library::Shape;

/// Highest bits of the code that are looked at.
const BITS: usize = 8;

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
    // The codes of the smooth signals: those of the measured ones know the noise that carried them over an edge.
    let (e, adc) = (context.ellipse, context.adc);
    let smooth = move |block: &Block, which: usize| -> Vec<i64> {
        let (a, b, adc) = [(e.a_c, e.b_c, adc.cos), (e.a_s, e.b_s, adc.sin)][which];
        let u = block.u[which].iter();
        u.map(|u| adc.code(a * u + b)).collect()
    };
    // The highest bit is the step in the middle of the range.
    let top = context.bits.min(40) - 1;
    for bit in (0..context.bits.min(40)).rev().take(BITS) {
        if (1i64 << bit) > reach || (1i64 << bit) < 8 {
            continue;
        }
        let shapes: Vec<Shape> = (0..2)
            .map(|which| {
                catalogue.library.pair(move |block: &Block, c, s| {
                    let set = |c: &i64| ((c + half) >> bit & 1) as f64 - 0.5;
                    let codes = smooth(block, which);
                    block.channel(which, &codes.iter().map(set).collect::<Vec<_>>(), c, s);
                })
            })
            .collect();
        catalogue.candidates.push(Candidate {
            trials: BITS as f64,
            parameters: Rc::new(move |e| {
                vec![
                    Parameter::exact("bit", f64::from(bit), "1"),
                    Parameter::measured("step_cos", e.x[0], e.error[0], "amplitude"),
                    Parameter::measured("step_sin", e.x[1], e.error[1], "amplitude"),
                ]
            }),
            evidence: Rc::new(move |p| {
                format!(
                    "the codes jump where bit {bit} of the ADC{} changes: by {} (cos) and {} (sin) of the amplitude",
                    if bit == top { ", at mid-scale," } else { "" },
                    p[1].brief(),
                    p[2].brief()
                )
            }),
            ..Candidate::new(Cause::AdcNonlinearity, Domain::Code, shapes)
        });
    }
}
