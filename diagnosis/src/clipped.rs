//! Samples that are left out where a channel is clipped: the other one tells the angle, and beside the rail both do.

use std::borrow::Cow;
use std::f64::consts::PI;

use crate::context::Context;
use crate::motion::spline::Spline;

/// Of the other channel's amplitude, beyond which it hardly knows the angle: its own peak is near.
pub(crate) const KNOWS: f64 = 0.985;

/// What a sample counts for the motion that does not tell the angle.
const LEFT_OUT: f64 = 1e-6;

/// A channel (0 is cos) at its upper or its lower rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AtRail {
    pub(crate) channel: usize,
    pub(crate) lower: bool,
}

/// What tells the angle of a sample that is left out for a rail's sake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum By {
    /// Both channels: it is beside the rail.
    Both,
    /// The other channel, which is neither near its own peak nor at a rail.
    Other(AtRail),
    /// Its neighbours.
    Neighbours,
}

/// A sample that is left out for a rail's sake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clipped {
    pub(crate) sample: usize,
    pub(crate) by: By,
}

impl AtRail {
    /// The corrected pair as the other channel alone has it, on the circle, for a phase error `beta` and an angle by which the pair was
    /// turned back, radians.
    pub(crate) fn pair(&self, pair: [f64; 2], beta: f64, turned: f64) -> [f64; 2] {
        let [c, s] = rotated(pair, turned);
        let angle = if self.channel == 0 {
            // The raw sine, sin(α − β), in which there is nothing of cos.
            let sine = s * beta.cos() - c * beta.sin();
            let right = sine.clamp(-1.0, 1.0).asin();
            beta + if self.lower { PI - right } else { right }
        } else {
            let upper = c.clamp(-1.0, 1.0).acos();
            if self.lower { -upper } else { upper }
        };
        rotated([angle.cos(), angle.sin()], -turned)
    }
}

/// A pair turned by an angle, radians.
fn rotated([c, s]: [f64; 2], by: f64) -> [f64; 2] {
    let (sin, cos) = by.sin_cos();
    [c * cos - s * sin, s * cos + c * sin]
}

impl Context {
    /// Gives clipped samples the pair that the other channel knows; pairs were `turned` back by these angles, or by none.
    pub(crate) fn complete(&self, c: &mut [f64], s: &mut [f64], turned: &[f64]) {
        for clipped in &self.clipped {
            if let By::Other(at) = clipped.by {
                let k = clipped.sample;
                let turned = turned.get(k).copied().unwrap_or(0.0);
                [c[k], s[k]] = at.pair([c[k], s[k]], self.ellipse.beta, turned);
            }
        }
    }

    /// 1 where a sample tells the angle: also where one channel is clipped, and beside that.
    pub(crate) fn tells(&self) -> Vec<f64> {
        let mut tells = self.weight.clone();
        let own = self.clipped.iter().filter(|one| one.by != By::Neighbours);
        own.for_each(|one| tells[one.sample] = 1.0);
        tells
    }

    /// What a sample counts for the motion: next to nothing where nothing tells the angle, but there it goes along what was
    /// laid over it, whatever its knots could do.
    pub(crate) fn leads(&self) -> Vec<f64> {
        let tells = self.tells().into_iter();
        tells.map(|tells| tells.max(LEFT_OUT)).collect()
    }

    /// The motion by the samples that tell it: the spline, and what it fits to an angle.
    pub(crate) fn fitted<'a>(
        &self,
        spline: &'a Spline,
        angle: &[f64],
    ) -> (Cow<'a, Spline>, Vec<f64>) {
        let leads = self.leads();
        let spline = if self.weight.iter().all(|weight| *weight > 0.0) {
            Cow::Borrowed(spline)
        } else {
            Cow::Owned(Spline::new(self.samples(), spline.spacing(), &leads))
        };
        let fit = spline.fit(angle, &leads);
        (spline, fit)
    }
}

#[cfg(test)]
mod tests {
    use super::{AtRail, rotated};
    use std::f64::consts::{FRAC_PI_2, PI};

    /// At each rail and far beside it, whatever the phase error is and by what the pair was turned back.
    #[test]
    fn the_other_channel_has_the_angle_at_each_rail() {
        for (channel, lower, at) in [
            (0, false, 0.0),
            (0, true, PI),
            (1, false, FRAC_PI_2),
            (1, true, -FRAC_PI_2),
        ] {
            for (off, beta, turned) in [
                (-0.4, 0.1, 0.0),
                (0.4, -0.3, 0.0),
                (1.0, 0.2, 0.0),
                (-1.0, -0.2, 0.05),
                (0.0, 0.1, -0.05),
            ] {
                let angle: f64 = at + off;
                let [mut c, mut raw_s] = [angle.cos(), (angle - beta).sin()];
                // Cut off, whatever it is.
                *[&mut c, &mut raw_s][channel] *= 0.8;
                let s = (raw_s + c * beta.sin()) / beta.cos();
                let at_rail = AtRail { channel, lower };
                let [c, s] = at_rail.pair(rotated([c, s], -turned), beta, turned);
                let angle = angle - turned;
                assert!((c - angle.cos()).abs() < 1e-12, "{channel} {lower} {off}");
                assert!((s - angle.sin()).abs() < 1e-12, "{channel} {lower} {off}");
            }
        }
    }
}
