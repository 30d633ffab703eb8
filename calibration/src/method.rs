//! The methods by name, what may be given, and why there may be no result.

use serde::Serialize;

use crate::set::Set;

/// How to calibrate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The geometric fit less its curvature bias.
    Unbiased,
    /// Heydemann's least squares (5).
    Heydemann,
    /// The extremes of the two signals.
    Extremes,
    /// The gradient search of 5.2: four parameters.
    Sumsq4,
    /// That of 5.3: five.
    Sumsq5,
    /// That of 5.4: eight.
    Poly8,
    /// And nine, with the phase.
    Poly9,
}

impl Method {
    /// All of them, the default first.
    pub const ALL: [Self; 7] = [
        Self::Unbiased,
        Self::Heydemann,
        Self::Extremes,
        Self::Sumsq4,
        Self::Sumsq5,
        Self::Poly8,
        Self::Poly9,
    ];

    /// Its name on the command line and in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unbiased => "unbiased",
            Self::Heydemann => "heydemann",
            Self::Extremes => "extremes",
            Self::Sumsq4 => "sumsq4",
            Self::Sumsq5 => "sumsq5",
            Self::Poly8 => "poly8",
            Self::Poly9 => "poly9",
        }
    }

    /// The parameters of its Θ.
    #[must_use]
    pub fn set(self) -> Set {
        match self {
            Self::Unbiased | Self::Heydemann | Self::Extremes | Self::Sumsq5 => Set::Five,
            Self::Sumsq4 => Set::Four,
            Self::Poly8 => Set::Eight,
            Self::Poly9 => Set::Nine,
        }
    }

    /// Whether it is a search, which may end where nothing is calibrated.
    #[must_use]
    pub fn searches(self) -> bool {
        matches!(
            self,
            Self::Sumsq4 | Self::Sumsq5 | Self::Poly8 | Self::Poly9
        )
    }

    /// Whether it finds the phase error β; the others take 0.
    #[must_use]
    pub fn finds_phase(self) -> bool {
        !matches!(self, Self::Extremes | Self::Sumsq4 | Self::Poly8)
    }
}

/// What may be given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// σ_s/σ_c, above 0; `None` estimates it. Only [`Method::Unbiased`] and the bound use it.
    pub noise_ratio: Option<f64>,
}

/// Why there is no calibration at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Not enough samples.
    #[error("{0} samples are too few; 16 or more are needed")]
    TooFew(usize),
    /// Nothing moves.
    #[error(
        "the signals stand still: {0}; move the scale by a whole period or more while recording"
    )]
    Standstill(String),
    /// The columns differ in length.
    #[error("{0} samples of cos, {1} of sin")]
    Lengths(usize, usize),
    /// A value is not finite.
    #[error("sample {0} is not finite")]
    NotFinite(usize),
    /// The noise ratio is no ratio.
    #[error("the noise ratio is {0}; it must be a number above 0")]
    Ratio(f64),
    /// No ellipse.
    #[error(
        "the samples draw no ellipse (noise about a standstill, too short an arc, or no sin/cos pair at all); move the \
         scale by a whole period or more while recording"
    )]
    NoEllipse,
}

impl Error {
    /// Whether the samples are in order and do not tell: what [`crate::undetermined`] puts into words.
    #[must_use]
    pub fn is_ignorance(&self) -> bool {
        matches!(self, Self::Standstill(_) | Self::NoEllipse)
    }
}
