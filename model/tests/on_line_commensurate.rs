//! Every search at exactly 4 to 8 and 64 samples a period.

use crate::chip_support::loss::sensor_for;
use crate::chip_support::{Bench, larger, rms, sensor_of};
use crate::on_line_speeds::{for_long, travel};
use crate::support::shipped::variants::{Variant, searches_of};
use nonius_kept::{every, figure_of_short, long};
use nonius_model::kernel::waits::applied;
use nonius_model::spec::{CalibrationMethod, Spec};
use rayon::prelude::*;

const TEST: &str = "model/tests/on_line_commensurate.rs";

/// What is left of the miscalibration, mrad rms: from new, a little beside that speed (of bends: or where they begin to learn, a little
/// beside eight samples a period), and at it again.
fn left(
    spec: &Spec,
    per_period: f64,
    signals: &impl Fn(f64) -> (f64, f64),
    place: f64,
) -> [f64; 3] {
    let mut bench = Bench::new(spec, 3);
    let left = |bench: &Bench| 1e3 * rms(&bench.miscalibration(signals));
    let first = left(&bench);
    let mut turns = place;
    let mut run = |periods: u32, step: f64| {
        travel(
            &mut bench,
            signals,
            &mut turns,
            ((f64::from(periods) * per_period) as u32, step),
        );
        let [.., theta_6, theta_7, theta_8, theta_9] = applied(&bench.chip.state);
        let bends = [theta_6, theta_7, theta_8, theta_9];
        (left(&bench), bends.map(|bend| bend.to_f64()))
    };
    let exactly = 1.0 / per_period;
    let beside = if spec.calibration.has_bend() {
        exactly.min(0.125)
    } else {
        exactly
    };
    // Where a period has few samples, each tells little; at four half of them tell of the radius, half of the angle.
    let periods = match per_period {
        ..5.0 => 12_000,
        ..64.0 => 6000,
        _ => 1000,
    };
    let (new, bends) = run(periods, exactly);
    // However much the speed seems to change with the angle of a sensor that is not yet calibrated.
    assert!(per_period > 6.0 || bends == [0.0; 4], "{bends:?}");
    let now = [new, run(periods, 0.997 * beside).0, run(periods, exactly).0];
    assert!(
        now[0] < first,
        "{per_period} samples a period from {place}: {first} mrad, then {now:?}"
    );
    now
}

