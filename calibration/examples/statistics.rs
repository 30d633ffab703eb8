//! Two thousand seeds of every method against the Cramér–Rao bound, as docs/offline-statistics.md.
//!
//!     cargo run --release -p nonius-calibration --example statistics [SEEDS]

use std::fmt::Write;
use std::thread;

use nonius_calibration::cramer_rao::bound;
use nonius_calibration::{Curve, Ellipse, Method, Options, calibrate};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 4000;
const TRUTH: Ellipse = Ellipse {
    a_c: 1.0,
    b_c: 0.1,
    a_s: 0.83,
    b_s: -0.08,
    beta: 0.087_266_462_599_716_47,
};

fn angles(start: f64) -> impl Iterator<Item = f64> {
    let step = 7.0 * std::f64::consts::TAU / SAMPLES as f64;
    (0..SAMPLES).map(move |k| start + step * k as f64)
}

/// Sums over seeds: error in bounds, its square, inside the 95 % interval; then seeds.
type Sums = [[f64; 3]; 5];

fn part(method: Method, noise: [f64; 2], unit: &[f64; 5], seeds: std::ops::Range<u64>) -> Sums {
    let mut sums = Sums::default();
    for seed in seeds {
        let mut random = StdRng::seed_from_u64(seed);
        let start: f64 = random.random_range(0.0..std::f64::consts::TAU);
        let (mut cos, mut sin) = (vec![], vec![]);
        for alpha in angles(start) {
            let y = TRUTH.point(alpha);
            let (n, m): (f64, f64) = (
                StandardNormal.sample(&mut random),
                StandardNormal.sample(&mut random),
            );
            cos.push(y.x + n * noise[0]);
            sin.push(y.y + m * noise[1]);
        }
        let Ok(found) = calibrate(&cos, &sin, method, &Options::default()) else {
            continue;
        };
        for (i, sum) in sums.iter_mut().enumerate() {
            let error = found.parameters[i].value - TRUTH.parameters()[i];
            sum[0] += error / unit[i];
            sum[1] += (error / unit[i]).powi(2);
            let inside = found.parameters[i]
                .std_error
                .is_some_and(|e| error.abs() < 1.96 * e);
            sum[2] += f64::from(u8::from(inside));
        }
    }
    sums
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(2000), |s| s.parse())?;
    let mut out = format!(
        "# Off-line estimators against the Cramér–Rao bound\n\n\
         Written by `cargo run --release -p nonius-calibration --example statistics`; do not edit. {SAMPLES} samples over\n\
         seven whole turns, offsets 10 % and −8 %, gain ratio 1.2, β = 5°; {seeds} seeds for `unbiased`, a tenth of them for the\n\
         others, whose error bars take forty fits each. The worst of the five parameters; errors in units of the bound.\n\n\
         | method | noise (cos, sin) | largest bias | largest spread | coverage of the 95 % interval |\n|---|---|---|---|---|\n"
    );
    for method in [
        Method::Unbiased,
        Method::Heydemann,
        Method::Sumsq5,
        Method::Extremes,
    ] {
        for noise in [[0.001; 2], [0.01; 2], [0.05; 2], [0.05 / 1.7, 0.05]] {
            let runs = if method == Method::Unbiased {
                seeds
            } else {
                seeds / 10
            };
            let all: Vec<f64> = angles(0.3).collect();
            let limit = bound(&TRUTH, &all, noise).ok_or("whole turns")?;
            let unit: [f64; 5] = std::array::from_fn(|i| limit.covariance[(i, i)].sqrt());
            let cores = thread::available_parallelism().map_or(1, usize::from) as u64;
            let sums = thread::scope(|scope| {
                let work: Vec<_> = (0..cores)
                    .map(|c| {
                        scope.spawn(move || {
                            part(
                                method,
                                noise,
                                &unit,
                                runs * c / cores..runs * (c + 1) / cores,
                            )
                        })
                    })
                    .collect();
                work.into_iter()
                    .filter_map(|w| w.join().ok())
                    .fold(Sums::default(), |mut a, b| {
                        for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
                            *a += b;
                        }
                        a
                    })
            });
            let n = runs as f64;
            let (mut bias, mut spread, mut low, mut high) = (0.0f64, 0.0f64, 1.0f64, 0.0f64);
            for [mean, square, inside] in sums {
                let mean = mean / n;
                bias = bias.max(mean.abs());
                spread = spread.max((square / n - mean * mean).sqrt());
                low = low.min(inside / n);
                high = high.max(inside / n);
            }
            writeln!(
                out,
                "| {method:?} | {:.3} %, {:.3} % | {bias:.3} | {spread:.3} | {:.1} … {:.1} % |",
                noise[0] * 100.0,
                noise[1] * 100.0,
                low * 100.0,
                high * 100.0
            )?;
            eprintln!("{method:?} {noise:?} done");
        }
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/offline-statistics.md");
    let scratch = format!("{path}.part");
    std::fs::write(&scratch, &out)?;
    std::fs::rename(scratch, path)?;
    print!("{out}");
    Ok(())
}
