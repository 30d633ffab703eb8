//! Lint, check, area and clock of a toy chip.

use crate::support::Toy;
use nonius_hdl::place::{Device, place};
use nonius_hdl::progress::silent;
use nonius_hdl::{verilator, yosys};

#[test]
fn verilators_lint_is_clean_and_finds_a_width() {
    let lint = |toy: &Toy| verilator::lint(&toy.open()).unwrap_or_else(|it| panic!("{it}"));
    assert_eq!(lint(&Toy::new()), Vec::<String>::new());
    let narrow = Toy::new().replace("rtl/adder_core.v", "9'sd0", "8'sd0");
    let warnings = lint(&narrow);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].starts_with("%Warning-WIDTH"), "{warnings:?}");
}

#[test]
fn yosys_check_is_clean_and_finds_a_net_that_nothing_drives() {
    let check = |toy: &Toy| yosys::check(&toy.open()).unwrap_or_else(|it| panic!("{it}"));
    let clean = check(&Toy::new());
    assert!(clean.passed, "{clean:?}");
    assert_eq!(clean.warnings, Vec::<String>::new());

    let undriven = check(&Toy::new().replace(
        "rtl/adder_core.v",
        "assign negative = total[8]",
        "wire loose; assign negative = loose",
    ));
    assert!(!undriven.passed);
    assert!(
        undriven.warnings.iter().any(|it| it.contains("loose")),
        "{undriven:?}"
    );
}

#[test]
fn the_toy_is_placed_and_its_cells_are_counted_without_the_harness() {
    for device in [Device::Hx8k, Device::Up5k] {
        let placed =
            place(&Toy::new().open(), device, &[1, 2], &silent).unwrap_or_else(|it| panic!("{it}"));
        // total and valid; 17 input bits and the pin's own, 10 output bits, and `load`.
        assert_eq!(placed.chip.ff, 10);
        assert_eq!(placed.harness.ff, 18 + 10 + 1);
        assert!((9..=20).contains(&placed.chip.lut4), "{placed:?}");
        assert_eq!(placed.placements.len(), 2);
        assert!(placed.best_mhz.expect("a clock") > 20.0, "{placed:?}");
        assert!(placed.placements[0].logic_cells.expect("a count") >= 39);
    }
}

/// Without placing: Debian has no nextpnr for it.
#[test]
fn the_toy_is_mapped_to_an_ecp5() {
    let placed =
        place(&Toy::new().open(), Device::Ecp5, &[], &silent).unwrap_or_else(|it| panic!("{it}"));
    assert_eq!(placed.chip.ff, 10);
    assert_eq!(placed.harness.ff, 18 + 10 + 1);
    // Nine bits of sum, two in each carry cell.
    assert!((4..=6).contains(&placed.chip.carry), "{placed:?}");
    assert!(placed.placements.is_empty() && placed.best_mhz.is_none());
}

#[test]
fn outputs_that_repeat_each_other_keep_their_logic() {
    let twice = Toy::new()
        .replace(
            "rtl/adder.v",
            "output wire signed [8:0] total,",
            "output wire signed [8:0] total, output wire signed [8:0] again,",
        )
        .replace(
            "rtl/adder.v",
            "    wire negative;\n",
            "    wire negative;\n    assign again = total;\n",
        );
    let once = place(&Toy::new().open(), Device::Hx8k, &[1], &silent).expect("the tools run");
    let twice = place(&twice.open(), Device::Hx8k, &[1], &silent).expect("the tools run");
    assert_eq!(once.chip, twice.chip);
    assert_eq!(twice.harness.ff, once.harness.ff + 9);
}
