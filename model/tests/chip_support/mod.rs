//! A bit-true chip, a sensor in front of it, and how far its parameters are from the truth.
#![allow(dead_code, reason = "each test uses its own part")]

pub(crate) mod bent;
pub(crate) mod loss;
pub(crate) use crate::support::shipped;

pub(crate) use shipped::optical;

use std::cell::RefCell;
use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::physical::Converter;
use nonius_model::reference::{Parameters, Theta};
use nonius_model::spec::Spec;
use rand::{Rng, SeedableRng, rngs::StdRng};

/// White noise of unit variance.
#[derive(Clone)]
pub(crate) struct Noise(StdRng);

impl Noise {
    pub(crate) fn new(seed: u64) -> Self {
        Self(StdRng::seed_from_u64(seed))
    }

    pub(crate) fn next(&mut self) -> f64 {
        let (u, v): (f64, f64) = (self.0.random(), self.0.random());
        (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
    }
}

/// A chip behind its ADC.
#[derive(Clone)]
pub(crate) struct Bench {
    pub(crate) design: Design,
    pub(crate) chip: Chip<Bits>,
    converter: Converter,
    noise: Noise,
}

thread_local! {
    /// The last one: it takes as long to make as thousands of samples, and mostly the next bench has the same.
    static LAST: RefCell<Option<Design>> = const { RefCell::new(None) };
}

/// A design that works.
fn design(spec: &Spec) -> Design {
    LAST.with_borrow_mut(|last| match last {
        Some(design) if design.spec == *spec => design.clone(),
        _ => last
            .insert(Design::new(spec).expect("a design that works"))
            .clone(),
    })
}

impl Bench {
    pub(crate) fn new(spec: &Spec, seed: u64) -> Self {
        let design = design(spec);
        Self {
            chip: Chip::bit_true(&design),
            converter: Converter::of(spec),
            noise: Noise::new(seed),
            design,
        }
    }

    /// The same bench, other noise.
    pub(crate) fn with_noise(&self, seed: u64) -> Self {
        Self {
            noise: Noise::new(seed),
            ..self.clone()
        }
    }

    /// One sample of a pair in units of the nominal amplitude, with noise as the design promises it.
    pub(crate) fn step(&mut self, y: (f64, f64)) {
        self.step_if(y, true);
    }

    /// The same with the pin `calibrate`.
    pub(crate) fn step_if(&mut self, y: (f64, f64), calibrate: bool) {
        let Spec { sensor, adc, .. } = &self.design.spec;
        let mut code = |y: f64| {
            let y = y + sensor.noise_rms * self.noise.next();
            self.converter.code(adc.middle + sensor.amplitude * y)
        };
        let (cos, sin) = (code(y.0), code(y.1));
        self.chip.step_codes(cos, sin, false, calibrate);
    }

    /// The corrected pair, of signals in units of the nominal amplitude.
    pub(crate) fn corrected(&self, y: (f64, f64)) -> (f64, f64) {
        self.correction()(y)
    }

    fn correction(&self) -> impl Fn((f64, f64)) -> (f64, f64) {
        let theta = Theta::from(self.chip.theta());
        let scale = self.design.spec.sensor.amplitude / self.design.spec.adc.full_scale;
        let power = (1.0 / scale).log2().floor().exp2().max(1.0);
        let set = if self.design.spec.calibration.has_bend() {
            Parameters::SplitNine
        } else {
            Parameters::Five
        };
        move |y| {
            let [c, s] = set.corrected(&theta, [y.0, y.1].map(|y| y * scale * power));
            (c, s)
        }
    }

    /// Angle of the noise-free corrected pair less the true one, radians, over a period, the mean removed.
    pub(crate) fn miscalibration(&self, signals: &dyn Fn(f64) -> (f64, f64)) -> Vec<f64> {
        self.miscalibration_at(720, signals)
    }

