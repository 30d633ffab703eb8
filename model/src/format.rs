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
    #[inline(always)]
    pub const fn signed(width: u32, fraction: u32) -> Self {
        Self {
            signed: true,
            width,
            fraction,
        }
    }

    /// Unsigned with `width` bits, the last of weight 2^-`fraction`.
    #[must_use]
    #[inline(always)]
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
        if self.signed {
            -exp2(i64::from(self.width) - 1 - i64::from(self.fraction))
        } else {
            0.0
        }
    }

    /// Largest value.
    #[must_use]
    pub fn max(self) -> f64 {
        let bits = self.width - u32::from(self.signed);
        exp2(i64::from(bits) - i64::from(self.fraction)) - self.lsb()
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
    /// The same for the bit-true reading.
    #[serde(skip)]
    pub(crate) in_container: InContainer,
}

impl Quantiser {
    /// A format and the way into it.
    #[must_use]
    #[inline(always)]
    pub const fn new(format: Format, rounding: Rounding, overflow: Overflow) -> Self {
        Self {
            format,
            rounding,
            overflow,
            in_container: InContainer::new(format, rounding, overflow),
        }
    }

    /// Round to nearest and saturate: the rule for signals.
    #[must_use]
    #[inline(always)]
    pub const fn saturating(format: Format) -> Self {
        Self::new(format, Rounding::Nearest, Overflow::Saturate)
    }

    /// The same where half a bit was added before: what is left of rounding to nearest is to cut off.
    #[must_use]
    #[inline(always)]
    pub const fn rounded_before(self) -> Self {
        Self {
            rounding: Rounding::Floor,
            in_container: InContainer {
                half: 0,
                ..self.in_container
            },
            ..self
        }
    }

    /// Cut off and wrap: the rule for angles and counters.
    #[must_use]
    #[inline(always)]
    pub const fn wrapping(format: Format) -> Self {
        Self::new(format, Rounding::Floor, Overflow::Wrap)
    }

    /// Cut off where the range is proven.
    #[must_use]
    #[inline(always)]
    pub const fn truncating(format: Format) -> Self {
        Self::new(format, Rounding::Floor, Overflow::Never)
    }

    /// Cut to a grid in every reading and wrap.
    #[must_use]
    #[inline(always)]
    pub const fn grid(format: Format) -> Self {
        Self::new(format, Rounding::Grid, Overflow::Wrap)
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

/// A quantiser as the bit-true reading applies it, in place: add, mask, sign-extend, clamp, on integers in units of
/// the container's last bit. Worked out once, because it is all that the chip does between its products.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct InContainer {
    /// Half a last bit of the format, 0 where nothing is rounded.
    pub(crate) half: i64,
    /// The bits that the format has; without an end above where it is signed or does not wrap.
    pub(crate) mask: i64,
    /// Bits above the sign of a format that wraps.
    pub(crate) spare: u32,
    /// Smallest value where it saturates.
    pub(crate) low: i64,
    /// Largest value where it saturates.
    pub(crate) high: i64,
}

impl InContainer {
    #[inline(always)]
    const fn new(format: Format, rounding: Rounding, overflow: Overflow) -> Self {
        // A format that is too fine for the container is refused when the chip is recorded.
        let drop = CONTAINER_FRACTION.saturating_sub(format.fraction);
        // Where the last bits are the container's own nothing is left to round, but of a product; that is refused too.
        let half = match rounding {
            Rounding::Nearest if drop > 0 => 1i64 << (drop - 1),
            Rounding::Nearest | Rounding::Floor | Rounding::Grid => 0,
        };
        let wraps = matches!(overflow, Overflow::Wrap);
        let saturates = matches!(overflow, Overflow::Saturate);
        let last_bits = (1i64 << drop) - 1;
        let top = drop + format.width;
        let above = if wraps && !format.signed && top < 64 {
            !0i64 << top
        } else {
            0
        };
        let spare = if wraps && format.signed && top < 64 {
            64 - top
        } else {
            0
        };
        Self {
            half,
            mask: !last_bits & !above,
            spare,
            low: if saturates {
                in_i64(format.min_raw() << drop)
            } else {
                i64::MIN
            },
            high: if saturates {
                in_i64(format.max_raw() << drop)
            } else {
                i64::MAX
            },
        }
    }

    /// The container's integer of what the integer `rounded` (half a bit added already) becomes.
    #[inline(always)]
    pub(crate) fn settle(&self, rounded: i64) -> i64 {
        let kept = rounded & self.mask;
        // What wraps does not saturate: each place in a kernel does always the one or always the other.
        if self.spare > 0 {
            (kept << self.spare) >> self.spare
        } else {
            // Not `clamp`, which checks its bounds every time.
            kept.max(self.low).min(self.high)
        }
    }
}

const fn in_i64(value: i128) -> i64 {
    if value > i64::MAX as i128 {
        i64::MAX
    } else if value < i64::MIN as i128 {
        i64::MIN
    } else {
        value as i64
    }
}

/// 2^`exponent` as an exact `f64`; 0 below its normal numbers, infinity above.
#[inline]
pub(crate) fn exp2(exponent: i64) -> f64 {
    f64::from_bits(((exponent.clamp(-1023, 1024) + 1023) as u64) << 52)
}
