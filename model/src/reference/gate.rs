//! When to calibrate: in lock only, and driven by travelled angle instead of time.
//!
//! The paper updates each sample and says that standstill biases it; without lock the update drives all gains to zero.

use std::f64::consts::TAU;

/// Sectors of a period.
const SECTORS: i64 = 64;

/// When an update is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gate {
    /// Never: fixed parameters.
    Closed,
    /// Each sample, as printed in the paper.
    EverySample,
    /// Each sample in lock.
    Locked(Window),
    /// In lock, each of 64 sectors of the period once until a whole period has been travelled.
    Travelled(Window),
}

/// What counts as lock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Largest |e|, radians.
    pub e: f64,
    /// Largest −ρ: a radius that is too large does not speak against lock. Parameters of a signal that had faded make one, and
    /// only in lock do they find back.
    pub rho: f64,
    /// So many samples within it, one after the other.
    pub samples: u32,
}

/// State of a gate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GateState {
    gate: Gate,
    good: u32,
    /// Sector number, counted from the unwrapped angle, where the map was cleared.
    origin: Option<i64>,
    /// One bit for each sector of the period that was used.
    used: u64,
    /// Side of the origin that the travel before it came from: sectors there were used.
    before: i64,
    /// The map was cleared with the last sample.
    cleared: bool,
}

impl GateState {
    /// Not locked, no sector used.
    #[must_use]
    pub fn new(gate: Gate) -> Self {
        Self {
            gate,
            good: 0,
            origin: None,
            used: 0,
            before: 0,
            cleared: true,
        }
    }

    /// The map of sectors was cleared with the last sample: a period of travel ended there, or without lock nothing counted.
    #[must_use]
    pub fn cleared(&self) -> bool {
        self.cleared
    }

    /// In lock, by the window of the gate; gates without a window are always locked.
    #[must_use]
    pub fn locked(&self) -> bool {
        match self.gate {
            Gate::Closed | Gate::EverySample => true,
            Gate::Locked(window) | Gate::Travelled(window) => self.good >= window.samples,
        }
    }

    /// Takes e, ρ and α̂ (radians, unwrapped) of a sample; true if it may move the parameters. `whole`: they move where a period of
    /// travel ends, and all of it counts.
    pub fn step(&mut self, e: f64, rho: f64, alpha_hat: f64, whole: bool) -> bool {
        match self.gate {
            Gate::Closed => false,
            Gate::EverySample => true,
            Gate::Locked(window) => self.within(window, e, rho),
            Gate::Travelled(window) => {
                let open = self.within(window, e, rho);
                if !open {
                    self.origin = None;
                    self.cleared = true;
                    return false;
                }
                self.fresh(alpha_hat, whole)
            }
        }
    }

    fn within(&mut self, window: Window, e: f64, rho: f64) -> bool {
        // NaN is not within.
        let good = e.abs() < window.e && rho > -window.rho;
        self.good = if good { self.good.saturating_add(1) } else { 0 };
        self.good >= window.samples
    }

    fn fresh(&mut self, alpha_hat: f64, whole: bool) -> bool {
        let sector = (alpha_hat / TAU * SECTORS as f64).floor() as i64;
        let relative = sector - self.origin.unwrap_or(sector);
        let cleared = relative.abs() >= SECTORS;
        self.cleared = cleared;
        if cleared || self.origin.is_none() {
            self.origin = Some(sector);
            self.used = 0;
            self.before = if cleared { -relative.signum() } else { 0 };
        }
        let fresh = self.used & bit(sector) == 0;
        if fresh && !whole && relative * self.before > 0 {
            // Turned back, where sectors were used right before the map was cleared.
            if (-SECTORS / 4..SECTORS / 4).contains(&relative) {
                return false;
            }
            let passed = (1..relative.abs()).map(|n| sector - n * self.before);
            self.used |= passed.fold(0, |map, sector| map | bit(sector));
            self.before = 0;
        }
        self.used |= bit(sector);
        fresh
    }
}

/// Of a sector in the map.
fn bit(sector: i64) -> u64 {
    1 << sector.rem_euclid(SECTORS)
}
