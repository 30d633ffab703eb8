//! ADCs described in part, in counts, one-sided, or not at all.

use nonius_recording::{Adc, AdcSource, Overrides, Recording};

/// 400 samples of two turns: the values of the codes that an ADC of that step and offset gives.
fn codes(amplitude: f64, middle: f64, lsb: f64, offset: f64, decimals: usize) -> String {
    let value = |v: f64| {
        let code = ((middle + amplitude * v - offset) / lsb).round();
        format!("{:.decimals$}", offset + code * lsb)
    };
    let row = |k: u32| {
        let alpha = f64::from(k) * std::f64::consts::TAU / 200.0;
        format!("{},{}\n", value(alpha.cos()), value(alpha.sin()))
    };
    "cos,sin\n".to_owned() + &(0..400).map(row).collect::<String>()
}

fn read(head: &str, table: &str) -> (Adc, Vec<String>) {
    let overrides = Overrides {
        sample_rate_hz: Some(1e3),
        ..Overrides::default()
    };
    let text = format!("{head}{table}");
    let recording = Recording::read_from(text.as_bytes(), "f", &overrides)
        .expect("a recording that can be read");
    let adc = recording.metadata.adc;
    // In every case the codes give the cells back to the last digit that matters.
    for ((c, s), k) in recording.codes().zip(0..) {
        for (found, cell) in [
            (adc.cos.value(c), recording.cos[k]),
            (adc.sin.value(s), recording.sin[k]),
        ] {
            assert!(
                (found - cell).abs() <= 0.51 * adc.cos.lsb,
                "row {k}: {found} for {cell}"
            );
        }
    }
    (adc.cos, recording.notes)
}

#[test]
fn counts_of_a_one_sided_adc() {
    let table = codes(1800.0, 2000.0, 1.0, 0.0, 0);
    for head in [
        "# adc_bits: 12\n# adc_min: 0\n# adc_max: 4095\n",
        "# adc_bits: 12\n# adc_min: 0\n# adc_max: 4096\n",
    ] {
        let (adc, notes) = read(head, &table);
        assert_eq!(
            (adc.lsb, adc.centre, adc.source),
            (1.0, 2048.0, AdcSource::Described)
        );
        assert_eq!(notes, [""; 0]);
    }
    let (adc, notes) = read("", &table);
    assert_eq!((adc.bits, adc.lsb, adc.centre), (12, 1.0, 2048.0));
    assert_eq!(
        notes,
        ["the ADC was estimated from the codes: 12 bits over 0 … 4096, one code = 1"]
    );
}

#[test]
fn counts_of_a_two_sided_adc() {
    let table = codes(1800.0, 12.0, 1.0, 0.0, 0);
    for full_scale in ["2047", "2047.5", "2048"] {
        let (adc, _) = read(
            &format!("# adc_bits: 12\n# full_scale: {full_scale}\n"),
            &table,
        );
        assert_eq!((adc.lsb, adc.centre), (1.0, 0.0));
    }
    let (adc, _) = read("", &table);
    assert_eq!((adc.bits, adc.lsb, adc.centre), (12, 1.0, 0.0));
}

#[test]
fn volts_of_a_one_sided_adc() {
    let table = codes(1.3, 1.6, 3.3 / 4096.0, 0.0, 6);
    let (adc, _) = read("# adc_bits: 12\n# adc_min: 0\n# adc_max: 3.3\n", &table);
    assert_eq!((adc.lsb, adc.source), (3.3 / 4096.0, AdcSource::Described));
    assert!((adc.centre - 1.65).abs() < 1e-6);
    let (adc, _) = read("", &table);
    assert_eq!((adc.bits, adc.source), (12, AdcSource::Estimated));
    assert!(
        (adc.lsb - 3.3 / 4096.0).abs() < 1e-8 && (adc.centre - 1.65).abs() < 1e-4,
        "{adc:?}"
    );
}

#[test]
fn codes_in_the_middle_between_the_steps() {
    // Half a step off: without care, the rounding of the text would decide the code.
    let lsb = 10.0 / 1024.0;
    let (adc, notes) = read(
        "# adc_bits: 10\n# full_scale: 5\n",
        &codes(4.0, 0.0, lsb, lsb / 2.0, 6),
    );
    assert!((adc.centre - lsb / 2.0).abs() < 1e-6, "{adc:?}");
    assert_eq!(notes, [""; 0]);
}

#[test]
fn a_description_in_part_is_completed() {
    let table = codes(0.9, 0.1, 1.0 / 2048.0, 0.0, 6);
    let (adc, notes) = read("# full_scale: 4\n", &table);
    assert_eq!(adc.bits, 14);
    assert!(
        notes[0].contains("(its number of bits is not given)"),
        "{notes:?}"
    );
    let (adc, notes) = read("# adc_bits: 16\n", &table);
    assert!((adc.full_scale() - 16.0).abs() < 1e-3, "{adc:?}");
    assert!(notes[0].contains("(its range is not given)"), "{notes:?}");
}

#[test]
fn a_description_that_does_not_fit_is_said() {
    let table = codes(0.8, 0.1, 1.0 / 2000.0, 0.0, 6);
    let (_, notes) = read("# adc_bits: 8\n# full_scale: 1\n", &table);
    assert!(
        notes[0].starts_with("the values do not lie on the codes"),
        "{notes:?}"
    );
}

#[test]
fn values_beyond_the_range_are_said() {
    let overrides = Overrides {
        sample_rate_hz: Some(1e3),
        adc_bits: Some(12),
        full_scale: Some(0.5),
        ..Overrides::default()
    };
    let table = codes(0.9, 0.0, 1.0 / 4096.0, 0.0, 6);
    let recording = Recording::read_from(table.as_bytes(), "f", &overrides)
        .expect("a recording that can be read");
    assert!(recording.notes[0].contains("values lie outside the range of the ADC (-0.5 … 0.5)"));
}

#[test]
fn a_fine_adc_seen_in_few_samples() {
    let (adc, _) = read("", &codes(2.3, 0.0, 5.0 / 65536.0, 0.0, 6));
    assert_eq!(adc.bits, 16);
    assert!((adc.lsb * 65536.0 / 5.0 - 1.0).abs() < 1e-4, "{adc:?}");
}
