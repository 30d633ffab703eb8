//! The complete system of the paper: correction, loop, calibration on line.

use super::lock::{Lock, Travel};
use super::{Filter, FilterError, Method, Objective, ParameterSet, Poles, Search};

/// Poles of the loop while it acquires: wide, and well damped.
const ACQUISITION: (f64, f64) = (0.6, 0.8);

/// The whole system.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The loop filter.
    pub method: Method,
    /// Closed-loop poles.
    pub poles: Poles,
    /// The filter's second pole; see [`Filter::new`].
    pub second_pole: Option<f64>,
    /// Sampling period in seconds.
    pub ts: f64,
    /// Nominal amplitude of both signals, in their unit, above 0.
    pub amplitude: f64,
    /// What both signals are centred about.
    pub middle: f64,
    /// Calibration on line; `None` corrects with the nominal amplitude alone.
    pub calibration: Option<Calibration>,
}

/// How Θ is searched. The search sees signals divided by the nominal amplitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Which parameters.
    pub set: ParameterSet,
    /// Which objective.
    pub objective: Objective,
    /// γ, which the paper leaves to the reader.
    pub gamma: Gamma,
    /// A factor of γ for each parameter; 1 is the paper's.
    pub equaliser: Vec<f64>,
    /// Largest deviation of each parameter from its nominal value.
    pub bound: f64,
}

/// γ shifts gear: it starts at `first` and halves after every `periods` periods of travel, down to `last`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gamma {
    /// The largest.
    pub first: f64,
    /// The smallest.
    pub last: f64,
    /// Periods of travel between two gears, at least 1.
    pub periods: u64,
}

impl Gamma {
    /// One γ for ever, as in the paper.
    #[must_use]
    pub fn constant(gamma: f64) -> Self {
        Self {
            first: gamma,
            last: gamma,
            periods: 1,
        }
    }

    fn after(&self, periods: u64) -> f64 {
        let gear = (periods / self.periods.max(1)).min(60) as i32;
        (self.first * 0.5f64.powi(gear)).max(self.last)
    }
}

/// What the system knows before sample k.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// α̂_k in radians, unwrapped.
    pub alpha_hat: f64,
    /// Its increment per sample in radians.
    pub step: f64,
    /// The loop follows.
    pub locked: bool,
    /// Θ for signals in their own unit.
    pub theta: Vec<f64>,
}

/// The system with what it remembers.
#[derive(Clone, Debug)]
pub struct Interpolator {
    configuration: Configuration,
    designed: Filter,
    wide: Filter,
    search: Option<Search>,
    set: ParameterSet,
    theta: Vec<f64>,
    lock: Lock,
    travel: Travel,
    started: bool,
}

impl Interpolator {
    /// The system at rest.
    ///
    /// # Errors
    /// What the paper says cannot be built.
    pub fn new(configuration: Configuration) -> Result<Self, FilterError> {
        let (poles, ts) = (configuration.poles, configuration.ts);
        let designed = Filter::new(configuration.method, poles, configuration.second_pole, ts)?;
        let wide = Poles::of(ACQUISITION.0, ACQUISITION.1);
        let wide = Filter::new(Method::Three, wide, Some(1.0), ts)?;
        let calibration = configuration.calibration.as_ref();
        let set = calibration.map_or(ParameterSet::Five, |c| c.set);
        Ok(Self {
            search: calibration.map(|c| Search::new(c.set, c.objective)),
            theta: set.nominal(1.0),
            set,
            designed,
            wide,
            lock: Lock::default(),
            travel: Travel::default(),
            started: false,
            configuration,
        })
    }

    fn filter(&self) -> &Filter {
        if self.lock.locked {
            &self.designed
        } else {
            &self.wide
        }
    }

    /// What is known before the next sample.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        let filter = self.filter();
        Estimate {
            alpha_hat: filter.alpha_hat(),
            step: filter.speed() * self.configuration.ts,
            locked: self.lock.locked,
            theta: self.theta(),
        }
    }

    /// Θ for signals in their own unit: the search divides them by the amplitude, after taking off the middle.
    #[must_use]
    pub fn theta(&self) -> Vec<f64> {
        let (amplitude, middle) = (self.configuration.amplitude, self.configuration.middle);
        let mut theta = self.theta.clone();
        if theta.len() > 5 {
            return theta;
        }
        theta[0] /= amplitude;
        theta[2] /= amplitude;
        let cross = theta.get(4).map_or(0.0, |t| t / amplitude);
        theta[1] -= theta[0] * middle;
        theta[3] -= (theta[2] + cross) * middle;
        if let Some(last) = theta.get_mut(4) {
            *last = cross;
        }
        theta
    }

    /// One sample, in the unit of the amplitude.
    pub fn step(&mut self, cos: f64, sin: f64) {
        let (amplitude, middle) = (self.configuration.amplitude, self.configuration.middle);
        let (y_c, y_s) = ((cos - middle) / amplitude, (sin - middle) / amplitude);
        let (c, s) = self.set.correct(&self.theta, y_c, y_s);
        if !self.started {
            self.started = true;
            self.wide.start(s.atan2(c), 0.0);
        }
        let filter = self.filter().clone();
        let (sin_hat, cos_hat) = filter.alpha_hat().sin_cos();
        let e = s * cos_hat - c * sin_hat;
        let rho = c * cos_hat + s * sin_hat - 1.0;
        let was = self.lock.locked;
        let good = self.lock.judge(e, rho);
        let mut next = filter.clone();
        next.step(e);
        if was {
            self.calibrate((y_c, y_s), &filter, e, good);
        } else {
            self.travel.stop();
        }
        self.designed.continue_from(&next);
        self.wide.continue_from(&next);
    }

    fn calibrate(&mut self, y: (f64, f64), filter: &Filter, e: f64, good: bool) {
        let (Some(search), Some(calibration)) = (&mut self.search, &self.configuration.calibration)
        else {
            return;
        };
        let gradient = search.gradient(y, &self.theta, filter, e);
        let fresh = good && self.travel.fresh(filter.alpha_hat());
        if !fresh {
            return;
        }
        let gamma = calibration.gamma.after(self.travel.periods);
        let nominal = self.set.nominal(1.0);
        for (i, g) in gradient.iter().enumerate() {
            let factor = calibration.equaliser.get(i).copied().unwrap_or(1.0);
            let next = self.theta[i] - gamma * factor * g;
            let bound = calibration.bound;
            self.theta[i] = next.clamp(nominal[i] - bound, nominal[i] + bound);
        }
    }
}
