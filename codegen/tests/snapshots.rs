//! Chips small enough to review as a whole: what a change of the generator does to the Verilog shows in the commit.

use crate::shipped;
use nonius_codegen::generate;
use nonius_model::design::Design;
use nonius_model::spec::{All, Coding, Multipliers, Spec};

/// The shipped optical design at 8 bits, altered.
fn verilog(change: impl Fn(&mut Spec)) -> String {
    let mut spec = shipped::optical();
    spec.adc.bits = 8;
    spec.sensor.noise_rms = 0.0;
    spec.accuracy.rms_periods = 1e-3;
    change(&mut spec);
    let design = Design::new(&spec).expect("a design that works");
    let chip = generate(&design, "hash", &[]).expect("templates render");
    let file = chip.files.iter().find(|f| f.0 == "rtl/optical.v");
    file.expect("the chip").1.clone()
}

#[test]
fn method_1_without_calibration_on_all_multipliers() {
    insta::assert_snapshot!(verilog(|s| {
        s.tracking.method = 1;
        s.tracking.filter_type = 1;
        s.sensor.speed_max_periods_per_s = 1e3;
        s.calibration.parameters = 0;
        s.chip.multipliers = Multipliers::All(All::All);
    }));
}

#[test]
fn method_2_with_four_parameters_on_one_multiplier() {
    insta::assert_snapshot!(verilog(|s| {
        s.tracking.method = 2;
        s.tracking.filter_type = 1;
        s.sensor.speed_max_periods_per_s = 1e3;
        s.calibration.parameters = 4;
        s.adc.coding = Coding::OffsetBinary;
    }));
}

#[test]
fn method_3_with_five_parameters_on_two_multipliers() {
    insta::assert_snapshot!(verilog(|s| s.chip.multipliers = Multipliers::Count(2)));
}
