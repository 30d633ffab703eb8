//! A stretch of samples, and the functions of it that shapes are made of.

use std::ops::Range;

use crate::context::Context;

/// Samples from `start` on. One value per sample in every slice.
#[derive(Clone, Copy)]
pub(crate) struct Block<'a> {
    /// Number of the first sample.
    pub start: usize,
    /// Seconds.
    pub time: &'a [f64],
    /// cos and sin of the smooth angle.
    pub cos: &'a [f64],
    /// See `cos`.
    pub sin: &'a [f64],
    /// Smooth angle, radians.
    pub alpha: &'a [f64],
    /// Smooth speed, radians per second.
    pub speed: &'a [f64],
    /// Angle of the revolution, radians.
    pub phi: Option<&'a [f64]>,
    /// Temperature, centred and of unit spread.
    pub temperature: Option<&'a [f64]>,
    /// ADC codes.
    pub codes: [&'a [i64]; 2],
    /// Phase error, radians.
    pub beta: f64,
}

impl Context {
    /// Some samples of the recording.
    pub(crate) fn block(&self, range: Range<usize>) -> Block<'_> {
        Block {
            start: range.start,
            time: &self.time[range.clone()],
            cos: &self.cos[range.clone()],
            sin: &self.sin[range.clone()],
            alpha: &self.alpha[range.clone()],
            speed: &self.speed[range.clone()],
            phi: self.phi.as_deref().map(|v| &v[range.clone()]),
            temperature: self.temperature.as_deref().map(|v| &v[range.clone()]),
            codes: [&self.codes[0][range.clone()], &self.codes[1][range]],
            beta: self.ellipse.beta,
        }
    }
}

impl Block<'_> {
    /// Number of samples.
    pub(crate) fn len(&self) -> usize {
        self.time.len()
    }

    /// Normalised raw channels: cos α and sin(α − β).
    pub(crate) fn normalised(&self) -> [Vec<f64>; 2] {
        let (sin_b, cos_b) = self.beta.sin_cos();
        let pairs = self.cos.iter().zip(self.sin);
        [
            self.cos.to_vec(),
            pairs.map(|(c, s)| s * cos_b - c * sin_b).collect(),
        ]
    }

    /// Their derivatives by α.
    pub(crate) fn derivatives(&self) -> [Vec<f64>; 2] {
        let (sin_b, cos_b) = self.beta.sin_cos();
        let pairs = self.cos.iter().zip(self.sin);
        [
            self.sin.iter().map(|s| -s).collect(),
            pairs.map(|(c, s)| c * cos_b + s * sin_b).collect(),
        ]
    }

    /// Writes a change of one raw channel, in fractions of its amplitude, as a change of the corrected pair.
    pub(crate) fn channel(&self, which: usize, change: &[f64], c: &mut [f64], s: &mut [f64]) {
        let (tan, secant) = (self.beta.tan(), 1.0 / self.beta.cos());
        for (k, v) in change.iter().enumerate() {
            (c[k], s[k]) = if which == 0 {
                (*v, v * tan)
            } else {
                (0.0, v * secant)
            };
        }
    }

    /// Writes a change of the raw channels, in fractions of their amplitudes, as a change of the corrected pair.
    pub(crate) fn raw(&self, cos: &[f64], sin: &[f64], c: &mut [f64], s: &mut [f64]) {
        let (tan, secant) = (self.beta.tan(), 1.0 / self.beta.cos());
        for (k, (x, y)) in cos.iter().zip(sin).enumerate() {
            (c[k], s[k]) = (*x, y * secant + x * tan);
        }
    }

    /// 1, cos α, sin α, cos 2α … sin mα, each times `by`, one after the other in `out`.
    pub(crate) fn waves(&self, top: usize, by: Option<&[f64]>, out: &mut [f64]) {
        let n = self.len();
        match by {
            Some(by) => out[..n].copy_from_slice(by),
            None => out[..n].fill(1.0),
        }
        if top == 0 {
            return;
        }
        for (k, (c, s)) in self.cos.iter().zip(self.sin).enumerate() {
            out[n + k] = out[k] * c;
            out[2 * n + k] = out[k] * s;
        }
        // The angles add up: the next order is the last one turned by α.
        for order in 2..=top {
            let (before, now) = out.split_at_mut((2 * order - 1) * n);
            let last = &before[(2 * order - 3) * n..];
            let (last_c, last_s) = last.split_at(n);
            let (now_c, now_s) = now[..2 * n].split_at_mut(n);
            for k in 0..n {
                let (c, s) = (self.cos[k], self.sin[k]);
                now_c[k] = last_c[k] * c - last_s[k] * s;
                now_s[k] = last_s[k] * c + last_c[k] * s;
            }
        }
    }
}
