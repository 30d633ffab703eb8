//! Samples on their way to the file, and the file.

use std::fmt::Write as _;

use crate::world::World;

/// Samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Time by the logger, s.
    pub time: Vec<f64>,
    /// cos and sin, V.
    pub volts: [Vec<f64>; 2],
    /// What the better instrument shows, rad.
    pub reference: Option<Vec<f64>>,
    /// °C.
    pub temperature: Option<Vec<f64>>,
    /// The true angle, rad: never in the file.
    pub alpha: Vec<f64>,
    /// What noise and rounding added to the two channels, V: never in the file.
    pub noise: [Vec<f64>; 2],
}

impl Rows {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// No sample at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Change of the two channels from other rows to these, V.
    #[must_use]
    pub fn less(&self, other: &Self) -> [Vec<f64>; 2] {
        [0, 1].map(|c: usize| {
            let pairs = self.volts[c].iter().zip(&other.volts[c]);
            pairs.map(|(a, b)| a - b).collect()
        })
    }

    /// Every column but the time.
    fn columns(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let [cos, sin] = &mut self.volts;
        let [noise_cos, noise_sin] = &mut self.noise;
        [cos, sin, &mut self.alpha, noise_cos, noise_sin]
            .into_iter()
            .chain(self.reference.as_mut())
            .chain(self.temperature.as_mut())
    }

    /// Takes a sample out. The logger counts: its times go on as if nothing had happened, unless it has a clock.
    pub fn drop_sample(&mut self, k: usize, clock: bool) {
        for column in self.columns() {
            column.remove(k);
        }
        if clock {
            self.time.remove(k);
        } else {
            self.time.pop();
        }
    }

    /// Doubles a sample, and the rest moves on.
    pub fn double(&mut self, k: usize) {
        for column in self.columns() {
            let value = column[k];
            column.insert(k, value);
        }
        let step = self.time.get(1).map_or(0.0, |t| t - self.time[0]);
        let last = self.time.last().copied().unwrap_or(0.0);
        self.time.push(last + step);
    }

    /// A sample of the pair is lost and the one before shown in its place.
    pub fn hold(&mut self, k: usize) {
        for column in self.volts.iter_mut().chain(&mut self.noise) {
            column[k] = column[k - 1];
        }
    }

    /// As many as the recording has.
    pub fn truncate(&mut self, samples: usize) {
        for column in self.columns() {
            column.truncate(samples);
        }
        self.time.truncate(samples);
    }

    /// The recording, as `docs/files.md` has it.
    #[must_use]
    pub fn csv(&self, world: &World) -> String {
        let mut text = format!("# adc_bits: {}\n# full_scale: 1\n", world.bits);
        if world.revolution_known {
            let _ = writeln!(
                text,
                "# periods_per_revolution: {}",
                world.periods_per_revolution
            );
        }
        text += "time_s,cos,sin";
        if self.reference.is_some() {
            text += ",reference_rad";
        }
        if self.temperature.is_some() {
            text += ",temperature_c";
        }
        text += "\n";
        for k in 0..self.len() {
            let [cos, sin] = [0, 1].map(|c: usize| self.volts[c][k]);
            let _ = write!(text, "{:.8},{cos},{sin}", self.time[k]);
            if let Some(reference) = &self.reference {
                let _ = write!(text, ",{:.8}", reference[k]);
            }
            if let Some(temperature) = &self.temperature {
                let _ = write!(text, ",{:.3}", temperature[k]);
            }
            text += "\n";
        }
        text
    }
}
