//! From physical units to integers: [`Spec`] becomes [`Design`].

mod budget;
mod check;
mod constants;
mod followers;
mod formats;
mod harmonics;
mod keywords;
mod lengths;
mod limits;
mod naming;
mod poles;
mod promised;
mod ranges;
mod refuse;
mod search;
mod shortest;
mod skew;
mod word;

pub use budget::{Budget, Term};
pub use harmonics::{Harmonics, ORDER_MAX};
pub use lengths::{Followers, Words};
pub use poles::{Acquisition, Loop};
pub use skew::{PHASE_MAX, Skew};
pub use word::Word;

use std::borrow::Cow;

use thiserror::Error;

use self::lengths::Lengths;
use crate::chip::{chip_kernel, record};
use crate::graph::{Graph, RangeError};
use crate::kernel::{Coefficients, Constant, Structure};
use crate::spec::Spec;

/// Why a design cannot work.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DesignError {
    /// A field is outside what can work.
    #[error("{field} = {value}: {reason} (limit: {limit})")]
    Field {
        /// The key in `design.toml`.
        field: Cow<'static, str>,
        /// What it says.
        value: String,
        /// What it may say.
        limit: String,
        /// Why.
        reason: String,
    },
    /// A signal does not fit; with the signal and its worst case.
    #[error("[formats] cannot hold the design: {0}")]
    Range(Box<RangeError>),
}

impl DesignError {
    /// A chip that is called like one of its signals.
    #[must_use]
    pub fn name_of_a_signal(name: &str) -> Self {
        Self::Field {
            field: "name".into(),
            value: format!("{name:?}"),
            limit: "no signal of the chip".into(),
            reason: "it names the Verilog module, and a signal in it has this name".into(),
        }
    }

    /// The key in `design.toml` that it is about, with its section.
    #[must_use]
    pub fn field(&self) -> &str {
        match self {
            Self::Field { field, .. } => field,
            Self::Range(_) => "formats",
        }
    }
}

impl From<RangeError> for DesignError {
    fn from(error: RangeError) -> Self {
        Self::Range(Box::new(error))
    }
}

/// The quantised chip.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What was asked for.
    pub spec: Spec,
    /// Poles and loop coefficients.
    pub tracking: Loop,
    /// How the loop widens in acquisition.
    pub acquisition: Acquisition,
    /// Word lengths that the budget settles.
    pub words: Words,
    /// Those that follow from them.
    pub followers: Followers,
    /// What each word costs.
    pub budget: Budget,
    /// Correction of channel skew, where there is one.
    pub skew: Option<Skew>,
    /// Correction of stored harmonics, where there are any.
    pub harmonics: Option<Harmonics>,
    /// Structure and formats.
    pub structure: Structure,
    /// The numbers.
    pub constants: Coefficients<Constant>,
    /// One sample as a graph.
    pub graph: Graph,
}

impl Design {
    /// Works the design out, or says why it cannot work.
    ///
    /// # Errors
    /// [`DesignError`] names the field, its value, the limit and the reason.
    pub fn new(spec: &Spec) -> Result<Self, DesignError> {
        check::check(spec)?;
        let tracking = Loop::new(spec)?;
        skew::check(spec, &tracking)?;
        harmonics::check(spec)?;
        let acquisition = Acquisition::new(spec, &tracking);
        word::plausible(spec, &tracking)?;
        budget::reachable(spec, &tracking)?;
        let (lengths, mut budget) = shortest::choose(spec, &tracking)?;
        let limits = limits::all(&lengths, spec);
        word::present(spec, &limits)?;
        word::inside(spec, &limits, &tracking)?;
        let Lengths { words, followers } = lengths;
        let all = (&words, &followers);
        let mut structure = formats::structure(spec, &acquisition, all)?;
        let constants = constants::constants(spec, &tracking, &acquisition, all, &structure);
        let skew = skew::settle(spec, &budget, &mut structure, &constants);
        let harmonics = harmonics::settle(spec, &mut budget, &mut structure, &constants);
        let graph = record(&structure, &constants, chip_kernel)?;
        naming::apart(&spec.name, &graph)?;
        check::used(spec.chip.multipliers, &graph)?;
        Ok(Self {
            spec: spec.clone(),
            tracking,
            acquisition,
            words,
            followers,
            budget,
            skew,
            harmonics,
            structure,
            constants,
            graph,
        })
    }
}

/// Nominal amplitude after normalisation, between ½ and 1, and the power of two that makes it so.
pub(crate) fn normalisation(spec: &Spec) -> (f64, u32) {
    let ratio = spec.sensor.amplitude / spec.adc.full_scale;
    let power = (-ratio.log2()).floor().max(0.0) as u32;
    (ratio * crate::format::exp2(power.into()), power)
}
