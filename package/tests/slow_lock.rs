//! Sensors at the ends of a wide promise, in slow motion.

use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_package::SlowLock;

const WIDE: &str = r#"
name = "wide"

[sensor]
amplitude = 0.5
amplitude_tolerance = 0.2
offset_max = 0.2
phase_error_max_deg = 10.0
noise_rms = 0.001
speed_max_periods_per_s = 100000.0
bend_max = 0.1

[adc]
bits = 12
full_scale = 1.0
sample_rate_hz = 1000000.0

[loop]
method = 3
type = 2
bandwidth_hz = 10000.0

[calibration]
parameters = 9

[accuracy]
rms_periods = 0.0002
"#;

fn learned(text: &str) -> Option<SlowLock> {
    let spec = Spec::from_toml(text, "wide.toml").expect("a design file");
    SlowLock::of(&Design::new(&spec).expect("a design that works"))
}

/// The signals are so far off that each period leaves the lock window before it has taught anything.
#[test]
fn a_sensor_that_is_never_learned_is_told() {
    let found = learned(WIDE).expect("bends are calibrated");
    assert!(
        found.not_learned > 0 && found.least_squares_helps,
        "{found:?}"
    );
    let missed = found.missed().expect("a sentence");
    assert!(missed.contains("least_squares"), "{missed}");
    let narrower = WIDE.replace("bend_max = 0.1", "bend_max = 0.05");
    let less = [
        WIDE.replace(
            "parameters = 9",
            "parameters = 9\nstart = \"least_squares\"",
        ),
        narrower.replace("offset_max = 0.2", "offset_max = 0.15"),
    ];
    for text in less {
        let found = learned(&text).expect("bends are calibrated");
        assert!(found.not_learned == 0 && found.missed().is_none(), "{text}");
    }
    let five = WIDE.replace("parameters = 9", "parameters = 5");
    assert!(learned(&five.replace("bend_max = 0.1", "")).is_none());
}
