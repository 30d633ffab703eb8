//! The search of the reference: which gradient a sample moves Θ by.

use super::config::{Config, Search, Steps};
use super::gradient::{Form, Observation, ResidualGradient};
use super::recursive::LeastSquaresStart;
use super::sum_of_squares::{Smoothing, SumOfSquares};
use super::{ReferenceError, Theta, require};

/// State of the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Searching {
    /// There is none.
    None,
    /// Section 5.5.
    Residual(ResidualGradient),
    /// Sections 5.2 to 5.4.
    SumOfSquares(SumOfSquares),
    /// Final form, after a start by recursive least squares.
    Started(Box<LeastSquaresStart>),
}

impl Searching {
    /// Before the first sample.
    pub(super) fn new(config: &Config) -> Result<Self, ReferenceError> {
        for &gamma in config.gamma.first.iter() {
            require(gamma.is_finite(), "gamma", gamma, "a step is finite")?;
        }
        for &gamma in config.gamma.first.diagonal().iter() {
            let reason = "a step against the gradient is not negative";
            require(gamma >= 0.0, "gamma", gamma, reason)?;
        }
        let along_radius = matches!(
            config.search,
            Search::Residual(Form::Final) | Search::SumOfSquares(_)
        );
        if config.completion.is_some() && !along_radius {
            return Err(ReferenceError::Impossible(
                "the completion is beside a search along the radius; the exact gradient sees that direction itself",
            ));
        }
        let filter = config.tracking.filter;
        Ok(match config.search {
            Search::None => Self::None,
            Search::Residual(form) => Self::Residual(ResidualGradient::new(form, filter)),
            Search::SumOfSquares(smoothing) => {
                if let Smoothing::Forgetting { lambda } = smoothing {
                    let reason = "the gradient is forgotten only for 0 <= lambda < 1";
                    require((0.0..1.0).contains(&lambda), "lambda", lambda, reason)?;
                }
                Self::SumOfSquares(SumOfSquares::new(smoothing))
            }
            Search::Started(start) => Self::Started(Box::new(LeastSquaresStart::new(start)?)),
        })
    }

    /// A batch forgets what it has gathered; a mean does not.
    pub(super) fn drop_period(&mut self) {
        if let Self::SumOfSquares(sum) = self {
            sum.drop_batch();
        }
    }

    /// What a sample at this α̂ (radians, unwrapped) moves Θ by, with this γ or not at all; `instead`: a gradient that it shows in the place of
    /// the residual's; `free` is 1 where a parameter learns, 0 where it rests.
    pub(super) fn step(
        &mut self,
        seen: &Observation,
        alpha_hat: f64,
        gamma: Option<&Steps>,
        (instead, free): (Option<Theta>, &Theta),
    ) -> Theta {
        let along =
            |gradient: Theta| gamma.map_or(Theta::zeros(), |g| -g * gradient.component_mul(free));
        let step = match self {
            Self::Residual(gradient) => along(instead.unwrap_or_else(|| gradient.step(seen))),
            // A closed gate takes no sample into the sum.
            Self::SumOfSquares(sum) if gamma.is_some() => {
                along(sum.step_of(&seen.m, seen.corrected, (instead, free)))
            }
            Self::Started(start) if gamma.is_some() => start
                .step(seen, alpha_hat)
                .unwrap_or_else(|| along(instead.unwrap_or_else(|| seen.final_form()))),
            Self::None | Self::SumOfSquares(_) | Self::Started(_) => Theta::zeros(),
        };
        step.component_mul(free)
    }
}
