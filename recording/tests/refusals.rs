//! What the reader refuses: the place, and a message that says what to do.

use nonius_recording::{Overrides, Recording};

fn refusal_with(text: &[u8], overrides: &Overrides) -> String {
    let read = Recording::read_from(text, "r.csv", overrides);
    read.expect_err("this must be refused").to_string()
}

/// The message must begin with the first and contain the second.
#[track_caller]
fn assert_refused(text: impl AsRef<[u8]>, begin: &str, contains: &str) {
    let message = refusal_with(text.as_ref(), &Overrides::default());
    assert!(message.starts_with(begin), "{message}");
    assert!(message.contains(contains), "{message}");
}

/// A good recording of 40 rows, the header in line 1.
fn good() -> String {
    let row = |k: u32| {
        let alpha = f64::from(k) * 0.3;
        format!(
            "{:.2},{:.4},{:.4}\n",
            f64::from(k) * 0.01,
            alpha.cos(),
            alpha.sin()
        )
    };
    "time_s,cos,sin\n".to_owned() + &(0..40).map(row).collect::<String>()
}

/// The good recording with line `at` in place of its own.
fn with_line(at: usize, line: &str) -> String {
    let mut lines: Vec<String> = good().lines().map(str::to_owned).collect();
    lines[at - 1] = line.to_owned();
    lines.join("\n")
}

#[test]
fn cells() {
    assert_refused(
        with_line(5, "0.03,abc,0.5"),
        "r.csv:5:6: 'abc' in the column 'cos'",
        "such as",
    );
    assert_refused(
        with_line(5, "0.03, 0.1,"),
        "r.csv:5:11: '' in the column 'sin'",
        "is empty",
    );
    assert_refused(with_line(5, "0.03,NaN,0.5"), "r.csv:5:6: 'NaN'", "finite");
    assert_refused(
        with_line(5, "0.03,0.5,-inf"),
        "r.csv:5:10: '-inf'",
        "finite",
    );
    assert_refused(
        with_line(5, "0.03,0.5,1e999"),
        "r.csv:5:10: '1e999'",
        "finite",
    );
    assert_refused(
        with_line(5, "0.03,0.5,1e31"),
        "r.csv:5:10: '1e31'",
        "beyond 1e30",
    );
    assert_refused(with_line(5, "0.03,\"0,5\",1"), "r.csv:5:6: '0,5'", "`;`");
    assert_refused(
        with_line(5, "0.03,é\"x,1"),
        "r.csv:5:6: 'é\"x'",
        "not a number",
    );
    assert_refused(
        with_line(5, "0.03,\"0.5,1"),
        "r.csv:5:6: the quote",
        "close or remove it",
    );
}

#[test]
fn rows() {
    assert_refused(
        with_line(5, "0.03,0.5"),
        "r.csv:5:9: 2 cells where the header has 3",
        "remove",
    );
    assert_refused(
        with_line(5, "0.03,0.5,1,2"),
        "r.csv:5:12: 4 cells",
        "remove the extra",
    );
    assert_refused(
        with_line(5, "0,03,0,5,0,1"),
        "r.csv:5:8: 6 cells",
        "decimal comma",
    );
    assert_refused(
        with_line(5, "# a remark"),
        "r.csv:5:1: a line with `#`",
        "only come first",
    );
}

#[test]
fn time() {
    assert_refused(
        with_line(5, "0.01,0.5,1"),
        "r.csv:5:1: the time runs back from 0.02",
        "goes forward",
    );
    assert_refused(
        with_line(5, "0.02,0.5,1"),
        "r.csv:5:1: the time stands still",
        "--sample-rate",
    );
    let twice = good() + good().split_once('\n').expect("a header").1;
    assert_refused(
        twice,
        "r.csv:42:1: the time runs back from 0.39 to 0",
        "several records",
    );
    assert_refused(
        "cos,sin\n1,2\n",
        "r.csv:1: neither a column time_s",
        "--sample-rate RATE",
    );
}

#[test]
fn files() {
    assert_refused("", "r.csv: the file is empty", "header line");
    assert_refused("# only: this\n\n", "r.csv: the file is empty", "");
    assert_refused(
        b"time_s,cos,s\xEFn\n",
        "r.csv:1:13: the text is not UTF-8",
        "save",
    );
    assert_refused(b"\xFF\xFEt\0", "r.csv:1:1: the text is UTF-16", "save");
    assert_refused("time_s|cos|sin\n", "r.csv:1:7: the columns seem", "`|`");
    assert_refused(
        "0,1,2\n",
        "r.csv:1:1: numbers where the header",
        "time_s,cos,sin",
    );
    assert_refused(
        "time_s,U1,cos\n",
        "r.csv:1: there is no column 'sin'",
        "--sin COLUMN",
    );
    assert_refused(
        "cos,cos,sin\n",
        "r.csv:1:5: the column 'cos' is there twice",
        "rename",
    );
    let short: String = good().lines().take(16).map(|l| format!("{l}\n")).collect();
    assert_refused(short, "r.csv: 15 samples are too few", "at least 16");
    let gone = Recording::read(std::path::Path::new("no/such.csv"), &Overrides::default());
    assert!(
        gone.expect_err("a refusal")
            .to_string()
            .starts_with("no/such.csv: cannot be read")
    );
}

