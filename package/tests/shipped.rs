//! The shipped designs reach what they ask for, simulated on the bit-true chip with everything that disturbs it.

use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_package::accuracy;

fn shipped(name: &str) -> (Design, Spec) {
    let path = format!("{}/../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped design");
    let spec = Spec::from_toml(&text, name).expect("a shipped design");
    (Design::new(&spec).expect("a shipped design"), spec)
}

#[test]
fn shipped_designs_reach_the_accuracy_they_ask_for() {
    for name in ["optical", "magnetic", "interferometer"] {
        let (design, spec) = shipped(name);
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
    for name in ["optical", "magnetic", "interferometer"] {
        let (_, mut spec) = shipped(name);
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
