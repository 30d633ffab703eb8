//! `[calibration]`: which parameters are searched on line, and how.

use serde::{Deserialize, Serialize};

use super::Spec;
use super::method::{CalibrationMethod, CalibrationStart};

/// `[calibration]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// 0 (off), 4 (gains, offsets), 5 (and phase), 8 (4 and bends) or 9 (8 and phase).
    #[serde(default = "five")]
    pub parameters: u32,
    /// Which gradient moves them.
    #[serde(default)]
    pub method: CalibrationMethod,
    /// How the search begins after lock.
    #[serde(default)]
    pub start: CalibrationStart,
    /// The mean gradient of `sum_of_squares` forgets 2^-`forgetting` of itself with each sample: λ = 1 − 2^-`forgetting`.
    #[serde(default = "forgetting")]
    pub forgetting: u32,
    /// Whether 8 and 9 parameters learn the direction that the radius does not show.
    #[serde(default = "yes")]
    pub completion: bool,
    /// γ of that direction is 2^-`completion_gamma` per sector of travel.
    #[serde(default = "completion_gamma")]
    pub completion_gamma: u32,
    /// Whether the radial residual allows for what the loop lags behind the signal: ρ + e²/2 in the place of ρ, for one product more than
    /// the paper's. Default: wherever that residual is searched, see [`allows_for_lag`](Self::allows_for_lag).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lag: Option<bool>,
    /// First γ is 2^-`gamma_first`.
    #[serde(default = "gamma_first")]
    pub gamma_first: u32,
    /// Last γ is 2^-`gamma_last`. Default: see [`gamma_last`](Self::gamma_last).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gamma_last: Option<u32>,
    /// Periods of travel between gears. Default: see [`gear_periods`](Self::gear_periods).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gear_periods: Option<u32>,
    /// |ρ| above this returns to the first γ, until a gear has ended with a small residual; where the search is
    /// [guarded](Self::guards_early) in two periods one after the other.
    #[serde(default = "restart")]
    pub restart_residual: f64,
    /// |ρ| above this holds the parameters once a gear has ended without: the signal may be fading. See [`Spec::hold_residual`].
    #[serde(default = "hold")]
    pub hold_residual: f64,
    /// Periods of travel that parameters are held before the sensor is taken for changed, and the search begins again: what was recalled, or
    /// without recall whatever they are. Default: see [`hold_periods`](Self::hold_periods).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold_periods: Option<u32>,
    /// Where they begin to be held, the parameters go back to what they were some periods before: a fade of the signal takes
    /// nothing along. Two registers for each parameter. Default: wherever parameters are held, see [`recalls`](Self::recalls).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recall: Option<bool>,
}

fn five() -> u32 {
    5
}
fn forgetting() -> u32 {
    3
}
fn yes() -> bool {
    true
}
fn completion_gamma() -> u32 {
    10
}
fn gamma_first() -> u32 {
    4
}
fn restart() -> f64 {
    0.25
}

fn hold() -> f64 {
    0.0625
}

impl Spec {
    /// |ρ| from which parameters are held: as the design says, and at least what noise (six σ) and a phase error that is not
    /// calibrated (sin β sin 2α / 2, and a quarter of that) leave in the radius.
    #[must_use]
    pub fn hold_residual(&self) -> f64 {
        self.calibration.hold_residual.max(self.left_in_lock())
    }

    /// Of e and ρ alike: e holds sin β (1 + cos 2α) / 2, of which the loop follows the first.
    fn left_in_lock(&self) -> f64 {
        let phase = if self.calibration.has_phase() {
            0.0
        } else {
            0.625 * self.sensor.phase_error_max_deg.to_radians().sin()
        };
        6.0 * self.sensor.noise_rms + phase
    }

    /// What a promised sensor leaves in lock of |e|, radians, and of |ρ|, once it is calibrated: as [`hold_residual`](Self::hold_residual)
    /// reckons, at least a twentieth, as a power of two, which makes a short comparator. A larger e is the loop catching up
    /// with a stop or a start.
    #[must_use]
    pub fn small_error(&self) -> f64 {
        let least = self.left_in_lock().max(0.05);
        least.log2().ceil().exp2()
    }

    /// Speeds are promised at which samples are so few that the radius does not show all parameters, and the search sees
    /// the radius only.
    #[must_use]
    pub fn is_sparse(&self) -> bool {
        self.promises(Calibration::SPARSE_RATE)
    }

    /// The same of the third order of both channels.
    #[must_use]
    pub fn has_sparse_bends(&self) -> bool {
        self.calibration.has_bend() && self.promises(Calibration::SPARSE_BENDS_RATE)
    }

    /// Whether speeds from this rate on, periods per sample, are promised to a search that sees the radius only.
    fn promises(&self, rate: f64) -> bool {
        let k = &self.calibration;
        let most = self.sensor.speed_max_periods_per_s / self.adc.sample_rate_hz;
        k.is_on() && !k.is_exact() && most >= rate
    }

