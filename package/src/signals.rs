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
    /// The keys of `design.toml` that set its format; none where it follows from the algorithm or from its operands.
    pub set_by: Vec<String>,
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
        let (why, set_by) = reason(design, name, node);
        list.push(Signal {
            name: name.clone(),
            kind,
            format: node.format.to_string(),
            range: [node.range.0 as f64 * lsb, node.range.1 as f64 * lsb],
            resolution: lsb,
            why: why.into(),
            set_by,
        });
    }
    list
}

/// Reasons of what is rounded or cut, by names without their numbers, and the keys that set it. What is not here is one of the
/// signals.
const REASONS: &[(&[&str], &str, &[&str])] = &[
    (&["adc_cos", "adc_sin"], "the ADC", &["adc.bits"]),
    (
        &["alpha_hat", "alpha_hat_previous"],
        "phase: the budget's dead band of the integrator",
        &["formats.phase_bits"],
    ),
    (
        &["rate", "rate_before", "rate_lost", "speed", "kick", "drift"],
        "increments of the phase: its resolution, up to what the largest speed needs",
        &["formats.phase_bits"],
    ),
    (
        &["rate_high"],
        "the upper part of the rate, as wide as a signal, for a multiplier of that width",
        &["formats.rate_high_bits"],
    ),
    (
        &["count"],
        "counted periods, as asked for",
        &["chip.count_bits"],
    ),
    (&["carry"], "whole periods gone by in a sample", &[]),
    (
        &["alpha_hat_last_bits"],
        "last bits of the phase: from where the lock level fills again, at most half of it",
        &["formats.phase_bits", "formats.lock_level_bits"],
    ),
    (
        &["level_again"],
        "the lock level, or from where it fills again",
        &["formats.phase_bits", "formats.lock_level_bits"],
    ),
    (
        &["sine_phase"],
        "phase in the sine: the budget's truncation",
        &["formats.sine_phase_bits"],
    ),
    (
        &["quarter_phase"],
        "the phase within a quarter turn, to every bit of the phase in the sine",
        &["formats.sine_phase_bits"],
    ),
    (
        &["recent", "proven"],
        "parameter as it is remembered: two bits finer than the pair that it corrects",
        &["formats.signal_fraction", "formats.accumulator_fraction"],
    ),
    (
        &["theta_deviation", "running", "gathered_9"],
        "parameter: bounded to what the design promises, a quarter more, up to a power of two; resolution by the budget",
        &["formats.accumulator_fraction"],
    ),
    (
        &["theta", "theta_solved", "cubic_c", "cubic_s"],
        "parameter as it is multiplied: resolution by the budget, its point as far left as its bounds allow",
        &[],
    ),
    (
        &["solved", "sector_step"],
        "step of a parameter: one bit more than the widest of them",
        &["formats.accumulator_fraction"],
    ),
    (
        &["rho_c", "rho_s"],
        "residual along the direction: as wide as a signal, its point as far left as its range allows",
        &["formats.signal_fraction"],
    ),
    (
        &["rho_limited", "e_alternating"],
        "residual: a quarter of the radius at most moves a parameter; resolution by the budget",
        &["formats.residual_fraction"],
    ),
    (
        &[
            "alpha_gradient",
            "alpha_gradient_rate",
            "null_gradient",
            "null_gradient_rate",
            "null_kick",
            "null_drift",
            "w_kick",
            "w_drift",
        ],
        "gradient of the phase: two turns at most; resolution by the budget",
        &["formats.sensitivity_fraction"],
    ),
    (
        &["gathered"],
        "gathered gradient: its bound; resolution by the budget",
        &["formats.gathered_fraction"],
    ),
    (
        &["lock_level"],
        "counts so many samples to lock as the loop takes to settle",
        &["formats.lock_level_bits"],
    ),
    (
        &["level_moved"],
        "lock_level before it starts again",
        &["formats.lock_level_bits"],
    ),
    (&["loop_gear"], "numbers the gears of acquisition", &[]),
    (
        &["gamma_gear", "gamma_gear_counted", "gamma_gear_searched"],
        "numbers the gears of gamma",
        &["calibration.gamma_first", "calibration.gamma_last"],
    ),
    (
        &["gear_periods"],
        "counts the quiet periods of travel in a gear of gamma, or after a recall",
        &["calibration.gear_periods", "calibration.hold_periods"],
    ),
    (
        &["held_periods"],
        "counts the periods of travel with a large residual",
        &["calibration.hold_periods"],
    ),
    (
        &["unlocked_samples"],
        "counts samples without lock, up to 256 times the full lock level",
        &["formats.lock_level_bits"],
    ),
    (
        &["failed_periods"],
        "counts the periods of travel that failed with bends near their bounds",
        &[],
    ),
    (
        &["start_periods"],
        "counts the periods of travel that the start has solved",
        &[],
    ),
    (
        &["travel_samples"],
        "counts the samples of a period of travel at a fifth of the loop's bandwidth",
        &[],
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
        &[],
    ),
    (
        &["sectors"],
        "sectors passed in a sample, up to a period",
        &[],
    ),
    (
        &["harmonic_cos", "harmonic_sin", "harmonic_turned"],
        "harmonics: a quarter of the amplitude at most; resolution by the budget",
        &["formats.harmonic_fraction"],
    ),
    (
        &["harmonic_phase_late"],
        "phase in the table of harmonics, as that in the sine, where the sine is sampled later",
        &["formats.sine_phase_bits"],
    ),
    (
        &["skew_turns"],
        "phase of the sine's delay in turns, to the resolution of the phase",
        &["formats.phase_bits"],
    ),
    (
        &["skew_rate"],
        "speed up to a quarter above the design's largest; resolution by the budget",
        &["formats.skew_rate_bits"],
    ),
    (
        &["skew", "skew_moving"],
        "phase of the sine's delay at that speed; resolution by the budget",
        &["formats.skew_bits"],
    ),
];

