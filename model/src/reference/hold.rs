//! A residual that was small and is no longer may be a signal that fades: then the parameters are held.
//!
//! They are held until a whole period has been travelled without such a residual. Where it stays for many periods and lock is not
//! lost, the signal has changed, and γ begins again. The paper has nothing of the kind: there the gains follow a signal down to
//! nothing.

use std::f64::consts::TAU;

use super::Theta;

/// When to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldConfig {
    /// From |ρ| on.
    pub residual: f64,
    /// ρ from which the radius is far too large.
    pub restart: f64,
    /// After so many halvings of γ.
    pub settled: u32,
    /// Periods of travel until γ begins again.
    pub periods: f64,
    /// Periods of travel after which Θ is remembered, and which a hold outlasts; `None`: never, and not.
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

/// Where the parameters began to be held, and where the residual was last large: α̂, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hold(Option<(f64, f64)>);

impl Hold {
    /// Held from here on, α̂ in radians.
    #[must_use]
    pub fn held_from(alpha_hat: f64) -> Self {
        Self(Some((alpha_hat, alpha_hat)))
    }

    /// Takes ρ and α̂ (radians, unwrapped) of a sample; `halvings` of γ so far, `None` without lock.
    pub fn step(
        &mut self,
        config: &HoldConfig,
        rho: f64,
        alpha_hat: f64,
        halvings: Option<u32>,
    ) -> Verdict {
        if halvings.is_none_or(|done| done < config.settled) {
            self.0 = None;
            return Verdict::Free;
        }
        if rho.abs() >= config.residual {
            let began = self.0.map_or(alpha_hat, |(began, _)| began);
            self.0 = Some((began, alpha_hat));
            let long = (alpha_hat - began).abs() >= config.periods * TAU;
            if long {
                self.0 = None;
                return Verdict::Changed;
            }
        }
        let quiet = (1.0 + config.recall.unwrap_or(0.0)) * TAU;
        match self.0 {
            Some((_, last)) if (alpha_hat - last).abs() < quiet => Verdict::Held,
            _ => {
                self.0 = None;
                Verdict::Free
            }
        }
    }
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
    /// ρ is larger than small.
    pub rises: bool,
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
        let proven = self.known && !self.fading && (!self.apart || seen.rises);
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
