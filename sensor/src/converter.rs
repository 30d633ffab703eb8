//! The ADC: codes, held at the ends of its range, and what may be wrong with them.

use crate::cause::{Cause, Channel};
use crate::sensor::{Grid, Sensor};

/// Most codes of a step: any more hold the signal at one.
const MOST: f64 = (1u64 << 40) as f64;

impl Sensor {
    /// Through the ADC, in the unit of the signals: channel 0 is cos, 1 is sin.
    pub(crate) fn converted(&self, value: f64, which: usize) -> f64 {
        let half = 2f64.powi(self.adc.bits as i32 - 1);
        let held = |code: f64| code.round().clamp(-half, half - 1.0);
        let Grid { lsb, centre } = self.adc.grid(which);
        let code = held((value - centre) / lsb);
        let amplitude = [self.signals.a_c, self.signals.a_s][which];
        let wrong = self.sum(|c| match *c {
            Cause::AdcNonlinearity {
                bit,
                step_cos,
                step_sin,
            } => {
                let step = [step_cos, step_sin][which];
                let set = ((code + half) as i64 >> (bit.clamp(0.0, 40.0) as u32)) & 1;
                step * amplitude * (set as f64 - 0.5)
            }
            _ => 0.0,
        });
        let mut code = (held(code + wrong / lsb) + half) as i64;
        for cause in &self.causes {
            code = digital(cause, code, which);
        }
        centre + lsb * (code as f64 - half)
    }
}

/// What happens to a code of channel `which`, counted from the lowest one.
fn digital(cause: &Cause, code: i64, which: usize) -> i64 {
    match *cause {
        Cause::StuckBit {
            bit,
            channel,
            level,
        } if Channel::holds(channel, which) => {
            let mask = 1i64 << (bit.clamp(0.0, 40.0) as u32);
            if level == 0.0 {
                code & !mask
            } else {
                code | mask
            }
        }
        Cause::CoarseQuantisation {
            step_lsb,
            channel,
            remainder_lsb,
        } if Channel::holds(channel, which) => {
            let whole = |lsb: f64| lsb.clamp(-MOST, MOST) as i64;
            let (step, first) = (whole(step_lsb).max(1), whole(remainder_lsb));
            (code - first).div_euclid(step) * step + first
        }
        _ => code,
    }
}
