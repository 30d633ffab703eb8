//! What a calibration says.

use nonius_recording::Ellipse;
use serde::Serialize;

use crate::cramer_rao::Bound;
use crate::method::Method;
use crate::shape::Shape;
use crate::together::Together;

/// A parameter.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// a_c, b_c, a_s, b_s, beta, theta_1 …
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Standard error; `None` where it cannot be told, or the method holds the parameter fixed.
    pub std_error: Option<f64>,
    /// "column" is the unit of the columns.
    pub unit: String,
    /// Standard error that no unbiased estimator can beat, where it is known.
    pub bound: Option<f64>,
}

/// Row by row; `None` with a parameter whose error cannot be told, or which the method holds fixed.
pub type Correlations = Vec<Vec<Option<f64>>>;

/// Where the ratio of the channels' noise is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RatioSource {
    /// The residuals.
    Estimated,
    /// [`Options`](crate::Options).
    Given,
    /// The residuals do not tell it, and equal noise was taken.
    Assumed,
}

/// A calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// How.
    pub method: Method,
    /// Samples of the recording.
    pub samples: usize,
    /// Samples so far off that they were left out.
    pub outliers: usize,
    /// Rms of the corrected radius less one, of the samples that were used.
    pub residual_rms: f64,
    /// The ellipse, equation (4).
    pub ellipse: Ellipse,
    /// Θ of the method's own parameter set, for [`crate::set::Set::correct`]; none where nothing is known.
    pub theta: Vec<f64>,
    /// Physical parameters, then Θ.
    pub parameters: Vec<Parameter>,
    /// Correlations of the physical parameters, where they are known.
    pub correlations: Option<Correlations>,
    /// And those of Θ.
    pub theta_correlations: Option<Correlations>,
    /// White noise of the channels, rms, in the unit of the columns; `None` where it cannot be told.
    pub noise: Option<[f64; 2]>,
    /// Standard error of σ_s/σ_c; `None` where it was given, assumed or [extreme](Self::noise_ratio_extreme).
    pub noise_ratio_error: Option<f64>,
    /// σ_s/σ_c was estimated and is too far from equal noise to be measured: it says which channel is quiet, not how quiet.
    pub noise_ratio_extreme: bool,
    /// Where the ratio is from.
    pub noise_ratio_source: RatioSource,
    /// Noise that both channels have together, where there is such.
    pub noise_together: Option<Together>,
    /// What repeats with the angle and is no ellipse.
    pub shape: Option<Shape>,
    /// How much further consecutive parts of the recording differ than the error bars of [`Method::Unbiased`] say.
    pub scatter: Option<f64>,
    /// Share of the scale period in which there are samples, 0 to 1.
    pub arc: f64,
    /// The Cramér–Rao bound of the ellipse for that noise and those angles; that of the method's own set is beside its parameters.
    pub bound: Option<Bound>,
    /// What the data cannot tell.
    pub cannot_tell: Vec<String>,
    /// What else to know about the numbers.
    pub remarks: Vec<String>,
}

impl Calibration {
    /// The corrected pair (cos α, sin α) of a raw pair; (NaN, NaN) where nothing is known.
    #[must_use]
    pub fn correct(&self, y_c: f64, y_s: f64) -> (f64, f64) {
        if self.theta.is_empty() {
            return (f64::NAN, f64::NAN);
        }
        self.method.set().correct(&self.theta, y_c, y_s)
    }
}
