//! The numbers of the chip, lifted into a reading.

use crate::bits::Bits;
use crate::graph::{Node, Recorder};
use crate::signal::Signal;

/// A coefficient: an integer, its point, what was rounded to it, and what it stands for in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    /// Integer in units of 2^-`fraction`.
    pub raw: i64,
    /// Fraction bits.
    pub fraction: u32,
    /// What it was derived as, before rounding.
    pub exact: f64,
    /// What the `f64` reading takes. For loop coefficients the quantised value (same loop, other arithmetic);
    /// for half-bit corrections of a truncation the value without it.
    pub ideal: f64,
}

impl Constant {
    /// `value` rounded to `fraction` bits; the `f64` reading takes the rounded value.
    #[must_use]
    pub fn rounded(value: f64, fraction: u32) -> Self {
        let raw = (value * crate::format::exp2(fraction.into())).round() as i64;
        Self {
            raw,
            fraction,
            exact: value,
            ideal: raw as f64 * crate::format::exp2(-i64::from(fraction)),
        }
    }

    /// `value` with the fraction bits that fill `width` bits, sign included.
    #[must_use]
    pub fn normalised(value: f64, width: u32, fraction_limit: u32) -> Self {
        let magnitude = if value == 0.0 {
            0
        } else {
            value.abs().log2().floor() as i64 + 1
        };
        let fraction = (i64::from(width) - 1 - magnitude).clamp(0, fraction_limit.into()) as u32;
        let constant = Self::rounded(value, fraction);
        // Rounding up to the next power of two would need one more bit.
        if constant.raw.unsigned_abs() >> (width - 1) != 0 && fraction > 0 {
            return Self::rounded(value, fraction - 1);
        }
        constant
    }

    /// The quantised value.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.raw as f64 * crate::format::exp2(-i64::from(self.fraction))
    }
}

