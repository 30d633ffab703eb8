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
    pub tau_s: f64,
    #[serde(default)]
    pub start_s: f64,
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
    /// Key, value and rule of the first that cannot be.
    pub(crate) fn wrong(&self) -> Option<(&'static str, f64, &'static str)> {
        let curved = [0, 1].iter().any(|which| self.curve(*which) != [0.0; 5]);
        if self.tau_s < 0.0 {
            let rule = "a time constant is not negative; without one, leave it out";
            Some(("tau_s", self.tau_s, rule))
        } else if self.tau_s > 0.0 && curved {
            let rule = "an exponential has no other curve: take out either tau_s or the curves";
            Some(("tau_s", self.tau_s, rule))
        } else if self.tau_s == 0.0 && self.start_s != 0.0 {
            let rule = "this is where an exponential begins: give tau_s as well";
            Some(("start_s", self.start_s, rule))
        } else {
            None
        }
    }

    /// What bends the line of channel 0 (cos) or 1 (sin), by degree from 2 on.
    fn curve(&self, which: usize) -> [f64; 5] {
        if which == 0 {
            [
                self.curve_cos_2,
                self.curve_cos_3,
                self.curve_cos_4,
                self.curve_cos_5,
                self.curve_cos_6,
            ]
        } else {
            [
                self.curve_sin_2,
                self.curve_sin_3,
                self.curve_sin_4,
                self.curve_sin_5,
                self.curve_sin_6,
            ]
        }
    }

    /// The change of channel 0 (cos) or 1 (sin) at a time of a recording of so many seconds.
    pub(crate) fn at(&self, which: usize, time: f64, whole: f64) -> f64 {
        let change = [self.change_cos, self.change_sin][which];
        if self.tau_s > 0.0 {
            let gone = |t: f64| -(-(t - self.start_s).max(0.0) / self.tau_s).exp_m1();
            let all = gone(whole);
            // One that begins after the end changes nothing.
            return if all > 0.0 {
                change * (gone(time) / all - 0.5)
            } else {
                0.0
            };
        }
        let curve = self.curve(which);
        let x = 2.0 * (time / whole) - 1.0;
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
