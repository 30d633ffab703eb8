//! Every search at exactly 4, 8 and 64 samples a period.

use crate::chip_support::loss::sensor_for;
use crate::chip_support::{Bench, rms};
use crate::on_line_speeds::{for_long, travel};
use crate::support::shipped::variants::{Variant, searches_of};
use nonius_kept::{every, figure_of_short};
use nonius_model::spec::{CalibrationMethod, Spec};
use rayon::prelude::*;

const TEST: &str = "model/tests/on_line_commensurate.rs";

/// What is left of the miscalibration, mrad rms: from new, a little beside that speed, and at it again.
fn left(spec: &Spec, per_period: u32, signs: u32, place: f64) -> [f64; 3] {
    let signals = sensor_for(spec, signs);
    let mut bench = Bench::new(spec, 3);
    let mut turns = place;
    let mut run = |periods: u32, step: f64| {
        travel(
            &mut bench,
            &signals,
            &mut turns,
            (periods * per_period, step),
        );
        1e3 * rms(&bench.miscalibration(&signals))
    };
    let exactly = 1.0 / f64::from(per_period);
    // Where a period has few samples, each tells little.
    let periods = if per_period < 64 { 6000 } else { 1000 };
    [
        run(periods, exactly),
        run(periods, exactly * 0.997),
        run(periods, exactly),
    ]
}

/// At exactly 8 and 64 samples a period every search of every set finds its parameters from new, and keeps them, but for bends where cos 4α is 0
/// at all eight places (`on_line_speeds.rs`). At exactly four the
/// exact gradient does; the others, which learn from the radius, see too little of it there from new, but keep what a speed a little beside has
/// shown them. Every fifth of the signs, each at another place of the period; in the long form all of both.
#[test]
fn every_search_at_commensurate_speeds() {
    for per_period in [4, 8, 64] {
        let worst = |spec: &Spec| {
            let places = [0.013, 0.1, 0.125, 0.0];
            let all = (0..16).flat_map(|signs| {
                // Each of the signs at another place first.
                let from = signs as usize;
                (0..4).map(move |i| (signs, places[(from + i) % 4]))
            });
            every(20, all)
                .map(|(signs, place)| left(spec, per_period, signs, place))
                .fold([0.0f64; 3], |worst, now| {
                    [0, 1, 2].map(|i| worst[i].max(now[i]))
                })
        };
        let rows: Vec<(Variant, [f64; 3])> = searches_of(&for_long())
            .into_par_iter()
            .map(|variant| {
                let left = worst(&variant.spec);
                (variant, left)
            })
            .collect();
        let mut groups = [[0.0f64; 3]; 4];
        for (variant, left) in &rows {
            let k = &variant.spec.calibration;
            println!(
                "{per_period} samples a period, {}, {} parameters: {left:.2?} mrad rms",
                variant.what, k.parameters
            );
            let exact = k.method == CalibrationMethod::Exact;
            let group = match (exact, k.has_bend(), k.squares()) {
                (true, ..) => 0,
                (_, false, _) => 1,
                (_, true, false) => 2,
                (_, true, true) => 3,
            };
            for (worst, now) in groups[group].iter_mut().zip(left) {
                *worst = worst.max(*now);
            }
        }
        println!("{per_period} samples a period: {groups:.2?}");
        let all = |limit: f64, of: &[[f64; 3]]| {
            assert!(of.iter().flatten().all(|left| *left < limit), "{of:?}");
        };
        if per_period == 4 {
            let [exact, linear, bent, squares] = groups;
            all(0.2, &[exact]);
            assert!(linear[1] < 0.3 && linear[2] < 0.6, "{linear:?}");
            assert!(bent[1] < 0.4 && bent[2] < 0.4, "{bent:?}");
            // What four places have taught bends by squares, which is wrong, they unlearn slowly.
            assert!(squares[1] < 60.0 && squares[2] < 60.0, "{squares:?}");
        } else {
            all(0.3, &groups);
        }
        let row = |group: [f64; 3]| group.map(|mrad| format!("{mrad:.2}")).join(", ");
        figure_of_short(
            &format!(
                "exactly {per_period} samples a period, every fifth of the signs: miscalibration left from new, a little beside that speed, and at it again, mrad rms; exact gradient; final form, sum of squares and batch with four and five parameters; final form with eight and nine; sum of squares and batch with eight and nine"
            ),
            &groups.map(row).join("; "),
            TEST,
        );
    }
}
