//! Channels with harmonics of the scale period: the chip that has them in its table, against the one that does not.
//!
//! The numbers are kept in docs/harmonics-measured.md; NONIUS_BLESS=1 writes it anew.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use crate::chip_support::shipped::{
    self,
    variants::{harmonics, third_and_fifth},
};
use crate::chip_support::{Bench, optical, rms};
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::harmonics::{Order, correct, stored};
use nonius_model::kernel::{Probes, State};
use nonius_model::reference::from_spec;
use nonius_model::spec::{Harmonic, Spec};

/// β of the sensor, radians.
const BETA: f64 = 0.06;
const SAMPLES: u32 = 90_000;
/// Turns a sample: a twentieth of the loop's bandwidth and four times it, at irrational places of the period.
const SLOW: f64 = 0.000_713;
const FAST: f64 = 0.0983;

fn spec(parameters: u32, known: Vec<Harmonic>) -> Spec {
    let mut spec = optical();
    spec.calibration.parameters = parameters;
    spec.correction.harmonics = known;
    spec
}

struct Seen {
    /// Angle error over the last third, periods: nothing is removed from it.
    errors: Vec<f64>,
    /// θ1 … θ9 in the end.
    theta: [f64; 9],
    /// Phase error over the last third, radians rms.
    e: f64,
}

/// The chip of `spec` behind a sensor with β, an amplitude off by 10 % and these harmonics.
fn run(spec: &Spec, real: &[Harmonic], speed: f64) -> Seen {
    let mut bench = Bench::new(spec, 3);
    let (beta, wrong) = match spec.calibration.parameters {
        0 => (0.0, 0.0),
        4 | 8 => (0.0, 1.0),
        _ => (BETA, 1.0),
    };
    let more =
        |which: usize, alpha: f64| -> f64 { real.iter().map(|h| h.at(which, alpha).0).sum() };
    let (mut errors, mut e) = (vec![], vec![]);
    // Long enough for the calibration of either.
    for k in 0..SAMPLES.max((60.0 / speed) as u32) {
        let turns = speed * f64::from(k);
        let alpha = TAU * turns;
        let error = bench.chip.position() - turns;
        if k >= 2 * SAMPLES.max((60.0 / speed) as u32) / 3 {
            assert!(bench.chip.state.locked);
            errors.push(error - error.round());
            e.push(bench.chip.state.error_previous.to_f64());
        }
        bench.step((
            (1.0 + 0.1 * wrong) * (alpha.cos() + more(0, alpha)) + 0.03 * wrong,
            (1.0 - 0.05 * wrong) * ((alpha - beta).sin() + more(1, alpha)) - 0.02 * wrong,
        ));
    }
    Seen {
        errors,
        theta: bench.chip.theta(),
        e: rms(&e),
    }
}

/// With the table the angle error is that of the sensor without harmonics, sample by sample, to what the design says is left
/// and to what ADC, calibration and arithmetic do to either. Without it the error is there.
fn the_angle_error_is_that_of_the_pure_sensor() -> String {
    let mut rows = String::from(
        "| parameters | speed | as with a pure sensor, with the table | without the table | e, pure | with the table | without |\n|---|---|---|---|---|---|---|\n",
    );
    for parameters in [0, 4, 5, 9] {
        let design = Design::new(&spec(parameters, third_and_fifth())).expect("a design");
        let (known, budget) = (design.harmonics.expect("a table"), &design.budget);
        for (speed, name) in [(SLOW, "slow"), (FAST, "fast")] {
            let pure = run(&spec(parameters, vec![]), &[], speed);
            let more = |list: Vec<Harmonic>| {
                let seen = run(&spec(parameters, list), &third_and_fifth(), speed);
                let pairs = seen.errors.iter().zip(&pure.errors);
                (rms(&pairs.map(|(a, b)| a - b).collect::<Vec<_>>()), seen.e)
            };
            let ((mended, e), (plain, e_plain)) = (more(third_and_fifth()), more(vec![]));
            let either =
                (budget.adc.powi(2) + budget.calibration.powi(2)).sqrt() + budget.arithmetic();
            let allowed = known.residual_rms_periods + 2.0 * either;
            let _ = writeln!(
                rows,
                "| {parameters} | {name} | {mended:.1e} | {plain:.1e} | {:.1e} | {e:.1e} | {e_plain:.1e} |",
                pure.e
            );
            assert!(mended <= allowed, "{mended} of {allowed}");
            if name == "slow" {
                // The loop follows it; a calibration that is biased by it adds to it or takes from it.
                assert!(plain > 0.5 * known.uncorrected_rms_periods, "{plain}");
            } else {
                // The loop does not, with or without the table: the phase error shows it.
                assert!(e_plain > 0.5 * TAU * known.uncorrected_rms_periods);
                assert!(e < 1.1 * pure.e, "{e}, {}", pure.e);
            }
        }
    }
    rows
}

