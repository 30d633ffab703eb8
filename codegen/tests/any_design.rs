//! Whatever design works, its Verilog can be written: no number that a template is given runs below zero (the tests are built with
//! checks of that).

use crate::shipped::variants::with_every_word;
use nonius_codegen::generate;
use nonius_model::design::Design;
use nonius_model::spec::Multipliers;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_design_is_written(
        chip in 0..64usize,
        bits in 8..=18u32,
        full_scale in 0.5..3.0f64,
        gamma_first in 3..=12u32,
        gears in prop_oneof![Just(0u32), Just(1), 0..=15u32],
        gear_periods in prop_oneof![Just(1u32), Just(255), 1..=255u32],
        hold_periods in prop_oneof![Just(None), Just(Some(1u32)), (1..=4096u32).prop_map(Some)],
        residuals in (0.01..1.5f64, 0.01..1.5f64),
        count_bits in 32..=44u32,
        multipliers in 1..=9u32,
        promise in (0.0..0.3f64, 0.0..0.3f64, 0.0..15.0f64, 0.0..0.2f64),
        bandwidth_log2 in -3.0..1.5f64,
        rms_log2 in 0.0..6.0f64,
    ) {
        let chips = with_every_word();
        let mut spec = chips[chip % chips.len()].spec.clone();
        spec.adc.bits = bits;
        spec.adc.full_scale *= full_scale;
        let c = &mut spec.calibration;
        if c.is_on() {
            (c.gamma_first, c.gamma_last) = (gamma_first, Some((gamma_first + gears).min(18)));
            c.gear_periods = Some(gear_periods);
            (c.restart_residual, c.hold_residual) = residuals;
            c.recall = c.recall.filter(|recall| !recall || c.settles());
            c.hold_periods = hold_periods.filter(|_| c.settles());
        }
        spec.chip.count_bits = count_bits;
        spec.chip.multipliers = Multipliers::Count(multipliers);
        let s = &mut spec.sensor;
        (s.amplitude_tolerance, s.offset_max, s.phase_error_max_deg, s.bend_max) = promise;
        spec.tracking.bandwidth_hz *= bandwidth_log2.exp2();
        spec.accuracy.rms_periods *= rms_log2.exp2();
        if let Ok(design) = Design::new(&spec) {
            let written = generate(&design, "0", &[]).expect("templates render");
            prop_assert!(!written.files.is_empty());
        }
    }
}