#[test]
fn dead_channels() {
    let dead: String = (0..40).map(|k| format!("{k},2.5,{}\n", k % 7)).collect();
    let dead = "time_s,cos,sin\n".to_owned() + &dead;
    assert_refused(
        dead,
        "r.csv: the column 'cos' is dead: it is constant at 2.5",
        "--cos COLUMN",
    );
}

#[test]
fn metadata() {
    let head = |line: &str| format!("# a: b\n# {line}\n{}", good());
    let cases = [
        (
            "sample_rate_hz: -5",
            "sample_rate_hz is '-5'; expected a rate in hertz above 0",
        ),
        ("sample_rate_hz: 0", "sample_rate_hz is '0'"),
        (
            "sample_rate_hz: 1 kHz",
            "sample_rate_hz is '1 kHz'; expected a number",
        ),
        ("sample_rate_hz:", "sample_rate_hz is ''"),
        (
            "adc_bits: 0",
            "adc_bits is '0'; expected a whole number from 2 to 32",
        ),
        ("adc_bits: 99", "adc_bits is '99'"),
        ("adc_bits: 12.5", "adc_bits is '12.5'"),
        ("full_scale: inf", "full_scale is 'inf'"),
        (
            "periods_per_revolution: -1",
            "periods_per_revolution is '-1'",
        ),
        (
            "periods_per_revolution: 1e12",
            "periods_per_revolution is '1e12'",
        ),
        ("scale_period_m: 0", "scale_period_m is '0'"),
        // Too large to be counted, too large for any number, more digits than fill a line.
        (
            "periods_per_revolution: 99999999999999999999",
            "periods_per_revolution is '99999999999999999999'; expected a whole number from 1 to 4294967295",
        ),
        (
            "adc_bits: 99999999999999999999",
            "adc_bits is '99999999999999999999'; expected a whole number from 2 to 32",
        ),
        (
            "sample_rate_hz: 1e999",
            "sample_rate_hz is '1e999'; expected a number from -1e30 to 1e30",
        ),
        (
            &format!("full_scale: {}", "9".repeat(60)),
            "full_scale is '9999999999999999999999999999999999999999…'; expected a number from -1e30 to 1e30",
        ),
        (
            "adc_min: 0",
            "the range of the ADC is not clear: adc_max is missing",
        ),
        (
            "adc_max: 1",
            "the range of the ADC is not clear: adc_min is missing",
        ),
    ];
    for (line, begin) in cases {
        assert_refused(head(line), &format!("r.csv:2: {begin}"), "");
    }
    let two = |a: &str, b: &str| format!("# {a}\n# {b}\n{}", good());
    assert_refused(
        two("adc_min: 2", "adc_max: 1"),
        "r.csv:2: the range",
        "not above",
    );
    assert_refused(
        two("adc_bits: 8", "adc_bits: 9"),
        "r.csv:2: adc_bits is given twice",
        "'8'",
    );
    let both = two("full_scale: 2", "adc_min: 1\n# adc_max: 3");
    assert_refused(both, "r.csv:3: the range", "either full_scale");
}

#[test]
fn the_command_line() {
    let refused = |overrides| refusal_with(good().as_bytes(), &overrides);
    let none = Overrides::default();
    let bits = Overrides {
        adc_bits: Some(99),
        ..none.clone()
    };
    assert!(refused(bits).starts_with("command line: --adc-bits is '99'"));
    let rate = Overrides {
        sample_rate_hz: Some(f64::NAN),
        ..none.clone()
    };
    assert!(refused(rate).starts_with("command line: --sample-rate is 'NaN'"));
    let scale = Overrides {
        full_scale: Some(-1.0),
        ..none.clone()
    };
    assert!(refused(scale).starts_with("command line: --full-scale is '-1'"));
    let scale = Overrides {
        full_scale: Some(1e31),
        ..none.clone()
    };
    assert!(
        refused(scale)
            .ends_with("expected a number above 0, up to 1e30, in the unit of the columns")
    );
    let column = Overrides {
        cos_column: Some("coz".into()),
        ..none
    };
    assert!(refused(column).contains("no column 'coz' (nearest: 'cos')"));
}
