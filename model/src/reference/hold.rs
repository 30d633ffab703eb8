//! A residual that was small and is no longer may be a signal that fades: then the parameters are held.
//!
//! Before it was small throughout a period of travel, Θ is still being found. They are held until a whole period has been travelled without such a residual, or many where an earlier Θ was recalled. Where it
//! stays for many periods and lock is not lost, the signal has changed, and γ begins again. The paper has nothing of the kind: there
//! the gains follow a signal down to nothing.

use std::f64::consts::TAU;

use super::Theta;

/// When to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldConfig {
    /// From |ρ| on.
    pub residual: f64,
    /// ρ from which the radius is far too large.
    pub restart: f64,
    /// Halvings of γ after which it has settled.
    pub settled: u32,
    /// Periods of travel until γ begins again: where nothing better is known, and where something is proven.
    pub periods: [u32; 2],
    /// When Θ is remembered; `None`: never.
    pub recall: Option<RecallConfig>,
    /// A gain that moves by more between two times that Θ is remembered is of a signal that fades.
    pub steady: f64,
}

/// When Θ is remembered, and how long one that was recalled rests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecallConfig {
    /// Periods of travel.
    pub periods: f64,
    /// Quiet ones.
    pub returning: u32,
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
    /// α̂ where the running period of travel began, radians; `None`: nothing is travelled yet.
    began: Option<f64>,
    /// A period has passed with a small residual since γ began.
    calm: bool,
    /// The residual was large in the running period.
    disturbed: bool,
    /// The residual was large in the period before.
    held: bool,
    /// An earlier Θ was recalled.
    returning: bool,
    /// Quiet periods since.
    quiet: u32,
    /// Periods held; where something is proven less those in which Θ was free.
    periods: u32,
}

impl Hold {
    /// An earlier Θ was recalled, and is held from here on.
    pub fn recalled(&mut self) {
        (self.calm, self.returning, self.quiet) = (true, true, 0);
    }

    /// Θ has been held for a period of travel or more.
    #[must_use]
    pub fn lasts(&self) -> bool {
        self.held
    }

    /// Takes ρ and α̂ (radians, unwrapped) of a sample; without lock (`locked`) nothing is travelled; Θ may be
    /// `proven`.
    pub fn step(
        &mut self,
        config: &HoldConfig,
        (rho, alpha_hat): (f64, f64),
        (locked, proven): (bool, bool),
    ) -> Verdict {
        if !locked {
            let Self {
                calm, returning, ..
            } = *self;
            *self = Self {
                began: Some(alpha_hat),
                calm,
                returning,
                ..Self::default()
            };
            return Verdict::Held;
        }
        self.disturbed |= rho.abs() >= config.residual;
        let began = *self.began.get_or_insert(alpha_hat);
        let travelled = (alpha_hat - began).abs() >= TAU;
        if !self.calm {
            if travelled {
                *self = Self {
                    began: Some(alpha_hat),
                    calm: !self.disturbed,
                    ..Self::default()
                };
            }
            return Verdict::Free;
        }
        if travelled {
            self.began = Some(alpha_hat);
            if self.disturbed && self.periods + 1 >= config.periods[usize::from(proven)] {
                *self = Self::default();
                return Verdict::Changed;
            }
            self.period_ends(config.recall, proven);
        }
        if self.disturbed || self.held || self.returning {
            Verdict::Held
        } else {
            Verdict::Free
        }
    }

    fn period_ends(&mut self, recall: Option<RecallConfig>, proven: bool) {
        if self.disturbed {
            self.periods += 1;
            self.quiet = 0;
        } else if !self.held {
            self.quiet += 1;
            // Every second period disturbed holds Θ as well as all of them.
            if !proven {
                self.periods = 0;
            } else if !self.returning {
                self.periods = self.periods.saturating_sub(1);
            }
            self.returning &= recall.is_some_and(|recall| self.quiet < recall.returning);
        }
        self.held = self.disturbed;
        self.disturbed = false;
    }
}

/// An angle a period further on towards α̂, radians: a period that is travelled and does not count.
pub(super) fn a_period_on(since: f64, alpha_hat: f64) -> f64 {
    since + TAU.copysign(alpha_hat - since)
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

    /// Something is proven, and γ has not begun again since because it no longer held.
    #[must_use]
    pub fn proven(&self) -> bool {
        self.known && !self.fading
    }

    /// A period of travel, up to α̂, has taught nothing.
    pub fn dropped(&mut self, alpha_hat: f64) {
        self.since = a_period_on(self.since, alpha_hat);
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
        let proven = self.proven() && (!self.apart || seen.faded);
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
