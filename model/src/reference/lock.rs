//! What the paper leaves out: whether the loop follows, and whether the scale has travelled.

use std::f64::consts::TAU;

/// |e| in radians and |ρ| that are still as in lock.
const WINDOW: f64 = 0.5;
const RADIUS: f64 = 0.6;
/// Good samples that make lock, and bad ones in excess that undo it.
const ENOUGH: u32 = 32;
/// Sectors of a period.
const SECTORS: i64 = 64;

/// Counts good and bad samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Lock {
    level: u32,
    pub(super) locked: bool,
}

impl Lock {
    /// Judges a sample; true if it looks as in lock.
    pub(super) fn judge(&mut self, e: f64, rho: f64) -> bool {
        let good = e.abs() < WINDOW && rho.abs() < RADIUS;
        self.level = if good {
            (self.level + 1).min(ENOUGH)
        } else {
            self.level.saturating_sub(8)
        };
        if self.level == ENOUGH {
            self.locked = true;
        } else if self.level == 0 {
            self.locked = false;
        }
        good
    }
}

/// Each sector of the period contributes once until the position is a whole period from where the map was cleared.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Travel {
    origin: Option<i64>,
    seen: Vec<bool>,
    /// Whole periods travelled.
    pub(super) periods: u64,
}

impl Travel {
    /// Forgets where it is.
    pub(super) fn stop(&mut self) {
        self.origin = None;
    }

    /// Whether the sector of `alpha_hat` (radians, unwrapped) is fresh.
    pub(super) fn fresh(&mut self, alpha_hat: f64) -> bool {
        let sector = (alpha_hat / TAU * SECTORS as f64).floor() as i64;
        let origin = match self.origin {
            Some(origin) if (sector - origin).abs() < SECTORS => origin,
            known => {
                self.periods += u64::from(known.is_some());
                self.seen = vec![false; SECTORS as usize];
                self.origin = Some(sector);
                sector
            }
        };
        let index = (sector - origin).rem_euclid(SECTORS) as usize;
        !std::mem::replace(&mut self.seen[index], true)
    }
}
