//! `[formats]`: word lengths of the user's in place of those that the analysis chose.

use serde::{Deserialize, Serialize};

macro_rules! overrides {
    ($($(#[doc = $doc:literal])* $key:ident: $kind:ty),* $(,)?) => {
        /// `[formats]`: any of these replaces what the analysis chose. Every word length that it chooses is here; those of the
        /// other signals follow from them, from the design's own numbers or from the algorithm.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Overrides {
            $(
                $(#[doc = $doc])*
                #[serde(default, skip_serializing_if = "Option::is_none")]
                pub $key: Option<$kind>,
            )*
        }

        impl Overrides {
            /// The keys, in the order of the budget.
            pub const KEYS: &'static [&'static str] = &[$(stringify!($key)),*];

            /// What the user says of `key`; `None`: the analysis chooses, or there is no such key.
            #[must_use]
            pub fn given(&self, key: &str) -> Option<i64> {
                match key {
                    $(stringify!($key) => self.$key.map(i64::from),)*
                    _ => None,
                }
            }

            /// Says `value` of `key`, or leaves it to the analysis; false where there is no such key or it cannot be that.
            #[must_use]
            pub fn set(&mut self, key: &str, value: Option<i64>) -> bool {
                match key {
                    $(stringify!($key) => {
                        let word = value.map(<$kind>::try_from).transpose();
                        word.map(|word| self.$key = word).is_ok()
                    })*
                    _ => false,
                }
            }

            /// What the word of `key` is, in a sentence.
            #[must_use]
            pub fn meaning(key: &str) -> Option<&'static str> {
                match key {
                    $(stringify!($key) => Some(concat!($($doc),*).trim_ascii()),)*
                    _ => None,
                }
            }
        }
    };
}

overrides! {
    /// Fraction bits of the signals: corrected pair, sine and cosine, phase error, radial residual.
    signal_fraction: u32,
    /// Bits of the phase and fraction bits of its increments.
    phase_bits: u32,
    /// Bits of the phase that address and interpolate the tables.
    sine_phase_bits: u32,
    /// Rows of the quarter-wave table: 2^`sine_rows_log2`.
    sine_rows_log2: u32,
    /// Rows of the table of harmonics: 2^`harmonic_rows_log2`.
    harmonic_rows_log2: u32,
    /// Fraction bits of the parameter accumulators and of their steps.
    accumulator_fraction: u32,
    /// Fraction bits of the values in the quarter-wave table.
    sine_value_fraction: u32,
    /// Fraction bits of the slopes (per turn) in the quarter-wave table.
    sine_slope_fraction: u32,
    /// Fraction bits of the harmonics as they are read.
    harmonic_fraction: u32,
    /// Fraction bits of the values in the table of harmonics.
    harmonic_value_fraction: u32,
    /// Fraction bits of the slopes (per turn) in the table of harmonics.
    harmonic_slope_fraction: u32,
    /// Bits of the gains θ1 and θ3 as they are multiplied.
    gain_bits: u32,
    /// Bits of the phase θ5 as it is multiplied.
    cross_bits: u32,
    /// Bits of the even bends θ6 and θ7 as they are multiplied.
    bend_bits: u32,
    /// Bits of the odd bends 4 (θ8 ± θ9) as they are multiplied.
    cubic_bits: u32,
    /// log2 of the largest deviation of the gains θ1 and θ3.
    gain_range_log2: i32,
    /// log2 of the largest offsets θ2 and θ4.
    offset_range_log2: i32,
    /// log2 of the largest phase θ5.
    cross_range_log2: i32,
    /// log2 of the largest bends θ6 … θ9.
    bend_range_log2: i32,
    /// Bits of the coefficients that multiply: of the loop, of the delay of the sine, of turns and amplitude.
    coefficient_bits: u32,
    /// Bits of the upper part of the rate in a loop of type 1, multiplied on its own.
    rate_high_bits: u32,
    /// Fraction bits of the radial residual as it moves the parameters.
    residual_fraction: u32,
    /// Fraction bits of the sensitivities of the phase, and of their increments.
    sensitivity_fraction: u32,
    /// Fraction bits of the gathered gradients.
    gathered_fraction: u32,
    /// Bits of the speed as it is multiplied by the delay of the sine.
    skew_rate_bits: u32,
    /// Bits of the phase of the delay of the sine.
    skew_bits: u32,
    /// Bits of the counter of samples to lock.
    lock_level_bits: u32,
}