/// What every search leaves at exactly so many samples a period, the worst of these signs and places: by the exact gradient; by others with four
/// and five parameters; with eight and nine by the final form; and by squares.
fn by_every_search(per_period: u32, cases: &[(u32, f64)]) -> [[f64; 3]; 4] {
    let rows: Vec<(Variant, [f64; 3])> = searches_of(&for_long())
        .into_par_iter()
        .map(|variant| {
            let spec = &variant.spec;
            let each = cases.iter().map(|&(signs, place)| {
                left(spec, f64::from(per_period), &sensor_for(spec, signs), place)
            });
            let left = each.fold([0.0; 3], larger);
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
        groups[group] = larger(groups[group], *left);
    }
    println!("{per_period} samples a period: {groups:.2?}");
    groups
}

fn all_below(limit: f64, of: &[[f64; 3]]) {
    assert!(of.iter().flatten().all(|left| *left < limit), "{of:?}");
}

fn keep(speed: &str, groups: [[f64; 3]; 4]) {
    let row = |group: [f64; 3]| group.map(|mrad| format!("{mrad:.2}")).join(", ");
    figure_of_short(
        &format!(
            "{speed}: miscalibration left from new, a little beside that speed, and at it again, mrad rms; exact gradient; final form, sum of squares and batch with four and five parameters; final form with eight and nine; sum of squares and batch with eight and nine"
        ),
        &groups.map(row).join("; "),
        TEST,
    );
}

/// At exactly 8 and 64 samples a period every search of every set finds its parameters from new, and keeps them; at 4 to 7 those of the
/// ellipse, which is all that these sensors have, as bends rest there. Every fifth of the signs, each at another place of the period; in the
/// long form all of both, and 6 and 7 samples too.
#[test]
fn every_search_at_commensurate_speeds() {
    let places = [0.013, 0.1, 0.125, 0.0];
    let all = (0..16).flat_map(|signs| {
        // Each of the signs at another place first.
        let from = signs as usize;
        (0..4).map(move |i| (signs, places[(from + i) % 4]))
    });
    let cases: Vec<(u32, f64)> = every(20, all).collect();
    let between: &[u32] = if long() { &[6, 7] } else { &[] };
    for &per_period in [4, 5, 8, 64].iter().chain(between) {
        let groups = by_every_search(per_period, &cases);
        // From four to seven bends rest with the noise that they came with.
        all_below(if per_period < 8 { 0.45 } else { 0.3 }, &groups);
        keep(
            &format!("exactly {per_period} samples a period, every fifth of the signs"),
            groups,
        );
    }
}

/// Where eight samples a period begin a sixteenth of a period from the cosine's top, cos 4α is 0 at all of them: the bend that no radius
/// shows there is found from the phase error. Every fifth of the signs; in the long form all.
#[test]
fn every_search_where_no_place_shows_cos_4_alpha() {
    let cases: Vec<(u32, f64)> = every(5, (0..16).map(|signs| (signs, 1.0 / 16.0))).collect();
    let groups = by_every_search(8, &cases);
    all_below(0.3, &groups);
    keep(
        "exactly 8 samples a period, the first a sixteenth of a period from the cosine's top, every fifth of the signs",
        groups,
    );
}

/// Bends that the radius shows, 2 % of second and of third order, at so few samples that it cannot tell them: they rest, nothing is further off
/// than it was, and the first slower speed shows them.
#[test]
fn bends_rest_where_a_period_has_seven_samples_or_fewer() {
    let bent = |signs: u32, beta: f64| {
        let sensor = sensor_of(signs, beta);
        move |alpha: f64| {
            let (c, s) = sensor(alpha);
            let bend = |u: f64| u + 0.02 * u * u + 0.02 * u.powi(3);
            (bend(c), bend(s))
        }
    };
    /// Samples per period, those last at which bends rest at some places of the period until the ellipse is found.
    const SPEEDS: [f64; 7] = [4.0, 5.0, 6.0, 7.0, 7.3, 7.5, 7.7];
    let bends = searches_of(&for_long()).into_iter();
    let worst = bends
        .filter(|variant| variant.spec.calibration.has_bend())
        .flat_map(|variant| SPEEDS.map(|per_period| (variant.clone(), per_period)))
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|(variant, per_period)| {
            let k = &variant.spec.calibration;
            let beta = if k.has_phase() { 5.0 } else { 0.0 };
            let all = (0..16).map(|signs| (signs, 0.013 + 0.37 * f64::from(signs)));
            let worst = every(8, all)
                .map(|(signs, place)| left(&variant.spec, per_period, &bent(signs, beta), place))
                .fold([0.0; 3], larger);
            println!(
                "{per_period} samples a period, {}, {} parameters: {worst:.2?} mrad rms",
                variant.what, k.parameters
            );
            (per_period, worst)
        })
        .collect::<Vec<_>>();
    let worst_of = |speeds: std::ops::RangeInclusive<f64>| {
        let all = worst.iter().filter(|(n, _)| speeds.contains(n));
        all.fold([0.0; 3], |a, (_, b)| larger(a, *b))
    };
    let [four, few, between] = [4.0..=4.0, 5.0..=7.0, 7.1..=7.9].map(worst_of);
    println!("{four:.2?} {few:.2?} {between:.2?}");
    // What second and third order leave of these bends is 0.8 to 1.7; exactly five samples a period show what they leave at fourth
    // and sixth order as first, and it moves the ellipse.
    for ([_, beside, again], limit) in [(four, 2.0), (few, 2.3), (between, 2.0)] {
        assert!(beside < 2.0 && again < limit, "{worst:?}");
    }
    figure_of_short(
        "exactly 4, exactly 5 to 7, and 7.3 to 7.7 samples a period, eight and nine parameters, bends of 2 % of second and third order, every eighth of the signs: miscalibration left from new, a little beside eight samples a period, and at it again, mrad rms",
        &[four, few, between]
            .map(|of| of.map(|mrad| format!("{mrad:.2}")).join(", "))
            .join("; "),
        TEST,
    );
}
