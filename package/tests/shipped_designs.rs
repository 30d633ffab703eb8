//! The shipped designs reach what they ask for, simulated on the bit-true chip with everything that disturbs it.

use crate::shipped;
use nonius_model::design::Design;
use nonius_package::simulate;

/// Whatever a chip is built with, nothing is as wide as it is for no reason.
#[test]
fn every_format_has_a_reason() {
    for variant in shipped::variants::everything() {
        let nobody = nonius_package::signals(&variant.design())
            .into_iter()
            .filter(|signal| signal.why.is_empty())
            .map(|signal| format!("{} {}", signal.name, signal.format))
            .collect::<Vec<_>>();
        assert!(nobody.is_empty(), "{}: {nobody:?}", variant.what);
    }
}

#[test]
fn shipped_designs_reach_the_accuracy_they_ask_for() {
    for name in shipped::NAMES {
        let (design, spec) = (shipped::design(name), shipped::spec(name));
        let found = simulate(&design).accuracy;
        let asked = spec.accuracy.rms_periods;
        println!(
            "{name}: {:.2e} periods rms, {asked:.2e} asked",
            found.rms_periods
        );
        assert!(
            found.locked && found.rms_periods <= asked,
            "{name}: {found:?}"
        );
    }
}

/// The budget predicts what the bit-true chip reaches with everything that disturbs it, also with a calibration so fast
/// that its noise counts. It is on the safe side: noise spreads the ADC's steps, and the loop takes some of them out.
#[test]
fn the_budget_predicts_what_is_simulated() {
    for name in shipped::NAMES {
        let mut spec = shipped::spec(name);
        for gamma_last in [5, spec.calibration.gamma_last()] {
            spec.calibration.gamma_last = Some(gamma_last);
            let design = Design::new(&spec).expect("a shipped design");
            let (predicted, found) = (
                design.budget.total(),
                simulate(&design).accuracy.rms_periods,
            );
            println!("{name}: {predicted:.2e} predicted, {found:.2e} periods rms simulated");
            assert!(
                (0.75..1.1).contains(&(found / predicted)),
                "{name}, gamma_last {gamma_last}: {predicted:e} predicted, {found:e} simulated"
            );
        }
    }
}

/// A slow machine with a loop of type 1 is judged at speeds that it promises, without the lag that such a loop has.
#[test]
fn a_slow_machine_reaches_what_is_asked() {
    let mut spec = shipped::optical();
    spec.tracking.filter_type = 1;
    spec.tracking.bandwidth_hz = 2e3;
    spec.sensor.speed_max_periods_per_s = 200.0;
    let design = Design::new(&spec).expect("a design that works");
    let found = simulate(&design).accuracy;
    println!("{found:?}");
    assert!(
        found.locked && found.rms_periods <= spec.accuracy.rms_periods,
        "{found:?}"
    );
}
