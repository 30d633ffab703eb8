//! Number formats and the one lossy step of the arithmetic.
//!
//! A [`Format`] says which binary digits a signal has; a [`Quantiser`] says how a value gets there.
//! Both are data that come from the design, not types: the container holds every format.

use serde::Serialize;

/// Fraction bits of the container of [`crate::bits::Bits`]; no signal may have more.
pub const CONTAINER_FRACTION: u32 = 48;
/// Integer bits of the container, sign included.
pub const CONTAINER_INTEGER: u32 = 16;

/// A fixed-point format: `width` bits, `fraction` of them (or of the zeros before them) behind the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Format {
    /// Two's complement if true, else the value is never negative.
    pub signed: bool,
    /// Number of bits, 1 to 64.
    pub width: u32,
    /// Weight of the last bit is 2^-fraction. May exceed `width` for small numbers.
    pub fraction: u32,
}

impl Format {
    /// Two's complement with `width` bits, the last of weight 2^-`fraction`.
    #[must_use]
    pub const fn signed(width: u32, fraction: u32) -> Self {
        Self {
            signed: true,
            width,
            fraction,
        }
    }

    /// Unsigned with `width` bits, the last of weight 2^-`fraction`.
    #[must_use]
    pub const fn unsigned(width: u32, fraction: u32) -> Self {
        Self {
            signed: false,
            width,
            fraction,
        }
    }

    /// The smallest integer (in units of the last bit) that the format holds.
    #[must_use]
    pub const fn min_raw(self) -> i128 {
        if self.signed {
            -(1i128 << (self.width - 1))
        } else {
            0
        }
    }

    /// The largest integer (in units of the last bit) that the format holds.
    #[must_use]
    pub const fn max_raw(self) -> i128 {
        if self.signed {
            (1i128 << (self.width - 1)) - 1
        } else {
            (1i128 << self.width) - 1
        }
    }

    /// Weight of the last bit.
    #[must_use]
    pub fn lsb(self) -> f64 {
        exp2(-(i64::from(self.fraction)))
    }

    /// Smallest value.
    #[must_use]
    pub fn min(self) -> f64 {
        self.min_raw() as f64 * self.lsb()
    }

    /// Largest value.
    #[must_use]
    pub fn max(self) -> f64 {
        self.max_raw() as f64 * self.lsb()
    }

    /// Signed format with the fewest bits that holds every integer from `low` to `high`.
    #[must_use]
    pub fn covering(low: i128, high: i128, fraction: u32) -> Self {
        let bits = |v: i128| {
            129 - if v < 0 {
                (!v).leading_zeros()
            } else {
                v.leading_zeros()
            }
        };
        Self::signed(bits(low).max(bits(high)), fraction)
    }
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}{}.{}",
            if self.signed { 's' } else { 'u' },
            self.width,
            self.fraction
        )
    }
}

/// What happens to the digits behind the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rounding {
    /// To the nearest, ties towards +∞. Not done in the `f64` reading.
    Nearest,
    /// Cut off, towards −∞. Not done in the `f64` reading.
    Floor,
    /// Cut off as part of the algorithm (a sector number, say): done in every reading.
    Grid,
}

/// What happens to a value outside the format. Part of the algorithm: done in every reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Overflow {
    /// Modulo the format's span: angles and counters.
    Wrap,
    /// The nearest end of the format: signals and bounded parameters.
    Saturate,
    /// Cannot happen; interval analysis proves it or refuses the design.
    Never,
}

/// A format and the way into it: the only lossy step of the arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Quantiser {
    /// Where the value goes.
    pub format: Format,
    /// What happens below the last bit.
    pub rounding: Rounding,
    /// What happens outside the range.
    pub overflow: Overflow,
}

impl Quantiser {
    /// Round to nearest and saturate: the rule for signals.
    #[must_use]
    pub const fn saturating(format: Format) -> Self {
        Self {
            format,
            rounding: Rounding::Nearest,
            overflow: Overflow::Saturate,
        }
    }

    /// The same where half a bit was added before: what is left of rounding to nearest is to cut off.
    #[must_use]
    pub const fn rounded_before(self) -> Self {
        Self {
            rounding: Rounding::Floor,
            ..self
        }
    }

    /// Cut off and wrap: the rule for angles and counters.
    #[must_use]
    pub const fn wrapping(format: Format) -> Self {
        Self {
            format,
            rounding: Rounding::Floor,
            overflow: Overflow::Wrap,
        }
    }

    /// Round to nearest where the range is proven.
    #[must_use]
    pub const fn proven(format: Format) -> Self {
        Self {
            format,
            rounding: Rounding::Nearest,
            overflow: Overflow::Never,
        }
    }

    /// Cut off where the range is proven.
    #[must_use]
    pub const fn truncating(format: Format) -> Self {
        Self {
            format,
            rounding: Rounding::Floor,
            overflow: Overflow::Never,
        }
    }

    /// Cut to a grid in every reading and wrap.
    #[must_use]
    pub const fn grid(format: Format) -> Self {
        Self {
            format,
            rounding: Rounding::Grid,
            overflow: Overflow::Wrap,
        }
    }

    /// Quantises the integer `raw` with `fraction` fraction bits, exactly as the chip does.
    ///
    /// This is the plain definition that the graph's evaluator uses; [`crate::bits::Bits`] has its own, fast one.
    #[must_use]
    pub fn apply(&self, raw: i128, fraction: u32) -> i128 {
        let format = self.format;
        let shifted = if fraction > format.fraction {
            let drop = fraction - format.fraction;
            let half = if self.rounding == Rounding::Nearest {
                1i128 << (drop - 1)
            } else {
                0
            };
            (raw + half) >> drop
        } else {
            raw << (format.fraction - fraction)
        };
        match self.overflow {
            Overflow::Saturate => shifted.clamp(format.min_raw(), format.max_raw()),
            Overflow::Wrap => {
                let span = 1i128 << format.width;
                (shifted - format.min_raw()).rem_euclid(span) + format.min_raw()
            }
            Overflow::Never => shifted,
        }
    }
}

/// 2^`exponent` as an exact `f64`.
pub(crate) fn exp2(exponent: i64) -> f64 {
    2f64.powi(exponent as i32)
}
