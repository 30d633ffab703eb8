//! The word formats of the chip's signals, and why each is as it is.

use nonius_model::design::Design;
use nonius_model::format::Format;
use nonius_model::graph::{Kind, Op};
use nonius_model::kernel::travel::SECTOR;

use crate::design_json::Signal;

/// Every signal with a name that is no flag.
pub(crate) fn formats(design: &Design) -> Vec<Signal> {
    let graph = &design.graph;
    let mut list = vec![];
    for id in graph.ids() {
        let node = graph.node(id);
        let (Some(name), false) = (&node.name, matches!(node.op, Op::Constant(_))) else {
            continue;
        };
        if node.kind == Kind::Flag {
            continue;
        }
        let lsb = node.format.lsb();
        let kind = match node.op {
            Op::Input => "register",
            _ if graph.probes.iter().any(|(n, _)| n == name) => "probe",
            _ => "value",
        };
        list.push(Signal {
            name: name.clone(),
            kind,
            format: node.format.to_string(),
            range: [node.range.0 as f64 * lsb, node.range.1 as f64 * lsb],
            resolution: lsb,
            why: why(design, name, &node.op, node.format).into(),
        });
    }
    list
}

fn why(design: &Design, name: &str, op: &Op, format: Format) -> &'static str {
    if !matches!(op, Op::Input | Op::Quantise(..) | Op::QuantiseGeared { .. }) {
        return "exact: every bit of the operation, range by interval analysis";
    }
    let by_name = [
        (
            "lock_level",
            "counts so many samples to lock as the loop takes to settle",
        ),
        ("level_moved", "lock_level before it starts again"),
        ("loop_gear", "numbers the gears of acquisition"),
        ("gamma_gear", "numbers the gears of gamma"),
        (
            "gear_periods",
            "counts the periods of travel in a gear of gamma",
        ),
        (
            "travel_samples",
            "counts the samples of a period of travel at a fifth of the loop's bandwidth",
        ),
        (
            "skew_rate",
            "speed up to a quarter above the design's largest, as wide as a signal",
        ),
        (
            "skew_moving",
            "phase of the sine's delay at that speed, six bits finer than a signal",
        ),
        (
            "skew",
            "phase of the sine's delay at that speed, six bits finer than a signal",
        ),
        ("carry", "whole periods gone by in a sample"),
        (
            "quarter_phase",
            "the phase within a quarter turn, to every bit of the phase in the sine",
        ),
    ];
    if let Some((_, why)) = by_name.iter().find(|(n, _)| *n == name) {
        return why;
    }
    let f = &design.structure.formats;
    let parameter = "parameter: bounded to what the design promises, a quarter more, up to a power of two; resolution by the \
                     budget";
    let multiplied = "parameter as it is multiplied: as wide as a signal, its point as far left as its bounds allow";
    let by_format = [
        (f.signal.format, "signals: the budget's rounding of signals"),
        (
            f.residual.format,
            "residual: a quarter of the radius at most moves a parameter; a signal's resolution",
        ),
        (f.alpha, "phase: the budget's dead band of the integrator"),
        (
            f.rate.format,
            "increments of the phase: its resolution, half a turn at most",
        ),
        (
            f.rate_high.format,
            "the upper part of the rate, as wide as a signal, for a multiplier of that width",
        ),
        (
            f.sine_phase.format,
            "phase in the sine: the budget's truncation",
        ),
        (f.count, "counted periods, as asked for"),
        (SECTOR, "sectors, 64 a period, of four periods"),
        (f.theta[0].format, multiplied),
        (f.theta[2].format, multiplied),
        (f.theta_bend.format, multiplied),
        (f.theta_cubic.format, multiplied),
        (
            f.step.format,
            "step of a parameter: one bit more than the widest of them",
        ),
        (
            f.alpha_gradient.format,
            "gradient of the phase: two turns at most, to its resolution",
        ),
        (
            f.gathered.format,
            "gathered gradient: its bound, to a parameter's resolution",
        ),
        (f.y, "normalised signals: every bit of the ADC"),
        (f.adc, "the ADC"),
    ];
    if f.deviation.iter().any(|to| to.format == format) {
        return parameter;
    }
    let known = by_format.iter().find(|(f, _)| *f == format);
    known.map_or(
        "as wide as its operands need: a difference of phases modulo one turn",
        |(_, why)| why,
    )
}
