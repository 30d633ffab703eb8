//! `design.json`: every number that was derived.

use nonius_model::design::Design;
use nonius_model::format::{Format, Quantiser};
use nonius_model::graph::{Kind, Op};
use nonius_model::kernel::{Coefficients, Constant};
use nonius_model::spec::Spec;
use serde::Serialize;

use crate::curves;
use crate::measure::{Accuracy, SineError, accuracy, sine_error};

/// The whole file.
#[derive(Clone, Debug, Serialize)]
pub struct DesignJson {
    /// Version of this layout.
    pub schema: &'static str,
    /// Name of the design and of its top module.
    pub name: String,
    /// Hash of all that went in.
    pub hash: String,
    /// Clocks from one sample to the next, and from `sample_valid` to `valid`.
    pub clocks_per_sample: usize,
    /// Products of a sample.
    pub products: usize,
    /// Multipliers they are computed on.
    pub multipliers: usize,
    /// Latencies.
    pub latency: Latency,
    /// The loop.
    #[serde(rename = "loop")]
    pub tracking: Tracking,
    /// Every coefficient with its rounding error.
    pub coefficients: Vec<Coefficient>,
    /// Every signal with a name.
    pub formats: Vec<Signal>,
    /// The sine table and what is made of it.
    pub sine_table: SineTable,
    /// Where the error of the angle comes from.
    pub budget: Budget,
    /// The bit-true chip, measured.
    pub simulated: Accuracy,
    /// What was asked for.
    pub spec: Spec,
}

/// Latencies.
#[derive(Clone, Debug, Serialize)]
pub struct Latency {
    /// From `sample_valid` to `valid`.
    pub clocks: usize,
    /// The slowest clock that serves the sample rate, hertz.
    pub clock_hz_min: f64,
    /// `clocks` at that clock, seconds.
    pub seconds_at_that_clock: f64,
    /// The position is the estimate for so many samples after the one that came in.
    pub position_is_ahead_by_samples: u32,
}

/// The loop in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Tracking {
    /// ω0 ts.
    pub omega0_ts: f64,
    /// p1 + p2.
    pub pole_sum: f64,
    /// p1 p2.
    pub pole_product: f64,
    /// Second pole of the filter; 1 is type 2.
    pub filter_pole: f64,
    /// −3 dB of the closed loop, hertz.
    pub bandwidth_3db_hz: f64,
    /// Equivalent noise bandwidth, one-sided, hertz.
    pub noise_bandwidth_hz: f64,
    /// Largest magnification of the closed loop.
    pub peak: f64,
    /// Largest speed, periods per second.
    pub speed_max_periods_per_s: f64,
    /// Position error at that speed, periods.
    pub lag_at_top_speed_periods: f64,
    /// Position error per acceleration, periods per (period/s²).
    pub acceleration_error_s2: f64,
    /// Gears in acquisition, each dividing the bandwidth by 2^`acquisition_stride`.
    pub acquisition_gears: u32,
    /// See `acquisition_gears`.
    pub acquisition_stride: u32,
}

/// A coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct Coefficient {
    /// Its name.
    pub name: String,
    /// What it is.
    pub meaning: &'static str,
    /// Integer.
    pub raw: i64,
    /// Bits.
    pub bits: u32,
    /// Fraction bits.
    pub fraction_bits: u32,
    /// What it should be.
    pub real: f64,
    /// What it is.
    pub quantised: f64,
    /// The difference as a fraction of `real`; 0 where that is 0.
    pub relative_error: f64,
}

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

/// The sine table.
#[derive(Clone, Debug, Serialize)]
pub struct SineTable {
    /// Rows.
    pub rows: usize,
    /// Bits of a row.
    pub row_bits: u32,
    /// Bits altogether.
    pub bits: u64,
    /// Errors of sine and cosine.
    pub error: SineError,
}

/// The error budget in periods rms.
#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    /// Asked for.
    pub asked: f64,
    /// The ADC's part.
    pub adc: f64,
    /// The sensor's noise through the loop.
    pub noise: f64,
    /// What the arithmetic may add.
    pub arithmetic_allowed: f64,
    /// What it adds.
    pub arithmetic: f64,
    /// Everything.
    pub total: f64,
    /// The arithmetic's part by source.
    pub terms: Vec<Term>,
}

/// A source of error.
#[derive(Clone, Debug, Serialize)]
pub struct Term {
    /// What it is.
    pub source: &'static str,
    /// Its part, periods rms.
    pub rms_periods: f64,
}

