//! Whatever the text, reading and surveying it end in a result or a message, never in a panic.

use nonius_recording::{Overrides, Recording, Survey};
use proptest::prelude::*;

/// Reads, surveys what was read, and checks what a recording promises.
fn digest(text: &[u8], overrides: &Overrides) -> Result<(), TestCaseError> {
    let recording = match Recording::read_from(text, "f", overrides) {
        Ok(recording) => recording,
        Err(error) => {
            let message = error.to_string();
            prop_assert!(message.contains(": "), "{message}");
            return Ok(());
        }
    };
    let n = recording.samples();
    prop_assert!(n >= nonius_recording::MIN_SAMPLES);
    prop_assert_eq!(recording.time_s.len(), n);
    prop_assert_eq!(recording.sin.len(), n);
    prop_assert!(recording.time_s.windows(2).all(|w| w[0] <= w[1]));
    prop_assert!(recording.metadata.sample_rate_hz > 0.0);
    for adc in [recording.metadata.adc.cos, recording.metadata.adc.sin] {
        prop_assert!((2..=32).contains(&adc.bits), "{adc:?}");
        prop_assert!(
            adc.lsb > 0.0 && adc.lsb.is_finite() && adc.centre.is_finite(),
            "{adc:?}"
        );
        let (min, max) = adc.codes();
        prop_assert!(
            recording
                .cos
                .iter()
                .all(|v| (min..=max).contains(&adc.code(*v)))
        );
    }
    let survey = Survey::of(&recording);
    let ellipse = survey.fit.ellipse;
    prop_assert!(ellipse.a_c > 0.0 && ellipse.a_s > 0.0, "{ellipse:?}");
    prop_assert_eq!(survey.motion.angle_periods.len(), n);
    prop_assert!(survey.motion.angle_periods.iter().all(|a| a.is_finite()));
    prop_assert!((0.0..=0.5 + 1e-9).contains(&survey.motion.max_speed_periods_per_sample));
    prop_assert!(survey.motion.periods_travelled >= survey.motion.periods_net.abs() - 1e-6);
    prop_assert!(survey.noise_rms >= 0.0);
    Ok(())
}

fn valid() -> String {
    let row = |k: u32| {
        let alpha = f64::from(k) * 0.3;
        let (c, s) = (alpha.cos(), alpha.sin());
        format!("{:.2},{c:.4},{s:.4},{:.4}\n", f64::from(k) * 0.01, alpha)
    };
    let head = "# sample_rate_hz: 100\n# adc_bits: 12\n# full_scale: 1.5\n";
    let rows: String = (0..30).map(row).collect();
    format!("{head}time_s,cos,sin,reference_rad\n{rows}")
}

/// Numbers as they come, from everyday to absurd.
fn cell() -> impl Strategy<Value = String> {
    prop_oneof![
        400 => (-2000i32..2000).prop_map(|v| v.to_string()),
        400 => (-1.0f64..1.0).prop_map(|v| format!("{v:.3}")),
        2 => any::<f64>().prop_map(|v| v.to_string()),
        9 => (-1e30f64..1e30).prop_map(|v| format!("{v:e}")),
        1 => "[-+0-9.eE,;\" ]{0,6}",
        1 => Just("1e-320".to_owned()),
        1 => Just("1e30".to_owned()),
    ]
}

fn head() -> impl Strategy<Value = String> {
    let key = prop_oneof![
        Just("sample_rate_hz"),
        Just("adc_bits"),
        Just("full_scale"),
        Just("adc_min"),
        Just("adc_max"),
        Just("periods_per_revolution"),
        Just("scale_period_m"),
    ];
    let line = (key, cell()).prop_map(|(key, value)| format!("# {key}: {value}\n"));
    proptest::collection::vec(line, 0..3).prop_map(|lines| lines.concat())
}

fn overrides() -> impl Strategy<Value = Overrides> {
    let sometimes = proptest::option::weighted(0.2, 1e-3f64..1e6);
    (
        sometimes.clone(),
        proptest::option::weighted(0.2, 0u32..40),
        sometimes,
    )
        .prop_map(|(rate, adc_bits, full_scale)| Overrides {
            sample_rate_hz: Some(rate.unwrap_or(1000.0)),
            adc_bits,
            full_scale,
            ..Overrides::default()
        })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn any_bytes(text in proptest::collection::vec(any::<u8>(), 0..400)) {
        digest(&text, &Overrides::default())?;
    }

    #[test]
    fn any_text(text in "[#a-z0-9,;.:\"\r\n \u{feff}é-]{0,200}") {
        digest(text.as_bytes(), &Overrides::default())?;
    }

    #[test]
    fn a_valid_file_damaged(
        places in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4u8), 1..6),
    ) {
        let mut text = valid().into_bytes();
        for (place, byte, how) in places {
            let at = place.index(text.len());
            let byte = if how == 3 { b"0123456789.,;-e\n\"# "[usize::from(byte) % 19] } else { byte };
            match how {
                0 => { text.remove(at); }
                1 => text.insert(at, byte),
                _ => text[at] = byte,
            }
        }
        digest(&text, &Overrides::default())?;
    }

    #[test]
    fn a_valid_file_cut(end in any::<prop::sample::Index>()) {
        let text = valid();
        digest(&text.as_bytes()[..end.index(text.len())], &Overrides::default())?;
    }

    #[test]
    fn tables_of_strange_numbers(
        head in head(),
        rows in proptest::collection::vec((cell(), cell()), 0..60),
        overrides in overrides(),
    ) {
        let rows: String = rows.iter().map(|(c, s)| format!("{c},{s}\n")).collect();
        digest(format!("{head}cos,sin\n{rows}").as_bytes(), &overrides)?;
    }

    #[test]
    fn tables_of_one_kind_of_number(
        scale in -300i32..30,
        offset in -1e3f64..1e3,
        values in proptest::collection::vec((-9i32..9, -9i32..9, 0.0f64..2.0), 16..80),
        overrides in overrides(),
    ) {
        let scale = 10f64.powi(scale);
        let mut time = 0.0;
        let mut text = "time_s,cos,sin,reference_rad\n".to_owned();
        for (c, s, step) in values {
            time += step * scale;
            let [c, s] = [c, s].map(|v| (f64::from(v) + offset) * scale);
            text += &format!("{time:e},{c:e},{s},{}\n", time * 7.0);
        }
        digest(text.as_bytes(), &overrides)?;
    }
}
