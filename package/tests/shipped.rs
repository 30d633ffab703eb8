//! The shipped designs reach what they ask for, simulated on the bit-true chip with everything that disturbs it.

use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_package::accuracy;

#[test]
fn shipped_designs_reach_the_accuracy_they_ask_for() {
    for name in ["optical", "magnetic", "interferometer"] {
        let path = format!("{}/../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).expect("a shipped design");
        let spec = Spec::from_toml(&text, name).expect("a shipped design");
        let design = Design::new(&spec).expect("a shipped design");
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
