//! What the reference is made of.

use nalgebra::SMatrix;

use super::catch_up::CatchUp;
use super::completed::CompletedConfig;
use super::gate::Gate;
use super::gradient::Form;
use super::harmonics::Harmonics;
use super::hold::HoldConfig;
use super::loops::LoopConfig;
use super::recursive::StartConfig;
use super::sparse::Sparse;
use super::start::Start;
use super::sum_of_squares::Smoothing;
use super::{Parameters, Theta};

/// Which gradient moves Θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// None: Θ stays as it is.
    None,
    /// Section 5.5: δΘ = −γ (∇r)ᵀ r.
    Residual(Form),
    /// Sections 5.2 to 5.4: δΘ = −γ ∇J.
    SumOfSquares(Smoothing),
    /// Final form, after a start by recursive least squares.
    Started(StartConfig),
}

/// The step δΘ = −Γ ∇: γ times the unit matrix in the paper; a diagonal gives each parameter its own γ, a full matrix
/// equalises the speeds of the gradient's modes.
pub type Steps = SMatrix<f64, 9, 9>;

/// γ and how it shrinks. The paper has one γ that stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gamma {
    /// The first.
    pub first: Steps,
    /// How often it is halved.
    pub halvings: u32,
    /// After so many periods of net travel in one direction, each time.
    pub periods: f64,
    /// From so many halvings on these take the place of the first; never in the paper.
    pub settled: Option<(u32, Steps)>,
    /// From so many halvings on Θ moves where a period of travel ends, by all that it taught; never in the paper.
    pub waits: Option<u32>,
}

impl Gamma {
    /// The paper's: one for all parameters, for ever.
    #[must_use]
    pub fn constant(gamma: f64) -> Self {
        Self {
            first: Steps::identity() * gamma,
            halvings: 0,
            periods: f64::INFINITY,
            settled: None,
            waits: None,
        }
    }
}

/// What the reference is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Parameter set.
    pub parameters: Parameters,
    /// Θ at the start.
    pub theta: Theta,
    /// The loop.
    pub tracking: LoopConfig,
    /// The sine is sampled so much later than the cosine, seconds; 0 in the paper.
    pub skew: f64,
    /// What stands in the channels beside the paper's signals; none there.
    pub harmonics: Harmonics,
    /// The search.
    pub search: Search,
    /// One scalar sensitivity for what the radius does not show, beside a search along it; never in the paper.
    pub completion: Option<CompletedConfig>,
    /// The residual along the radius is the radius less 1, not its projection on the estimate, which lags; never in the paper.
    pub allows_for_lag: bool,
    /// From this speed on, radians per sample, bends rest; infinite in the paper.
    pub bend_rate: f64,
    /// What is learned from the phase error too, where samples are few; nothing in the paper.
    pub sparse: Option<Sparse>,
    /// When a sample teaches nothing because the loop catches up; never in the paper.
    pub catch_up: Option<CatchUp>,
    /// γ.
    pub gamma: Gamma,
    /// When Θ may move.
    pub gate: Gate,
    /// Periods of travel whose least squares move Θ before the search does; none in the paper.
    pub solved: u32,
    /// When Θ is held; never in the paper.
    pub hold: Option<HoldConfig>,
    /// How far each parameter may go from its start; infinite in the paper.
    pub bound: Theta,
    /// How α̂ starts.
    pub start: Start,
}

impl Config {
    /// The paper as printed: final form, one γ for ever, an update each sample, no bounds, α̂ = 0 at the start.
    #[must_use]
    pub fn paper(parameters: Parameters, tracking: LoopConfig, gamma: f64) -> Self {
        Self {
            parameters,
            theta: parameters.nominal(1.0),
            tracking,
            skew: 0.0,
            harmonics: Harmonics::NONE,
            search: Search::Residual(Form::Final),
            completion: None,
            allows_for_lag: false,
            bend_rate: f64::INFINITY,
            sparse: None,
            catch_up: None,
            gamma: Gamma::constant(gamma),
            gate: Gate::EverySample,
            solved: 0,
            hold: None,
            bound: Theta::repeat(f64::INFINITY),
            start: Start::At {
                alpha_hat: 0.0,
                speed: 0.0,
                e_1: 0.0,
            },
        }
    }
}
