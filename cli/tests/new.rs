//! What `nonius new` writes is true of the design that stands beside it.

use std::fs;

use crate::support::{done, nonius, recording, refused};
use nonius_model::spec::Spec;

/// The design that is fitted to a recording.
fn fitted(recording: &str) -> (String, Spec) {
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), recording).expect("a recording");
    done(dir.path(), &["new", "it", "--from", "r.csv"]);
    let text = fs::read_to_string(dir.path().join("it.toml")).expect("it.toml");
    let spec = Spec::from_toml(&text, "it.toml").expect("a design");
    (text, spec)
}

/// Value and comment of a key.
fn line<'a>(text: &'a str, key: &str) -> (f64, &'a str) {
    let line = text.lines().find(|l| l.starts_with(&format!("{key} = ")));
    let (value, note) = line
        .and_then(|l| l.split_once(" = ")?.1.split_once('#'))
        .expect("a commented key");
    (value.trim().parse().expect("a number"), note.trim())
}

/// Slow, in between and fast, each with its own reason.
#[test]
fn the_bandwidth_says_which_of_three_it_is() {
    for (per_period, reason) in [
        (
            2000.0,
            "2 % of the sample rate, more than 8 times the speed",
        ),
        (300.0, "8 times the speed"),
        (
            20.0,
            "6 % of the sample rate: 8 times the speed would be more",
        ),
    ] {
        let (text, spec) = fitted(&recording(8000, per_period));
        let (bandwidth, note) = line(&text, "bandwidth_hz");
        assert_eq!(note, reason);
        let (speed, rate) = (spec.sensor.speed_max_periods_per_s, spec.adc.sample_rate_hz);
        let is = |of: f64| (bandwidth / of - 1.0).abs() < 1e-3;
        let true_of_it = match reason.split_at(1).0 {
            "2" => is(0.02 * rate) && bandwidth > 8.0 * speed,
            "6" => is(0.06 * rate) && bandwidth < 8.0 * speed,
            _ => is(8.0 * speed),
        };
        assert!(true_of_it, "{bandwidth} of {speed} and {rate}: {note}");
    }
}

#[test]
fn a_line_is_written_once_and_numbers_end_with_their_last_digit() {
    let (text, _) = fitted(&recording(8000, 61.3));
    let comments: Vec<&str> = text.lines().take_while(|l| l.starts_with('#')).collect();
    assert_eq!(comments.len(), 1, "{text}");
    assert!(comments[0].starts_with("# Fitted to a recording: 8000 samples, "));
    let mut numbers = 0;
    for (_, note) in text.lines().filter_map(|l| l.split_once("# measured: ")) {
        for word in note.split([' ', ';']) {
            if let Ok(value) = word.parse::<f64>() {
                assert_eq!(word, value.to_string(), "{note}");
                numbers += 1;
            }
        }
    }
    assert_eq!(numbers, 6, "{text}");
    // The fastest stretch that was measured, to the digit that the comment has, in periods per second.
    let (_, note) = line(&text, "speed_max_periods_per_s");
    let measured: f64 = note
        .trim_start_matches("measured: ")
        .parse()
        .expect("a number");
    assert!((measured / (1e6 / 61.3) - 1.0).abs() < 1e-2, "{note}");
}

/// A sine far off its middle, further than any chip is promised to hold: file and terminal say the same of it, and nothing of the
/// promises that hold.
#[test]
fn a_promise_that_does_not_hold_is_told_in_the_file_and_on_the_terminal() {
    let far: String = recording(8000, 61.3)
        .replace(
            "adc_bits: 12\n# full_scale: 1\n",
            "adc_bits: 14\n# full_scale: 8\n",
        )
        .lines()
        .map(|row| match row.rsplit_once(',') {
            Some((rest, sin)) if !sin.starts_with('s') => {
                let sin: f64 = sin.parse().expect("a number");
                format!("{rest},{}\n", sin + 3.0)
            }
            _ => format!("{row}\n"),
        })
        .collect();
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), far).expect("a recording");
    let said = done(dir.path(), &["new", "it", "--from", "r.csv"]);
    let text = fs::read_to_string(dir.path().join("it.toml")).expect("it.toml");
    let (most, note) = line(&text, "offset_max");
    assert_eq!(most, 0.6, "{note}");
    let why = note.strip_prefix("NOT ENOUGH: ").expect("it is not enough");
    assert!(
        why.starts_with("measured 1.8") && why.ends_with("more than 0.6: adjust the sensor"),
        "{why}"
    );
    let told: Vec<&str> = said
        .lines()
        .filter(|l| l.contains("does not hold what"))
        .collect();
    let expected = format!("note: sensor.offset_max does not hold what the recording shows: {why}");
    assert_eq!(told, [expected]);
}

