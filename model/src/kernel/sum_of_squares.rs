//! The sum-of-squares gradient: ε = (c² + s² − 1)/2 in place of the radial residual, the corrected pair in place of
//! (cos α̂, sin α̂). It knows no angle and needs no loop; travel still decides which samples count. A gradient of many
//! samples makes each step: see [`gather`](super::gather).

use super::Structure;
use crate::signal::{Formula, Signal, Wide};

static RADIUS: Formula = Formula {
    title: "Squared radius",
    equation: "epsilon = (c^2 + s^2 - 1)/2",
    source: "paper section 5.2",
};

/// ε, half the error of the squared radius; ρ where the radius is near 1.
pub fn half_square<S: Signal>(c: S, s: S, half: S, structure: &Structure) -> S {
    c.begin(&RADIUS);
    ((c * c + s * s).scale(-1) - half.widen())
        .named("epsilon_exact")
        .quantise(&structure.formats.signal)
        .named("epsilon")
}