macro_rules! coefficients {
    ($($(#[doc = $doc:literal])* $name:ident),* $(,)?) => {
        /// The coefficients as the kernels take them: constants of the design, or those lifted into a reading.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Coefficients<T> {
            $($(#[doc = $doc])* pub $name: T,)*
        }

        impl<T: Copy> Coefficients<T> {
            /// What the coefficient of this name is, in a sentence.
            #[must_use]
            pub fn meaning(name: &str) -> Option<&'static str> {
                match name {
                    $(stringify!($name) => Some(concat!($($doc),*).trim_ascii()),)*
                    _ => None,
                }
            }

            /// Applies `f` to every coefficient and its name.
            pub fn map<U>(&self, mut f: impl FnMut(&'static str, T) -> U) -> Coefficients<U> {
                Coefficients { $($name: f(stringify!($name), self.$name),)* }
            }
        }
    };
}

coefficients! {
    /// Middle of the ADC's code range (offset binary).
    adc_middle,
    /// Loop coefficient a, turns per radian.
    loop_a,
    /// Loop coefficients a + b, turns per radian.
    loop_ab,
    /// Loop coefficient a, radians per radian.
    loop_a_radians,
    /// Loop coefficients a + b, radians per radian.
    loop_ab_radians,
    /// 1 − p, p the second pole of a type 1 filter.
    loop_leak,
    /// Nominal θ1.
    theta_1_nominal,
    /// Nominal θ3.
    theta_3_nominal,
    /// Delay of the sine: radians of phase per turn of speed and sample.
    skew_delay,
    /// Nominal amplitude of the cosine.
    nominal_amplitude,
    /// Turns in a radian.
    turns_per_radian,
    /// A quarter turn, less one bit of the sine phase.
    quarter_turn,
    /// Half a bit of the sine phase: what was cut off, on average.
    half_bit,
    /// Half a sine table segment.
    half_segment,
    /// Half a segment of the table of harmonics.
    half_harmonic_segment,
    /// Largest |e| in lock, radians.
    lock_error,
    /// Largest −ρ in lock.
    lock_residual,
    /// Radius of the smallest signal in lock: across the estimate it has this |e|.
    lock_radius,
    /// −ρ of that signal where it points away from the estimate.
    lock_opposite,
    /// Corrected signals below this are lost.
    weak_signal,
    /// |ρ| above this begins the search again.
    restart_residual,
    /// |ρ| above this is not small: it holds the parameters once a gear has ended without.
    hold_residual,
    /// A gain that moves by more between two times that it is remembered is of a signal that fades.
    steady_gain,
    /// A gain's deviation from which it is near its bound.
    gain_near_bound,
    /// From this θ8 on, in magnitude, the bends are near their bounds.
    bend_near_bound,
    /// Bends rest from this rate on, turns per sample.
    bend_rate,
    /// From this rate on samples are few, turns per sample.
    sparse_rate,
    /// From this rate on the same for the third order, turns per sample.
    sparse_bends_rate,
    /// Rate below which the direction does not change, turns per sample.
    direction_rate,
    /// What a bad sample adds to the lock level.
    lock_down,
    /// The full lock level.
    lock_full,
    /// Lock level after a change of loop gear.
    lock_restart,
    /// Last loop gear.
    loop_gear_last,
    /// What a calibrated sensor leaves in lock is smaller: of |e| in radians, of |ρ| in amplitudes.
    small_error,
    /// Twice what a calibrated sensor leaves: the |e|, radians, of a sensor that is not calibrated yet is smaller.
    far_error,
    /// A period of travel that takes so many samples is too slow for the completion.
    travel_samples_last,
    /// From this γ gear on bends are searched by sums of squares.
    gamma_gear_bends,
    /// From this γ gear on γ has settled.
    gamma_gear_settled,
    /// Last γ gear.
    gamma_gear_last,
    /// Periods of travel per γ gear, less one.
    gear_periods_last,
    /// Periods of travel that the parameters are held before the search begins again, less one.
    held_periods_last,
    /// Periods of travel that the parameters are held where better ones are known, less one.
    hold_periods_last,
    /// One sample without lock, of all that the counter of samples without lock can hold.
    unlocked_sample,
    /// Samples without lock from which on the search has strayed.
    unlocked_samples_last,
    /// Periods that failed from which on it has.
    failed_periods_last,
    /// Quiet periods of travel after a recall that move nothing.
    returning_periods,
    /// Periods of travel that the start solves.
    start_periods_last,
    /// Travel that the start takes for a period.
    start_period,
    /// The radius 1, less half a bit of the residual.
    unit_radius,
    /// 0.
    zero,
    /// 1.
    one,
    /// ½.
    half,
    /// ¼.
    quarter,
}

impl<T: Copy> Coefficients<T> {
    /// What the coefficient of this name is, or the negative one `minus_…`, in a sentence.
    #[must_use]
    pub fn described(name: &str) -> Option<String> {
        let Some(positive) = name.strip_prefix("minus_") else {
            return Self::meaning(name).map(str::to_owned);
        };
        let meaning = Self::meaning(positive)?;
        Some(match positive {
            "one" | "half" | "quarter" => format!("−{meaning}"),
            _ => format!("Minus {positive}: {meaning}"),
        })
    }
}

impl Coefficients<Constant> {
    /// For the `f64` reading.
    #[must_use]
    pub fn real(&self) -> Coefficients<f64> {
        self.map(|_, c| c.ideal)
    }

    /// For the bit-true reading.
    #[must_use]
    pub fn bits(&self) -> Coefficients<Bits> {
        self.map(|_, c| Bits::from_raw(c.raw, c.fraction))
    }

    /// For the recording reading.
    #[must_use]
    pub fn record<'g>(&self, recorder: &'g Recorder) -> Coefficients<Node<'g>> {
        self.map(|name, c| recorder.constant(Some(name), c.raw, c.fraction))
    }
}

impl<S: Signal> Coefficients<S> {
    /// The flag that is always false.
    pub fn never(&self) -> S::Bool {
        self.zero.less_than(self.zero)
    }
}