/// Why a signal is as wide as it is, and the keys that set it before those of its parameter.
type Reason = (&'static str, &'static [&'static str]);

/// Why a named signal is as wide as it is, empty where nobody has said, and the keys that set it.
fn reason(design: &Design, name: &str, node: &Entry) -> (&'static str, Vec<String>) {
    let (why, keys) = match node.op {
        Op::Lookup { .. } => table_word(name),
        Op::Input | Op::Quantise(..) | Op::QuantiseGeared { .. } => {
            let stem = stem(name);
            let of = |name: &str| REASONS.iter().find(|r| r.0.contains(&name));
            match of(name).or_else(|| of(&stem)) {
                Some(&(_, why, keys)) => (why, keys),
                None => as_signal(design, node),
            }
        }
        _ => {
            let why = "exact: every bit of the operation, range by interval analysis";
            return (why, vec![]);
        }
    };
    let own = keys.iter().chain(by_parameter(name));
    let held = design.word_lengths();
    let has = |key: &&&str| !key.starts_with("formats.") || held.iter().any(|w| w.key == **key);
    (why, own.filter(has).map(ToString::to_string).collect())
}

/// The reason and the keys of a word that is read from a table.
fn table_word(name: &str) -> Reason {
    const SINE: &str = "word of the sine table: the budget's rounding of the table";
    const HARMONICS: &str = "word of the table of harmonics: the budget's rounding of the table";
    match (name.starts_with("harmonic"), name.ends_with("slope")) {
        (false, false) => (SINE, &["formats.sine_value_fraction"]),
        (false, true) => (SINE, &["formats.sine_slope_fraction"]),
        (true, false) => (HARMONICS, &["formats.harmonic_value_fraction"]),
        (true, true) => (HARMONICS, &["formats.harmonic_slope_fraction"]),
    }
}

/// The reason and the keys of what has no reason of its own.
fn as_signal(design: &Design, node: &Entry) -> Reason {
    let is_signal = node.format == design.structure.formats.signal.format;
    let why = if is_signal {
        "signals: the budget's rounding of signals"
    } else {
        ""
    };
    (why, &["formats.signal_fraction"])
}

/// A name without its numbers.
fn stem(name: &str) -> String {
    let words = name.split('_').filter(|w| w.parse::<u32>().is_err());
    words.collect::<Vec<_>>().join("_")
}

/// Words and ranges that differ from parameter to parameter.
fn by_parameter(name: &str) -> &'static [&'static str] {
    const GAIN: [&str; 2] = ["formats.gain_range_log2", "formats.gain_bits"];
    const CROSS: [&str; 2] = ["formats.cross_range_log2", "formats.cross_bits"];
    const BEND: [&str; 2] = ["formats.bend_range_log2", "formats.bend_bits"];
    let number = name.split('_').find_map(|w| w.parse::<u32>().ok());
    let (range, kept) = match (stem(name).as_str(), number) {
        ("cubic_c" | "cubic_s", _) => {
            return &["formats.bend_range_log2", "formats.cubic_bits"];
        }
        ("solved" | "sector_step", _) => {
            return &[
                "formats.gain_range_log2",
                "formats.offset_range_log2",
                "formats.cross_range_log2",
                "formats.bend_range_log2",
            ];
        }
        ("theta_deviation" | "recent" | "proven" | "running", Some(n)) => (n, true),
        // The step of a period is as wide as what it moves.
        ("gathered", Some(9)) => (9, true),
        ("theta" | "theta_solved", Some(n)) => (n, false),
        _ => return &[],
    };
    let all: &'static [&'static str; 2] = match range {
        1 | 3 => &GAIN,
        2 | 4 => return &["formats.offset_range_log2"],
        5 => &CROSS,
        _ => &BEND,
    };
    if kept { &all[..1] } else { all }
}
