//! From power-up into full speed, with every sensor that a shipped design promises at its worst.

mod chip_support;

use std::f64::consts::TAU;

use chip_support::{Bench, shipped};
use nonius_model::spec::Spec;
use rayon::prelude::*;

/// Samples: the loop locks within a few hundred where it does.
const SAMPLES: u32 = 6000;

/// All errors as large as promised; each bit of `signs` turns one of them round. In units of the nominal amplitude.
fn corner(spec: &Spec, signs: u32) -> impl Fn(f64) -> (f64, f64) {
    let s = &spec.sensor;
    let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let gain = [0, 1].map(|i| 1.0 + sign(i) * s.amplitude_tolerance);
    let offset = [2, 3].map(|i| sign(i) * s.offset_max);
    let beta = sign(4) * s.phase_error_max_deg.to_radians();
    move |alpha| {
        (
            gain[0] * alpha.cos() + offset[0],
            gain[1] * (alpha - beta).sin() + offset[1],
        )
    }
}

fn locks(spec: &Spec, signs: u32, speed: f64, phase: f64) -> bool {
    let signals = corner(spec, signs);
    let mut bench = Bench::new(spec, u64::from(signs));
    for k in 0..SAMPLES {
        bench.step(signals(TAU * (phase + speed * f64::from(k))));
    }
    bench.chip.state.locked && !bench.chip.state.lock_lost
}

#[test]
fn every_promised_sensor_locks_at_full_speed() {
    for name in shipped::NAMES {
        let spec = shipped::spec(name);
        let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
        (0..32u32).into_par_iter().for_each(|signs| {
            for part in [-1.0, -0.5, 0.0, 0.02, 0.9, 1.0] {
                for phase in [0.0, 0.13, 0.4, 0.77] {
                    let locked = locks(&spec, signs, part * top, phase);
                    assert!(
                        locked,
                        "{name}, signs {signs:b}, {part} of the top speed from {phase}"
                    );
                }
            }
        });
    }
}
