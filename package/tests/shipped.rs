//! The shipped designs reach what they ask for, simulated on the bit-true chip with everything that disturbs it.

#[path = "../../designs/shipped.rs"]
mod shipped;

use nonius_model::design::Design;
use nonius_package::accuracy;

/// Formats that happen to be equal do not lend each other their reasons.
#[test]
fn every_format_has_its_own_reason() {
    for name in shipped::NAMES {
        let json = nonius_package::package(&shipped::design(name), 2)
            .expect("a package")
            .json;
        for (signal, reason) in [
            ("rate", "increments"),
            ("speed", "increments"),
            ("kick", "increments"),
            ("theta_1", "as it is multiplied"),
            ("theta_5", "as it is multiplied"),
            ("theta_5_deviation", "parameter: bounded"),
            ("theta_2_deviation", "parameter: bounded"),
            ("sin_value", "word of the sine table"),
            ("cos_slope", "word of the sine table"),
            ("alpha_hat", "phase: "),
            ("rho", "signals: "),
        ] {
            let found = json.formats.iter().find(|s| s.name == signal);
            let found = found.unwrap_or_else(|| panic!("{name}: no {signal}"));
            assert!(
                found.why.starts_with(reason) || found.why.contains(reason),
                "{name}, {signal}: {}",
                found.why
            );
        }
    }
}

#[test]
fn shipped_designs_reach_the_accuracy_they_ask_for() {
    for name in shipped::NAMES {
        let (design, spec) = (shipped::design(name), shipped::spec(name));
        let found = accuracy(&design);
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
        for gamma_last in [5, spec.calibration.gamma_last] {
            spec.calibration.gamma_last = gamma_last;
            let design = Design::new(&spec).expect("a shipped design");
            let (predicted, found) = (design.budget.total(), accuracy(&design).rms_periods);
            println!("{name}: {predicted:.2e} predicted, {found:.2e} periods rms simulated");
            assert!(
                (0.75..1.1).contains(&(found / predicted)),
                "{name}, gamma_last {gamma_last}: {predicted:e} predicted, {found:e} simulated"
            );
        }
    }
}
