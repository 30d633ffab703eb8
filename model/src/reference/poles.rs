//! The two closed-loop poles of section 4.1.

/// Sum and product of p1 and p2; the poles themselves may be complex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Poles {
    /// p1 + p2.
    pub sum: f64,
    /// p1 p2.
    pub product: f64,
}

impl Poles {
    /// p1,2 = exp(−ω0 ts (ξ ∓ √(ξ² − 1))) for `omega0_ts` = ω0 ts and damping `xi` = ξ > 0.
    #[must_use]
    pub fn of(omega0_ts: f64, xi: f64) -> Self {
        let product = (-2.0 * omega0_ts * xi).exp();
        let spread = (xi * xi - 1.0).abs().sqrt() * omega0_ts;
        // exp(x) + exp(−x) = 2 cosh x, and cosh of an imaginary number is a cosine.
        let half = if xi < 1.0 {
            spread.cos()
        } else {
            spread.cosh()
        };
        Self {
            sum: 2.0 * (-omega0_ts * xi).exp() * half,
            product,
        }
    }
}