/// The calibration sees a pure ellipse: gains, offsets and phase come out as without harmonics. What looks like a gain error
/// or a phase error along the radius moves them without the table.
fn the_parameters_are_not_biased() -> String {
    let mut rows =
        String::from("| parameters | speed | with the table | without |\n|---|---|---|---|\n");
    for parameters in [5, 9] {
        for (speed, name) in [(SLOW, "slow"), (FAST, "fast")] {
            let of = |known: Vec<Harmonic>, real: &[Harmonic]| {
                run(&spec(parameters, known), real, speed).theta
            };
            let pure = of(vec![], &[]);
            let off = |theta: [f64; 9]| {
                let differences = theta.iter().zip(pure).take(5).map(|(a, b)| (a - b).abs());
                differences.fold(0.0, f64::max)
            };
            let mended = off(of(third_and_fifth(), &third_and_fifth()));
            let plain = off(of(vec![], &third_and_fifth()));
            let _ = writeln!(
                rows,
                "| {parameters} | {name} | {mended:.1e} | {plain:.1e} |"
            );
            assert!(mended < 5e-4 && plain > 5e-3, "{mended}, {plain}");
        }
    }
    rows
}

/// What the chip reads from its table, at every phase, against the harmonics themselves: off by no more than interpolation
/// and the roundings of word, slope and result.
fn the_table_holds_at_every_phase() -> String {
    let mut page = String::from(
        "| design | orders | rows | bits of a row | phases, all tried | largest error | bound | order in tan β | left, periods rms | of |\n|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for variant in harmonics() {
        let design = variant.design();
        let (k, structure) = (design.constants.bits(), &design.structure);
        let known = structure.harmonics.as_ref().expect("a table");
        let list = &variant.spec.correction.harmonics;
        let bits = structure.formats.sine_phase.format.fraction;
        let half = |fraction: u32| 0.5f64.powi(fraction as i32 + 1);
        let columns = &known.table.columns;
        let reach = 0.5f64.powi(known.table.index_fraction as i32 + 1);
        let allowed = design.harmonics.expect("a table").interpolation_max * 1.001
            + half(columns[0].format.fraction)
            + half(columns[1].format.fraction) * reach
            + half(structure.formats.harmonic.format.fraction);
        let mut worst = 0.0f64;
        for phase in 0..1u64 << bits {
            let turns = Bits::from_raw(phase as i64, bits);
            let (c, s) = stored(turns, None, &k, (structure, known));
            let alpha = TAU * (phase as f64 + 0.5) / 2f64.powi(bits as i32);
            for (which, read) in [c, s].into_iter().enumerate() {
                let exact: f64 = list.iter().map(|h| h.at(which, alpha).0).sum();
                worst = worst.max((read.to_f64() - exact).abs());
            }
        }
        let found = design.harmonics.expect("a table");
        let orders: Vec<String> = list.iter().map(|h| h.order.to_string()).collect();
        // Nothing but the rounding of f64 is nothing.
        let left = match found.residual_rms_periods {
            left if left < 1e-12 => "0".to_owned(),
            left => format!("{left:.1e}"),
        };
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {worst:.1e} | {allowed:.1e} | {:?} | {} | {:.1e} |",
            variant.what,
            orders.join(", "),
            known.table.rows(),
            known.table.row_width(),
            1u64 << bits,
            found.order,
            left,
            found.uncorrected_rms_periods
        );
        assert!(worst <= allowed, "{}: {worst} of {allowed}", variant.what);
    }
    page
}

