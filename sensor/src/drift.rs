//! Slow changes of offsets and gains.

use serde::Deserialize;

/// A change of each channel from one end of the recording to the other: evenly, and along Legendre polynomials of the time
/// of degree 2 … 6 that bend the line between the same ends. Fractions of the channel's amplitude.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the keys of `sensor.toml`, explained above")]
pub struct Drift {
    pub change_cos: f64,
    pub change_sin: f64,
    #[serde(default)]
    pub curve_cos_2: f64,
    #[serde(default)]
    pub curve_cos_3: f64,
    #[serde(default)]
    pub curve_cos_4: f64,
    #[serde(default)]
    pub curve_cos_5: f64,
    #[serde(default)]
    pub curve_cos_6: f64,
    #[serde(default)]
    pub curve_sin_2: f64,
    #[serde(default)]
    pub curve_sin_3: f64,
    #[serde(default)]
    pub curve_sin_4: f64,
    #[serde(default)]
    pub curve_sin_5: f64,
    #[serde(default)]
    pub curve_sin_6: f64,
}

impl Drift {
    /// The change of channel 0 (cos) or 1 (sin) at a share of the recording's time, 0 … 1.
    pub(crate) fn at(&self, which: usize, share: f64) -> f64 {
        let (change, curve) = if which == 0 {
            let curve = [
                self.curve_cos_2,
                self.curve_cos_3,
                self.curve_cos_4,
                self.curve_cos_5,
                self.curve_cos_6,
            ];
            (self.change_cos, curve)
        } else {
            let curve = [
                self.curve_sin_2,
                self.curve_sin_3,
                self.curve_sin_4,
                self.curve_sin_5,
                self.curve_sin_6,
            ];
            (self.change_sin, curve)
        };
        let x = 2.0 * share - 1.0;
        // Odd ones are part of the change.
        let line = 0.5 * change - curve[1] - curve[3];
        let (mut before, mut now, mut sum) = (1.0, x, line * x);
        for (c, n) in curve.iter().zip(1..) {
            let n = f64::from(n);
            (before, now) = (now, ((2.0 * n + 1.0) * x * now - n * before) / (n + 1.0));
            sum += c * now;
        }
        sum
    }
}
