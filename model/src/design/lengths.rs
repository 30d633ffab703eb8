//! Every word length that the analysis chooses, by the key that it has in `[formats]`.

use super::limits::of_lengths;
use crate::spec::Spec;

macro_rules! keyed {
    ($(#[$meta:meta])* $name:ident { $($(#[doc = $doc:literal])* $key:ident),* $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name {
            $($(#[doc = $doc])* pub $key: u32,)*
        }

        impl $name {
            /// Their keys.
            pub(super) const KEYS: &'static [&'static str] = &[$(stringify!($key)),*];

            /// The word of `key`; `None` where it is none of these.
            pub(super) fn word(&self, key: &str) -> Option<u32> {
                match key {
                    $(stringify!($key) => Some(self.$key),)*
                    _ => None,
                }
            }

            /// With another word of `key`.
            pub(super) fn with(mut self, key: &str, bits: u32) -> Self {
                match key {
                    $(stringify!($key) => self.$key = bits,)*
                    _ => {}
                }
                self
            }
        }
    };
}

keyed! {
    /// The word lengths that cost most.
    Words {
        /// Fraction bits of the signals.
        signal_fraction,
        /// log2 of the rows of the quarter-wave table.
        sine_rows_log2,
        /// log2 of the rows of the table of harmonics, where there is one.
        harmonic_rows_log2,
        /// Bits of the phase in the sine.
        sine_phase_bits,
        /// Bits of the phase and its increments.
        phase_bits,
        /// Fraction bits of the parameter accumulators.
        accumulator_fraction,
    }
}

keyed! {
    /// The words that follow from those; see [`Overrides`](crate::spec::Overrides) for what each is.
    #[allow(missing_docs, reason = "described where the user gives them")]
    Followers {
        sine_value_fraction,
        sine_slope_fraction,
        harmonic_fraction,
        harmonic_value_fraction,
        harmonic_slope_fraction,
        gain_bits,
        cross_bits,
        bend_bits,
        cubic_bits,
        coefficient_bits,
        rate_high_bits,
        residual_fraction,
        sensitivity_fraction,
        gathered_fraction,
        skew_rate_bits,
        skew_bits,
        lock_level_bits,
    }
}

/// All of them.
#[derive(Clone, Copy, Default)]
pub(super) struct Lengths {
    pub(super) words: Words,
    pub(super) followers: Followers,
}

impl Lengths {
    /// Their keys; the ends of a word hang on those before it alone.
    pub(super) fn keys() -> impl Iterator<Item = &'static str> {
        Words::KEYS.iter().chain(Followers::KEYS).copied()
    }

    /// The word of `key`; 0 where there is none.
    pub(super) fn word(&self, key: &str) -> u32 {
        let word = self.words.word(key).or_else(|| self.followers.word(key));
        word.unwrap_or(0)
    }

    /// With another word of `key`.
    pub(super) fn with(&self, key: &str, bits: u32) -> Self {
        Self {
            words: self.words.with(key, bits),
            followers: self.followers.with(key, bits),
        }
    }

    /// What the word of `key` may be.
    pub(super) fn ends(&self, key: &str, spec: &Spec) -> (u32, u32) {
        let bits = |n: i64| u32::try_from(n).unwrap_or(0);
        let list = of_lengths(self, spec);
        let own = list.iter().find(|l| l.key == key);
        own.map_or((0, 0), |l| (bits(l.lowest), bits(l.highest)))
    }
}
