//! What the sample says about the estimate: phase error, radial residual, loss of signal.

use super::{Coefficients, Structure};
use crate::signal::{Formula, Logic, Signal, Wide};

static PHASE: Formula = Formula {
    title: "Phase detector",
    equation: "e = s cos(alpha_hat) - c sin(alpha_hat)",
    source: "paper section 3",
};

static RADIUS: Formula = Formula {
    title: "Radial residual",
    equation: "rho = c cos(alpha_hat) + s sin(alpha_hat) - 1, the half bit of rounding in the 1",
    source: "paper section 5.5.1, n^T r",
};

static LAG: Formula = Formula {
    title: "Radius, whatever the loop lags behind",
    equation: "radius - 1 = rho + e^2/2",
    source: "rho is a projection on the estimate, which is e off the pair: cos(e) - 1 is no error of the sensor",
};

static WEAK: Formula = Formula {
    title: "Loss of signal",
    equation: "|c| and |s| both below the threshold",
    source: "",
};

/// e ≈ α − α̂ in radians.
#[inline(always)]
pub fn phase_error<S: Signal>(c: S, s: S, cos_hat: S, sin_hat: S, structure: &Structure) -> S {
    c.begin(&PHASE);
    (s * cos_hat - c * sin_hat)
        .named("e_exact")
        .quantise(&structure.formats.signal)
}

/// ρ: projection of the corrected pair on the estimate's direction, less one. The 1 is half a bit short, which rounds
/// the result without an adder of its own.
#[inline(always)]
pub fn radial_residual<S: Signal>(
    c: S,
    s: S,
    cos_hat: S,
    sin_hat: S,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    c.begin(&RADIUS);
    (c * cos_hat - k.unit_radius.widen() + s * sin_hat)
        .named("rho_exact")
        .quantise(&structure.formats.signal_rounded)
}

/// Radius of the corrected pair less one, to third order in e.
#[inline(always)]
pub fn radius<S: Signal>(rho: S, e: S) -> S::Wide {
    rho.begin(&LAG);
    rho.widen() + (e * e).scale(-1)
}

/// Whether −`limit` ≤ x < `limit`: both comparisons need only the bits above the last one of `limit`.
pub fn within<S: Signal>(x: S, limit: S) -> S::Bool {
    x.less_than(limit).and(x.less_than(-limit).not())
}

/// Both corrected signals are too small to tell an angle.
#[inline(always)]
pub fn weak<S: Signal>(c: S, s: S, k: &Coefficients<S>) -> S::Bool {
    c.begin(&WEAK);
    let (c, s) = (within(c, k.weak_signal), within(s, k.weak_signal));
    c.named("c_weak").and(s.named("s_weak"))
}
