//! The paper's complete system: correction, loop and on-line calibration.
//!
//! Each sample k: Θ_k corrects y_k, the phase detector compares it with α̂_k, the loop goes on to α̂_{k+1}, the search to
//! Θ_{k+1}. The estimate returned for sample k is α̂_k, made from samples before it.

use std::f64::consts::TAU;

use super::catch_up::{self, Behind};
use super::completed::Completion;
pub use super::config::{Config, Gamma, Search, Steps};
pub use super::estimate::Estimate;
use super::gate::{Gate, GateState, Window};
use super::gradient::Observation;
use super::hold::{self, Hold, Recall, Recalled, Verdict};
use super::loops::Loop;
use super::searching::Searching;
use super::solved::Solved;
use super::start::{Acquisition, Start};
use super::{ReferenceError, Theta};

/// The reference: configuration and state.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    config: Config,
    theta: Theta,
    /// Steps of the search in the running period of travel, which wait for its end.
    pending: Theta,
    /// The same of the completion; it is applied at once but where the decisions are made outside.
    completing: Theta,
    tracking: Loop,
    searching: Searching,
    completion: Option<Completion>,
    gate: GateState,
    solved: Solved,
    hold: Hold,
    recall: Recall,
    acquisition: Option<Acquisition>,
    /// Periods of travel in which the loop was far behind the axis.
    behind: Behind,
    /// Samples out of the window, one after the other.
    out_of_window: u32,
    /// Halvings of γ so far, and α̂ where the present one began.
    geared: (u32, f64),
    /// e of the sample before, radians.
    e_before: f64,
}

impl Reference {
    /// Before the first sample.
    ///
    /// # Errors
    /// A search that this parameter set cannot have, or a step that cannot converge.
    pub fn new(config: Config) -> Result<Self, ReferenceError> {
        let filter = config.tracking.filter;
        let searching = Searching::new(&config)?;
        let completion = config
            .completion
            .map(|completed| Completion::new(completed, config.parameters, filter))
            .transpose()?;
        let (tracking, acquisition) = config.start.begin(config.tracking)?;
        Ok(Self {
            config,
            theta: config.theta,
            pending: Theta::zeros(),
            completing: Theta::zeros(),
            tracking,
            searching,
            completion,
            gate: GateState::new(config.gate),
            solved: Solved::new(config.solved),
            hold: Hold::default(),
            recall: Recall::new(config.theta, tracking.alpha_hat()),
            acquisition,
            behind: Behind::default(),
            out_of_window: 0,
            geared: (0, tracking.alpha_hat()),
            e_before: match config.start {
                Start::At { e_1, .. } => e_1,
                Start::Arctangent { .. } => 0.0,
            },
        })
    }

    /// One sample, Θ moved as the configured gate and γ say. The signals must be finite.
    pub fn step(&mut self, y_c: f64, y_s: f64) -> Estimate {
        if let Some(acquisition) = &mut self.acquisition {
            let corrected = self.config.parameters.corrected(&self.theta, [y_c, y_s]);
            let (seen, found) = acquisition.step(corrected, self.config.tracking);
            if let Some(tracking) = found {
                self.tracking = tracking;
                self.geared.1 = tracking.alpha_hat();
                self.acquisition = None;
            }
            return Estimate {
                theta: self.theta,
                ..seen
            };
        }
        let seen = self.observe([y_c, y_s]);
        let waits = self.config.gamma.waits;
        let waits = waits.is_some_and(|from| self.geared.0 >= from);
        let alpha_hat = self.tracking.alpha_hat();
        let open = self.gate.step(seen.e, seen.rho, alpha_hat, waits);
        let locked = self.gate.locked();
        let behind = self.behind(seen.e, locked);
        let open = open && !behind.catches_up && self.free(seen.rho, locked);
        let due = !waits || self.gate.cleared() && (open || !locked);
        let gamma = self.gamma();
        let starting = self.solved.running();
        let solved = if starting {
            self.solve(&seen, locked)
        } else {
            Theta::zeros()
        };
        let gamma = (open && !starting && !behind.ends_so).then_some(&gamma);
        let complete = (locked && !behind.catches_up, true);
        let estimate = self.go_on(&seen, (gamma, due), complete, solved);
        self.watch(&seen);
        Estimate { locked, ..estimate }
    }

