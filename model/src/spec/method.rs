//! Which gradient is searched on line, and how the search begins.

use serde::{Deserialize, Serialize};

/// The gradient searches of the paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationMethod {
    /// The residual gradient in its final form (5.5.1): along the radius.
    #[default]
    Final,
    /// The residual gradient with the recursion (11).
    Exact,
    /// The sum of squares (5.2, 5.3) with a forgetting factor.
    SumOfSquares,
    /// The sum of squares, gathered over a period of travel before each update.
    Batch,
}

/// How the calibration begins after lock, and again where the residual shows that the signal has changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationStart {
    /// With the largest γ.
    #[default]
    Gears,
    /// Θ by linearised least squares over each of the first two periods of travel, then the gears.
    LeastSquares,
}
