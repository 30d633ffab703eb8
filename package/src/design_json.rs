//! `design.json`: every number that was derived.

use nonius_model::design::Design;
use nonius_model::format::Format;
use nonius_model::graph::Op;
use nonius_model::kernel::skew::Order;
use nonius_model::kernel::{Coefficients, Constant};
use nonius_model::physical::{metres, radians_of_revolution};
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
    /// The correction of channel skew, where the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel_skew: Option<ChannelSkew>,
    /// The position at the output.
    pub position: Position,
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

/// The position that the chip puts out, equation (1) at its edge.
#[derive(Clone, Debug, Serialize)]
pub struct Position {
    /// Bits of whole periods.
    pub period_bits: u32,
    /// Bits of the fraction of a period.
    pub fraction_bits: u32,
    /// Weight of the last bit, periods.
    pub step_periods: f64,
    /// Metres per scale period, where the design says.
    pub metres_per_period: Option<f64>,
    /// Weight of the last bit, metres.
    pub step_m: Option<f64>,
    /// Largest displacement either way, metres.
    pub range_m: Option<f64>,
    /// Radians of the revolution per scale period, where the design says how many make one.
    pub radians_per_period: Option<f64>,
}

impl Position {
    fn of(design: &Design) -> Self {
        let (f, spec) = (&design.structure.formats, &design.spec);
        let step = f.alpha.lsb();
        Self {
            period_bits: f.count.width,
            fraction_bits: f.alpha.width,
            step_periods: step,
            metres_per_period: metres(spec, 1.0),
            step_m: metres(spec, step),
            range_m: metres(spec, 2f64.powi(f.count.width as i32 - 1)),
            radians_per_period: radians_of_revolution(spec, 1.0),
        }
    }
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
    /// p1 and p2: real and imaginary part.
    pub poles: [[f64; 2]; 2],
    /// The same of the coefficients as they are rounded.
    pub poles_quantised: [[f64; 2]; 2],
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

/// The correction of a sine that is sampled later than the cosine.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelSkew {
    /// Delay of the sine as asked for, seconds.
    pub delay_s: f64,
    /// As the chip has it.
    pub delay_quantised_s: f64,
    /// The difference, seconds.
    pub delay_error_s: f64,
    /// Phase that it makes at the largest speed, radians.
    pub phase_at_top_speed_rad: f64,
    /// Order of the series that takes it off.
    pub order: u32,
    /// Angle error there that the series leaves, at worst over what the design promises, periods rms.
    pub left_at_top_speed_periods: f64,
    /// What would be there without it, periods rms.
    pub uncorrected_at_top_speed_periods: f64,
}

impl ChannelSkew {
    fn of(design: &Design) -> Option<Self> {
        let delay_s = design.spec.correction.channel_skew_s;
        design.skew.map(|skew| Self {
            delay_s,
            delay_quantised_s: skew.delay_quantised_s,
            delay_error_s: skew.delay_quantised_s - delay_s,
            phase_at_top_speed_rad: skew.phase_max,
            order: match skew.order {
                Order::First => 1,
                Order::Second => 2,
            },
            left_at_top_speed_periods: skew.residual_rms_periods,
            uncorrected_at_top_speed_periods: skew.uncorrected_rms_periods,
        })
    }
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
    /// Noise that the calibration at its last gamma lets into the parameters.
    pub calibration: f64,
    /// What the design promises of the sensor and does not calibrate, at its worst.
    pub uncorrected: f64,
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
                poles: roots(t.pole_sum, t.pole_product),
                poles_quantised: poles_quantised(design),
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
            channel_skew: ChannelSkew::of(design),
            position: Position::of(design),
            coefficients: coefficients(design),
            formats: crate::why::formats(design),
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
                calibration: b.calibration,
                uncorrected: b.uncorrected,
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

/// The roots of z² − `sum` z + `product`, real and imaginary part.
fn roots(sum: f64, product: f64) -> [[f64; 2]; 2] {
    let square = sum * sum / 4.0 - product;
    let root = square.abs().sqrt();
    if square < 0.0 {
        [[sum / 2.0, root], [sum / 2.0, -root]]
    } else {
        [[sum / 2.0 + root, 0.0], [sum / 2.0 - root, 0.0]]
    }
}

/// The poles that the rounded coefficients make: the relations of the paper's sections 4.1 to 4.3 backwards.
fn poles_quantised(design: &Design) -> [[f64; 2]; 2] {
    let (k, tracking) = (&design.constants, &design.spec.tracking);
    let turns = std::f64::consts::TAU;
    let (a, ab) = (k.loop_a.value() * turns, k.loop_ab.value() * turns);
    let filter_pole = if tracking.filter_type == 2 {
        1.0
    } else {
        1.0 - k.loop_leak.value()
    };
    if tracking.method == 2 {
        return roots(1.0 + filter_pole - a, filter_pole);
    }
    let sum = 1.0 + filter_pole - a;
    roots(sum, sum - 1.0 + ab)
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
            "skew_delay" => {
                std::f64::consts::TAU
                    * design.spec.correction.channel_skew_s
                    * design.spec.adc.sample_rate_hz
            }
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
