//! The sensor and the ADC that a stimulus goes through.

use std::f64::consts::TAU;

use nonius_model::design::Design;

/// A pair of ADC codes, cosine first.
pub(crate) type Codes = (i64, i64);

/// A sensor with half of what the design promises of gains, offsets and phase, its ADC, and how long it is played.
pub(crate) struct Plant<'a> {
    pub(crate) design: &'a Design,
    /// Samples.
    pub(crate) rows: usize,
    /// Nominal amplitude, of the ADC's range.
    pub(crate) amplitude: f64,
    /// Half of the promised offset, of the ADC's range.
    pub(crate) offset: f64,
    /// Half of the promised phase error, radians.
    pub(crate) beta: f64,
    /// Half of the promised tolerance of the amplitudes.
    gain: f64,
    /// Largest promised speed, periods per sample.
    pub(crate) top: f64,
    /// Codes of the middle and of either rail.
    pub(crate) middle: i64,
    pub(crate) low: i64,
    pub(crate) full: i64,
}

impl<'a> Plant<'a> {
    pub(crate) fn new(design: &'a Design, rows: usize) -> Self {
        let spec = &design.spec;
        let half = 1i64 << (spec.adc.bits - 1);
        let middle = if design.structure.offset_binary {
            half
        } else {
            0
        };
        let amplitude = spec.sensor.amplitude / spec.adc.full_scale;
        Self {
            design,
            rows,
            amplitude,
            offset: spec.sensor.offset_max / 2.0 * amplitude,
            beta: spec.sensor.phase_error_max_deg.to_radians() / 2.0,
            gain: spec.sensor.amplitude_tolerance / 2.0,
            top: spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz,
            middle,
            low: middle - half,
            full: middle + half - 1,
        }
    }

    /// The samples as a number.
    pub(crate) fn samples(&self) -> f64 {
        self.rows as f64
    }

    /// Code of a part of the ADC's range, at most those of the rails.
    pub(crate) fn code(&self, part: f64) -> i64 {
        let half = (self.full + 1 - self.middle) as f64;
        (part * half).round().clamp(-half, half - 1.0) as i64 + self.middle
    }

    /// The sensor at a place, periods.
    pub(crate) fn at(&self, turns: f64) -> Codes {
        self.changed(turns, 1.0, 0.0)
    }

    /// The same with another gain and offset of the cosine, of its own gain and of the ADC's range.
    pub(crate) fn changed(&self, turns: f64, gain: f64, offset: f64) -> Codes {
        let (a, alpha) = (self.amplitude, turns * TAU);
        let cos = a * (1.0 + self.gain) * gain * alpha.cos() + self.offset + offset;
        let sin = a * (1.0 - self.gain) * (alpha - self.beta).sin() - self.offset;
        (self.code(cos), self.code(sin))
    }

    /// The same with this part of both signals, offsets included.
    pub(crate) fn faded(&self, turns: f64, gain: f64) -> Codes {
        let of = |code: i64| {
            let code = self.middle + ((code - self.middle) as f64 * gain).round() as i64;
            code.clamp(self.low, self.full)
        };
        let (cos, sin) = self.at(turns);
        (of(cos), of(sin))
    }

    /// Periods of travel up to a sample, at top speed.
    pub(crate) fn travelled(&self, k: usize) -> f64 {
        k as f64 * self.top
    }

    /// The same at some tenth of top speed.
    pub(crate) fn slowly(&self, per_sample: f64, k: usize) -> f64 {
        per_sample * k as f64 * (self.top / 0.1)
    }
}
