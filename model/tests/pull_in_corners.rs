//! From power-up into full speed, with every sensor that a shipped design promises at its worst.

mod support;

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use rayon::prelude::*;
use support::{Encoder, shipped};

/// Samples: the loop locks within a few hundred where it does.
const SAMPLES: u32 = 6000;

/// All errors as large as promised; each bit of `signs` turns one of them round.
fn corner(spec: &Spec, signs: u32) -> Encoder {
    let s = &spec.sensor;
    let a = s.amplitude / spec.adc.full_scale;
    let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
    Encoder {
        amplitude: [0, 1].map(|i| a * (1.0 + sign(i) * s.amplitude_tolerance)),
        offset: [2, 3].map(|i| a * sign(i) * s.offset_max),
        beta: sign(4) * s.phase_error_max_deg.to_radians(),
        ..Encoder::ideal(spec)
    }
}

fn locks(design: &Design, encoder: &Encoder, speed: f64, phase: f64) -> bool {
    let offset = if design.structure.offset_binary {
        1 << (design.spec.adc.bits - 1)
    } else {
        0
    };
    let mut chip = Chip::bit_true(design);
    for k in 0..SAMPLES {
        let [cos, sin] = encoder.codes(phase + speed * f64::from(k));
        chip.step_codes(cos + offset, sin + offset, false, true);
    }
    chip.state.locked && !chip.state.lock_lost
}

#[test]
fn every_promised_sensor_locks_at_full_speed() {
    for name in shipped::NAMES {
        let spec = shipped::spec(name);
        let design = Design::new(&spec).expect("a shipped design");
        let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
        (0..32u32).into_par_iter().for_each(|signs| {
            let encoder = corner(&spec, signs);
            for part in [-1.0, -0.5, 0.0, 0.02, 0.9, 1.0] {
                for phase in [0.0, 0.13, 0.4, 0.77] {
                    let locked = locks(&design, &encoder, part * top, phase);
                    assert!(
                        locked,
                        "{name}, signs {signs:b}, {part} of the top speed from {phase}"
                    );
                }
            }
        });
    }
}