    /// |e|, radians, that hardly a sensor leaves whose search has begun: twice as much.
    #[must_use]
    pub fn far_error(&self) -> f64 {
        2.0 * self.small_error()
    }

    /// A gain that moves by more within twice [`gear_periods`](Calibration::gear_periods) is of a signal that fades: a part of the
    /// amplitude, or six times a gain's noise.
    #[must_use]
    pub fn steady_gain(&self) -> f64 {
        (0.4 * self.sensor.noise_rms).max(0.5f64.powi(9))
    }
}

impl Calibration {
    /// Periods of travel that parameters are held of which nothing better is known, before the search begins again, where the design does
    /// not say.
    pub const HELD: u32 = 32;
    /// The same of those of which something is known, where the design does not say.
    pub const HELD_KNOWN: u32 = 256;
    /// γ gear from which on bends are searched by sums of squares: the ellipse is nearly found by then, and γ a fourth.
    pub const BENDS_GEAR: u32 = 2;
    /// Periods of travel in the first gear, with bends near their bounds, after which a search that began again with each gives up.
    pub const FAILED: u32 = 31;
    /// Halvings of the phase's step once γ has settled, in the final form of five parameters.
    pub const PHASE_HALVINGS: u32 = 2;
    /// Bends rest from this rate on, periods per sample: exactly seven samples a period and fewer do not show them, eight do.
    pub const BEND_RATE: f64 = 17.0 / 128.0;
    /// From this rate on, periods per sample, parameters are learned from the phase error too: exactly four samples a period do not show all
    /// along the radius.
    pub const SPARSE_RATE: f64 = 7.0 / 32.0;
    /// The same for the third order of both channels: exactly eight samples need not show it along the radius.
    pub const SPARSE_BENDS_RATE: f64 = 15.0 / 128.0;

    /// Any parameters are calibrated.
    #[must_use]
    pub fn is_on(&self) -> bool {
        self.parameters > 0
    }

    /// θ5 is calibrated.
    #[must_use]
    pub fn has_phase(&self) -> bool {
        matches!(self.parameters, 5 | 9)
    }

    /// θ6 … θ9 are calibrated.
    #[must_use]
    pub fn has_bend(&self) -> bool {
        self.parameters >= 8
    }

    /// Halvings of γ from the first to the last.
    #[must_use]
    pub fn gears(&self) -> u32 {
        self.gamma_last().saturating_sub(self.gamma_first)
    }

    /// Batches of eight and nine parameters: one step a period, half as large as one of other searches with the same γ, that lags what
    /// drifts by a period more.
    fn is_slowest(&self) -> bool {
        self.is_batch() && self.has_bend()
    }

    /// Halvings of γ after which it has settled: parameters move where a period of travel ends then.
    #[must_use]
    pub fn settled_gears(&self) -> u32 {
        if self.is_slowest() { 3 } else { 4 }
    }

    /// γ is halved often enough to settle.
    #[must_use]
    pub fn settles(&self) -> bool {
        self.gears() >= self.settled_gears()
    }

    /// Once γ has settled the parameters move where a period of travel ends, by all that it taught: what lasts less than a period,
    /// such as a vibration, moves nothing.
    #[must_use]
    pub fn waits(&self) -> bool {
        let by_samples = matches!(
            self.method,
            CalibrationMethod::Final | CalibrationMethod::Exact
        );
        self.is_on() && by_samples && self.settles()
    }

    /// A period of travel in which the loop caught up with the axis is dropped where it ends, once γ has settled. What a mean has taken in
    /// has moved the parameters already.
    #[must_use]
    pub fn drops_periods(&self) -> bool {
        self.waits() || self.is_batch() && self.settles()
    }

    /// From the first quiet period on, a residual or a phase error that is far too large is a signal that goes, not a search on its way.
    /// Batches leave out a period with one anyway, and bends by sums of squares swing so far.
    #[must_use]
    pub fn guards_early(&self) -> bool {
        self.is_on() && self.settles() && !self.is_batch() && !self.swings()
    }

    /// On the way to what they are the parameters swing widely: bends by sums of squares.
    #[must_use]
    pub fn swings(&self) -> bool {
        self.squares() && self.has_bend()
    }

    /// Sums of squares do not need the estimate, and can learn what the loop does not lock to.
    #[must_use]
    pub fn may_stray(&self) -> bool {
        self.squares() && self.settles()
    }

    /// The step of the phase becomes smaller once γ has settled ([`Self::PHASE_HALVINGS`]): until then it is twice as fast as what it
    /// brings along, and noisier.
    #[must_use]
    pub fn phase_settles(&self) -> bool {
        self.is_linear_final() && self.has_phase() && self.settles()
    }

    /// The sum over a period of travel moves the parameters, from the first on.
    #[must_use]
    pub fn is_batch(&self) -> bool {
        self.is_on() && self.method == CalibrationMethod::Batch
    }

