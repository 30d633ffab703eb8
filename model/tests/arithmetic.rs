//! The bit-true reading computes on whole containers; every step of it is the exact arithmetic of integers, cut to its format.

use nonius_model::bits::Bits;
use nonius_model::format::{Format, Overflow, Quantiser, Rounding};
use nonius_model::graph::Recorder;
use nonius_model::signal::{Signal, Wide};
use proptest::prelude::*;

/// A word of the chip: at most seven bits before the point, so that products of two stay in the container.
fn word() -> impl Strategy<Value = (i64, u32)> {
    (1u32..24, 0i32..7).prop_flat_map(|(width, integer)| {
        let half = 1i64 << (width - 1);
        let fraction = (width as i32 - integer).max(0) as u32;
        (-half..half, Just(fraction))
    })
}

fn quantiser() -> impl Strategy<Value = Quantiser> {
    let rounding = prop::sample::select(vec![Rounding::Nearest, Rounding::Floor, Rounding::Grid]);
    let overflow = prop::sample::select(vec![Overflow::Saturate, Overflow::Wrap]);
    (any::<bool>(), 1u32..40, 0u32..48, rounding, overflow)
        // Words with more digits before the point than the container has do not pass the analysis.
        .prop_filter("in the container", |(_, width, fraction, ..)| {
            *width < fraction + 15
        })
        .prop_map(|(signed, width, fraction, rounding, overflow)| {
            let format = Format {
                signed,
                width: width + u32::from(signed),
                fraction,
            };
            Quantiser::new(format, rounding, overflow)
        })
}

fn bits((raw, fraction): (i64, u32)) -> Bits {
    Bits::from_raw(raw, fraction)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn a_value_is_cut_to_its_format(word in word(), to in quantiser()) {
        let expected = to.apply(word.0.into(), word.1);
        prop_assert_eq!(i128::from(bits(word).quantise(&to).raw(to.format.fraction)), expected);
    }

    #[test]
    fn a_product_and_a_sum_of_two_are_exact_until_cut(a in word(), b in word(), c in word(), to in quantiser()) {
        let product = i128::from(a.0) * i128::from(b.0);
        let fraction = a.1 + b.1;
        let cut = (bits(a) * bits(b)).quantise(&to);
        prop_assert_eq!(i128::from(cut.raw(to.format.fraction)), to.apply(product, fraction));
        let fine = fraction.max(c.1);
        let sum = (product << (fine - fraction)) + (i128::from(c.0) << (fine - c.1));
        let cut = (bits(a) * bits(b) + bits(c).widen()).quantise(&to);
        prop_assert_eq!(i128::from(cut.raw(to.format.fraction)), to.apply(sum, fine));
    }

    #[test]
    fn a_geared_product_is_rounded_once(a in word(), b in word(), gear in 0i64..8, stride in 1u32..4, to in quantiser()) {
        let product = i128::from(a.0) * i128::from(b.0);
        let cut = (bits(a) * bits(b)).quantise_geared(Bits::from_raw(gear, 0), stride, 7, &to);
        let slower = to.apply(product, a.1 + b.1 + stride * gear as u32);
        prop_assert_eq!(i128::from(cut.raw(to.format.fraction)), slower);
    }

    #[test]
    fn a_product_is_scaled_by_powers_of_two(a in word(), b in word(), power in -20i32..6, to in quantiser()) {
        let product = i128::from(a.0) * i128::from(b.0);
        let fraction = (a.1 + b.1) as i32 - power;
        let (product, fraction) = (product << (-fraction).max(0), fraction.max(0) as u32);
        prop_assume!(product.unsigned_abs() >> fraction < 1 << 14);
        let cut = Wide::scale(bits(a) * bits(b), power).quantise(&to);
        prop_assert_eq!(i128::from(cut.raw(to.format.fraction)), to.apply(product, fraction));
    }
}

/// A product is cut off at the container's last bit, so a chip that would round one there is refused.
#[test]
fn a_product_ends_before_the_containers_last_bit() {
    let rounded_to = |fraction: u32, rounding| {
        let recorder = Recorder::new();
        let signal = recorder.input("signal", Format::signed(26, 25));
        let cut = Quantiser::new(Format::signed(50, fraction), rounding, Overflow::Saturate);
        recorder.probe("square", (signal * signal).quantise(&cut).id);
        recorder.finish()
    };
    assert!(rounded_to(47, Rounding::Nearest).is_ok());
    assert!(rounded_to(48, Rounding::Floor).is_ok());
    let refused = rounded_to(48, Rounding::Nearest).expect_err("nothing to round with");
    assert!(
        refused.to_string().contains("does not fit s62.47"),
        "{refused}"
    );
}

/// What does not fit is named with what it is made of, with its steps, and with the way out.
#[test]
fn a_value_that_does_not_fit_is_named() {
    let recorder = Recorder::new();
    let signal = recorder.input("signal", Format::signed(26, 25));
    recorder.probe("small", signal.scale(-24).id);
    let refused = recorder.finish().expect_err("too fine").to_string();
    for words in [
        "does not fit s63.48",
        "in steps of 2^-49",
        "signal is -1 … ",
        "[formats]",
    ] {
        assert!(refused.contains(words), "{refused}");
    }
    assert!(!refused.contains("operand"), "{refused}");
}
