//! Designs that cannot work are refused with the field and the way out.

use crate::support::{Encoder, optical, shipped, wrapped};
use nonius_model::design::{Design, DesignError, Words};
use nonius_model::spec::{
    CalibrationMethod, CalibrationStart, Multipliers, Overrides, Place, Spec, keys,
};
use proptest::prelude::*;

#[test]
fn numbers_in_messages_are_short() {
    let mut spec = optical();
    spec.sensor.speed_max_periods_per_s = 1e300;
    spec.adc.full_scale = 1e299;
    let message = Design::new(&spec).expect_err("no such ADC").to_string();
    assert!(
        message.len() < 200 && message.contains("1e299"),
        "{message}"
    );
}

#[test]
fn what_cannot_work_names_the_field() {
    type Change = fn(&mut Spec);
    let cases: [(&str, Change); 18] = [
        ("loop.type", |s| s.tracking.method = 2),
        ("loop.method", |s| s.tracking.method = 4),
        ("loop.bandwidth_hz", |s| s.tracking.bandwidth_hz = 4e5),
        ("adc.sample_rate_hz", |s| {
            s.sensor.speed_max_periods_per_s = 4e5
        }),
        ("calibration.start", |s| {
            s.calibration.method = CalibrationMethod::Batch;
            s.calibration.start = CalibrationStart::LeastSquares;
        }),
        // Parameters are held, and recalled, only after four gears, or three.
        ("calibration.recall", |s| {
            s.calibration.recall = Some(true);
            s.calibration.gamma_last = Some(s.calibration.gamma_first + 3);
        }),
        ("correction.channel_skew_s", |s| {
            s.correction.channel_skew_s = f64::NAN;
        }),
        // More than a sample, though slow.
        ("correction.channel_skew_s", |s| {
            s.correction.channel_skew_s = -1.1e-6;
            s.sensor.speed_max_periods_per_s = 1e3;
        }),
        // 0.31 rad at the largest speed.
        ("correction.channel_skew_s", |s| {
            s.correction.channel_skew_s = 5e-7;
        }),
        // A loop so wide that it would swing with its own speed.
        ("correction.channel_skew_s", |s| {
            s.correction.channel_skew_s = 1e-6;
            s.sensor.speed_max_periods_per_s = 10e3;
            s.tracking.bandwidth_hz = 100e3;
            s.accuracy.rms_periods = 1e-3;
        }),
        ("adc.bits", |s| s.adc.bits = 24),
        ("calibration.gamma_first", |s| {
            s.calibration.gamma_first = 13
        }),
        ("accuracy.rms_periods", |s| s.accuracy.rms_periods = 1e-6),
        ("formats.phase_bits", |s| s.formats.phase_bits = Some(60)),
        ("chip.multipliers", |s| {
            s.chip.multipliers = Multipliers::Count(18)
        }),
        ("sensor.amplitude", |s| s.sensor.amplitude = f64::NAN),
        ("sensor.amplitude", |s| s.sensor.amplitude_tolerance = 0.6),
        ("description", |s| s.description = "a\0b".into()),
    ];
    for (expected, change) in cases {
        let mut spec = optical();
        change(&mut spec);
        match Design::new(&spec) {
            Err(DesignError::Field { field, .. }) => assert_eq!(field, expected),
            other => panic!("{expected}: {:?}", other.err()),
        }
    }
}

/// An accuracy that the sensor does not allow, or a share that leaves it nothing, names what would be accepted.
#[test]
fn the_limit_of_the_accuracy_is_accepted() {
    for (rms, share) in [(1e-9, 0.05), (1e-6, 0.9), (55e-6, 0.999), (1e-6, 1.0)] {
        let mut spec = optical();
        (spec.accuracy.rms_periods, spec.accuracy.arithmetic_share) = (rms, share);
        let mut refused = vec![];
        while let Err(DesignError::Field { field, limit, .. }) = Design::new(&spec) {
            let ends: Vec<f64> = limit.split(" … ").flat_map(str::parse).collect();
            let [least, most] = ends[..] else {
                panic!("{limit}");
            };
            match &*field {
                "accuracy.rms_periods" => spec.accuracy.rms_periods = least,
                "accuracy.arithmetic_share" => spec.accuracy.arithmetic_share = most,
                other => panic!("{other}"),
            }
            assert!(!refused.contains(&field), "{field}: {limit}");
            refused.push(field);
        }
        assert!(!refused.is_empty() && Design::new(&spec).is_ok(), "{rms}");
    }
}