#[test]
fn what_the_page_says() {
    let how = "NONIUS_BLESS=1 cargo test -p nonius-model harmonics";
    let page = format!(
        "# Stored harmonics, measured\n\nWritten by `{how}`; do not edit.\n\n\
         ## The chip behind a sensor with third and fifth harmonics of free phase\n\n\
         designs/optical.toml, third order of 1.2 and 1.5 %, fifth of 0.6 and 0.4 %, β = 0.06 rad, gains off by 10 and 5 %, noise as\n\
         promised. Slow: the loop follows the harmonics. Fast: 98 300 periods a second, ten times the loop's bandwidth. Angle: how far\n\
         the chip is from the same chip behind the same sensor without harmonics, periods rms. e: the phase error, rad rms.\n\n{}\n\
         ## Its parameters\n\nLargest difference of θ1 … θ5 from those behind the sensor without harmonics.\n\n{}\n\
         ## The table\n\nWhat is read at each phase against the harmonics themselves, as a fraction of the amplitude; bound: half bits of value,\n\
         slope and result, and the parabola that the straight line leaves out. Left: by the series in tan β, at worst over what is\n\
         promised of phase and amplitude, of what the harmonics do to the angle.\n\n{}",
        the_angle_error_is_that_of_the_pure_sensor(),
        the_parameters_are_not_biased(),
        the_table_holds_at_every_phase()
    );
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/harmonics-measured.md");
    nonius_kept::near(Path::new(file), &page, |x| 0.05 * x.abs(), how);
}

/// The series in tan β against the square root and the paper's own way: at second order it is off by T⁴/8 of the sine's
/// harmonic.
#[test]
fn the_series_is_of_second_order() {
    let design = Design::new(&spec(9, third_and_fifth())).expect("a design");
    let (k, structure) = (design.constants.real(), &design.structure);
    let exact = from_spec::harmonics(&design.spec);
    for degrees in [1.0f64, 5.0, 20.0] {
        let tan = degrees.to_radians().tan();
        for i in 0..500 {
            let alpha = TAU * f64::from(i) / 500.0;
            let [h_c, h_s] = exact.at(alpha, alpha);
            let pair = (alpha.cos(), alpha.sin());
            let of = (structure, Order::Second);
            let (c, s) = correct(pair, (h_c, h_s), (1.0, tan), &k, of);
            let [c_exact, s_exact] = exact.removed([pair.0, pair.1], (alpha, alpha), tan);
            assert!((c - c_exact).abs() < 1e-15);
            let off = (s - s_exact).abs();
            assert!(off <= h_s.abs() * tan.powi(4) / 8.0 + 1e-15, "{off}");
        }
    }
}

/// How far the phase is followed is what its promise needs; each product has its reason; no harmonics are no change.
#[test]
fn what_is_built_follows_from_the_promise() {
    let order = |degrees: f64| {
        let mut spec = spec(5, third_and_fifth());
        spec.sensor.phase_error_max_deg = degrees;
        let design = Design::new(&spec).expect("a design");
        let known = design.harmonics.expect("a table");
        // Half of what arithmetic may add, or what one step of Newton's leaves of tan beta at the largest tolerance.
        let newton = degrees.to_radians().tan() * design.spec.sensor.amplitude_tolerance.powi(2);
        let largest: f64 = third_and_fifth().iter().map(|h| h.amplitude_cos).sum();
        let allowed = (design.budget.allowed / 2.0).max(1.1 * newton * largest / TAU);
        assert!(known.residual_rms_periods <= allowed);
        known.order
    };
    assert_eq!(order(0.001), Order::Zeroth);
    assert_eq!(order(0.5), Order::First);
    assert_eq!(order(5.0), Order::Second);
    let more = |parameters: u32| {
        let [with, without] = [third_and_fifth(), vec![]]
            .map(|list| Design::new(&spec(parameters, list)).expect("a design"));
        with.graph.products() - without.graph.products()
    };
    // Two to read the table; tan β is three, and two to use it.
    assert_eq!([0, 4, 5, 8, 9].map(more), [2, 2, 7, 2, 4]);
    let text = shipped::text("optical");
    let read = |text: &str| {
        let spec = Spec::from_toml(text, "optical.toml").expect("a design");
        Design::new(&spec).expect("a design")
    };
    let empty = format!("{text}\n[correction]\nharmonics = []\n");
    assert_eq!(read(&empty), read(&text));
}

