//! What the diagnosis writes, the sensor reads, and what the sensor shows, the diagnosis finds: name, numbers, signs and
//! phases. The two are written apart.

mod support;

use nonius_diagnosis::{OTHER_ORDER, Parameter, diagnose, sensor_toml};
use nonius_sensor::{Motion, Sensor};
use support::{PLAIN, recording};

/// Causes of the catalogue beyond the five parameters.
const CATALOGUE: [&str; 29] = [
    "even_nonlinearity",
    "odd_nonlinearity",
    "spatial_harmonic",
    "saturation",
    "adc_nonlinearity",
    "stuck_bit",
    "coarse_quantisation",
    "channel_skew",
    "bandwidth_mismatch",
    "common_bandwidth",
    "latency",
    "ac_coupling",
    "interference",
    "amplitude_ripple",
    "offset_drift",
    "gain_drift",
    "runout",
    "graduation_error",
    "contamination",
    "glitches",
    "dropped_samples",
    "repeated_samples",
    "clock_jitter",
    "flicker_noise",
    "amplitude_noise",
    "hysteresis",
    "delayed_crosstalk",
    "vibration",
    "cogging",
];

/// What no finding tells: which of two codes stays, and the share of samples that are lost or doubled, of which it tells the number.
const UNTOLD: [&str; 3] = ["level", "remainder_lsb", "share"];

/// The cause alone is found, its numbers are those that were written, and so it is when what was found is simulated.
fn round_trip(cause: &str) {
    round_trip_beside(cause, false);
}

