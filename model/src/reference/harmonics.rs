//! Harmonics of the scale period in the channels, which the paper does not know.
//!
//! y_c = a_c (cos α + h_c(α)) + b_c, y_s = a_s (sin(α − β) + h_s(α)) + b_s. Θ makes of them
//!
//! c = cos α + h_c,  s = [sin(α − β) + h_s + sin β (cos α + h_c)] / cos β = sin α + h_s / cos β + tan β h_c,
//!
//! from which cosines and sines of multiples of the estimate are taken: no table, no series.

/// Highest order.
pub const HIGHEST: usize = 16;

/// What stands in the channels: coefficients of cos nα and sin nα.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonics {
    /// Of the cosine channel: entry n − 1 is of order n.
    cosine: [[f64; 2]; HIGHEST],
    /// Of the sine channel.
    sine: [[f64; 2]; HIGHEST],
    /// Orders beyond this one are 0.
    last: usize,
}

impl Harmonics {
    /// As in the paper.
    pub const NONE: Self = Self {
        cosine: [[0.0; 2]; HIGHEST],
        sine: [[0.0; 2]; HIGHEST],
        last: 0,
    };

    /// With amplitude · cos(order · α + phase) more in each channel, given as (amplitude, phase) of the cosine and of the
    /// sine. Orders 1 to [`HIGHEST`]; others change nothing.
    #[must_use]
    pub fn with(mut self, order: usize, cosine: (f64, f64), sine: (f64, f64)) -> Self {
        if (1..=HIGHEST).contains(&order) {
            for (all, (amplitude, phase)) in [(&mut self.cosine, cosine), (&mut self.sine, sine)] {
                let [of_cos, of_sin] = &mut all[order - 1];
                *of_cos += amplitude * phase.cos();
                *of_sin -= amplitude * phase.sin();
            }
            self.last = self.last.max(order);
        }
        self
    }

    /// There are none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.last == 0
    }

    /// h_c(α) and h_s(α'), each channel at the angle at which it is sampled, radians.
    #[must_use]
    pub fn at(&self, of_cosine: f64, of_sine: f64) -> [f64; 2] {
        let sum = |all: &[[f64; 2]], angle: f64| {
            let of_order = |(n, [a, b]): (f64, &[f64; 2])| {
                let (sin, cos) = (n * angle).sin_cos();
                a * cos + b * sin
            };
            let orders = (1..=self.last).map(|n| n as f64);
            orders.zip(all).map(of_order).sum()
        };
        [sum(&self.cosine, of_cosine), sum(&self.sine, of_sine)]
    }

    /// The pair that Θ corrected, without them.
    #[must_use]
    pub fn removed(
        &self,
        [c, s]: [f64; 2],
        (of_cosine, of_sine): (f64, f64),
        tan_beta: f64,
    ) -> [f64; 2] {
        let [h_c, h_s] = self.at(of_cosine, of_sine);
        let secant = (1.0 + tan_beta * tan_beta).sqrt();
        [c - h_c, s - h_s * secant - tan_beta * h_c]
    }
}