/// What a promised sensor reaches: bends where they are calibrated, and harmonics, are in it beside tolerance and offset.
#[test]
fn a_promised_sensor_reaches_further_by_bends_and_harmonics() {
    let second = |phases: [f64; 2]| {
        vec![Harmonic {
            order: 2,
            amplitude_cos: 0.02,
            phase_cos: phases[0],
            amplitude_sin: 0.02,
            phase_sin: phases[1],
        }]
    };
    for (parameters, list, reach) in [
        (5, vec![], 1.25),
        (8, vec![], 1.15 * 1.05 + 0.1),
        // In phase with a channel's peak, and where that is some way off.
        (5, second([0.0, 0.0]), 1.15 * 1.02 + 0.1),
        (5, second([0.3, 1.1]), 1.2720),
        (9, second([0.0, 0.0]), 1.15 * 1.07 + 0.1),
    ] {
        let spec = spec(parameters, list);
        let found = spec.reach();
        assert!((found - reach).abs() < 1e-4, "{parameters}: {found}");
    }
}

/// As steep as is not refused, from rest at any place of the period, and moving: the loop locks.
#[test]
fn the_steepest_harmonics_lock() {
    let one = |order: u32, amplitude: f64, phase: f64| Harmonic {
        order,
        amplitude_cos: amplitude,
        phase_cos: phase,
        amplitude_sin: amplitude,
        phase_sin: phase + 1.3,
    };
    for order in [2, 3, 7, 16] {
        for place in 0..16 {
            let largest = (1..200).find_map(|n| {
                let list = vec![one(order, 0.2 * 0.97f64.powi(n), 0.7 * f64::from(place))];
                Design::new(&spec(5, list.clone())).ok().map(|_| list)
            });
            let list = largest.expect("small enough");
            let mut bench = Bench::new(&spec(5, list.clone()), 11);
            let speed = if place % 2 == 0 { 0.0 } else { 0.01 };
            for k in 0..20_000 {
                let alpha = TAU * (f64::from(place) / 16.0 + speed * f64::from(k));
                let [h_c, h_s] = [0, 1].map(|which| list[0].at(which, alpha).0);
                bench.step((alpha.cos() + h_c, alpha.sin() + h_s));
            }
            assert!(bench.chip.state.locked, "order {order}, place {place}");
            let truth = f64::from(place) / 16.0 + speed * 20_000.0;
            let error = bench.chip.position() - truth;
            let error = (error - error.round()).abs();
            assert!(error < 3e-3, "order {order}, place {place}: {error}");
        }
    }
}

fn pairs(probes: &Probes<Bits>) -> Vec<(&'static str, Option<Bits>)> {
    let names = Probes::<Bits>::VALUES.iter();
    names.map(|n| (*n, probes.value(n))).collect()
}

fn registers(chip: &Chip<Bits>) -> Vec<Option<Bits>> {
    let names = State::<Bits>::VALUES.iter();
    names.map(|n| chip.state.value(n)).collect()
}

/// A table of zeros changes no bit of any probe or register: nothing but the harmonics acts.
#[test]
fn a_table_of_zeros_is_no_correction() {
    let nothing = third_and_fifth().into_iter().map(|h| Harmonic {
        amplitude_cos: 0.0,
        amplitude_sin: 0.0,
        ..h
    });
    let nothing: Vec<Harmonic> = nothing.collect();
    for parameters in [0, 4, 5, 8, 9] {
        for order in [Order::Zeroth, Order::First, Order::Second] {
            let mut with = Design::new(&spec(parameters, nothing.clone())).expect("a design");
            with.structure.harmonics.as_mut().expect("a table").order = order;
            let mut without = with.clone();
            without.structure.harmonics = None;
            let [mut with, mut without] = [with, without].map(|d| Chip::bit_true(&d));
            for k in 0..6000 {
                let alpha = 0.0137 * TAU * f64::from(k);
                let code = |x: f64| (x * 1700.0).round() as i64;
                let codes = (code(alpha.cos()), code(0.9 * (alpha - BETA).sin()));
                let a = with.step_codes(codes.0, codes.1, false, true);
                let b = without.step_codes(codes.0, codes.1, false, true);
                assert_eq!(pairs(&a), pairs(&b), "sample {k}");
                assert_eq!(registers(&with), registers(&without), "sample {k}");
            }
            assert!(with.state.locked);
        }
    }
}
