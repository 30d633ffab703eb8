//! The word formats of the chip's signals, and why each is as it is.

use nonius_model::design::Design;
use nonius_model::graph::{Entry, Kind, Op};
use serde::Serialize;

/// A named signal.
#[derive(Clone, Debug, Serialize)]
pub struct Signal {
    /// Its name.
    pub name: String,
    /// What it is: register, probe, or value on the way.
    pub kind: &'static str,
    /// Its format, as in the Verilog.
    pub format: String,
    /// Smallest and largest value it can take, by interval analysis.
    pub range: [f64; 2],
    /// Weight of its last bit.
    pub resolution: f64,
    /// Why it is as wide as it is.
    pub why: String,
}

/// Every signal with a name that is no flag.
#[must_use]
pub fn signals(design: &Design) -> Vec<Signal> {
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
            why: why(design, name, node).unwrap_or_default().into(),
        });
    }
    list
}

/// Reasons of what is rounded or cut, by names without their numbers. What is not here is one of the signals.
const REASONS: &[(&[&str], &str)] = &[
    (&["adc_cos", "adc_sin"], "the ADC"),
    (
        &["alpha_hat", "alpha_hat_previous"],
        "phase: the budget's dead band of the integrator",
    ),
    (
        &["rate", "rate_before", "rate_lost", "speed", "kick", "drift"],
        "increments of the phase: its resolution, up to what the largest speed needs",
    ),
    (
        &["rate_high"],
        "the upper part of the rate, as wide as a signal, for a multiplier of that width",
    ),
    (&["count"], "counted periods, as asked for"),
    (&["carry"], "whole periods gone by in a sample"),
    (
        &["sine_phase"],
        "phase in the sine: the budget's truncation",
    ),
    (
        &["quarter_phase"],
        "the phase within a quarter turn, to every bit of the phase in the sine",
    ),
    (
        &["theta_deviation", "recent", "proven"],
        "parameter: bounded to what the design promises, a quarter more, up to a power of two; resolution by the budget",
    ),
    (
        &["theta", "theta_solved", "cubic_c", "cubic_s"],
        "parameter as it is multiplied: as wide as a signal, its point as far left as its bounds allow",
    ),
    (
        &["solved"],
        "step of a parameter: one bit more than the widest of them",
    ),
    (
        &["rho_limited"],
        "residual: a quarter of the radius at most moves a parameter; a signal's resolution",
    ),
    (
        &[
            "alpha_gradient",
            "alpha_gradient_rate",
            "null_gradient",
            "null_gradient_rate",
        ],
        "gradient of the phase: two turns at most, to its resolution",
    ),
    (
        &["gathered"],
        "gathered gradient: its bound, to a parameter's resolution",
    ),
    (
        &["lock_level"],
        "counts so many samples to lock as the loop takes to settle",
    ),
    (&["level_moved"], "lock_level before it starts again"),
    (&["loop_gear"], "numbers the gears of acquisition"),
    (&["gamma_gear"], "numbers the gears of gamma"),
    (
        &["gear_periods"],
        "counts the periods of travel in a gear of gamma, or held",
    ),
    (
        &["start_periods"],
        "counts the periods of travel that the start has solved",
    ),
    (
        &["travel_samples"],
        "counts the samples of a period of travel at a fifth of the loop's bandwidth",
    ),
    (
        &[
            "sector",
            "sector_relative",
            "travel_origin",
            "travel_low",
            "travel_high",
        ],
        "sectors, 64 a period, of four periods",
    ),
    (&["sectors"], "sectors passed in a sample, up to a period"),
    (
        &["harmonic_cos", "harmonic_sin", "harmonic_turned"],
        "harmonics: a quarter of the amplitude at most, to a signal's resolution",
    ),
    (
        &["harmonic_phase_late"],
        "phase in the table of harmonics, as that in the sine, where the sine is sampled later",
    ),
    (
        &["skew_turns"],
        "phase of the sine's delay in turns, to the resolution of the phase",
    ),
    (
        &["skew_rate"],
        "speed up to a quarter above the design's largest, as wide as a signal",
    ),
    (
        &["skew", "skew_moving"],
        "phase of the sine's delay at that speed, six bits finer than a signal",
    ),
];

/// Why a named signal is as wide as it is; `None`: nobody has said.
fn why(design: &Design, name: &str, node: &Entry) -> Option<&'static str> {
    match node.op {
        Op::Lookup { .. } => {
            return Some(if name.starts_with("harmonic") {
                "word of the table of harmonics: two bits finer than a signal, with its slope"
            } else {
                "word of the sine table: the budget's rounding of the table"
            });
        }
        Op::Input | Op::Quantise(..) | Op::QuantiseGeared { .. } => {}
        _ => return Some("exact: every bit of the operation, range by interval analysis"),
    }
    let words = name.split('_').filter(|w| w.parse::<u32>().is_err());
    let stem = words.collect::<Vec<_>>().join("_");
    if let Some((_, why)) = REASONS.iter().find(|r| r.0.contains(&stem.as_str())) {
        return Some(why);
    }
    let signal = design.structure.formats.signal.format;
    (node.format == signal).then_some("signals: the budget's rounding of signals")
}
