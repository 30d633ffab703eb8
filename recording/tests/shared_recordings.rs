//! The real recordings beside the workspace: read, estimated, surveyed.

use nonius_kept::recording;
use nonius_recording::{AdcSource, ErrorKind, FitMethod, Overrides, Recording, Survey};

fn read(check: &str, name: &str) -> Option<Recording> {
    let file = recording(check, name)?;
    Some(Recording::read(&file, &Overrides::default()).expect("a recording that can be read"))
}

#[track_caller]
fn assert_near(found: f64, expected: f64, relative: f64) {
    let near = (found / expected - 1.0).abs() < relative;
    assert!(near, "{found}, expected {expected} ± {relative}");
}

#[test]
fn rm44_has_a_12_bit_adc_and_turns_once() {
    for name in [
        "rm44_center",
        "rm44_static_x500um",
        "rm44_gap_z500um",
        "rm44_jumps",
    ] {
        let Some(recording) = read("12-bit ADC of the RM44", &format!("{name}.csv")) else {
            return;
        };
        let adc = recording.metadata.adc;
        assert_eq!((adc.cos.bits, adc.cos.source), (12, AdcSource::Estimated));
        // The channels were scaled apart before they were written.
        assert_near(adc.cos.lsb, 2.446_39e-4, 1e-5);
        assert_near(adc.sin.lsb, 1.0 / 4096.0, 1e-5);
        assert!(recording.notes[0].starts_with("the ADC was estimated from the codes: 12 bits"));
        assert_eq!(recording.metadata.sample_rate_hz, 1000.0);
        // Every cell is its code's value, to the digits of the text.
        for ((c, s), k) in recording.codes().zip(0..) {
            assert!(
                (adc.cos.value(c) - recording.cos[k]).abs() < 2e-6,
                "{name} row {k}"
            );
            assert!(
                (adc.sin.value(s) - recording.sin[k]).abs() < 2e-6,
                "{name} row {k}"
            );
        }
        let survey = Survey::of(&recording);
        assert_eq!(survey.fit.method, FitMethod::Conic);
        assert!(survey.fit.residual_rms < 0.005);
        // The reference turns the other way.
        let reference = recording.reference_rad.expect("a reference");
        let turned = (reference[999] - reference[0]) / std::f64::consts::TAU;
        assert_near(survey.motion.periods_net, -turned, 1e-3);
        assert_near(survey.motion.max_speed_periods_per_s, 1.0, 0.1);
        assert_eq!(survey.notes, [""; 0]);
    }
}

#[test]
fn rm44_shifted_sideways_has_its_gain_ratio() {
    let Some(recording) = read("gain ratio of the RM44", "rm44_static_x500um.csv") else {
        return;
    };
    let ellipse = Survey::of(&recording).fit.ellipse;
    assert_near(ellipse.a_c / ellipse.a_s, 0.915, 1e-3);
}

#[test]
fn the_homodyne_recordings_have_an_8_bit_oscilloscope() {
    for (name, rate, speed) in [("settle", 2e5, 28.4e3), ("stop", 2e6, 131e3)] {
        let Some(recording) = read("homodyne interferometer", &format!("homodyne_{name}.csv"))
        else {
            return;
        };
        let adc = recording.metadata.adc;
        assert_eq!(adc.cos.bits, 8);
        assert_eq!(adc.cos, adc.sin);
        assert_near(adc.cos.lsb, 0.039_525, 1e-4);
        assert_eq!(recording.metadata.sample_rate_hz, rate);
        let survey = Survey::of(&recording);
        assert_near(survey.motion.max_speed_periods_per_s, speed, 0.01);
        assert!(survey.motion.max_step_periods < 0.2);
        assert!(
            (0.03..0.04).contains(&survey.fit.residual_rms),
            "one LSB is 3.9 %"
        );
        assert_near(survey.fit.ellipse.beta.to_degrees(), 6.2, 0.1);
    }
}

#[test]
fn the_three_photodiode_interferometers_show_no_codes() {
    for (name, gain_ratio, beta) in [("fs", 1.022, 4.6), ("mmi", 1.67, -29.0)] {
        let Some(recording) = read("3x3 interferometer", &format!("interf3x3_{name}.csv")) else {
            return;
        };
        let adc = recording.metadata.adc.cos;
        assert_eq!((adc.bits, adc.source), (16, AdcSource::Assumed));
        assert!(recording.notes[0].starts_with("the values show no codes; the ADC was assumed"));
        assert_eq!(
            recording.other("pd2_V").expect("the column").len(),
            recording.samples()
        );
        let ellipse = Survey::of(&recording).fit.ellipse;
        assert_near(ellipse.a_c / ellipse.a_s, gain_ratio, 0.01);
        assert_near(ellipse.beta.to_degrees(), beta, 0.05);
    }
}

#[test]
fn the_wheel_magnetometer_turns_with_its_gyroscope() {
    let Some(recording) = read("wheel magnetometer", "wheel_magnetometer.csv") else {
        return;
    };
    assert_near(recording.metadata.adc.cos.lsb, 1.0 / 2048.0, 1e-6);
    let reference = recording.reference_rad.as_ref().expect("a reference");
    let turned = (reference.last().expect("a sample") - reference[0]) / std::f64::consts::TAU;
    assert_near(Survey::of(&recording).motion.periods_net, -turned, 0.01);
}

#[test]
fn the_optical_tables_are_refused_whole_and_read_one_by_one() {
    let Some(file) = recording("optical tables", "optical_servo_tables.csv") else {
        return;
    };
    let error = Recording::read(&file, &Overrides::default()).expect_err("several records in one");
    assert!(matches!(*error.kind, ErrorKind::TimeBack { .. }), "{error}");
    assert_eq!((error.place.line, error.place.column), (Some(514), Some(1)));
    let text = error.to_string();
    assert!(
        text.contains("several records, as the column 'unit' changes"),
        "{text}"
    );

    let whole = std::fs::read_to_string(file).expect("a file of text");
    let units = nonius_kept::units(&whole);
    assert_eq!(units.len(), 16);
    for (unit, one) in units.iter().enumerate() {
        let recording = Recording::read_from(one.as_bytes(), "one unit", &Overrides::default())
            .expect("a recording that can be read");
        assert_eq!(recording.samples(), 512);
        let adc = recording.metadata.adc.cos;
        assert_eq!(
            (adc.bits, adc.lsb, adc.centre),
            (12, 1.0, 2048.0),
            "unit {unit}"
        );
        let survey = Survey::of(&recording);
        let travelled = survey.motion.periods_travelled;
        assert!((0.9..1.4).contains(&travelled), "unit {unit}: {travelled}");
    }
}
