//! Slow changes of offsets and gains: what drifts on, and what warms up.

use std::collections::BTreeMap;

use serde::Deserialize;

/// Highest degree of the polynomials that a drift may be made of.
const DEGREE: usize = 6;
/// The channels, as keys end with them.
const CHANNELS: [&str; 2] = ["cos", "sin"];

/// A change of each channel from one end of the recording to the other: evenly, and along Legendre polynomials of the time
/// of degree 2 … 6 that bend the line between the same ends. With a time constant, seconds, it is an exponential in the place
/// of both, which begins at `start_s`: 1 − e^(−(t − start)/τ), half of it on either side of zero. Fractions of the channel's amplitude.
///
/// The keys of `sensor.toml` are `change_cos` and `change_sin`, and, each zero where it is not given, `curve_cos_2` … `curve_sin_6`,
/// `tau_s` and `start_s`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "BTreeMap<String, f64>")]
pub struct Drift {
    /// From one end to the other, of cos and of sin.
    change: [f64; 2],
    /// By degree, from 2 on, of cos and of sin.
    curve: [[f64; DEGREE - 1]; 2],
    tau_s: f64,
    start_s: f64,
}

impl TryFrom<BTreeMap<String, f64>> for Drift {
    type Error = String;

    fn try_from(mut keys: BTreeMap<String, f64>) -> Result<Self, String> {
        let mut known = vec![];
        let mut take = |key: String| {
            let value = keys.remove(&key);
            known.push(key);
            value
        };
        let mut change = [0.0; 2];
        for (change, channel) in change.iter_mut().zip(CHANNELS) {
            let key = format!("change_{channel}");
            *change = take(key.clone()).ok_or_else(|| format!("missing field `{key}`"))?;
        }
        let tau_s = take("tau_s".into()).unwrap_or_default();
        let start_s = take("start_s".into()).unwrap_or_default();
        let curve = CHANNELS.map(|channel| {
            std::array::from_fn(|i| {
                let key = format!("curve_{channel}_{}", i + 2);
                take(key).unwrap_or_default()
            })
        });
        if let Some(other) = keys.keys().next() {
            let known: Vec<String> = known.iter().map(|key| format!("`{key}`")).collect();
            let known = known.join(", ");
            return Err(format!("unknown field `{other}`, expected one of {known}"));
        }
        let drift = Self {
            change,
            curve,
            tau_s,
            start_s,
        };
        drift.check()?;
        Ok(drift)
    }
}

impl Drift {
    /// Says which value cannot be.
    fn check(&self) -> Result<(), String> {
        if self.tau_s < 0.0 {
            let tau = self.tau_s;
            return Err(format!(
                "tau_s = {tau}: a time constant is not negative; without one, leave it out"
            ));
        }
        let curved = self.curve.iter().flatten().any(|c| *c != 0.0);
        if self.tau_s > 0.0 && curved {
            return Err(
                "with tau_s it is an exponential, which has no other curve: take out either it or the curves".into(),
            );
        }
        if self.tau_s == 0.0 && self.start_s != 0.0 {
            return Err("start_s is where an exponential begins: give tau_s as well".into());
        }
        Ok(())
    }

    /// The change of channel 0 (cos) or 1 (sin) at a time of a recording of so many seconds.
    pub(crate) fn at(&self, which: usize, time: f64, whole: f64) -> f64 {
        if self.tau_s > 0.0 {
            let gone = |t: f64| -(-(t - self.start_s).max(0.0) / self.tau_s).exp_m1();
            let all = gone(whole);
            // One that begins after the end changes nothing.
            return if all > 0.0 {
                self.change[which] * (gone(time) / all - 0.5)
            } else {
                0.0
            };
        }
        self.bent(which, time / whole)
    }

    /// The same of a line and its bends, at a share of the recording's time, 0 … 1.
    fn bent(&self, which: usize, share: f64) -> f64 {
        let (change, curve) = (self.change[which], &self.curve[which]);
        let x = 2.0 * share - 1.0;
        // Odd ones are part of the change.
        let odd: f64 = curve.iter().skip(1).step_by(2).sum();
        let line = 0.5 * change - odd;
        let (mut before, mut now, mut sum) = (1.0, x, line * x);
        for (c, n) in curve.iter().zip(1..) {
            let n = f64::from(n);
            (before, now) = (now, ((2.0 * n + 1.0) * x * now - n * before) / (n + 1.0));
            sum += c * now;
        }
        sum
    }
}
