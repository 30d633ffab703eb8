//! A residual that was small and is no longer may be a signal that fades: then the parameters are held.
//!
//! They are held until a whole period has been travelled without such a residual. Where the radius is far too large, which it is
//! of no signal that fades, or the residual stays for many periods and lock is not lost, the signal has changed, and γ begins
//! again. The paper has nothing of the kind: there the gains follow a signal down to nothing.

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
            if rho >= config.restart || long {
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
#[derive(Clone, Debug, PartialEq)]
pub struct Recall {
    recent: Theta,
    proven: Theta,
    /// α̂ where Θ was last remembered or held, radians.
    since: f64,
}

impl Recall {
    /// Nothing is remembered yet.
    #[must_use]
    pub fn new(theta: Theta, alpha_hat: f64) -> Self {
        Self {
            recent: theta,
            proven: theta,
            since: alpha_hat,
        }
    }

    /// Takes Θ of a sample; what it is to be, where it is held and has its `last` γ.
    pub fn step(
        &mut self,
        periods: f64,
        theta: &Theta,
        alpha_hat: f64,
        verdict: Verdict,
        last: bool,
    ) -> Option<Theta> {
        if verdict == Verdict::Free {
            if (alpha_hat - self.since).abs() >= periods * TAU {
                (self.proven, self.recent) = (self.recent, *theta);
                self.since = alpha_hat;
            }
            return None;
        }
        self.since = alpha_hat;
        last.then(|| {
            self.recent = self.proven;
            self.proven
        })
    }
}
