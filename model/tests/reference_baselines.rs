//! What the paper argues against: the open-loop arctangent, and the extremes of the signals.

use crate::reference_support::{MISCALIBRATED, Noise, TS};
use nonius_model::reference::Parameters;
use nonius_model::reference::baseline::{Baseline, OpenLoop};
use nonius_model::reference::extremes::PeriodExtremes;

const SPEED: f64 = 0.05;

/// Samples with 0.1 % noise.
fn record(signals: impl Fn(f64) -> [f64; 2], samples: u32) -> Vec<[f64; 2]> {
    let mut noise = Noise::new(11, 0.001);
    (0..samples)
        .map(|k| {
            let (y, n) = (signals(SPEED * f64::from(k)), noise.pair());
            [y[0] + n[0], y[1] + n[1]]
        })
        .collect()
}

/// The baselines: the open-loop arctangent keeps the whole miscalibration; extremes leave the phase error and noise.
#[test]
fn the_baselines_leave_what_they_must() {
    let record = record(|a| MISCALIBRATED.signals(a), 20_000);
    let five = Parameters::Five;
    let plain = Baseline::Fixed(five, five.nominal(1.0));
    let extremes = Baseline::Extremes(PeriodExtremes::new(1.0));
    let calibrated = Baseline::Fixed(five, five.from_five(MISCALIBRATED.theta()));
    let [plain, extremes, calibrated] = [plain, extremes, calibrated].map(|baseline| {
        let mut open_loop = OpenLoop::new(baseline, TS);
        let mut square = 0.0;
        for (k, y) in record.iter().enumerate() {
            let seen = open_loop.step(y[0], y[1]);
            if k >= 10_000 {
                square += (seen.alpha_hat - SPEED * k as f64).powi(2) / 10_000.0;
                // Speed as a difference of two noisy angles, miscalibrated at worst by a quarter.
                assert!(
                    (seen.speed * TS / SPEED - 1.0).abs() < 0.5,
                    "{}",
                    seen.speed
                );
            }
        }
        square.sqrt()
    });
    println!(
        "rms angle error, mrad: arctangent {:.1}, extremes {:.1}, calibrated {:.2}",
        1e3 * plain,
        1e3 * extremes,
        1e3 * calibrated
    );
    assert!(plain > 0.1, "{plain}");
    // β/2 sin 2α and β/2 of constant shift remain: β/2 √(1 + ½).
    let left = MISCALIBRATED.beta / 2.0 * 1.5f64.sqrt();
    assert!((extremes / left - 1.0).abs() < 0.1, "{extremes} {left}");
    assert!((calibrated - 1e-3).abs() < 1e-4, "{calibrated}");
}

/// The extremes are those of the last whole period: a sensor that changes is followed a period later, not before.
#[test]
fn extremes_forget_with_each_period() {
    let mut extremes = PeriodExtremes::new(1.0);
    let large = |a: f64| [2.0 * a.cos(), 2.0 * a.sin()];
    let small = |a: f64| [0.5 * a.cos() + 0.1, 0.5 * a.sin()];
    for k in 0..500 {
        let alpha = 0.05 * f64::from(k);
        extremes.step(large(alpha), alpha);
    }
    assert!((extremes.theta()[0] - 0.5).abs() < 1e-3);
    // Three periods and 123 samples were travelled: the running period still holds large ones.
    for k in 500..530 {
        let alpha = 0.05 * f64::from(k);
        extremes.step(small(alpha), alpha);
    }
    assert!(extremes.theta()[0] < 1.0);
    for k in 530..800 {
        let alpha = 0.05 * f64::from(k);
        extremes.step(small(alpha), alpha);
    }
    let [t1, t2, ..] = extremes.theta();
    assert!(
        (t1 - 2.0).abs() < 1e-3 && (t2 + 0.2).abs() < 1e-3,
        "{t1} {t2}"
    );
}