    /// One sample with the decisions made outside: the search steps by this γ, or not at all, and Θ is what it has found, or stays; so with the
    /// completion, where there is one, which still has its own gate.
    pub fn step_with(
        &mut self,
        y: [f64; 2],
        steps: (Option<&Steps>, bool),
        complete: (bool, bool),
    ) -> Estimate {
        let seen = self.observe(y);
        self.go_on(&seen, steps, complete, Theta::zeros())
    }

    /// What the search has found, or gathered, since the last period of travel ended is forgotten.
    pub fn drop_period(&mut self) {
        self.pending = Theta::zeros();
        self.searching.drop_period();
    }

    /// The same of the completion.
    pub fn drop_completion(&mut self) {
        self.completing = Theta::zeros();
    }

    /// What is known of the next sample before it comes: e and ρ are not, and are 0.
    #[must_use]
    pub fn expected(&self) -> Estimate {
        if let Some(acquisition) = &self.acquisition {
            return Estimate {
                theta: self.theta,
                ..acquisition.expected(self.config.tracking.ts)
            };
        }
        let (turns, phase) = self.tracking.turns_and_phase();
        Estimate {
            alpha_hat: self.tracking.alpha_hat(),
            turns,
            phase,
            speed: self.tracking.speed(),
            theta: self.theta,
            e: 0.0,
            rho: 0.0,
            locked: self.gate.locked(),
            updated: false,
        }
    }

    /// Θ as it stands for the next sample.
    #[must_use]
    pub fn theta(&self) -> &Theta {
        &self.theta
    }

    /// The loop as it stands for the next sample.
    #[must_use]
    pub fn tracking(&self) -> &Loop {
        &self.tracking
    }

    fn observe(&self, y: [f64; 2]) -> Observation {
        let (_, phase) = self.tracking.turns_and_phase();
        let Config {
            parameters, skew, ..
        } = self.config;
        // Before lock the speed is that of acquisition, not of the scale.
        let kappa = if self.gate.locked() {
            skew * self.tracking.speed()
        } else {
            0.0
        };
        let known = (kappa, &self.config.harmonics);
        Observation::known(parameters, &self.theta, y, phase, known)
    }

    /// Gathers a sample of the start; what it moves Θ by. A period that was solved is worth a halving of γ.
    fn solve(&mut self, seen: &Observation, locked: bool) -> Theta {
        let alpha_hat = self.tracking.alpha_hat();
        self.geared.1 = alpha_hat;
        if !locked {
            self.solved.drop_period();
            return Theta::zeros();
        }
        let solved = self.solved.step(self.config.parameters, seen, alpha_hat);
        if solved.is_some() {
            self.geared.0 = (self.geared.0 + 1).min(self.config.gamma.halvings);
        }
        solved.unwrap_or_else(Theta::zeros)
    }

    /// The loop and Θ one sample on; `solved`: what moves Θ besides the search.
    fn go_on(
        &mut self,
        seen: &Observation,
        (gamma, due): (Option<&Steps>, bool),
        (completes, completed): (bool, bool),
        solved: Theta,
    ) -> Estimate {
        let theta = self.theta;
        let estimate = Estimate {
            e: seen.e,
            rho: seen.rho,
            updated: gamma.is_some(),
            ..self.expected()
        };
        let parameters = self.config.parameters;
        let followed = self.followed(seen);
        let speed = self.tracking.speed() * self.config.tracking.ts;
        let fast = speed.abs() >= self.config.bend_rate;
        let instead = self.config.sparse.and_then(|sparse| {
            let (turns, phase) = self.tracking.turns_and_phase();
            let period = if phase < 0.0 { turns - 1 } else { turns };
            let direction = match self.config.search {
                Search::SumOfSquares(_) => seen.corrected,
                _ => [seen.cos_hat, seen.sin_hat],
            };
            sparse.gradient(
                parameters,
                seen,
                (speed, period),
                (self.e_before, direction),
            )
        });
        self.e_before = seen.e;
        let free = if fast {
            parameters.of_ellipse()
        } else {
            Theta::repeat(1.0)
        };
        if let Some(completion) = &mut self.completion {
            let completes = completes && !fast;
            self.completing +=
                completion.step(parameters, &theta, seen, estimate.alpha_hat, completes);
        }
        let alpha_hat = estimate.alpha_hat;
        let by = (instead, &free);
        self.pending += self.searching.step(&followed, alpha_hat, gamma, by);
        let Config {
            bound,
            theta: start,
            ..
        } = &self.config;
        let mut change = solved;
        if completed {
            change += self.completing;
            self.completing = Theta::zeros();
        }
        if due {
            change += self.pending;
            self.pending = Theta::zeros();
        }
        self.theta = Theta::from_fn(|i, _| {
            let moved = theta[i] + change[i];
            start[i] + (moved - start[i]).clamp(-bound[i], bound[i])
        });
        self.tracking.advance(seen.e);
        estimate
    }