/// A sensor so far off that a chip which is promised it, and some to spare, does not always lock: said at once, with what helps.
#[test]
fn a_sensor_that_does_not_always_lock_is_told() {
    let said = |amplitudes: [f64; 2], offset: f64, beta: f64| {
        let dir = tempfile::tempdir().expect("scratch");
        let mut rows = String::from("# sample_rate_hz: 1000\ncos,sin\n");
        for k in 0..4000 {
            let angle = f64::from(k) * 0.02;
            let cos = amplitudes[0] * angle.cos() + offset;
            let sin = amplitudes[1] * (angle - beta).sin() - offset;
            rows += &format!(
                "{},{}\n",
                (cos * 4096.0).round() / 4096.0,
                (sin * 4096.0).round() / 4096.0
            );
        }
        fs::write(dir.path().join("r.csv"), rows).expect("a recording");
        done(dir.path(), &["new", "it", "--from", "r.csv"])
    };
    let far_off = said([1.25, 0.75], 0.36, 0.5);
    for words in [
        "sensors at the ends of the promise do not lock",
        "every sensor locks with sensor.amplitude_tolerance",
    ] {
        assert!(far_off.contains(words), "{far_off}");
    }
    let usual = said([1.05, 0.95], 0.05, 0.05);
    assert!(!usual.contains("do not lock"), "{usual}");
}

/// A name that the chip has for a signal is told as such, not as an accuracy that cannot be reached.
#[test]
fn a_name_that_the_chip_has_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    for name in ["position", "clk", "theta_1"] {
        let output = nonius(dir.path(), &["new", name]);
        refused(&output, &["name = ", name, "a signal"]);
        assert!(!dir.path().join(format!("{name}.toml")).exists());
    }
}

/// Not the accuracy, which is worked out.
#[test]
fn the_number_at_fault_is_named() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = format!("# scale_period_m: 1e-20\n{}", recording(8000, 300.0));
    fs::write(dir.path().join("r.csv"), text).expect("a recording");
    let output = nonius(dir.path(), &["new", "it", "--from", "r.csv"]);
    refused(
        &output,
        &["sensor.scale_period_m = ", "the number at fault"],
    );
}

/// Noise about a standstill has any angle in each sample. No speed is made of that: both commands say what it is, in the same words.
#[test]
fn a_scale_that_stands_still_is_told_and_no_speed() {
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, Normal};
    let mut random = StdRng::seed_from_u64(1);
    let noise = Normal::new(0.0, 0.01).expect("a standard deviation");
    let mut rows = String::from("# sample_rate_hz: 20000\ncos,sin\n");
    for _ in 0..4000 {
        let mut about = |place: f64| place + noise.sample(&mut random);
        rows += &format!("{:.9},{:.9}\n", about(0.995), about(0.1));
    }
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), rows).expect("a recording");
    let output = nonius(dir.path(), &["new", "it", "--from", "r.csv"]);
    let why = "the samples are a cloud and no ring: the scale stands still, or the signals are no sin/cos pair; move the scale by a \
               whole period or more while recording";
    refused(&output, &[&format!("r.csv: {why}")]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        !said.contains("per sample") && !said.contains("Hz"),
        "{said}"
    );
    assert!(!dir.path().join("it.toml").exists());
    let output = nonius(dir.path(), &["calibrate", "r.csv", "--json"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains(why), "{said}");
}
