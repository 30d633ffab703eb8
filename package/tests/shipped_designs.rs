//! The shipped designs reach what they ask for, simulated on the bit-true chip with everything that disturbs it.

use crate::shipped;
use nonius_model::design::Design;
use nonius_package::{simulate, simulate_weakest};

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
        let weakest = simulate_weakest(&design);
        assert!(
            weakest.locked && weakest.rms_periods <= asked,
            "{name}: {weakest:?}"
        );
        // Noise and steps of the ADC are most of it, and the signals are weaker by what is promised.
        let weaker = weakest.rms_periods / found.rms_periods;
        let of_signals = 1.0 / (1.0 - spec.sensor.amplitude_tolerance);
        assert!((weaker / of_signals - 1.0).abs() < 0.05, "{name}: {weaker}");
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
