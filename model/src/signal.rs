//! The vocabulary in which every formula of the chip is written, once.
//!
//! A kernel is a plain function over [`Signal`]. Read with `f64` it is the algorithm without rounding; read with
//! [`Bits`](crate::bits::Bits) it is the chip, bit by bit; read with [`Node`](crate::graph::Node) it records itself as
//! a graph, from which the Verilog is written. Sums, differences, products and scalings by powers of two are exact;
//! the only lossy step is [`Signal::quantise`]. There is no `if` on data in a kernel: a decision is a [`Logic`] value
//! and a [`Signal::select`]. What counts only where a decision holds may be left out where it is
//! [known not to](Logic::is_known_false).

use std::ops::{Add, Mul, Neg, Sub};

use crate::format::Quantiser;
use crate::rom::Rom;

/// What a formula is: shown in the Verilog beside the lines it becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formula {
    /// Short name, as a heading.
    pub title: &'static str,
    /// The equation in the paper's symbols.
    pub equation: &'static str,
    /// Where it comes from.
    pub source: &'static str,
}

/// A number of the chip: a signal, a register, a coefficient. Angles are in turns of a scale period.
pub trait Signal:
    Copy
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = <Self as Signal>::Wide>
{
    /// An exact product or a sum of such; only adds, subtracts and ends in `quantise`.
    type Wide: Wide<Narrow = Self>;
    /// A decision.
    type Bool: Logic;

    /// The same value, ready to be added to products.
    fn widen(self) -> Self::Wide;
    /// Times 2^`power`, exactly.
    fn scale(self, power: i32) -> Self;
    /// The lossy step.
    fn quantise(self, to: &Quantiser) -> Self;
    /// True if this value is smaller than `other`.
    fn less_than(self, other: Self) -> Self::Bool;
    /// `yes` where `condition` holds, else `no`.
    fn select(condition: Self::Bool, yes: Self, no: Self) -> Self;
    /// Reads `column` of the row of `rom` in which `address` (turns) falls.
    fn lookup(rom: &Rom, column: usize, address: Self) -> Self;
    /// Gives the value its name in waves and Verilog.
    #[must_use]
    fn named(self, _name: &'static str) -> Self {
        self
    }
    /// Starts a new formula: what is recorded from here on belongs to it.
    fn begin(self, _formula: &'static Formula) {}
}

/// An exact sum of products. Multiplying it does not compile.
pub trait Wide: Copy + Add<Output = Self> + Sub<Output = Self> {
    /// The signal it becomes.
    type Narrow: Signal;
    /// Times 2^`power`, exactly.
    #[must_use]
    fn scale(self, power: i32) -> Self;
    /// The lossy step.
    fn quantise(self, to: &Quantiser) -> Self::Narrow;
    /// Times 2^(−`stride` · `gear`), then the lossy step. `gear` is an integer from 0 to `last`.
    fn quantise_geared(
        self,
        gear: Self::Narrow,
        stride: u32,
        last: u32,
        to: &Quantiser,
    ) -> Self::Narrow;
    /// Gives the value its name in Verilog.
    #[must_use]
    fn named(self, _name: &'static str) -> Self {
        self
    }
}

/// A decision of the chip.
pub trait Logic: Copy + std::fmt::Debug {
    /// Both.
    #[must_use]
    fn and(self, other: Self) -> Self;
    /// At least one.
    #[must_use]
    fn or(self, other: Self) -> Self;
    /// Exactly one.
    #[must_use]
    fn xor(self, other: Self) -> Self;
    /// The opposite.
    #[must_use]
    fn not(self) -> Self;
    /// Gives the decision its name in waves and Verilog.
    #[must_use]
    fn named(self, _name: &'static str) -> Self {
        self
    }
    /// True where this is known not to hold, and what only counts where it holds need not be worked out. Leaving that out saves
    /// time and changes nothing; a recording never knows.
    fn is_known_false(self) -> bool {
        false
    }
}

impl Logic for bool {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self ^ other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
    #[inline(always)]
    fn is_known_false(self) -> bool {
        !self
    }
}
