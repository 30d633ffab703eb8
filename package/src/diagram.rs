//! What stands in the report's block diagram: the corrections and the search that this design has.

use nonius_model::spec::{CalibrationMethod, Spec};

/// Texts of the blocks.
#[derive(Debug, PartialEq)]
pub(crate) struct Diagram {
    /// What the correction does, in order.
    pub(crate) correction: String,
    /// Its parameters.
    pub(crate) thetas: String,
    /// The equation of the search; `None` where nothing is calibrated.
    pub(crate) search: Option<&'static str>,
    /// What the search is made of.
    pub(crate) seen: &'static str,
    /// A second equation, for what the radius does not show.
    pub(crate) completion: Option<&'static str>,
}

impl Diagram {
    pub(crate) fn of(spec: &Spec) -> Self {
        let c = &spec.calibration;
        let thetas = c.moving_thetas();
        let bent = thetas.contains(&6);
        let (search, seen) = match c.method {
            CalibrationMethod::Final => ("δΘ = −γ Mᵀ n ρ", "ρ"),
            CalibrationMethod::Exact => ("δΘ = −γ ∇r r, (11)", "e, ρ"),
            CalibrationMethod::SumOfSquares => ("δΘ = −γ ∇(c² + s² − 1)²", "c² + s²"),
            CalibrationMethod::Batch => ("once per period", "c² + s²"),
        };
        let corrected = match (thetas.is_empty(), bent, thetas.contains(&5)) {
            (true, ..) => "nominal gains",
            (_, true, true) => "offset, gain, bend, phase",
            (_, true, false) => "offset, gain, bend",
            (_, false, true) => "offset, gain, phase",
            (_, false, false) => "offset, gain",
        };
        let more = if spec.correction.harmonics.is_empty() {
            ""
        } else {
            ", table"
        };
        Self {
            correction: corrected.to_owned() + more,
            thetas: ranges(&thetas),
            search: (!thetas.is_empty()).then_some(search),
            seen,
            completion: c.completed().map(|_| "θ9: −γᵥ (w − ∇α̂) e"),
        }
    }
}

/// Numbers of parameters, neighbours as a range.
fn ranges(thetas: &[usize]) -> String {
    let parts = thetas.chunk_by(|a, b| a + 1 == *b);
    let part = |part: &[usize]| match part {
        [one] => format!("θ{one}"),
        [first, .., last] => format!("θ{first} … θ{last}"),
        [] => String::new(),
    };
    parts.map(part).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn neighbours_are_a_range() {
        assert_eq!(ranges(&[1, 2, 3, 4, 6, 7, 8, 9]), "θ1 … θ4, θ6 … θ9");
        assert_eq!(ranges(&[1, 3]), "θ1, θ3");
        assert_eq!(ranges(&[]), "");
    }
}
