//! A stretch of samples, and the functions of it that shapes are made of.

use std::ops::Range;

use crate::context::Context;
use crate::shapes::trig::Trig;

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
    /// Smooth speed, radians per second.
    pub speed: &'a [f64],
    /// Smooth acceleration, radians per second squared.
    pub acceleration: &'a [f64],
    /// Angle of the revolution, radians.
    pub phi: Option<&'a [f64]>,
    /// Temperature, centred and of unit spread.
    pub temperature: Option<&'a [f64]>,
    /// Normalised raw channels: cos α and sin(α − β).
    pub u: [&'a [f64]; 2],
    /// Their derivatives by α.
    pub slope: [&'a [f64]; 2],
    /// Phase error, radians.
    pub beta: f64,
    /// What is known to be added to them at each angle.
    pub periodic: &'a [Trig; 2],
}

/// What blocks share, made once for each.
#[derive(Default)]
pub(crate) struct Shared {
    u: [Vec<f64>; 2],
    slope: [Vec<f64>; 2],
}

impl Context {
    /// Some samples of the recording.
    pub(crate) fn block<'a>(&'a self, range: Range<usize>, shared: &'a mut Shared) -> Block<'a> {
        let (sin_b, cos_b) = self.ellipse.beta.sin_cos();
        let pairs = || self.cos[range.clone()].iter().zip(&self.sin[range.clone()]);
        let fill = |to: &mut Vec<f64>, f: &dyn Fn(f64, f64) -> f64| {
            to.clear();
            to.extend(pairs().map(|(c, s)| f(*c, *s)));
        };
        fill(&mut shared.u[0], &|c, _| c);
        fill(&mut shared.u[1], &|c, s| s * cos_b - c * sin_b);
        fill(&mut shared.slope[0], &|_, s| -s);
        fill(&mut shared.slope[1], &|c, s| c * cos_b + s * sin_b);
        let shared = &*shared;
        Block {
            u: [&shared.u[0], &shared.u[1]],
            slope: [&shared.slope[0], &shared.slope[1]],
            start: range.start,
            time: &self.time[range.clone()],
            cos: &self.cos[range.clone()],
            sin: &self.sin[range.clone()],
            speed: &self.speed[range.clone()],
            acceleration: &self.acceleration[range.clone()],
            phi: self.phi.as_deref().map(|v| &v[range.clone()]),
            temperature: self.temperature.as_deref().map(|v| &v[range]),
            beta: self.ellipse.beta,
            periodic: &self.periodic,
        }
    }
}

/// Waves of an angle that is the sum of the angles of two others.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn turned([last_c, last_s]: [&[f64]; 2], [cos, sin]: [&[f64]; 2], [c, s]: [&mut [f64]; 2]) {
    let last = last_c.iter().zip(last_s);
    let by = cos.iter().zip(sin);
    for (((c, s), (last_c, last_s)), (cos, sin)) in c.iter_mut().zip(s).zip(last).zip(by) {
        *c = last_c * cos - last_s * sin;
        *s = last_s * cos + last_c * sin;
    }
}

impl Block<'_> {
    /// Number of samples.
    pub(crate) fn len(&self) -> usize {
        self.time.len()
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
        let (by, first) = out.split_at_mut(n);
        let (first_c, first_s) = first[..2 * n].split_at_mut(n);
        for (to, wave) in [(first_c, self.cos), (first_s, self.sin)] {
            for ((to, by), wave) in to.iter_mut().zip(&*by).zip(wave) {
                *to = by * wave;
            }
        }
        // The angles add up: the next order is the last one turned by α.
        for order in 2..=top {
            let (before, now) = out.split_at_mut((2 * order - 1) * n);
            let last = &before[(2 * order - 3) * n..];
            let (last_c, last_s) = last.split_at(n);
            let (now_c, now_s) = now[..2 * n].split_at_mut(n);
            turned([last_c, last_s], [self.cos, self.sin], [now_c, now_s]);
        }
    }
}
