//! What the diagnosis writes, the sensor reads, and what the sensor shows, the diagnosis finds: name, numbers, signs and
//! phases. The two are written apart.
#![allow(clippy::unwrap_used)]

use nonius_diagnosis::{diagnose, sensor_toml};
use nonius_recording::{Overrides, Recording};
use nonius_sensor::{Motion, Sensor};

const PLAIN: &str = "
[signals]
a_c = 0.8
b_c = 0.03
a_s = 0.75
b_s = -0.02
beta = 0.04
noise_rms = 0.001
[adc]
bits = 14
lsb = 0.0001220703125
centre = 0.0
sample_rate_hz = 10000.0
[motion]
periods_travelled = 900.0
speed_max_periods_per_s = 700.0
periods_per_revolution = 16
";

fn recorded(sensor: &Sensor, seed: u64) -> Recording {
    let samples = sensor.simulate(&Motion::to_and_fro(sensor), seed);
    let overrides = Overrides {
        adc_bits: Some(sensor.adc.bits),
        full_scale: Some(sensor.adc.lsb * 2f64.powi(sensor.adc.bits as i32 - 1)),
        periods_per_revolution: sensor.motion.periods_per_revolution,
        ..Overrides::default()
    };
    Recording::from_samples(samples.time_s, samples.cos, samples.sin, &overrides).unwrap()
}

/// The cause alone is found, its numbers are those that were written, and so it is when what was found is simulated.
fn round_trip(cause: &str) {
    let mut text = format!("{PLAIN}[[cause]]\n{cause}");
    for round in 0..2 {
        let sensor = Sensor::from_toml(&text, "sensor.toml").unwrap();
        let recording = recorded(&sensor, 5 + round);
        let found = diagnose(&recording).unwrap();
        let names: Vec<&str> = found.findings.iter().map(|f| f.cause.as_str()).collect();
        let expected: toml::Table = cause.parse().unwrap();
        let name = expected["name"].as_str().unwrap();
        assert_eq!(names, [name], "{}", found.unexplained.signature);
        for p in &found.findings[0].parameters {
            let truth = expected
                .get(&p.name)
                .and_then(|v| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)));
            let Some(truth) = truth else { continue };
            let mut off = p.value - truth;
            if p.unit == "rad" && p.name.starts_with("phase") {
                off -= std::f64::consts::TAU * (off / std::f64::consts::TAU).round();
            }
            // The phase of a line at the first sample hangs on its frequency, over half the recording.
            let line = name == "interference" || name == "amplitude_ripple";
            let slack = if line && p.unit == "rad" { 0.1 } else { 0.0 };
            let limit = 6.0 * p.std_error + 0.02 * truth.abs() + slack;
            assert!(
                off.abs() <= limit,
                "{name} {}: {} is not {truth}",
                p.name,
                p.value
            );
        }
        text = sensor_toml(&found, &recording);
    }
}

#[test]
fn static_causes() {
    round_trip("name = \"even_nonlinearity\"\nk_cos = 0.006\nk_sin = -0.004\n");
    round_trip("name = \"odd_nonlinearity\"\nk_cos = 0.01\nk_sin = 0.004\n");
    round_trip(
        "name = \"spatial_harmonic\"\norder = 3.0\namplitude_cos = 0.004\nphase_cos = 0.7\namplitude_sin = 0.003\nphase_sin = -2.0\n",
    );
}

#[test]
fn causes_with_speed() {
    round_trip("name = \"channel_skew\"\ndelay_s = 4e-7\n");
    round_trip("name = \"common_bandwidth\"\ntau_s = 2e-5\n");
    round_trip("name = \"hysteresis\"\noffset_cos = 0.004\noffset_sin = -0.003\n");
}

#[test]
fn causes_with_time() {
    round_trip(
        "name = \"interference\"\nfrequency_hz = 311.3\namplitude_cos = 0.003\nphase_cos = 0.4\namplitude_sin = 0.004\nphase_sin = 1.9\n",
    );
    round_trip("name = \"amplitude_ripple\"\nfrequency_hz = 100.2\ndepth = 0.004\nphase = 1.1\n");
    round_trip("name = \"offset_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\n");
}

#[test]
fn causes_with_the_revolution() {
    round_trip("name = \"runout\"\norder = 2\ndepth = 0.005\nphase = -0.9\n");
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let refused = |text: &str, words: &[&str]| {
        let said = Sensor::from_toml(text, "s.toml").unwrap_err().to_string();
        for word in words {
            assert!(said.contains(word), "{word} is not in: {said}");
        }
    };
    refused("[signals", &["s.toml:1"]);
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"gremlins\"\n"),
        &["s.toml:1", "gremlins", "spatial_harmonic"],
    );
    refused(
        &PLAIN.replace("a_c = 0.8", "a_c = -1.0"),
        &["signals.a_c", "-1"],
    );
    refused(&PLAIN.replace("bits = 14", "bits = 77"), &["adc.bits"]);
    refused(
        &PLAIN.replace("beta = 0.04", "beta = nan"),
        &["signals.beta"],
    );
    refused(&PLAIN.replace("lsb", "lbs"), &["lbs", "lsb"]);
}
