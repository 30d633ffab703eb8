//! What is measured on the bit-true chip itself.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::sine::sine;
use nonius_model::physical::Converter;
use serde::Serialize;

/// Phases up to this many bits are all tried; of longer ones every so many.
const EXHAUSTIVE_BITS: u32 = 22;

/// Largest errors of sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SineError {
    /// Of sine and of cosine.
    pub largest: f64,
    /// Of the angle that the pair points to, in turns.
    pub largest_angle_turns: f64,
    /// Every phase was tried.
    pub exhaustive: bool,
    /// Phases tried.
    pub phases: u64,
}

/// Sine and cosine against the exact ones, for every phase of the sine unit (each stands for the middle of what it
/// cuts off).
#[must_use]
pub fn sine_error(design: &Design) -> SineError {
    let (coefficients, structure) = (design.constants.bits(), &design.structure);
    let bits = structure.formats.sine_phase.format.fraction;
    let step = 1u64 << bits.saturating_sub(EXHAUSTIVE_BITS);
    let mut result = SineError {
        largest: 0.0,
        largest_angle_turns: 0.0,
        exhaustive: step == 1,
        phases: 0,
    };
    // An odd stride reaches every position within a segment.
    let stride = if step == 1 { 1 } else { step + 1 };
    let mut phase = 0u64;
    while phase < 1 << bits {
        let exact = (phase as f64 + 0.5) / 2f64.powi(bits as i32) * TAU;
        let (s, c) = sine(Bits::from_raw(phase as i64, bits), &coefficients, structure);
        let (s, c) = (s.to_f64(), c.to_f64());
        let (sin, cos) = exact.sin_cos();
        let worst = (s - sin).abs().max((c - cos).abs());
        result.largest = result.largest.max(worst);
        let angle = (s * cos - c * sin).atan2(c * cos + s * sin) / TAU;
        result.largest_angle_turns = result.largest_angle_turns.max(angle.abs());
        result.phases += 1;
        phase += stride;
    }
    result
}

/// Angle errors of the bit-true chip in periods.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// Rms.
    pub rms_periods: f64,
    /// Largest.
    pub largest_periods: f64,
    /// The loop was locked at the end.
    pub locked: bool,
}

/// A sensor with half of the promised errors, the promised noise and a slow sweep, after convergence on line.
#[must_use]
pub fn accuracy(design: &Design) -> Accuracy {
    let spec = &design.spec;
    let (s, converter) = (&spec.sensor, Converter::of(spec));
    let (m, o) = (s.amplitude_tolerance / 2.0, s.offset_max / 2.0);
    let beta = s.phase_error_max_deg.to_radians() / 2.0;
    // The sine is sampled so many samples later, where the design corrects that.
    let late = spec.correction.channel_skew_s * spec.adc.sample_rate_hz;
    // The larger signal just fits the ADC.
    let room = spec.adc.full_scale / (s.amplitude * (1.0 + m + o));
    let a = s.amplitude * room.min(1.0) * 0.999;
    let top = s.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    let fast = (top / 2.0).min(0.00713);
    // At the last gamma the slowest mode settles by an e-th in about 2/(64 gamma) periods.
    let last = 2f64.powi(spec.calibration.gamma_last as i32);
    let periods = 60.0 + 10.0 * last / 64.0 * 2.0;
    let converge = ((periods / fast) as usize).clamp(5_000, 400_000);
    // A whole period.
    let (settle, sweep) = (5_000, 100_000);
    let slow = 1.0 / sweep as f64;
    let mut noise = Noise(1);
    let mut chip = Chip::bit_true(design);
    let mut at = 0.1;
    let mut errors = vec![];
    for k in 0..converge + settle + sweep {
        // An axis slows down; a step in speed would show the loop's transient in the residual.
        let slowed = (k.saturating_sub(converge) as f64 / settle as f64).min(1.0);
        let speed = fast + (slow - fast) * slowed;
        at += speed;
        let (alpha, alpha_of_sin) = (at * TAU, (at + late * speed) * TAU);
        let mut channel =
            |v: f64| converter.code(spec.adc.middle + v + a * s.noise_rms * noise.next());
        let cos = channel(a * (1.0 + m) * alpha.cos() + o * a);
        let sin = channel(a * (1.0 - m) * (alpha_of_sin - beta).sin() - o * a);
        if k >= converge + settle {
            let error = chip.position() - at;
            errors.push(error - error.round());
        }
        chip.step_codes(cos, sin, false, true);
    }
    let n = errors.len() as f64;
    Accuracy {
        rms_periods: (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt(),
        largest_periods: errors.iter().fold(0.0, |most, e| most.max(e.abs())),
        locked: chip.state.locked,
    }
}

/// Nearly Gaussian noise from a fixed seed: twelve uniform numbers less six.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            // xorshift64
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            sum += (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum
    }
}
