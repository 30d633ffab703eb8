//! Samples at which a channel is clipped: the other one tells the angle.

use std::f64::consts::PI;

/// A sample at which one channel is at a rail and the other one is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Clipped {
    pub(crate) sample: usize,
    /// 0 is cos.
    pub(crate) channel: usize,
    /// At its lower rail.
    pub(crate) lower: bool,
}

impl Clipped {
    /// The corrected pair as the other channel alone has it, on the circle: near its own peak that hardly knows the angle.
    pub(crate) fn pair(&self, [c, s]: [f64; 2], beta: f64) -> [f64; 2] {
        let angle = if self.channel == 0 {
            // The raw sine, sin(α − β), in which there is nothing of cos.
            let sine = s * beta.cos() - c * beta.sin();
            let right = sine.clamp(-1.0, 1.0).asin();
            beta + if self.lower { PI - right } else { right }
        } else {
            let upper = c.clamp(-1.0, 1.0).acos();
            if self.lower { -upper } else { upper }
        };
        [angle.cos(), angle.sin()]
    }
}

#[cfg(test)]
mod tests {
    use super::Clipped;

    #[test]
    fn the_other_channel_has_the_angle_at_each_rail() {
        let beta = 0.1;
        for (channel, lower, at) in [
            (0, false, 0.0),
            (0, true, std::f64::consts::PI),
            (1, false, std::f64::consts::FRAC_PI_2),
            (1, true, -std::f64::consts::FRAC_PI_2),
        ] {
            for off in [-0.4, 0.0, 0.4] {
                let angle: f64 = at + off;
                let [mut c, mut raw_s] = [angle.cos(), (angle - beta).sin()];
                // Cut off, whatever it is.
                *[&mut c, &mut raw_s][channel] *= 0.8;
                let s = (raw_s + c * beta.sin()) / beta.cos();
                let clipped = Clipped {
                    sample: 0,
                    channel,
                    lower,
                };
                let [c, s] = clipped.pair([c, s], beta);
                assert!((c - angle.cos()).abs() < 1e-12, "{channel} {lower} {off}");
                assert!((s - angle.sin()).abs() < 1e-12, "{channel} {lower} {off}");
            }
        }
    }
}
