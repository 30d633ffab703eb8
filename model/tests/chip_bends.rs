//! Eight and nine parameters on the chip: what the radius shows and what only the completion does.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::physical::Converter;
use nonius_model::spec::Spec;
use rand::{Rng, SeedableRng, rngs::StdRng};

/// Samples per period of the signal; the loop's bandwidth is `bandwidth` times its frequency.
const PER_PERIOD: f64 = 126.0;

fn spec(parameters: u32, completion: bool, bandwidth: f64) -> Spec {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../designs/optical.toml");
    let text = std::fs::read_to_string(path).expect("designs/optical.toml");
    let mut spec = Spec::from_toml(&text, "optical.toml").expect("a shipped design");
    spec.adc.bits = 16;
    spec.tracking.bandwidth_hz = bandwidth * spec.adc.sample_rate_hz / PER_PERIOD;
    spec.calibration.parameters = parameters;
    spec.calibration.completion = completion;
    spec
}

/// The corrected pair of the noise-free signals at `alpha` with the chip's parameters: the formula in plain `f64`.
fn corrected(theta: &[f64; 9], y: (f64, f64)) -> (f64, f64) {
    let [t1, t2, t3, t4, t5, t6, t7, t8, t9] = *theta;
    let (u, v) = (t1 * y.0 + t2, t3 * y.1 + t4);
    let (t_2, t_3) = (
        |u: f64| 2.0 * u * u - 1.0,
        |u: f64| 4.0 * u * u * u - 3.0 * u,
    );
    let c = u + t6 * t_2(u) + t8 * t_3(u) + t9 * (t_3(u) - u);
    let s = v + t7 * t_2(v) + t8 * t_3(v) - t9 * (t_3(v) - v);
    (c, s + t5 * c)
}

/// Order 2 of the miscalibration, and its rms, mrad.
fn miscalibration(
    design: &Design,
    theta: &[f64; 9],
    signals: &dyn Fn(f64) -> (f64, f64),
) -> (f64, f64) {
    let n = 720;
    let scale = design.spec.sensor.amplitude / design.spec.adc.full_scale;
    let errors: Vec<(f64, f64)> = (0..n)
        .map(|k| {
            let alpha = TAU * f64::from(k) / f64::from(n);
            let y = signals(alpha);
            let (c, s) = corrected(theta, (y.0 * scale, y.1 * scale));
            let error = s.atan2(c) - alpha;
            (alpha, error - TAU * (error / TAU).round())
        })
        .collect();
    let n = f64::from(n);
    let (re, im) = errors.iter().fold((0.0, 0.0), |(re, im), (a, e)| {
        (re + e * (2.0 * a).cos(), im + e * (2.0 * a).sin())
    });
    let mean = errors.iter().map(|e| e.1).sum::<f64>() / n;
    let rms = (errors.iter().map(|e| (e.1 - mean).powi(2)).sum::<f64>() / n).sqrt();
    (2e3 * re.hypot(im) / n, 1e3 * rms)
}

/// Order 2 of the miscalibration before and after `periods` periods, and its rms after, mrad.
fn calibrate(spec: &Spec, periods: u32, signals: &dyn Fn(f64) -> (f64, f64)) -> [f64; 3] {
    let design = Design::new(spec).expect("a design that works");
    let converter = Converter::of(spec);
    let mut chip = Chip::bit_true(&design);
    let mut random = StdRng::seed_from_u64(5);
    let mut gauss = || {
        let (u, v): (f64, f64) = (random.random(), random.random());
        (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
    };
    let before = miscalibration(&design, &chip.theta(), signals).0;
    for k in 0..(f64::from(periods) * PER_PERIOD) as u64 {
        let y = signals(TAU * k as f64 / PER_PERIOD);
        let a = spec.sensor.amplitude;
        let noise = (1e-3 * gauss(), 1e-3 * gauss());
        let (cos, sin) = (a * (y.0 + noise.0), a * (y.1 + noise.1));
        chip.step_codes(converter.code(cos), converter.code(sin), false, true);
    }
    assert!(chip.state.locked);
    let (after, rms) = miscalibration(&design, &chip.theta(), signals);
    let _: [Bits; 1] = [chip.state.theta_9_deviation];
    [before, after, rms]
}

fn cubic(alpha: f64) -> (f64, f64) {
    let (s, c) = alpha.sin_cos();
    (c + 0.03 * c.powi(3), s - 0.03 * s.powi(3))
}

fn third_harmonics(alpha: f64) -> (f64, f64) {
    (
        alpha.cos() + 0.03 * (3.0 * alpha).cos(),
        alpha.sin() + 0.03 * (3.0 * alpha).sin(),
    )
}

#[test]
fn explore() {
    for parameters in [5, 8, 9] {
        for completion in [false, true] {
            if parameters == 5 && completion {
                continue;
            }
            for bandwidth in [0.5, 1.0, 2.0] {
                let spec = spec(parameters, completion, bandwidth);
                let a = calibrate(&spec, 1200, &cubic);
                let b = calibrate(&spec, 1200, &third_harmonics);
                println!("{parameters} {completion} {bandwidth}: cubic {a:.3?} third {b:.3?}");
            }
        }
    }
}