    /// The same at so many places of the period.
    pub(crate) fn miscalibration_at(
        &self,
        points: usize,
        signals: &dyn Fn(f64) -> (f64, f64),
    ) -> Vec<f64> {
        let corrected = self.correction();
        let errors: Vec<f64> = (0..points)
            .map(|k| {
                let alpha = TAU * k as f64 / points as f64;
                let (c, s) = corrected(signals(alpha));
                let error = s.atan2(c) - alpha;
                error - TAU * (error / TAU).round()
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / points as f64;
        errors.iter().map(|e| e - mean).collect()
    }
}

/// Amplitude of one order of an error over a period.
pub(crate) fn order(error: &[f64], n: u32) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (k, e) in error.iter().enumerate() {
        let angle = TAU * f64::from(n) * k as f64 / error.len() as f64;
        re += e * angle.cos();
        im += e * angle.sin();
    }
    2.0 * re.hypot(im) / error.len() as f64
}

/// Root of the mean square.
pub(crate) fn rms(error: &[f64]) -> f64 {
    (error.iter().map(|e| e * e).sum::<f64>() / error.len() as f64).sqrt()
}

/// The larger of each.
pub(crate) fn larger<const N: usize>(a: [f64; N], b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i].max(b[i]))
}

/// Largest magnitude.
pub(crate) fn largest(error: &[f64]) -> f64 {
    error.iter().fold(0.0, |m, e| m.max(e.abs()))
}

/// Offsets 10 %, gain ratio 1.2, β = 5°, with these signs.
pub(crate) fn sensor(signs: u32) -> impl Fn(f64) -> (f64, f64) {
    sensor_of(signs, 5.0)
}

/// The same with another β, degrees.
pub(crate) fn sensor_of(signs: u32, beta: f64) -> impl Fn(f64) -> (f64, f64) + Clone {
    let sign = move |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let ratio = 1.2f64.powf(0.5 * sign(0));
    let beta = beta.to_radians() * sign(3);
    move |alpha: f64| {
        (
            ratio * alpha.cos() + 0.1 * sign(1),
            (alpha - beta).sin() / ratio + 0.1 * sign(2),
        )
    }
}

/// Largest share of the first miscalibration that is left after 1, 2, … `periods` periods of travel in lock, over all
/// signs, at 64 samples a period; percent. β, which four and eight parameters do not calibrate, is 0 for them.
pub(crate) fn course(spec: &Spec, periods: usize) -> Vec<f64> {
    // A little off 64 a period, so that the sectors are not always met at the same places.
    course_at(spec, periods, 64.37)
}

/// The same at so many samples a period, 64 or a little more.
pub(crate) fn course_at(spec: &Spec, periods: usize, per_period: f64) -> Vec<f64> {
    let mut worst = vec![0.0f64; periods];
    let beta = match spec.calibration.parameters {
        4 | 8 => 0.0,
        _ => 5.0,
    };
    let at_rest = Bench::new(spec, 0);
    for signs in 0..16 {
        let signals = sensor_of(signs, beta);
        let mut bench = at_rest.with_noise(u64::from(signs));
        let before = rms(&bench.miscalibration(&signals));
        let period = per_period.round() as usize;
        let (mut locked, mut k) = (0, 0);
        while locked < periods * period {
            bench.step(signals(TAU / per_period * f64::from(k)));
            k += 1;
            assert!(k < 20_000, "never locked");
            if bench.chip.state.locked {
                locked += 1;
                if locked % period == 0 {
                    let left = rms(&bench.miscalibration(&signals)) / before;
                    let worst = &mut worst[locked / period - 1];
                    *worst = worst.max(100.0 * left);
                }
            }
        }
    }
    worst
}

/// The optical design at 64 samples a period: 12 bits, 0.1 % noise, a loop that follows.
pub(crate) fn fast() -> Spec {
    let mut spec = optical();
    spec.tracking.bandwidth_hz = 20e3;
    spec.accuracy.rms_periods = 200e-6;
    spec
}