impl DesignJson {
    /// All of it; measures the sine and the accuracy.
    #[must_use]
    pub fn of(design: &Design, hash: &str, clocks: usize) -> Self {
        let (spec, t, b) = (&design.spec, &design.tracking, &design.budget);
        let (rate, products) = (spec.adc.sample_rate_hz, design.graph.products());
        let clock = rate * clocks as f64;
        let top = spec.sensor.speed_max_periods_per_s;
        let rom = &design.structure.sine;
        Self {
            schema: "nonius.design/1",
            name: spec.name.clone(),
            hash: hash.into(),
            clocks_per_sample: clocks,
            products,
            multipliers: spec.chip.multipliers.count(products),
            latency: Latency {
                clocks,
                clock_hz_min: clock,
                seconds_at_that_clock: clocks as f64 / clock,
                position_is_ahead_by_samples: 1,
            },
            tracking: Tracking {
                omega0_ts: t.omega,
                pole_sum: t.pole_sum,
                pole_product: t.pole_product,
                filter_pole: t.pole,
                bandwidth_3db_hz: curves::bandwidth(t) * rate,
                noise_bandwidth_hz: t.noise_gain * rate / 2.0,
                peak: curves::peak(t),
                speed_max_periods_per_s: top,
                lag_at_top_speed_periods: t.lag(top / rate) / std::f64::consts::TAU,
                acceleration_error_s2: 1.0 / (t.ab * std::f64::consts::TAU * rate * rate),
                acquisition_gears: design.acquisition.gears,
                acquisition_stride: design.acquisition.stride,
            },
            coefficients: coefficients(design),
            formats: formats(design),
            sine_table: SineTable {
                rows: rom.rows(),
                row_bits: rom.row_width(),
                bits: rom.bits(),
                error: sine_error(design),
            },
            budget: Budget {
                asked: spec.accuracy.rms_periods,
                adc: b.adc,
                noise: b.noise,
                arithmetic_allowed: b.allowed,
                arithmetic: b.arithmetic(),
                total: b.total(),
                terms: b
                    .terms
                    .iter()
                    .map(|t| Term {
                        source: t.source,
                        rms_periods: t.rms_periods,
                    })
                    .collect(),
            },
            simulated: accuracy(design),
            spec: spec.clone(),
        }
    }
}

fn coefficients(design: &Design) -> Vec<Coefficient> {
    let (t, mut list) = (&design.tracking, vec![]);
    design.constants.map(|name, constant| {
        let used = design.graph.ids().any(|id| {
            let node = design.graph.node(id);
            let named = node.name.as_deref() == Some(name);
            named && matches!(node.op, Op::Constant(_)) && is_read(design, id)
        });
        if !used {
            return;
        }
        let quantised = constant.value();
        let real = match name {
            "loop_a" => t.a,
            "loop_ab" => t.ab,
            "loop_leak" => 1.0 - t.pole,
            _ => constant.ideal,
        };
        let bits =
            Format::covering(constant.raw.into(), constant.raw.into(), constant.fraction).width;
        list.push(Coefficient {
            name: name.into(),
            meaning: Coefficients::<Constant>::meaning(name).unwrap_or_default(),
            raw: constant.raw,
            bits,
            fraction_bits: constant.fraction,
            real,
            quantised,
            relative_error: if real == 0.0 {
                0.0
            } else {
                (quantised - real) / real
            },
        });
    });
    list
}

fn is_read(design: &Design, id: nonius_model::graph::NodeId) -> bool {
    let graph = &design.graph;
    let used = graph.nodes.iter().any(|n| n.op.operands().contains(&id));
    used || graph
        .next
        .iter()
        .chain(&graph.probes)
        .any(|(_, n)| *n == id)
}

fn formats(design: &Design) -> Vec<Signal> {
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
            why: why(design, &node.op, node.format),
        });
    }
    list
}

fn why(design: &Design, op: &Op, format: Format) -> String {
    let f = &design.structure.formats;
    let stated = |to: &Quantiser| to.format == format;
    let named = [
        (
            stated(&f.signal),
            "signals: the budget's rounding of signals",
        ),
        (
            format == f.alpha,
            "phase: the budget's dead band of the integrator",
        ),
        (
            stated(&f.rate),
            "increments of the phase: its resolution, half a turn at most",
        ),
        (
            stated(&f.sine_phase),
            "phase in the sine: the budget's truncation",
        ),
        (format == f.count, "counted periods, as asked for"),
        (
            f.deviation.iter().any(stated),
            "parameter: bounded to what the design promises, a quarter more, up to a power of two; resolution by the budget",
        ),
        (
            stated(&f.step),
            "step of a parameter: one bit more than the widest of them",
        ),
        (format == f.adc, "the ADC"),
    ];
    let known = named.iter().find(|n| n.0).map(|n| n.1);
    match (known, op) {
        (Some(why), Op::Input | Op::Quantise(..) | Op::QuantiseGeared { .. }) => why.into(),
        (_, Op::Quantise(..) | Op::QuantiseGeared { .. } | Op::Input) => {
            "stated by its formula".into()
        }
        _ => "exact: every bit of the operation, range by interval analysis".into(),
    }
}
