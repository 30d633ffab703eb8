//! Parameters with the error bars that the samples tell.

use nalgebra::DMatrix;
use nonius_recording::Ellipse;

use crate::curve::Curve;
use crate::method::Method;
use crate::result::{Correlations, Parameter};
use crate::set::Set;
use crate::words;

/// Which error bars the samples tell.
pub(crate) struct Told {
    /// Of a_c, b_c, a_s, b_s, β.
    pub(crate) physical: Vec<bool>,
    /// Of Θ.
    pub(crate) theta: Vec<bool>,
}

impl Told {
    /// Θ is made of the physical parameters, a cubic of all of them: what one cannot be told of, it cannot either.
    pub(crate) fn of(method: Method, untold: [bool; 5]) -> Self {
        let [a_c, b_c, a_s, b_s, beta] = untold;
        let cross = a_c || beta;
        let sine = a_s || beta;
        let theta = match method.set() {
            Set::Four => vec![a_c, a_c || b_c, a_s, a_s || b_s],
            Set::Five => vec![a_c, a_c || b_c, sine, sine || b_s || cross || b_c, cross],
            set => vec![untold.contains(&true); set.parameters()],
        };
        let told = |untold: &[bool]| untold.iter().map(|u| !u).collect();
        Self {
            physical: told(&untold),
            theta: told(&theta),
        }
    }
}

/// Physical parameters, then Θ; `errors` are the covariances of both, `bounds` the least that they can be.
pub(crate) fn parameters(
    method: Method,
    (ellipse, theta): (&Ellipse, &[f64]),
    errors: Option<(&DMatrix<f64>, &DMatrix<f64>)>,
    bounds: Option<(&DMatrix<f64>, &DMatrix<f64>)>,
    told: &Told,
) -> Vec<Parameter> {
    let own =
        |c: &DMatrix<f64>, i: usize| Some(c[(i, i)].sqrt()).filter(|e| e.is_finite() && *e > 0.0);
    let physical = words::NAMES.iter().enumerate().map(|(i, name)| Parameter {
        name: (*name).into(),
        value: ellipse.parameters()[i],
        std_error: errors
            .filter(|_| told.physical[i])
            .and_then(|(c, _)| own(c, i)),
        unit: if i == 4 { "rad" } else { "column" }.into(),
        bound: bounds.and_then(|(c, _)| own(c, i)),
    });
    let powers = method.set().powers();
    let thetas = theta
        .iter()
        .zip(powers)
        .enumerate()
        .map(|(i, (value, power))| Parameter {
            name: format!("theta_{}", i + 1),
            value: *value,
            std_error: errors
                .filter(|_| told.theta[i])
                .and_then(|(_, c)| own(c, i)),
            unit: match power {
                0 => "1".into(),
                1 => "1/column".into(),
                n => format!("1/column^{n}"),
            },
            bound: bounds.and_then(|(_, c)| own(c, i)),
        });
    physical.chain(thetas).collect()
}

/// Correlations of what the samples tell.
pub(crate) fn correlations(c: &DMatrix<f64>, told: &[bool]) -> Correlations {
    let known = |i: usize| told[i] && c[(i, i)] > 0.0;
    let one = |i: usize, j: usize| {
        let size = (c[(i, i)] * c[(j, j)]).sqrt();
        // Of a sandwich both halves differ in their last digits.
        let both = (c[(i, j)] + c[(j, i)]) / 2.0;
        let value = if i == j { 1.0 } else { both / size };
        (known(i) && known(j) && value.is_finite()).then_some(value)
    };
    let n = c.nrows();
    (0..n)
        .map(|i| (0..n).map(|j| one(i, j)).collect())
        .collect()
}
