//! Channel skew: the sine channel sampled later than the cosine channel, which the paper does not know.
//!
//! y_s = a_s sin(α + κ − β) + b_s with κ = ω · delay. Θ, which knows β alone, makes of it
//!
//! s' = [sin(α + κ − β) + sin β cos α] / cos β = sin α (cos κ + tan β sin κ) + cos α (sin κ + tan β (1 − cos κ)),
//!
//! which is solved for sin α with cos α = c: no series.

use super::{Parameters, Theta};

/// tan β as Θ has it; 0 for sets without phase. With the cubic of section 5.4 in the raw signals, that of its linear part.
#[must_use]
pub fn tan_beta(parameters: Parameters, theta: &Theta) -> f64 {
    match parameters {
        Parameters::Four
        | Parameters::Eight
        | Parameters::ChebyshevEight
        | Parameters::SplitEight => 0.0,
        Parameters::Five => theta[4] / theta[0],
        Parameters::Nine => theta[8] / theta[0],
        Parameters::ChebyshevNine => theta[8],
        Parameters::SplitNine => theta[4],
    }
}

/// The corrected pair as if both channels had been sampled with the cosine; `kappa` is the speed times the delay, radians.
#[must_use]
pub fn together([c, s]: [f64; 2], kappa: f64, tan_beta: f64) -> [f64; 2] {
    let (sin, cos) = kappa.sin_cos();
    [
        c,
        (s - c * (sin + tan_beta * (1.0 - cos))) / (cos + tan_beta * sin),
    ]
}