    /// The sum of squares moves the parameters.
    #[must_use]
    pub fn squares(&self) -> bool {
        let squares = matches!(
            self.method,
            CalibrationMethod::SumOfSquares | CalibrationMethod::Batch
        );
        self.is_on() && squares
    }

    /// Recursion (11) runs.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.is_on() && self.method == CalibrationMethod::Exact
    }

    /// What the loop lags is no part of the residual. The sum of squares knows no estimate that could lag.
    #[must_use]
    pub fn allows_for_lag(&self) -> bool {
        self.is_on() && !self.squares() && self.lag.unwrap_or(true)
    }

    /// The first periods of travel are solved by least squares.
    #[must_use]
    pub fn starts(&self) -> bool {
        self.is_on() && self.start == CalibrationStart::LeastSquares
    }

    /// Gradients are gathered over samples: by the search or by its start.
    #[must_use]
    pub fn gathers(&self) -> bool {
        self.squares() || self.starts()
    }

    /// Where parameters begin to be held, those of some periods before come back.
    #[must_use]
    pub fn recalls(&self) -> bool {
        self.is_on() && self.recall.unwrap_or(self.settles())
    }

    /// Periods of travel that recalled parameters are held before the search begins again: as the design says, or as a signal takes
    /// that fades or comes back over some hundred periods. What is not known to be right is held for
    /// [`Self::hold_unknown_periods`].
    #[must_use]
    pub fn hold_periods(&self) -> u32 {
        let known = self.recall.unwrap_or(true);
        let periods = if known { Self::HELD_KNOWN } else { Self::HELD };
        self.hold_periods.unwrap_or(periods)
    }

    /// The same of parameters of which nothing better is known: [`Self::HELD`], and where the design wants no recall as it says.
    #[must_use]
    pub fn hold_unknown_periods(&self) -> u32 {
        if self.recall == Some(false) {
            self.hold_periods()
        } else {
            Self::HELD
        }
    }

    /// Quiet periods of travel after which what was recalled moves again: an eighth. What comes back slowly is small again before it is
    /// whole, for about a tenth of the way.
    #[must_use]
    pub fn returning_periods(&self) -> u32 {
        self.hold_periods().div_ceil(8)
    }

    /// γ = 2^-that of the direction that no radius shows; `None`: it is not learnt.
    #[must_use]
    pub fn completed(&self) -> Option<u32> {
        (self.has_bend() && self.completion).then_some(self.completion_gamma)
    }

    /// Whether the search is the final form with four or five parameters.
    #[must_use]
    pub fn is_linear_final(&self) -> bool {
        self.method == CalibrationMethod::Final && !self.has_bend()
    }

    /// Last γ is 2^-this: as the design says, or what follows the drift of a sensor that warms up, and has settled. A step of the exact
    /// gradient and of batches is half as large as one of the others with the same γ.
    #[must_use]
    pub fn gamma_last(&self) -> u32 {
        let follows = match self.method {
            _ if self.is_slowest() => 7,
            CalibrationMethod::Exact | CalibrationMethod::Batch => 8,
            CalibrationMethod::Final | CalibrationMethod::SumOfSquares => 9,
        };
        let settled = self.gamma_first.saturating_add(self.settled_gears());
        self.gamma_last.unwrap_or(follows.max(settled))
    }

    /// Periods of travel between gears: as the design says, or what is soonest below 1 % of the first miscalibration. The final
    /// form with four and five parameters is still quick in the fourth period; the others swing or are noisy there.
    #[must_use]
    pub fn gear_periods(&self) -> u32 {
        self.gear_periods
            .unwrap_or(if self.is_linear_final() { 4 } else { 3 })
    }

    /// Which of θ1 … θ9 the parameter set has. Without completion the third-order bends are one number, see [`Self::moving_thetas`].
    #[must_use]
    pub fn thetas(&self) -> &'static [usize] {
        match self.parameters {
            0 => &[],
            4 => &[1, 2, 3, 4],
            5 => &[1, 2, 3, 4, 5],
            8 => &[1, 2, 3, 4, 6, 7, 8, 9],
            _ => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
        }
    }

    /// Which of them have a register: what no radius shows has one only where the gradient is completed.
    #[must_use]
    pub fn moving_thetas(&self) -> Vec<usize> {
        let moves = |n: &usize| *n < 9 || self.completed().is_some();
        self.thetas().iter().copied().filter(moves).collect()
    }
}

impl Default for Calibration {
    fn default() -> Self {
        Self {
            parameters: five(),
            method: CalibrationMethod::default(),
            start: CalibrationStart::default(),
            forgetting: forgetting(),
            completion: yes(),
            completion_gamma: completion_gamma(),
            lag: None,
            gamma_first: gamma_first(),
            gamma_last: None,
            gear_periods: None,
            restart_residual: restart(),
            hold_residual: hold(),
            hold_periods: None,
            recall: None,
        }
    }
}
