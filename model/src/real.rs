//! The `f64` reading: the algorithm without rounding.

use crate::format::{Overflow, Quantiser, Rounding, exp2};
use crate::rom::Rom;
use crate::signal::{Signal, Wide};

/// Wrap, clamp and grid are part of the algorithm and happen here too; only rounding does not.
#[inline]
fn fit(mut x: f64, to: &Quantiser) -> f64 {
    let format = to.format;
    if to.rounding == Rounding::Grid {
        x = (x / format.lsb()).floor() * format.lsb();
    }
    match to.overflow {
        Overflow::Saturate => x.clamp(format.min(), format.max()),
        Overflow::Wrap => {
            let span = exp2(i64::from(format.width) - i64::from(format.fraction));
            let low = format.min();
            let wrapped = x - span * ((x - low) / span).floor();
            // A tiny negative x lands exactly on the upper end, which belongs to the next span.
            if wrapped >= low + span { low } else { wrapped }
        }
        Overflow::Never => x,
    }
}

impl Signal for f64 {
    type Wide = f64;
    type Bool = bool;

    fn widen(self) -> f64 {
        self
    }
    fn scale(self, power: i32) -> f64 {
        self * exp2(i64::from(power))
    }
    fn quantise(self, to: &Quantiser) -> f64 {
        fit(self, to)
    }
    fn less_than(self, other: f64) -> bool {
        self < other
    }
    fn select(condition: bool, yes: f64, no: f64) -> f64 {
        if condition { yes } else { no }
    }
    fn lookup(rom: &Rom, column: usize, address: f64) -> f64 {
        let row = (address * exp2(i64::from(rom.index_fraction)))
            .floor()
            .max(0.0) as usize;
        rom.columns[column].exact[row.min(rom.rows() - 1)]
    }
}

impl Wide for f64 {
    type Narrow = f64;

    fn scale(self, power: i32) -> f64 {
        self * exp2(i64::from(power))
    }
    fn quantise(self, to: &Quantiser) -> f64 {
        fit(self, to)
    }
    fn quantise_geared(self, gear: f64, stride: u32, _last: u32, to: &Quantiser) -> f64 {
        fit(self * exp2(-(i64::from(stride) * gear as i64)), to)
    }
}
