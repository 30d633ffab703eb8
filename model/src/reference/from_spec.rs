//! The reference for a `design.toml`: its physical numbers, nothing of the chip.

use std::f64::consts::{SQRT_2, TAU};

use super::completed::CompletedConfig;
use super::gate::{Gate, Window};
use super::gradient::Form;
use super::harmonics::Harmonics;
use super::hold::{HoldConfig, RecallConfig};
use super::interpolator::{Gamma, Search};
use super::loops::LoopConfig;
use super::poles::Poles;
use super::start::Start;
use super::sum_of_squares::Smoothing;
use super::{CatchUp, Config, Parameters, ReferenceError, Sparse, Steps, Theta};
use crate::spec::{Calibration, CalibrationMethod, Spec};

/// From the unit of the ADC's range to y: the middle becomes 0, the nominal amplitude 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normalise {
    /// Middle of the range.
    pub middle: f64,
    /// Nominal amplitude.
    pub amplitude: f64,
}

impl Normalise {
    /// As the design says.
    #[must_use]
    pub fn of(spec: &Spec) -> Self {
        Self {
            middle: spec.adc.middle,
            amplitude: spec.sensor.amplitude,
        }
    }

    /// y of a signal.
    #[must_use]
    pub fn y(&self, signal: f64) -> f64 {
        (signal - self.middle) / self.amplitude
    }

    /// The five parameters of section 5.3 for y, as those for the signals themselves.
    #[must_use]
    pub fn theta_of_signals(&self, theta: [f64; 5]) -> [f64; 5] {
        let [t1, t2, t3, t4, t5] = theta;
        let [gain_c, gain_s, cross] = [t1, t3, t5].map(|t| t / self.amplitude);
        [
            gain_c,
            t2 - gain_c * self.middle,
            gain_s,
            t4 - (gain_s + cross) * self.middle,
            cross,
        ]
    }
}

/// The loop of a design.
///
/// # Errors
/// Poles outside the unit circle, and what the paper says is impossible.
pub fn tracking(spec: &Spec) -> Result<LoopConfig, ReferenceError> {
    let t = &spec.tracking;
    let ts = 1.0 / spec.adc.sample_rate_hz;
    let poles = Poles::new(TAU * t.bandwidth_hz, t.damping, ts)?;
    LoopConfig::named(t.method, t.filter_type, t.pole, &poles, ts)
}

/// What the design knows of the channels' harmonics.
#[must_use]
pub fn harmonics(spec: &Spec) -> Harmonics {
    let list = spec.correction.harmonics.iter();
    list.fold(Harmonics::NONE, |all, h| {
        let [cosine, sine] = h.channels();
        all.with(h.order as usize, cosine, sine)
    })
}

/// The gradient's modes are 1/2 for offsets, 1/4 and 1/2 for gains, 1/8 for the phase: brought to about one speed as the
/// chip does, whose gains and phase carry the square of the amplitude at its input to a power of two. The final form of four
/// parameters takes half of each gain's gradient from the other's; that of five has its phase twice as fast until γ has settled,
/// half as fast then. The exact gradient has twice the modes, for what turns the pair counts too, and the sum of squares, which lags, has
/// gains and phase half as fast. A batch is a step of Newton's at the first γ.
fn equaliser(spec: &Spec, parameters: Parameters) -> Steps {
    let octaves = 2.0 * (spec.sensor.amplitude / spec.adc.full_scale).log2();
    let nearest = (octaves - octaves.round()).exp2();
    let (offset, gain, phase) = match (spec.calibration.method, parameters.count()) {
        (_, 8 | 9) => (1.0, 2.0 * nearest, 4.0),
        (CalibrationMethod::Final, _) => {
            let below = (octaves + (-octaves - 0.3).round()).exp2();
            (1.0, 2.0 * below, 16.0 * below)
        }
        (CalibrationMethod::Exact, _) => (0.5, nearest, 2.0 * nearest),
        (CalibrationMethod::SumOfSquares, _) => (1.0, nearest, 4.0 * nearest),
        (CalibrationMethod::Batch, _) => (2.0, 3.0 * nearest, 8.0 * nearest),
    };
    let mut equaliser = Theta::repeat(offset);
    let [gain_c, _, gain_s, _] = parameters.linear();
    (equaliser[gain_c], equaliser[gain_s]) = (gain, gain);
    if let Some(at) = parameters.phase() {
        equaliser[at] = phase;
    }
    let mut steps = Steps::from_diagonal(&equaliser);
    let across = match (spec.calibration.method, parameters.count()) {
        (CalibrationMethod::Final, 4) => -gain / 2.0,
        // The inverse of the normal equations.
        (CalibrationMethod::Batch, 4 | 5) => -gain / 3.0,
        _ => 0.0,
    };
    (steps[(gain_c, gain_s)], steps[(gain_s, gain_c)]) = (across, across);
    steps
}

fn search(spec: &Spec) -> Search {
    let k = &spec.calibration;
    match k.method {
        _ if !k.is_on() => Search::None,
        CalibrationMethod::Final => Search::Residual(Form::Final),
        CalibrationMethod::Exact => Search::Residual(Form::Exact),
        CalibrationMethod::SumOfSquares => Search::SumOfSquares(Smoothing::Forgetting {
            lambda: 1.0 - 0.5f64.powi(k.forgetting as i32),
        }),
        CalibrationMethod::Batch => Search::SumOfSquares(Smoothing::Batch { samples: 64 }),
    }
}

