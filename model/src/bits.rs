//! The bit-true reading: what the chip computes, at native speed.
//!
//! Every value sits in one container with 48 fraction bits, every exact product in one with 96; the formats of the
//! design say which of these bits exist. Interval analysis of the recorded graph proves that nothing leaves the
//! container, so the arithmetic here needs no checks (debug builds check all the same).

use std::ops::{Add, Mul, Neg, Sub};

use fixed::types::{I16F48, I32F96};

use crate::format::{CONTAINER_FRACTION, Quantiser};
use crate::rom::Rom;
use crate::signal::{Signal, Wide};

/// A value of the chip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bits(I16F48);

/// An exact product, or a sum of products and values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WideBits(I32F96);

const WIDE_FRACTION: u32 = 2 * CONTAINER_FRACTION;

impl Bits {
    /// The value `raw` · 2^-`fraction`.
    #[must_use]
    #[inline(always)]
    pub fn from_raw(raw: i64, fraction: u32) -> Self {
        Self(I16F48::from_bits(raw << (CONTAINER_FRACTION - fraction)))
    }

    /// The integer that stands for this value in units of 2^-`fraction`.
    #[must_use]
    #[inline(always)]
    pub fn raw(self, fraction: u32) -> i64 {
        self.0.to_bits() >> (CONTAINER_FRACTION - fraction)
    }

    /// The value as a real number, exact up to 53 bits.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.0.to_num()
    }
}

impl Add for Bits {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Bits {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Neg for Bits {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Mul for Bits {
    type Output = WideBits;
    #[inline(always)]
    fn mul(self, other: Self) -> WideBits {
        WideBits(self.0.wide_mul(other.0))
    }
}

impl Signal for Bits {
    type Wide = WideBits;
    type Bool = bool;

    #[inline(always)]
    fn widen(self) -> WideBits {
        WideBits(I32F96::from_bits(
            i128::from(self.0.to_bits()) << (WIDE_FRACTION - CONTAINER_FRACTION),
        ))
    }
    #[inline(always)]
    fn scale(self, power: i32) -> Self {
        let bits = self.0.to_bits();
        Self(I16F48::from_bits(if power >= 0 {
            bits << power
        } else {
            bits >> -power
        }))
    }
    #[inline(always)]
    fn quantise(self, to: &Quantiser) -> Self {
        let to = &to.in_container;
        Self(I16F48::from_bits(to.settle(self.0.to_bits() + to.half)))
    }
    #[inline(always)]
    fn less_than(self, other: Self) -> bool {
        self.0 < other.0
    }
    #[inline(always)]
    fn select(condition: bool, yes: Self, no: Self) -> Self {
        if condition { yes } else { no }
    }
    #[inline(always)]
    fn lookup(rom: &Rom, column: usize, address: Self) -> Self {
        rom.columns[column].bits[address.raw(rom.index_fraction) as usize]
    }
}

impl Add for WideBits {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for WideBits {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Wide for WideBits {
    type Narrow = Bits;

    #[inline(always)]
    fn scale(self, power: i32) -> Self {
        let bits = self.0.to_bits();
        // The container has no room for more places; said so, a shift takes two instructions and not eight.
        let places = |n: i32| {
            debug_assert!(n < 64, "a shift by {n} places");
            n as u32 & 63
        };
        Self(I32F96::from_bits(if power >= 0 {
            bits << places(power)
        } else {
            bits >> places(-power)
        }))
    }
    #[inline(always)]
    fn quantise(self, to: &Quantiser) -> Bits {
        let to = &to.in_container;
        let kept = (self.0.to_bits() >> CONTAINER_FRACTION) as i64;
        Bits(I16F48::from_bits(to.settle(kept + to.half)))
    }
    #[inline(always)]
    fn quantise_geared(self, gear: Bits, stride: u32, _last: u32, to: &Quantiser) -> Bits {
        // Cutting off before the rounding changes nothing: half a bit is a whole number of what is left.
        let to = &to.in_container;
        let slower =
            (self.0.to_bits() >> CONTAINER_FRACTION) as i64 >> (stride * gear.raw(0) as u32);
        Bits(I16F48::from_bits(to.settle(slower + to.half)))
    }
}
