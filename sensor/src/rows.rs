//! Samples that are lost or doubled on the way from the ADC to the file.

use rand::{Rng, rngs::StdRng};

use crate::cause::Cause;
use crate::sensor::Sensor;
use crate::signals::Samples;

impl Sensor {
    /// The samples that arrive. The first and the last always do.
    pub(crate) fn arrived(&self, mut samples: Samples, random: &mut StdRng) -> Samples {
        for cause in &self.causes {
            let last = samples.time_s.len().saturating_sub(1);
            match *cause {
                Cause::RepeatedSamples { share } => {
                    for k in 1..last {
                        if random.random::<f64>() < share {
                            samples.cos[k] = samples.cos[k - 1];
                            samples.sin[k] = samples.sin[k - 1];
                        }
                    }
                }
                Cause::DroppedSamples { share } => {
                    let kept: Vec<bool> = (0..=last)
                        .map(|k| k == 0 || k == last || random.random::<f64>() >= share)
                        .collect();
                    for values in [&mut samples.time_s, &mut samples.cos, &mut samples.sin] {
                        let mut keeps = kept.iter();
                        values.retain(|_| keeps.next().copied().unwrap_or(true));
                    }
                }
                _ => {}
            }
        }
        samples
    }
}