fn completion(spec: &Spec) -> Option<CompletedConfig> {
    let gamma = spec.calibration.completed()?;
    Some(CompletedConfig {
        // The chip's θ9 turns the pair four times as far as v does.
        gamma_v: 4.0 * 0.5f64.powi(gamma as i32),
        slowest: TAU * spec.tracking.bandwidth_hz / (5.0 * spec.adc.sample_rate_hz),
    })
}

/// From which speeds on samples are few, where such are promised.
#[must_use]
pub fn sparse(spec: &Spec) -> Option<Sparse> {
    let from = |needed: bool, rate: f64| if needed { TAU * rate } else { f64::INFINITY };
    let (ellipse, bends) = (spec.is_sparse(), spec.has_sparse_bends());
    (ellipse || bends).then_some(Sparse {
        rate: from(ellipse, Calibration::SPARSE_RATE),
        bends_rates: [
            from(bends, Calibration::SPARSE_BENDS_RATE),
            TAU * Calibration::BEND_RATE,
        ],
    })
}

/// What makes a step of the sum of squares as large as one of the residual: its gradient is eight times that along the
/// radius, its sum under λ is the mean over 1 − λ, and a batch acts by a quarter.
fn gathered(spec: &Spec) -> f64 {
    match spec.calibration.method {
        CalibrationMethod::Final | CalibrationMethod::Exact => 1.0,
        CalibrationMethod::SumOfSquares => 0.5f64.powi(3 + spec.calibration.forgetting as i32),
        CalibrationMethod::Batch => 0.5f64.powi(5),
    }
}

/// The whole system for a design, for signals in the unit of [`Normalise`]: search, γ and its halvings as the design
/// says, the modes equalised, a step per sector of travel and in lock only, applied where a period ends once γ has settled, started
/// from the arctangent.
///
/// # Errors
/// As [`tracking`]; a number of parameters other than 0, 4, 5, 8, 9.
pub fn config(spec: &Spec) -> Result<Config, ReferenceError> {
    let tracking = tracking(spec)?;
    let k = &spec.calibration;
    let parameters = match k.parameters {
        4 => Parameters::Four,
        0 | 5 => Parameters::Five,
        8 => Parameters::ChebyshevEight,
        9 => Parameters::ChebyshevNine,
        _ => {
            return Err(ReferenceError::Impossible(
                "the parameter sets have 4, 5, 8 or 9 parameters",
            ));
        }
    };
    let s = &spec.sensor;
    let beta = s.phase_error_max_deg.to_radians();
    let more = 5.0 * s.noise_rms
        + TAU * s.speed_max_periods_per_s * spec.correction.channel_skew_s.abs() / 2.0;
    let radius = 1.5 * s.offset_max + s.amplitude_tolerance + beta + more;
    // What a loop that follows none of it sees as phase error.
    let turn = s.amplitude_tolerance + SQRT_2 * s.offset_max + 0.75 * beta + more;
    let first = equaliser(spec, parameters) * (0.5f64.powi(k.gamma_first as i32) * gathered(spec));
    let settled = parameters.phase().filter(|_| k.phase_settles()).map(|at| {
        let mut steps = first;
        let less = 0.5f64.powi(Calibration::PHASE_HALVINGS as i32);
        steps.row_mut(at).scale_mut(less);
        (k.settled_gears(), steps)
    });
    // A loop settles within some multiples of 1/ω0.
    let omega = TAU * spec.tracking.bandwidth_hz / spec.adc.sample_rate_hz;
    let settles = (4.0 / omega).ceil().clamp(8.0, 1e6) as u32;
    let window = Window {
        e: (1.2 * turn).clamp(0.35, 0.8),
        rho: (1.25 * radius).clamp(0.4, 0.9),
        samples: settles,
    };
    Ok(Config {
        parameters,
        theta: parameters.nominal(1.0),
        tracking,
        skew: spec.correction.channel_skew_s,
        harmonics: harmonics(spec),
        search: search(spec),
        completion: completion(spec),
        allows_for_lag: k.allows_for_lag(),
        bend_rate: TAU * Calibration::BEND_RATE,
        sparse: sparse(spec),
        // A loop of type 1 always lags.
        catch_up: (k.is_on() && k.settles() && spec.tracking.filter_type == 2).then(|| CatchUp {
            settled: k.settled_gears(),
            e: spec.small_error(),
            drops: k.drops_periods(),
        }),
        gamma: Gamma {
            first,
            halvings: k.gears(),
            periods: k.gear_periods().into(),
            settled,
            waits: k.waits().then_some(k.settled_gears()),
        },
        gate: if k.is_on() {
            Gate::Travelled(window)
        } else {
            Gate::Locked(window)
        },
        solved: if k.starts() { 2 } else { 0 },
        hold: k.settles().then(|| HoldConfig {
            residual: spec.hold_residual(),
            restart: k.restart_residual,
            settled: k.settled_gears(),
            periods: [k.hold_unknown_periods(), k.hold_periods()],
            steady: spec.steady_gain(),
            recall: k.recalls().then_some(RecallConfig {
                periods: k.gear_periods().into(),
                returning: k.returning_periods().max(k.gear_periods()),
            }),
        }),
        bound: Theta::repeat(1.0),
        start: Start::Arctangent {
            samples: settles.min(64),
        },
    })
}
