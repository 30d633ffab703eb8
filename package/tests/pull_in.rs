//! From power-up into motion, with every sensor that a design promises at its worst.

use crate::shipped;
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_package::{BOTH_WAYS, DesignJson, PullIn, package, pull_in};

fn pulled_in(spec: &Spec, parts: &[f64]) -> PullIn {
    pull_in(&Design::new(spec).expect("a design that works"), parts)
}

#[test]
fn every_promised_sensor_locks_at_any_speed() {
    for name in shipped::NAMES {
        let found = pulled_in(&shipped::spec(name), &[-1.0, -0.5, 0.0, 0.02, 0.9, 1.0]);
        println!("{name}: {found:?}");
        assert!(found.holds(), "{name}: {found:?}");
        assert_eq!((found.sensors, found.starts_each), (32, 24), "{name}");
        assert!(found.longest_samples > 0 && found.worst.is_none());
    }
}

/// Whatever a chip calibrates with; with 8 and 9 parameters the bends are promised too.
#[test]
fn every_kind_of_chip_locks() {
    for kind in shipped::variants::kinds() {
        let found = pulled_in(&kind.spec, &BOTH_WAYS);
        assert!(found.holds(), "{}: {found:?}", kind.what);
        let bends = kind.spec.calibration.has_bend();
        assert_eq!(found.sensors, if bends { 128 } else { 32 }, "{}", kind.what);
    }
}

/// A loop of type 1 has no wider gear to begin in: with its pole this near to 1 four samples a period are out of its reach,
/// whatever the sensor promises.
#[test]
fn a_speed_out_of_reach_is_told() {
    let mut spec = shipped::optical();
    spec.tracking.filter_type = 1;
    spec.tracking.pole = Some(0.9995);
    spec.sensor.speed_max_periods_per_s = 250e3;
    let found = pulled_in(&spec, &BOTH_WAYS);
    assert!(!found.holds() && found.remedies.len() == 1, "{found:?}");
    assert!(found.remedies[0].starts_with("sensor.speed_max_periods_per_s = "));
}

/// Offsets that the loop cannot follow at top speed and that its window cannot hold.
fn too_much_offset() -> Spec {
    let mut spec = shipped::optical();
    spec.sensor.amplitude = 0.6;
    spec.sensor.offset_max = 0.4;
    spec
}

#[test]
fn a_promise_that_does_not_lock_is_told_with_its_worst_sensor_and_what_helps() {
    let spec = too_much_offset();
    let found = pulled_in(&spec, &BOTH_WAYS);
    let worst = found.worst.as_ref().expect("a sensor that does not lock");
    println!("{found:?}");
    assert!(!found.holds() && (1..=found.starts_each).contains(&worst.starts));
    assert!(worst.offsets.iter().all(|b| b.abs() == 0.4));
    let speed = worst.speed_periods_per_s.abs();
    assert_eq!(speed, spec.sensor.speed_max_periods_per_s);
    // What it advises holds when it is done.
    assert!(!found.remedies.is_empty());
    for remedy in &found.remedies {
        let mut mended = spec.clone();
        let s = &mut mended.sensor;
        for one in remedy.replace(" and ", ", ").split(", ") {
            let (field, value) = one.split_once(" = ").expect("field = value");
            let value = value.parse().expect("a number");
            match field {
                "sensor.amplitude_tolerance" => s.amplitude_tolerance = value,
                "sensor.offset_max" => s.offset_max = value,
                "sensor.phase_error_max_deg" => s.phase_error_max_deg = value,
                "sensor.speed_max_periods_per_s" => s.speed_max_periods_per_s = value,
                other => panic!("{other}"),
            }
        }
        assert!(pulled_in(&mended, &BOTH_WAYS).holds(), "{remedy}");
    }
}

#[test]
fn the_package_says_so() {
    let told = |spec: &Spec| {
        let design = Design::new(spec).expect("a design that works");
        let package = package(&design, 10).expect("a package");
        let file = |name: &str| {
            let found = package.files.iter().find(|(path, _)| path == name);
            String::from_utf8_lossy(&found.expect("a file").1).into_owned()
        };
        let json: serde_json::Value = serde_json::from_str(&file("design.json")).expect("JSON");
        let holds = DesignJson::holds(&package.json);
        (holds, json["pull_in"].clone(), file("report.html"))
    };
    let (holds, json, page) = told(&shipped::optical());
    assert!(holds && json["not_locked"] == 0 && json["worst"].is_null());
    assert!(page.contains("locked within") && !page.contains("class=\"fact missed\""));
    let (holds, json, page) = told(&too_much_offset());
    let sensors = json["not_locked"].as_u64().expect("a number");
    assert!(!holds && sensors > 0 && json["remedies"][0].is_string());
    assert!(page.contains(&format!("{sensors} of 32 sensors do not lock")));
    assert!(page.contains("class=\"fact missed\""));
}

/// Whoever waits hears of every start.
#[test]
fn every_start_is_heard_of() {
    use std::sync::Mutex;
    let heard = Mutex::new(vec![]);
    let design = Design::new(&shipped::optical()).expect("a shipped design");
    let found = nonius_package::pull_in_followed(&design, &BOTH_WAYS, &|event| {
        heard.lock().expect("no panic").push(event);
    });
    let heard = heard.into_inner().expect("no panic");
    let starts = (found.sensors * found.starts_each) as usize;
    assert_eq!(heard[0], nonius_package::Event::Starting { starts });
    let started = heard
        .iter()
        .filter(|e| **e == nonius_package::Event::Started);
    assert_eq!((started.count(), heard.len()), (starts, starts + 1));
}
