//! What is no design is told with its place and the way out; no text makes the reader panic.

use crate::support::shipped;
use nonius_model::spec::{Place, Spec};
use proptest::prelude::*;

fn text() -> String {
    shipped::text("optical")
}

#[test]
fn an_unknown_key_is_named_with_its_line_and_the_nearest_known_one() {
    let wrong = text().replace("bandwidth_hz", "bandwith_hz");
    let message = Spec::from_toml(&wrong, "d.toml")
        .expect_err("a misspelt key")
        .to_string();
    assert!(
        message.starts_with("d.toml:22:1: unknown key `loop.bandwith_hz`"),
        "{message}"
    );
    assert!(
        message.contains("did you mean `bandwidth_hz`?"),
        "{message}"
    );
}

/// Wherever it stands: indented, dotted, in a table on one line, in a list; and nowhere.
#[test]
fn a_field_is_found_where_it_is_given() {
    let text = "loop.type = 2\nadc = { bits = 12, middle = 0.5 }\n[sensor]\n  noise_rms = 1\n[correction]\n\
                harmonics = [{ order = 3 },\n  { order = 4 }]\n";
    for (field, place) in [
        ("loop.type", "1:6"),
        ("adc.middle", "2:20"),
        ("sensor.noise_rms", "4:3"),
        ("correction.harmonics", "6:1"),
        ("correction.harmonics[2].order", "7:5"),
    ] {
        let found = Place::of_field(text, field).map(|place| place.to_string());
        assert_eq!(found.as_deref(), Some(place), "{field}");
    }
    for field in [
        "loop.pole",
        "chip.clock_hz",
        "correction.harmonics[3].order",
        "",
    ] {
        assert_eq!(Place::of_field(text, field), None, "{field}");
    }
    let unknown = Spec::from_toml("adc = { bits = 12, bitz = 1 }\n", "d.toml");
    let message = unknown.expect_err("an unknown key").to_string();
    assert!(message.starts_with("d.toml:1:20: unknown key"), "{message}");
}

#[test]
fn what_is_wrong_is_named_with_its_section() {
    let message = |text: &str| {
        let error = Spec::from_toml(text, "d.toml").expect_err("wrong");
        error.to_string()
    };
    for (text, place, section) in [("adc = 3\n", 7, "adc"), ("chip = [1]\n", 8, "chip")] {
        assert_eq!(
            message(text),
            format!("d.toml:1:{place}: {section}: expected a section, [{section}], with its keys")
        );
    }
    let missing = message(&text().replace("bits = 12", ""));
    assert_eq!(missing, "d.toml:14:1: adc: missing field `bits`");
    let wrong = format!("{}\n[[correction.harmonics]]\norder = \"third\"\n", text());
    let told = message(&wrong);
    assert!(
        told.contains(": correction.harmonics[1].order: invalid type"),
        "{told}"
    );
}

#[test]
fn a_value_of_the_wrong_kind_is_told_without_words_of_rust() {
    for (was, is, expected) in [
        (
            "bits = 12",
            "bits = \"many\"",
            "d.toml:15:8: adc.bits: invalid type: string \"many\", expected a whole number, 0 or more",
        ),
        (
            "bits = 12",
            "bits = -12",
            "d.toml:15:8: adc.bits: invalid value: `-12`, expected a whole number, 0 or more",
        ),
        (
            "full_scale = 1.0 ",
            "full_scale = true ",
            "d.toml:16:14: adc.full_scale: invalid type: boolean `true`, expected a number",
        ),
    ] {
        let message = Spec::from_toml(&text().replace(was, is), "d.toml")
            .expect_err("a wrong kind")
            .to_string();
        assert_eq!(message.lines().next(), Some(expected));
    }
}

/// Whatever it was to be: the place, the value and what may be written.
#[test]
fn a_number_that_is_too_large_to_be_read_is_told_with_its_limit() {
    let many = "9".repeat(60);
    let count = format!("bits = {many}");
    let real = format!("full_scale = {many} ");
    for (was, is, expected) in [
        (
            "bits = 12",
            "bits = 5_000_000_000",
            "d.toml:15:8: adc.bits = 5_000_000_000: out of range (limit: 0 … 4294967295)",
        ),
        (
            "bits = 12",
            "bits = -99999999999999999999",
            "d.toml:15:8: adc.bits = -99999999999999999999: out of range (limit: 0 … 4294967295)",
        ),
        (
            "bits = 12",
            "bits = 0xfffffffffffffffffff",
            "d.toml:15:8: adc.bits = 0xfffffffffffffffffff: out of range (limit: 0 … 4294967295)",
        ),
        (
            "bits = 12",
            &count,
            "d.toml:15:8: adc.bits = 9999999999999999999999999999999999999999…: out of range (limit: 4294967295 where it is a \
             whole number; others are written with a point or an exponent)",
        ),
        (
            "name = \"optical\"",
            "formats = { phase_bits = 30, gain_range_log2 = 99999999999999999999 }\nname = \"optical\"",
            "d.toml:2:48: formats.gain_range_log2 = 99999999999999999999: out of range (limit: -2147483648 … 2147483647)",
        ),
        (
            "multipliers = 1",
            "multipliers = 99999999999999999999",
            "d.toml:32:15: chip.multipliers = 99999999999999999999: out of range (limit: 1 … 4294967295, or \"all\")",
        ),
        (
            "multipliers = 1",
            "multipliers = 4294967296",
            "d.toml:32:15: chip.multipliers = 4294967296: out of range (limit: 1 … 4294967295, or \"all\")",
        ),
        (
            "full_scale = 1.0 ",
            "full_scale = 99999999999999999999 ",
            "d.toml:16:14: adc.full_scale = 99999999999999999999: so many digits are written with a point or an exponent \
             (limit without: 9223372036854775807)",
        ),
        (
            "full_scale = 1.0 ",
            &real,
            "d.toml:16:14: adc.full_scale = 9999999999999999999999999999999999999999…: out of range (limit: 4294967295 where it \
             is a whole number; others are written with a point or an exponent)",
        ),
        (
            "full_scale = 1.0 ",
            "full_scale = 1e400 ",
            "d.toml:16:14: adc.full_scale = 1e400: out of range (limit: -1.797e308 … 1.797e308)",
        ),
        (
            "parameters = 5",
            "recall = 99999999999999999999",
            "d.toml:25:10: calibration.recall: invalid type: `99999999999999999999`, expected a boolean",
        ),
    ] {
        let message = Spec::from_toml(&text().replacen(was, is, 1), "d.toml")
            .expect_err("no such number")
            .to_string();
        assert_eq!(message.lines().next(), Some(expected));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_text_makes_the_reader_panic(garbage in ".{0,200}") {
        let _ = Spec::from_toml(&garbage, "d.toml");
    }
}