    /// What was seen, less what the loop lags along the radius.
    fn followed(&self, seen: &Observation) -> Observation {
        if self.config.allows_for_lag {
            seen.without_lag()
        } else {
            *seen
        }
    }

    /// Whether the loop catches up with motion in a sample that the gate has taken, and whether that ends a period that is dropped.
    fn behind(&mut self, e: f64, locked: bool) -> catch_up::Seen {
        let Some(by) = self.config.catch_up else {
            return catch_up::Seen::default();
        };
        let far = self.geared.0 >= by.settled && e.abs() >= by.e;
        let mut seen = self.behind.step(far, self.gate.cleared(), locked);
        seen.ends_so &= by.drops;
        if seen.ends_so {
            self.drop_period();
            // It counts for no gear either. Without lock all of them begin anew.
            if locked {
                let alpha_hat = self.tracking.alpha_hat();
                self.geared.1 = hold::a_period_on(self.geared.1, alpha_hat);
                self.recall.dropped(alpha_hat);
            }
        }
        seen
    }

    /// Whether the search goes on; where the signal has changed, γ begins again. A Θ that is held may be an earlier one.
    fn free(&mut self, rho: f64, locked: bool) -> bool {
        let Some(config) = &self.config.hold else {
            return true;
        };
        let alpha_hat = self.tracking.alpha_hat();
        let lost = !locked && self.hold.lasts();
        let proven = self.recall.proven();
        let seen = (rho, alpha_hat);
        let verdict = self.hold.step(config, seen, (locked, proven));
        if let Some(hold::RecallConfig { periods, .. }) = config.recall {
            let [gain_c, _, gain_s, _] = self.config.parameters.linear();
            let seen = hold::Seen {
                verdict,
                risen: rho >= config.restart,
                faded: rho >= config.residual || lost,
                settled: self.geared.0 >= config.settled,
                locked,
                last: self.geared.0 >= self.config.gamma.halvings,
                gains: ([gain_c, gain_s], config.steady),
            };
            let recalled = self.recall.step(periods, &self.theta, alpha_hat, seen);
            if let Recalled::Held(theta) | Recalled::Again(theta) = recalled {
                self.theta = theta;
                self.pending = Theta::zeros();
                self.completing = Theta::zeros();
                self.hold.recalled();
                // A mean of the way down would be the first to act on it.
                if let Searching::SumOfSquares(sum) = &mut self.searching {
                    sum.clear();
                }
            }
            if let Recalled::Again(_) = recalled {
                self.geared = (self.config.gamma.halvings, alpha_hat);
                return false;
            }
        }
        if verdict == Verdict::Changed {
            self.geared = (0, alpha_hat);
            self.solved.again();
        }
        verdict != Verdict::Held
    }

    /// γ after its halvings.
    fn gamma(&mut self) -> Steps {
        let Gamma {
            first,
            halvings,
            periods,
            settled,
            ..
        } = self.config.gamma;
        let alpha_hat = self.tracking.alpha_hat();
        let (done, since) = self.geared;
        if !self.gate.locked() {
            self.geared.1 = alpha_hat;
        } else if done < halvings && (alpha_hat - since).abs() >= periods * TAU {
            self.geared = (done + 1, alpha_hat);
        }
        let steps = match settled {
            Some((from, steps)) if self.geared.0 >= from => steps,
            _ => first,
        };
        steps * 0.5f64.powi(self.geared.0 as i32)
    }

    /// Starts again from the arctangent where the loop has been astray for as long as lock takes.
    fn watch(&mut self, seen: &Observation) {
        let (Gate::Locked(Window { e, rho, samples })
        | Gate::Travelled(Window { e, rho, samples })) = self.config.gate
        else {
            return;
        };
        let good = seen.e.abs() < e && seen.rho > -rho;
        self.out_of_window = if good {
            0
        } else {
            self.out_of_window.saturating_add(1)
        };
        if let (true, Start::Arctangent { samples }) =
            (self.out_of_window > samples, self.config.start)
        {
            self.acquisition = Some(Acquisition::after(samples, &self.tracking));
            self.out_of_window = 0;
        }
    }
}