/// The same, beside a reference that shows the motion as it is or not.
fn round_trip_beside(cause: &str, reference: bool) {
    let mut text = format!("{PLAIN}[[cause]]\n{cause}");
    for round in 0..2 {
        let sensor = Sensor::from_toml(&text, "sensor.toml").expect("a sensor");
        let motion = Motion::to_and_fro(&sensor);
        let mut recording = recording(&sensor, sensor.simulate(&motion, 5 + round));
        recording.reference_rad = reference.then_some(motion.alpha);
        let found = diagnose(&recording).expect("an ellipse");
        let names: Vec<String> = found.findings.iter().map(|f| f.cause.to_string()).collect();
        let expected: toml::Table = cause.parse().expect("TOML");
        let name = expected["name"].as_str().expect("a name");
        assert_eq!(names, [name], "{}", found.unexplained.signature);
        // A drift could be a polynomial, which has neither.
        for key in ["tau_s", "start_s"] {
            let known = found.findings[0].parameter(key).is_some();
            assert_eq!(known, expected.contains_key(key), "{name}: {key}");
        }
        for (key, truth) in &expected {
            let truth = truth.as_float().or(truth.as_integer().map(|i| i as f64));
            let Some(truth) = truth.filter(|_| !UNTOLD.contains(&key.as_str())) else {
                continue;
            };
            let told = found.findings[0].parameters.iter();
            let Some(p) = told.clone().find(|p| p.name == *key) else {
                panic!("{name}: {key} is not told, but {told:?}");
            };
            let mut off = p.value - truth;
            if p.unit == "rad" && p.name.starts_with("phase") {
                off -= std::f64::consts::TAU * (off / std::f64::consts::TAU).round();
            }
            // The phase of a line at the first sample hangs on its frequency, over half the recording.
            let line = name == "interference" || name == "amplitude_ripple";
            let slack = match p.name.as_str() {
                _ if line && p.unit == "rad" => 0.1,
                // Off the curve through its neighbours, which bends less than the signal, and by noise.
                "largest" => 0.05 * truth,
                _ => 0.0,
            };
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
    round_trip("name = \"saturation\"\nthreshold = 0.8\ncompression = 0.05\n");
    round_trip(
        "name = \"saturation\"\nthreshold = 0.8\ncompression = 0.05\ncompression_lower = 0.0\n",
    );
    round_trip(
        "name = \"spatial_harmonic\"\norder = 3.0\namplitude_cos = 0.004\nphase_cos = 0.7\namplitude_sin = 0.003\nphase_sin = -2.0\n",
    );
}

/// Of a harmonic whose order is not sure, the one that was named is simulated.
#[test]
fn an_order_that_may_be_another() {
    let third = "name = \"spatial_harmonic\"\norder = 3.0\namplitude_cos = 0.004\nphase_cos = 0.7\namplitude_sin = 0.003\nphase_sin = -2.0\n";
    let sensor = Sensor::from_toml(&format!("{PLAIN}[[cause]]\n{third}"), "sensor.toml");
    let sensor = sensor.expect("a sensor");
    let recording = recording(&sensor, sensor.simulate(&Motion::to_and_fro(&sensor), 5));
    let mut found = diagnose(&recording).expect("an ellipse");
    let as_found = sensor_toml(&found, &recording);
    let other = Parameter {
        name: OTHER_ORDER.into(),
        ..found.findings[0].parameters[0].clone()
    };
    found.findings[0].parameters.push(other);
    assert_eq!(sensor_toml(&found, &recording), as_found);
}

#[test]
fn causes_with_speed() {
    round_trip("name = \"channel_skew\"\ndelay_s = 4e-7\n");
    round_trip("name = \"common_bandwidth\"\ntau_s = 2e-5\n");
    round_trip(
        "name = \"delayed_crosstalk\"\nproduct_into_cos_s = 8e-7\nproduct_into_sin_s = -6e-7\n",
    );
    round_trip("name = \"hysteresis\"\noffset_cos = 0.004\noffset_sin = -0.003\n");
}

#[test]
fn other_causes_with_speed() {
    round_trip("name = \"bandwidth_mismatch\"\ntau_cos_s = 3e-5\n");
    round_trip_beside("name = \"latency\"\ndelay_s = 4e-7\n", true);
}

/// From rest, where a capacitor that has been charged to the signal would leave none of it; the strongest does two thousand times what
/// the noise does.
#[test]
fn capacitors() {
    for corner in ["0.02", "1.0"] {
        round_trip(&format!("name = \"ac_coupling\"\ncorner_hz = {corner}\n"));
    }
}

#[test]
fn causes_in_the_codes() {
    round_trip("name = \"adc_nonlinearity\"\nbit = 12.0\nstep_cos = 0.004\nstep_sin = -0.003\n");
    round_trip("name = \"glitches\"\nshare = 0.001\nlargest = 0.2\n");
}

#[test]
fn causes_in_the_motion() {
    round_trip("name = \"vibration\"\nfrequency_hz = 1210.3\namplitude = 0.004\nphase = 0.3\n");
    round_trip("name = \"cogging\"\norder = 48.0\namplitude = 0.01\nphase = 0.3\n");
}

#[test]
fn causes_in_the_data() {
    round_trip("name = \"stuck_bit\"\nbit = 1\nchannel = \"sin\"\nlevel = 1\n");
    round_trip(
        "name = \"coarse_quantisation\"\nstep_lsb = 8.0\nchannel = \"cos\"\nremainder_lsb = 3.0\n",
    );
    round_trip("name = \"dropped_samples\"\nshare = 0.001\n");
    round_trip("name = \"repeated_samples\"\nshare = 0.001\n");
}

#[test]
fn causes_in_the_noise() {
    round_trip("name = \"flicker_noise\"\ndensity_at_1_hz = 3e-4\n");
    round_trip("name = \"amplitude_noise\"\nrms = 0.002\n");
    round_trip("name = \"clock_jitter\"\nrms_s = 4e-7\n");
}

#[test]
fn causes_with_time() {
    round_trip(
        "name = \"interference\"\nfrequency_hz = 311.3\namplitude_cos = 0.003\nphase_cos = 0.4\namplitude_sin = 0.004\nphase_sin = 1.9\n",
    );
    round_trip(
        "name = \"interference\"\nfrequency_hz = 50.2\namplitude_cos = 0.003\nphase_cos = 0.4\namplitude_sin = 0.004\nphase_sin = 1.9\namplitude_cos_2 = 0.001\nphase_cos_2 = 0.3\namplitude_sin_2 = 0.001\nphase_sin_2 = 2.5\namplitude_cos_3 = 0.002\nphase_cos_3 = -0.5\namplitude_sin_3 = 0.0015\nphase_sin_3 = 0.8\n",
    );
    round_trip("name = \"amplitude_ripple\"\nfrequency_hz = 100.2\ndepth = 0.004\nphase = 1.1\n");
    round_trip(
        "name = \"offset_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\ncurve_cos_2 = 0.004\ncurve_sin_3 = 0.003\n",
    );
    round_trip("name = \"offset_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\n");
    round_trip("name = \"gain_drift\"\nchange_cos = 0.01\nchange_sin = -0.006\n");
    for name in ["offset_drift", "gain_drift"] {
        let warms_up = "change_cos = 0.01\nchange_sin = -0.006\ntau_s = 0.3\n";
        round_trip(&format!("name = \"{name}\"\n{warms_up}"));
        round_trip(&format!("name = \"{name}\"\n{warms_up}start_s = 0.5\n"));
    }
}

#[test]
fn causes_with_the_revolution() {
    round_trip("name = \"runout\"\norder = 2\ndepth = 0.005\nphase = -0.9\n");
    round_trip("name = \"contamination\"\ndepth = 0.02\nplace = 2.0\nwidth = 0.1\n");
    round_trip_beside(
        "name = \"graduation_error\"\norder = 3\namplitude = 0.003\nphase = 0.7\n",
        true,
    );
}

#[test]
fn bad_files_are_refused_with_their_place() {
    let refused = |text: &str, words: &[&str]| {
        let said = Sensor::from_toml(text, "s.toml")
            .expect_err("a bad file")
            .to_string();
        for word in words {
            assert!(said.contains(word), "{word} is not in: {said}");
        }
    };
    refused("[signals", &["s.toml:1"]);
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"gremlins\"\n"),
        &["s.toml:1", "gremlins", "spatial_harmonic"],
    );
    // The list of what is known names every cause that a diagnosis can find.
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"gremlins\"\n"),
        &CATALOGUE,
    );
    refused(
        &PLAIN.replace("a_c = 0.8", "a_c = -1.0"),
        &["signals.a_c", "-1"],
    );
    refused(&PLAIN.replace("bits = 14", "bits = 77"), &["adc.bits"]);
    refused(
        &PLAIN.replace("[motion]", "[adc.sin]\nlsb = 0.0\ncentre = 0.0\n[motion]"),
        &["adc.sin.lsb", "a code has a size"],
    );
    refused(
        &PLAIN.replace("beta = 0.04", "beta = nan"),
        &["signals.beta"],
    );
    refused(
        &PLAIN.replace("lsb", "lbs"),
        &["s.toml:10:1", "lbs", "did you mean `lsb`?"],
    );
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"channel_skew\"\ndelay_s = nan\n"),
        &["cause.delay_s", "NaN"],
    );
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"channel_skew\"\ndelay = 1e-6\n"),
        &["delay", "did you mean `delay_s`?"],
    );
    let drift = |keys: &str| {
        let changes = "change_cos = 0.01\nchange_sin = 0.0";
        format!("{PLAIN}[[cause]]\nname = \"gain_drift\"\n{changes}\n{keys}\n")
    };
    refused(
        &drift("curve_cos_7 = 0.1"),
        &["curve_cos_7", "did you mean `curve_cos_"],
    );
    refused(&drift("tau_s = -1.0"), &["tau_s = -1", "negative"]);
    refused(
        &drift("tau_s = 1.0\ncurve_sin_3 = 0.1"),
        &["curves", "exponential"],
    );
    refused(&drift("start_s = 1.0"), &["start_s", "tau_s"]);
    refused(
        &format!("{PLAIN}[[cause]]\nname = \"stuck_bits\"\nbit = 3\n"),
        &["stuck_bits", "did you mean `stuck_bit`?"],
    );
}
