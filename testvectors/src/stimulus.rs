//! Named stimuli: what the testbench plays.

use nonius_model::design::Design;
use nonius_model::spec::Calibration;
use rand::{Rng, SeedableRng, rngs::StdRng};

use crate::ties::Ties;

/// What arrives with one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// ADC code of the cosine channel.
    pub cos: i64,
    /// ADC code of the sine channel.
    pub sin: i64,
    /// Zero preset.
    pub preset: bool,
    /// Calibration on.
    pub calibrate: bool,
}

/// A named sequence of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stimulus {
    /// Name of its vector file.
    pub name: String,
    /// The samples.
    pub samples: Vec<Sample>,
}

/// Position of a sweep over its time 0 … 1: at top speed 1, over to −1 as slowly as there is time, and back.
fn sweep(t: f64) -> f64 {
    match t {
        t if t < 1.0 / 6.0 => t,
        t if t < 5.0 / 6.0 => {
            let turning = t - 1.0 / 6.0;
            1.0 / 6.0 + turning - 1.5 * turning * turning
        }
        t => 1.0 - t,
    }
}

/// Periods of travel in which the signal fades.
const FADING: f64 = 12.0;

/// Periods of travel in which it vanishes.
const VANISHING: f64 = 100.0;

/// All named stimuli, `rows` samples each, from one seed.
#[must_use]
pub fn named(design: &Design, rows: usize) -> Vec<Stimulus> {
    let spec = &design.spec;
    let half = (1i64 << (spec.adc.bits - 1)) as f64;
    let middle = if design.structure.offset_binary {
        1i64 << (spec.adc.bits - 1)
    } else {
        0
    };
    let a = spec.sensor.amplitude / spec.adc.full_scale;
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    let m = spec.sensor.amplitude_tolerance / 2.0;
    let o = spec.sensor.offset_max / 2.0 * a;
    let beta = spec.sensor.phase_error_max_deg.to_radians() / 2.0;
    let code = |v: f64| (v * half).round().clamp(-half, half - 1.0) as i64 + middle;
    let pair = |turns: f64, gain: f64, offset: f64| {
        let alpha = turns * std::f64::consts::TAU;
        let cos = a * (1.0 + m) * gain * alpha.cos() + o + offset;
        let sin = a * (1.0 - m) * (alpha - beta).sin() - o;
        (code(cos), code(sin))
    };
    // Periods of travel from a fade until the search has begun again and gamma, in gears of a period, has settled.
    let followed = 12.0 + f64::from(spec.calibration.hold_periods());
    let n = rows as f64;
    let motion = |name: &str, f: &dyn Fn(usize) -> (i64, i64)| {
        let samples = (0..rows).map(|k| {
            let (cos, sin) = f(k);
            Sample {
                cos,
                sin,
                // The second one stands after every loss of lock.
                preset: k == rows / 3 || k == rows - rows / 8,
                calibrate: k % 701 > 3,
            }
        });
        Stimulus {
            name: name.into(),
            samples: samples.collect(),
        }
    };
    let full = (1i64 << (spec.adc.bits - 1)) - 1 + middle;
    let low = -(1i64 << (spec.adc.bits - 1)) + middle;
    let faded = |(cos, sin): (i64, i64), gain: f64| {
        let of = |code: i64| middle + ((code - middle) as f64 * gain).round() as i64;
        (of(cos).clamp(low, full), of(sin).clamp(low, full))
    };
    // Gains at so many sixteenths of their bound make it a circle; the limit of what is near the bound is 15.
    let small = |k: usize, sixteenths: f64| {
        let constants = &design.constants;
        let nominal = constants.theta_1_nominal.ideal;
        let small = nominal / (nominal + constants.gain_near_bound.value() * sixteenths / 15.0);
        let alpha = std::f64::consts::TAU * k as f64 * top / 2.5;
        (code(a * small * alpha.cos()), code(a * small * alpha.sin()))
    };
    let mut random = StdRng::seed_from_u64(1);
    let noise: Vec<(i64, i64)> = (0..rows)
        .map(|_| {
            (
                random.random_range(low..=full),
                random.random_range(low..=full),
            )
        })
        .collect();
    let slow = motion("slow turn", &|k| {
        pair(0.007 * k as f64 * (top / 0.1), 1.0, 0.0)
    });
    // Rate below which the direction does not change, turns.
    let dead = design.constants.direction_rate.value();
    let mut all = vec![
        motion("standstill", &|_| pair(0.3, 1.0, 0.0)),
        motion("forwards", &|k| {
            pair(0.017 * k as f64 * (top / 0.1), 1.0, 0.0)
        }),
        motion("backwards", &|k| {
            pair(0.4 - 0.013 * k as f64 * (top / 0.1), 1.0, 0.0)
        }),
        motion("sweep", &|k| pair(sweep(k as f64 / n) * n * top, 1.0, 0.0)),
        // So slow that the direction is the old one, then the other one.
        motion("creep", &|k| {
            let t = k as f64 / n - 0.5;
            pair(0.3 + 4.0 * dead * n * t * t, 1.0, 0.0)
        }),
        // The signal grows before gamma has settled, goes before the search has begun again and once more after its first period, and falls
        // a little later; it goes, comes back small, and grows.
        motion("loss", &|k| {
            let gain = match k as f64 / n {
                t if t < 0.2 => 0.72,
                t if t > 0.235 && t < 0.25 => 0.0,
                t if t > 0.45 && t < 0.465 => 0.0,
                t if t > 0.60 && t < 0.64 => 1.0 - 2.5 * (t - 0.60),
                t if t < 0.66 => 1.0,
                t if t < 0.72 => 0.0,
                t if t < 0.9 => 0.7,
                t => 0.7 + 4.0 * (t - 0.9),
            };
            faded(pair(0.02 * k as f64 * (top / 0.1), 1.0, 0.0), gain)
        }),
        // At top speed, soon after lock, each second period has a part that is too large. The signal fades slowly once gamma has settled,
        // and stays so until the search begins again; where there is recall it changes for some periods once gamma has settled on it,
        // is then back, and grows until the radius is far too large.
        motion("fade", &|k| {
            let travelled = k as f64 * top;
            let fading = (k as f64 - n / 3.0) * top;
            let gain = match fading - FADING / 2.0 - followed {
                _ if travelled > 17.0 && travelled < 24.0 && travelled % 2.0 < 0.2 => 1.35,
                _ if 3 * k < rows => 1.0,
                _ if fading < FADING => 1.0 - 0.12 * fading / FADING,
                _ if !spec.calibration.recalls() => 0.88,
                periods if periods > 6.0 => 1.06 + 0.006 * (periods - 6.0),
                periods if periods > 0.0 && periods < 3.0 => 0.97,
                _ => 0.88,
            };
            faded(pair(top * k as f64, 1.0, 0.0), gain)
        }),
        // So slowly that the gains follow for some periods, to nothing, and back.
        motion("vanish", &|k| {
            let vanished = (k as f64 - 0.22 * n) * top / VANISHING;
            let gain = if vanished < 1.0 {
                1.0 - vanished.max(0.0)
            } else {
                ((vanished - 1.05) * 2.0).clamp(0.0, 1.0)
            };
            faded(pair(top * k as f64, 1.0, 0.0), gain)
        }),
        // Weak once gamma has settled and before anything is proven, until the search begins again.
        motion("early", &|k| {
            let periods = k as f64 * top;
            let weak = periods > 34.0 && periods < 74.0;
            faded(pair(periods, 1.0, 0.0), if weak { 0.88 } else { 1.0 })
        }),
        // Weak for most of what is waited for, whole for some periods, and weak for most of it again.
        motion("weak", &|k| {
            let weak = (k as f64 - 0.4 * n) * top;
            let again = 0.625 * f64::from(spec.calibration.hold_periods());
            let whole = again + 8.0 + f64::from(spec.calibration.returning_periods());
            let gain = match weak {
                weak if weak < 0.0 => 1.0,
                weak if weak < again => 0.88,
                weak if weak < whole => 1.0,
                _ => 0.88,
            };
            faded(pair(top * k as f64, 1.0, 0.0), gain)
        }),
        motion("step", &|k| {
            let stepped = if k > rows / 2 {
                (0.9, 0.04 * a)
            } else {
                (1.0, 0.0)
            };
            pair(0.011 * k as f64 * (top / 0.1), stepped.0, stepped.1)
        }),
        motion("corners", &|k| {
            if k % 7 == 3 {
                (middle, middle)
            } else {
                (
                    if k & 1 == 0 { full } else { low },
                    if k & 2 == 0 { full } else { low },
                )
            }
        }),
        // The parameters are led to their bounds and beyond before a gear has ended calm, then come codes that the correction
        // cannot hold.
        motion("bounds", &|k| {
            let t = ((k as f64 / n - 0.03) * 8.0).clamp(0.0, 1.0);
            let alpha = std::f64::consts::TAU * k as f64 * top.min(1.0 / 20.0);
            if 3 * k < 2 * rows {
                let cos = a * (1.0 - 0.5 * t) * alpha.cos() + o * 6.0 * t;
                let sin = a * (1.0 - 0.5 * t) * (alpha - beta * 6.0 * t).sin() - o * 6.0 * t;
                (code(cos), code(sin))
            } else {
                let rail = |v: f64| if v < 0.0 { low } else { full };
                (rail(alpha.cos()), rail(alpha.sin()))
            }
        }),
        // So slowly down that the parameters follow, until it falls.
        motion("drift", &|k| {
            let drifting = (k as f64 - 0.4 * n) * top;
            let left = if 8 * k > 7 * rows { 0.88 } else { 1.0 };
            let gain = left * (1.0 - 6e-4 * drifting.max(0.0));
            faded(pair(top * k as f64, 1.0, 0.0), gain)
        }),
        // At top speed, and once gamma has settled a little slower and back within a sample, again and again: in each of some
        // periods of travel, then in one alone. The loop catches up by a tenth of a radian and more, in lock. Later so far at once that
        // it is out of the lock window, then that the estimate is across the signal, then that it points away from it, with all of the
        // signal there. At last the signal is small, and gone for two samples.
        motion("jolts", &|k| {
            let slower = 0.4 * spec.tracking.bandwidth_hz / spec.adc.sample_rate_hz;
            let run = ((1.3 / top) as usize).max(1);
            let slow = |n: usize| n / (2 * run) * run + (n % (2 * run)).min(run);
            let busy = 8 * run;
            let since = k.saturating_sub(2 * rows / 5);
            let alone = since.saturating_sub(busy + 8 * run).min(4 * run);
            let slowly = slow(since.min(busy)) + alone;
            // Small for two samples, across the estimate: a little more than the least radius in lock, and what the loop leaves of that.
            let least = 19 * rows / 20;
            let (jump, gain) = match k {
                k if 5 * k < 4 * rows => (0.0, 1.0),
                k if 20 * k < 17 * rows => (0.14, 1.0),
                k if 20 * k < 18 * rows => (0.44, 1.0),
                k if k < least => (0.89, 1.0),
                k if k < least + 2 => {
                    let radius = design.constants.lock_radius.value();
                    (1.14, if k == least { radius + 0.03 } else { radius })
                }
                k if k < least + 4 => (0.89, 0.0),
                _ => (0.89, 1.0),
            };
            let turns = top * k as f64 - slower.min(top / 2.0) * slowly as f64 + jump;
            faded(pair(turns, 1.0, 0.0), gain)
        }),
        // Over a period and back.
        motion("reversals", &|k| {
            let swing = k as f64 * top / 32.0;
            pair(
                0.65 * (1.0 - (swing * std::f64::consts::TAU).cos()),
                1.0,
                0.0,
            )
        }),
        // So small a signal that both gains come to rest near their bounds, and later at them; a little smaller, beyond the limit.
        motion("small", &|k| {
            small(k, if k as f64 / n < 0.62 { 14.6 } else { 16.2 })
        }),
        motion("smaller", &|k| {
            small(k, if k as f64 / n < 0.9 { 15.4 } else { 18.0 })
        }),
        Stimulus {
            name: "ties".into(),
            samples: Ties::new(design).search(design, &slow.samples),
        },
        motion("random", &|k| noise[k]),
    ];
    if spec.calibration.has_bend() {
        // So fast that bends rest, forwards and backwards, and a little slower.
        all.push(motion("fast", &|k| {
            let third = rows / 3;
            let run = |of: usize| k.saturating_sub(of * third).min(third) as f64;
            let rate = Calibration::BEND_RATE;
            let turns = rate * (1.13 * run(0) - 1.43 * run(1) + 0.93 * run(2));
            pair(turns, 1.0, 0.0)
        }));
    }
    all
}
