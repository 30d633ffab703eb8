//! A residual that was small and is no longer may be a signal that fades: then the parameters are held.
//!
//! They are held until a whole period has been travelled without such a residual, or many where an earlier Θ was recalled. Where it
//! stays for many periods and lock is not lost, the signal has changed, and γ begins again. The paper has nothing of the kind: there
//! the gains follow a signal down to nothing.

use std::f64::consts::TAU;

use super::Theta;
use crate::spec::Calibration;

/// When to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldConfig {
    /// From |ρ| on.
    pub residual: f64,
    /// ρ from which the radius is far too large.
    pub restart: f64,
    /// After so many halvings of γ.
    pub settled: u32,
    /// Periods of travel until γ begins again, and where an earlier Θ was recalled.
    pub periods: [f64; 2],
    /// Periods of travel after which Θ is remembered, and the least quiet ones that a Θ which was recalled is held for; `None`: never.
    pub recall: Option<f64>,
    /// A gain that moves by more between two times that Θ is remembered is of a signal that fades.
    pub steady: f64,
}

/// What a sample means for the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Θ may move.
    Free,
    /// Θ stays.
    Held,
    /// The signal has changed.
    Changed,
}

/// Whether the parameters are held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hold {
    /// Where they began to be, and where the residual was last large: α̂, radians.
    since: Option<(f64, f64)>,
    /// An earlier Θ was recalled.
    returning: bool,
}

impl Hold {
    /// An earlier Θ was recalled, and is held from here on, α̂ in radians.
    pub fn recalled(&mut self, alpha_hat: f64) {
        self.since.get_or_insert((alpha_hat, alpha_hat));
        self.returning = true;
    }

    /// They have been held for a period of travel or more.
    #[must_use]
    pub fn lasts(&self, alpha_hat: f64) -> bool {
        let apart = |(began, _): (f64, f64)| (alpha_hat - began).abs() >= TAU;
        self.since.is_some_and(apart)
    }

    /// Takes ρ and α̂ (radians, unwrapped) of a sample; `halvings` of γ so far; without lock (`locked`) nothing is travelled.
    pub fn step(
        &mut self,
        config: &HoldConfig,
        rho: f64,
        alpha_hat: f64,
        (halvings, locked): (u32, bool),
    ) -> Verdict {
        if halvings < config.settled {
            *self = Self::default();
            return Verdict::Free;
        }
        if !locked {
            self.since = self.returning.then_some((alpha_hat, alpha_hat));
            return Verdict::Held;
        }
        if rho.abs() >= config.residual {
            let began = self.since.map_or(alpha_hat, |(began, _)| began);
            self.since = Some((began, alpha_hat));
            let most = config.periods[usize::from(self.returning)];
            if (alpha_hat - began).abs() >= most * TAU {
                *self = Self::default();
                return Verdict::Changed;
            }
        }
        let returning = config.recall.filter(|_| self.returning);
        match self.since {
            Some((began, last)) if (alpha_hat - last).abs() < quiet(began, last, returning) => {
                Verdict::Held
            }
            _ => {
                *self = Self::default();
                Verdict::Free
            }
        }
    }
}

/// Travel without a large residual after which Θ moves again, radians: a period, and where an earlier one was `returning` so many more,
/// or a part of what it was held for.
fn quiet(began: f64, last: f64, returning: Option<f64>) -> f64 {
    let held = (last - began).abs() / f64::from(Calibration::RETURNING);
    TAU + returning.map_or(0.0, |periods| held.max(periods * TAU))
}

/// Θ of better days: where it begins to be held, a fade has already taken it along for some periods.
///
/// Where the residual stays, γ begins again, and Θ follows a signal that fades more slowly than that; where the radius is then far
/// too large, the signal has come back, and where lock is lost, it is gone: Θ of before is taken again. A fade that is slower still
/// takes Θ along: none is proven while a gain moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Recall {
    recent: Theta,
    proven: Theta,
    /// α̂ where Θ was last remembered or held, radians.
    since: f64,
    /// There is a proven Θ.
    known: bool,
    /// γ began again where the residual had stayed.
    fading: bool,
    /// A gain has moved away from what is proven.
    apart: bool,
}

/// What a sample means for what is remembered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// What it means for the search.
    pub verdict: Verdict,
    /// ρ is far too large.
    pub risen: bool,
    /// ρ is larger than small, or the signal is lost that had faded for a period or more.
    pub faded: bool,
    /// γ has settled.
    pub settled: bool,
    /// The loop follows.
    pub locked: bool,
    /// γ is the last one.
    pub last: bool,
    /// The gains in Θ, and by how much they may have moved.
    pub gains: ([usize; 2], f64),
}

/// What Θ is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recalled {
    /// As it is.
    Nothing,
    /// This, as long as it is held.
    Held(Theta),
    /// This, with the last γ.
    Again(Theta),
}

impl Recall {
    /// Nothing is remembered yet.
    #[must_use]
    pub fn new(theta: Theta, alpha_hat: f64) -> Self {
        Self {
            recent: theta,
            proven: theta,
            since: alpha_hat,
            known: false,
            fading: false,
            apart: false,
        }
    }

    /// Takes Θ of a sample, to be remembered after `periods` of travel, with the last γ after twice as many.
    pub fn step(&mut self, periods: f64, theta: &Theta, alpha_hat: f64, seen: Seen) -> Recalled {
        let back = seen.risen || !(seen.locked || seen.settled);
        if self.fading && self.known && back {
            (self.fading, self.apart) = (false, false);
            self.since = alpha_hat;
            return Recalled::Again(self.proven);
        }
        if seen.verdict == Verdict::Free {
            let apart = if seen.last { 2.0 * periods } else { periods };
            if (alpha_hat - self.since).abs() >= apart * TAU {
                let (gains, limit) = seen.gains;
                let steady = gains.map(|i| (theta[i] - self.recent[i]).abs() < limit);
                self.apart |= seen.last && steady != [true; 2];
                if seen.last && (steady == [true; 2] || !self.known) {
                    self.apart = false;
                    self.proven = self.recent;
                    (self.known, self.fading) = (true, false);
                }
                self.recent = *theta;
                self.since = alpha_hat;
            }
            return Recalled::Nothing;
        }
        self.since = alpha_hat;
        let proven = self.known && !self.fading && (!self.apart || seen.faded);
        if seen.verdict == Verdict::Changed {
            self.known &= self.fading || !seen.risen;
            self.fading |= !seen.risen;
        }
        if !proven {
            return Recalled::Nothing;
        }
        (self.recent, self.apart) = (self.proven, false);
        Recalled::Held(self.proven)
    }
}
