//! Slow changes of offsets and gains: what drifts on, and what warms up.

use serde::Deserialize;

/// A change of each channel from one end of the recording to the other: evenly, and along Legendre polynomials of the time
/// of degree 2 … 6 that bend the line between the same ends. With a time constant, seconds, it is an exponential in the place
/// of both, which begins at `start_s`: 1 − e^(−(t − start)/τ), half of it on either side of zero. Fractions of the channel's amplitude.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the keys of `sensor.toml`, explained above")]
pub struct Drift {
    pub change_cos: f64,
    pub change_sin: f64,
    #[serde(default)]
    pub start_s: f64,
    #[serde(default)]
    pub tau_s: f64,
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
    /// Key, value and rule of the first value that cannot be.
    pub(crate) fn wrong(&self) -> Option<(&'static str, f64, &'static str)> {
        if self.tau_s < 0.0 || !self.tau_s.is_finite() {
            return Some(("tau_s", self.tau_s, "a time constant is not negative"));
        }
        let bends = [
            ("curve_cos_2", self.curve_cos_2),
            ("curve_cos_3", self.curve_cos_3),
            ("curve_cos_4", self.curve_cos_4),
            ("curve_cos_5", self.curve_cos_5),
            ("curve_cos_6", self.curve_cos_6),
            ("curve_sin_2", self.curve_sin_2),
            ("curve_sin_3", self.curve_sin_3),
            ("curve_sin_4", self.curve_sin_4),
            ("curve_sin_5", self.curve_sin_5),
            ("curve_sin_6", self.curve_sin_6),
        ];
        if self.tau_s > 0.0 {
            let bent = bends.into_iter().find(|(_, value)| *value != 0.0);
            return bent.map(|(key, value)| {
                (
                    key,
                    value,
                    "with tau_s it is an exponential, which has no other curve",
                )
            });
        }
        let alone = self.start_s != 0.0;
        alone.then_some((
            "start_s",
            self.start_s,
            "where an exponential begins, give tau_s as well",
        ))
    }

    /// The change of channel 0 (cos) or 1 (sin) at a time of a recording of so many seconds.
    pub(crate) fn at(&self, which: usize, time: f64, whole: f64) -> f64 {
        if self.tau_s > 0.0 {
            let change = [self.change_cos, self.change_sin][which];
            let gone = |t: f64| -(-(t - self.start_s).max(0.0) / self.tau_s).exp_m1();
            let all = gone(whole);
            // One that begins after the end changes nothing.
            return if all > 0.0 {
                change * (gone(time) / all - 0.5)
            } else {
                0.0
            };
        }
        self.bent(which, time / whole)
    }

    /// The same of a line and its bends, at a share of the recording's time, 0 … 1.
    fn bent(&self, which: usize, share: f64) -> f64 {
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
