//! The long form's cases, its file of numbers, and its page.

use std::fmt::Write;

use nonius_calibration::Method;
use serde_json::{Value, json};

use super::campaign::{Case, SAMPLES, SENSOR, Sensor, Tally};

/// Seeds that a test runs again, to see whether the file is fresh.
pub(crate) const PROBE: u64 = 2;
/// The file of numbers.
pub(crate) const NUMBERS: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../docs/offline-statistics.json"
);
/// The page.
pub(crate) const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/offline-statistics.md");
/// What writes both.
pub(crate) const COMMAND: &str = "cargo run --release -p nonius-calibration --example statistics";

/// Without errors, with the opposite ones, and with a sine of half the amplitude.
const OTHERS: [Sensor; 3] = [
    [1.0, 0.0, 1.0, 0.0, 0.0],
    [0.9, -0.09, 1.08, 0.108, -0.087_266_462_599_716_47],
    [1.0, -0.1, 0.5, 0.05, 0.1],
];

/// As the others' sensor, but for the phase error, which methods without phase take to be 0.
const IN_PHASE: Sensor = [1.0, 0.1, 0.83, -0.08, 0.0];

/// Noise of 1.7 : 1 between the channels, either way.
const UNEQUAL: f64 = 0.05 / 1.7;

/// All cases, with the share of the seeds that each gets: what is promised gets all of them.
pub(crate) fn cases() -> Vec<(Case, f64)> {
    let mut out = vec![];
    let mut add = |method: Method, noise, periods, share| {
        let without_phase = method.searches() && !method.finds_phase();
        out.push((
            Case {
                method,
                sensor: if without_phase { IN_PHASE } else { SENSOR },
                noise,
                periods,
            },
            share,
        ));
    };
    for noise in [0.001, 0.003, 0.01, 0.03, 0.05] {
        add(Method::Unbiased, [noise; 2], 7.0, 1.0);
    }
    add(Method::Unbiased, [UNEQUAL, 0.05], 7.0, 1.0);
    add(Method::Unbiased, [0.05, UNEQUAL], 7.0, 1.0);
    for periods in [0.75, 0.5, 0.35, 0.25] {
        add(Method::Unbiased, [0.005; 2], periods, 0.25);
    }
    for method in [
        Method::Heydemann,
        Method::Sumsq5,
        Method::Poly9,
        Method::Sumsq4,
        Method::Poly8,
        Method::Extremes,
    ] {
        for noise in [[0.001; 2], [0.01; 2], [0.05; 2], [UNEQUAL, 0.05]] {
            add(method, noise, 7.0, 0.1);
        }
    }
    let others = OTHERS.iter().flat_map(|sensor| {
        // Of the amplitude of each channel.
        [0.001, 0.01, 0.05].map(|noise| Case {
            method: Method::Unbiased,
            sensor: *sensor,
            noise: [noise * sensor[0], noise * sensor[2]],
            periods: 7.0,
        })
    });
    out.extend(others.map(|case| (case, 1.0)));
    out
}

/// A case and its tally as a row of the file. `probe` is the tally of the first [`PROBE`] seeds.
pub(crate) fn row(case: &Case, tally: &Tally, probe: &Tally) -> Value {
    let list = |v: nalgebra::SVector<f64, 5>| v.iter().copied().collect::<Vec<f64>>();
    json!({
        "method": case.method.name(),
        "sensor": case.sensor,
        "noise": case.noise,
        "periods": case.periods,
        "seeds": tally.seeds,
        "refused": tally.refused,
        "bias": list(tally.bias()),
        "bias_error": list(tally.bias_error()),
        "spread": list(tally.spread()),
        "spread_error": list(tally.spread_error()),
        "stated": list(tally.stated()),
        "coverage": list(tally.coverage()),
        "probe": {"bias": list(probe.bias()), "spread": list(probe.spread()), "stated": list(probe.stated())},
    })
}

/// The page, from the file of numbers alone.
pub(crate) fn page(numbers: &Value) -> String {
    let mut out = format!(
        "# Off-line estimators against the Cramér–Rao bound\n\n\
         Written by `{COMMAND}`; do not edit. The numbers behind it are in\n\
         [offline-statistics.json](offline-statistics.json).\n\n\
         Each seed is a recording of {SAMPLES} samples of a sensor (a_c, b_c, a_s, b_s, β), noise in the same unit,\n\
         used with its white noise and with the negative of it, so that bias shows apart from scatter. Of the five\n\
         parameters each column has the worst. Bias and spread (standard deviation) are in units of the bound; *stated* is\n\
         the standard error that the method gives, in units of the true spread; *coverage* is the share of its 95 %\n\
         intervals that hold the truth.\n\n\
         | method | sensor | periods | noise (cos, sin) | seeds | bias | spread | stated | coverage |\n|---|---|---|---|---|---|---|---|---|\n"
    );
    for row in numbers["rows"].as_array().into_iter().flatten() {
        let list = |name: &str| -> Vec<f64> {
            row[name]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Value::as_f64)
                .collect()
        };
        // β has no error bar where it is held.
        let free: Vec<usize> = (0..5).filter(|i| list("stated")[*i] > 0.0).collect();
        let of = |name: &str| -> Vec<f64> { free.iter().map(|i| list(name)[*i]).collect() };
        let most = |v: &[f64]| v.iter().copied().fold(0.0, |m: f64, x| m.max(x.abs()));
        let ends = |v: &[f64]| {
            let low = v.iter().copied().fold(f64::INFINITY, f64::min);
            let high = v.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (low, high)
        };
        let (bias, spread) = (of("bias"), of("spread"));
        let stated: Vec<f64> = of("stated")
            .iter()
            .zip(&spread)
            .map(|(s, t)| s / t)
            .collect();
        let far = spread.iter().copied().fold(1.0, |far: f64, s| {
            if (s - 1.0).abs() > (far - 1.0).abs() {
                s
            } else {
                far
            }
        });
        let (low, high) = ends(&of("coverage"));
        let (least, largest) = ends(&stated);
        let noise = list("noise");
        let sensor = list("sensor");
        let _ = writeln!(
            out,
            "| {} | {}, {}, {}, {}, {:.1}° | {} | {:.2} %, {:.2} % | {} | {:.3} | {:.3} | {least:.2} … {largest:.2} | {:.1} … {:.1} % |",
            row["method"].as_str().unwrap_or_default(),
            sensor[0],
            sensor[1],
            sensor[2],
            sensor[3],
            sensor[4].to_degrees(),
            row["periods"],
            noise[0] * 100.0,
            noise[1] * 100.0,
            row["seeds"],
            most(&bias),
            far,
            low * 100.0,
            high * 100.0,
        );
    }
    out
}