/// Asking for more accuracy takes longer words, of twice the accuracy those that count most, of sixteen times all.
#[test]
fn words_follow_from_the_accuracy() {
    let words = |finer: f64| {
        let mut spec = optical();
        spec.adc.bits = 18;
        spec.sensor.noise_rms = 0.0;
        spec.accuracy.rms_periods /= finer;
        let design = Design::new(&spec).expect("a design that works");
        assert!(design.budget.arithmetic() <= design.budget.allowed);
        WORDS.map(|(_, word, _)| word(&design.words))
    };
    let [once, twice, sixteen] = [1.0, 2.0, 16.0].map(words);
    println!("{once:?} {twice:?} {sixteen:?}");
    assert!(twice.iter().zip(once).all(|(two, one)| *two >= one));
    assert!(twice.iter().sum::<u32>() > once.iter().sum::<u32>());
    assert!(sixteen.iter().zip(once).all(|(more, one)| *more > one));
}

/// The field of a word in `design.toml`, the word, and how to ask for it.
type Word = (&'static str, fn(&Words) -> u32, fn(&mut Overrides, u32));

const WORDS: [Word; 5] = [
    (
        "formats.signal_fraction",
        |w| w.signal_fraction,
        |f, n| f.signal_fraction = Some(n),
    ),
    (
        "formats.sine_rows_log2",
        |w| w.sine_rows_log2,
        |f, n| f.sine_rows_log2 = Some(n),
    ),
    (
        "formats.sine_phase_bits",
        |w| w.sine_phase_bits,
        |f, n| f.sine_phase_bits = Some(n),
    ),
    (
        "formats.phase_bits",
        |w| w.phase_bits,
        |f, n| f.phase_bits = Some(n),
    ),
    (
        "formats.accumulator_fraction",
        |w| w.accumulator_fraction,
        |f, n| f.accumulator_fraction = Some(n),
    ),
];

/// A short word of the user's makes the error of that word, and the others are not blamed for it.
#[test]
fn an_override_that_misses_the_budget_is_built() {
    let chosen = Design::new(&optical()).expect("a shipped design");
    for (field, word, set) in WORDS {
        let mut spec = optical();
        let short = match field {
            // As short as the phases that stand on it allow.
            "formats.phase_bits" => chosen.words.sine_phase_bits,
            _ => word(&chosen.words) - 3,
        };
        set(&mut spec.formats, short.max(4));
        match Design::new(&spec) {
            Ok(design) => {
                assert_eq!(word(&design.words), short.max(4), "{field}");
                let (is, may) = (design.budget.arithmetic(), design.budget.allowed);
                assert!(is > may, "{field}: {:?}", design.words);
            }
            Err(error) => panic!("{field}: {error}"),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Anything in any field, of those too that the shipped design leaves out, is either a design or a refusal.
    #[test]
    fn no_value_makes_the_design_panic(
        field in 0..keys().count(),
        value in prop_oneof![
            Just("0".to_owned()), Just("-1".to_owned()), Just("1e308".to_owned()), Just("nan".to_owned()),
            Just("inf".to_owned()), Just("4294967295".to_owned()), (-40i32..50).prop_map(|n| n.to_string()),
            (-12.0..12.0f64).prop_map(|x| format!("{:e}", 10f64.powf(x))),
            prop_oneof![
                Just("all"), Just("exact"), Just("batch"), Just("sum_of_squares"), Just("least_squares"),
                Just("offset_binary"), Just(""),
            ].prop_map(|word| format!("{word:?}")),
            Just("true".to_owned()), Just("[1]".to_owned()),
        ],
    ) {
        let (section, key) = keys().nth(field).expect("a field");
        let mut design: toml::Table = shipped::text("optical").parse().expect("a shipped design");
        let value: toml::Table = format!("it = {value}").parse().expect("a value");
        let fields = match section.split_once('.') {
            // One entry of a list, sound but for this field.
            Some((section, list)) => {
                let mut entry: toml::Table = keys()
                    .filter(|(of, _)| of.ends_with(list))
                    .map(|(_, key)| (key.to_owned(), if key == "order" { 3.into() } else { 0.01.into() }))
                    .collect();
                entry.insert(key.into(), value["it"].clone());
                let fields = design.entry(section).or_insert(toml::Table::new().into());
                fields.as_table_mut().expect("a section").insert(list.into(), vec![entry].into());
                None
            }
            None => Some(design.entry(section).or_insert(toml::Table::new().into())),
        };
        if let Some(fields) = fields {
            let fields = fields.as_table_mut().expect("a section");
            fields.insert(key.into(), value["it"].clone());
        }
        if let Ok(spec) = Spec::from_toml(&design.to_string(), "d.toml") {
            let _ = Design::new(&spec);
        }
    }
}

proptest! {
    /// What a refusal says may be said is accepted.
    #[test]
    fn the_limit_that_is_named_is_accepted(
        bandwidth_log10 in 1.0..5.0f64,
        rate_log10 in 4.0..7.0f64,
        rms_log10 in -8.0..-3.0f64,
        type_1 in any::<bool>(),
        parameters in prop_oneof![Just(0), Just(5), Just(9)],
    ) {
        let mut spec = optical();
        spec.adc.sample_rate_hz = 10f64.powf(rate_log10);
        spec.sensor.speed_max_periods_per_s = spec.adc.sample_rate_hz / 10.0;
        spec.tracking.bandwidth_hz = 10f64.powf(bandwidth_log10);
        spec.tracking.filter_type = if type_1 { 1 } else { 2 };
        spec.calibration.parameters = parameters;
        spec.accuracy.rms_periods = 10f64.powf(rms_log10);
        // One thing after the other.
        for _ in 0..4 {
            let Err(DesignError::Field { field, limit, .. }) = Design::new(&spec) else {
                return Ok(());
            };
            let said = match field.as_ref() {
                "sensor.speed_max_periods_per_s" => &mut spec.sensor.speed_max_periods_per_s,
                "loop.bandwidth_hz" => &mut spec.tracking.bandwidth_hz,
                "accuracy.rms_periods" => &mut spec.accuracy.rms_periods,
                _ => return Ok(()),
            };
            let (before, number) = (*said, |word: &str| word.parse::<f64>().ok());
            let ends: Vec<f64> = limit.split(' ').filter_map(number).collect();
            // The nearer end.
            let nearer = ends.iter().copied().reduce(|a, b| if before > b { b } else { a });
            *said = nearer.expect("a limit with a number");
            if let Err(DesignError::Field { field: again, limit, .. }) = Design::new(&spec) {
                prop_assert!(again != field, "{field} = {nearer:?}: {limit}");
            }
        }
    }
}

/// The completion counts the samples of a period of travel at a fifth of the loop's bandwidth.
#[test]
fn a_loop_too_slow_for_the_completion_is_refused() {
    let mut spec = optical();
    spec.calibration.parameters = 9;
    spec.sensor.speed_max_periods_per_s = 100.0;
    spec.tracking.bandwidth_hz = 610.0;
    let refused = Design::new(&spec).expect_err("too slow").to_string();
    for words in [
        "loop.bandwidth_hz = 610",
        "610.43",
        "calibration.completion",
    ] {
        assert!(refused.contains(words), "{refused}");
    }
    spec.tracking.bandwidth_hz = 611.0;
    Design::new(&spec).expect("just fast enough");
    spec.tracking.bandwidth_hz = 610.0;
    spec.calibration.completion = false;
    Design::new(&spec).expect("nothing to count");
}

/// The test's own encoder: an ideal one has no offset, angles wrap to half a turn.
#[test]
fn the_simulated_encoder_is_what_it_says() {
    let spec = optical();
    let [cos, sin] = Encoder::ideal(&spec).volts(0.25);
    assert!(cos.abs() < 1e-12 && (sin - 0.8).abs() < 1e-12);
    assert!((wrapped(0.75) + 0.25).abs() < 1e-12);
}

#[test]
fn the_exact_gradient_with_bends_is_refused_with_its_cost() {
    for parameters in [8, 9] {
        let mut spec = optical();
        spec.calibration.method = CalibrationMethod::Exact;
        spec.calibration.parameters = parameters;
        let message = Design::new(&spec).expect_err("too dear").to_string();
        for part in [
            "calibration.method",
            "costs 16 or 18 products a sample",
            "4 or 5 parameters",
        ] {
            assert!(message.contains(part), "{message}");
        }
    }
}

#[test]
fn a_hold_that_noise_would_never_leave_is_widened_and_one_out_of_range_refused() {
    let mut spec = optical();
    spec.sensor.noise_rms = 0.03;
    assert!(spec.hold_residual() >= 0.18);
    spec.calibration.hold_residual = 2.0;
    let message = Design::new(&spec).expect_err("no residual").to_string();
    assert!(message.contains("calibration.hold_residual"), "{message}");
}

/// Keys of another search, or of other parameters, are refused where they have no effect.
#[test]
fn keys_of_another_search_are_refused() {
    let with = |lines: &str| {
        let text = shipped::text("optical").replace("parameters = 5", lines);
        Design::new(&Spec::from_toml(&text, "d.toml").expect("well formed"))
    };
    for (lines, key) in [
        ("parameters = 5\nforgetting = 2", "forgetting"),
        (
            "parameters = 5\nmethod = \"batch\"\nforgetting = 2",
            "forgetting",
        ),
        ("parameters = 4\ncompletion_gamma = 9", "completion_gamma"),
        (
            "parameters = 9\ncompletion = false\ncompletion_gamma = 9",
            "completion_gamma",
        ),
    ] {
        let refused = with(lines).expect_err(lines);
        assert_eq!(refused.field(), format!("calibration.{key}"), "{lines}");
        let message = refused.to_string();
        assert!(message.contains("leave it out"), "{message}");
        assert!(message.contains("no effect"), "{message}");
    }
    for lines in [
        "parameters = 5\nmethod = \"sum_of_squares\"\nforgetting = 2",
        "parameters = 5\ncompletion = false",
        "parameters = 5\nforgetting = 3\ncompletion = true\ncompletion_gamma = 10",
    ] {
        assert!(with(lines).is_ok(), "{lines}");
    }
}

/// Without calibration its keys are refused, each with its own name; as they stand by themselves they may be written.
#[test]
fn keys_of_no_calibration_are_refused() {
    let fixed = shipped::text("optical").replace("parameters = 5", "parameters = 0");
    let with = |line: &str| {
        let text = fixed.replace("parameters = 0", &format!("parameters = 0\n{line}"));
        let spec = Spec::from_toml(&text, "d.toml").expect("well formed");
        (Design::new(&spec), text)
    };
    for (key, other, same) in [
        ("method", "\"exact\"", "\"final\""),
        ("start", "\"least_squares\"", "\"gears\""),
        ("forgetting", "2", "3"),
        ("completion", "false", "true"),
        ("completion_gamma", "9", "10"),
        ("gamma_first", "5", "4"),
        ("gamma_last", "12", "9"),
        ("gear_periods", "3", "4"),
        ("restart_residual", "0.3", "0.25"),
        ("hold_residual", "0.125", "0.0625"),
        ("lag", "false", "true"),
        ("hold_periods", "16", "256"),
        ("recall", "false", "true"),
    ] {
        assert!(with(&format!("{key} = {same}")).0.is_ok(), "{key}");
        let (refused, text) = with(&format!("{key} = {other}"));
        let refused = refused.expect_err("no effect");
        assert_eq!(refused.field(), format!("calibration.{key}"));
        let place = Place::of_field(&text, refused.field()).map(|place| place.to_string());
        assert_eq!(place.as_deref(), Some("26:1"));
        let message = refused.to_string();
        assert!(message.contains(&format!(" = {other}: ")), "{message}");
        assert!(message.contains("leave it out"), "{message}");
    }
    let keys = keys().filter(|(section, key)| *section == "calibration" && *key != "parameters");
    assert_eq!(keys.count(), 13);
}
