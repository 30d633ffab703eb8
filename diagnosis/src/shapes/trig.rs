//! Trigonometric polynomials of the angle: what a static error of a channel is along the radius and along the circle
//! follows by multiplication, not by a column of samples.

/// Σ a_m cos mα + b_m sin mα; the pairs (a_m, b_m) from m = 0 on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Trig(pub(crate) Vec<[f64; 2]>);

impl Trig {
    /// A constant.
    pub(crate) fn constant(value: f64) -> Self {
        Self(vec![[value, 0.0]])
    }

    /// cos(mα + phase), phase in radians.
    pub(crate) fn cos(order: usize, phase: f64) -> Self {
        let mut list = vec![[0.0; 2]; order + 1];
        list[order] = [phase.cos(), if order > 0 { -phase.sin() } else { 0.0 }];
        Self(list)
    }

    /// sin(mα + phase), phase in radians.
    pub(crate) fn sin(order: usize, phase: f64) -> Self {
        let mut list = vec![[0.0; 2]; order + 1];
        list[order] = if order > 0 {
            [phase.sin(), phase.cos()]
        } else {
            [phase.sin(), 0.0]
        };
        Self(list)
    }

    pub(crate) fn scaled(&self, by: f64) -> Self {
        Self(self.0.iter().map(|[a, b]| [a * by, b * by]).collect())
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        let at = |list: &Self, m: usize| list.0.get(m).copied().unwrap_or_default();
        let sum = |m| {
            let ([a, b], [c, d]) = (at(self, m), at(other, m));
            [a + c, b + d]
        };
        Self((0..self.0.len().max(other.0.len())).map(sum).collect())
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut list = vec![[0.0; 2]; self.0.len() + other.0.len() - 1];
        for (i, [a, b]) in self.0.iter().enumerate() {
            for (j, [c, d]) in other.0.iter().enumerate() {
                let (sum, difference) = (i + j, i.abs_diff(j));
                // sin of the difference i − j changes its sign with it.
                let sign = if i >= j { 1.0 } else { -1.0 };
                list[sum][0] += 0.5 * (a * c - b * d);
                list[difference][0] += 0.5 * (a * c + b * d);
                list[sum][1] += 0.5 * (a * d + b * c);
                if difference > 0 {
                    list[difference][1] += 0.5 * sign * (b * c - a * d);
                }
            }
        }
        Self(list)
    }

    /// Whether it is the same at all angles.
    pub(crate) fn is_constant(&self) -> bool {
        self.0.iter().skip(1).flatten().all(|v| *v == 0.0)
    }

    pub(crate) fn power(&self, exponent: usize) -> Self {
        (0..exponent).fold(Self::constant(1.0), |p, _| p.times(self))
    }
}

/// A change of the corrected pair, along the radius and along the circle.
pub(crate) fn rotated(c: &Trig, s: &Trig) -> [Trig; 2] {
    let (cos, sin) = (Trig::cos(1, 0.0), Trig::sin(1, 0.0));
    [
        c.times(&cos).plus(&s.times(&sin)),
        s.times(&cos).plus(&c.times(&sin).scaled(-1.0)),
    ]
}

/// The same of a change of the raw channels in fractions of their amplitudes, with the phase error `beta` in radians.
pub(crate) fn raw(beta: f64, cos: &Trig, sin: &Trig) -> [Trig; 2] {
    let s = sin.scaled(1.0 / beta.cos()).plus(&cos.scaled(beta.tan()));
    rotated(cos, &s)
}

/// The same of a change of one raw channel.
pub(crate) fn channel(beta: f64, which: usize, change: &Trig) -> [Trig; 2] {
    let zero = Trig::constant(0.0);
    if which == 0 {
        raw(beta, change, &zero)
    } else {
        raw(beta, &zero, change)
    }
}

/// The raw channels themselves in their amplitudes: cos α and sin(α − β).
pub(crate) fn normalised(beta: f64) -> [Trig; 2] {
    [Trig::cos(1, 0.0), Trig::sin(1, -beta)]
}

/// Their derivatives by α.
pub(crate) fn derivatives(beta: f64) -> [Trig; 2] {
    [Trig::sin(1, 0.0).scaled(-1.0), Trig::cos(1, -beta)]
}

#[cfg(test)]
mod tests {
    use super::{Trig, channel, normalised};

    fn value(t: &Trig, alpha: f64) -> f64 {
        let terms = t.0.iter().enumerate();
        terms
            .map(|(m, [a, b])| a * (m as f64 * alpha).cos() + b * (m as f64 * alpha).sin())
            .sum()
    }

    #[test]
    fn products_are_products_of_values() {
        let (a, b) = (
            Trig::cos(2, 0.4).plus(&Trig::constant(0.3)),
            Trig::sin(5, 1.1).plus(&Trig::cos(2, 0.2)),
        );
        let product = a.times(&b);
        for alpha in [0.0, 0.7, 2.0, -4.0] {
            let expected = value(&a, alpha) * value(&b, alpha);
            assert!((value(&product, alpha) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_channel_is_rotated_as_its_samples_are() {
        let (beta, alpha) = (0.2f64, 0.9f64);
        let cube = normalised(beta)[1].power(3);
        let [radial, tangential] = channel(beta, 1, &cube);
        let s = (alpha - beta).sin().powi(3) / beta.cos();
        assert!((value(&radial, alpha) - s * alpha.sin()).abs() < 1e-14);
        assert!((value(&tangential, alpha) - s * alpha.cos()).abs() < 1e-14);
    }
}
