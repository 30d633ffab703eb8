//! The recorded graph beside the chip.

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::graph::Evaluation;
use nonius_model::kernel::Input;
use nonius_model::registers::{format, registers};

/// Every register and probe of both, in every bit, over so many samples of `codes`, with presets and without calibration at
/// times.
#[track_caller]
pub(crate) fn graph_equals_chip(design: &Design, codes: impl Fn(u32) -> [i64; 2], samples: u32) {
    let bits = design.spec.adc.bits;
    let mut chip = Chip::bit_true(design);
    let (values, flags) = registers(&design.structure);
    for k in 0..samples {
        let [cos, sin] = codes(k);
        let before = chip.state;
        let input = Input {
            adc_cos: Bits::from_raw(cos, bits),
            adc_sin: Bits::from_raw(sin, bits),
            preset: k % 977 == 0,
            calibrate: k % 500 > 20,
        };
        let probes = chip.step(&input);
        let evaluation = Evaluation::new(&design.graph, |name| match name {
            "adc_cos" => cos.into(),
            "adc_sin" => sin.into(),
            "preset" => input.preset.into(),
            "calibrate" => input.calibrate.into(),
            name => before.flag(name).map(i128::from).unwrap_or_else(|| {
                let fraction = format(name, &design.structure).map_or(0, |f| f.fraction);
                before.value(name).map_or(0, |v| v.raw(fraction).into())
            }),
        });
        for (name, node) in &design.graph.next {
            let expected = if flags.contains(&name.as_str()) {
                chip.state.flag(name).map(i128::from)
            } else {
                assert!(values.contains(&name.as_str()));
                let fraction = format(name, &design.structure).map_or(0, |f| f.fraction);
                assert_eq!(fraction, design.graph.node(*node).format.fraction, "{name}");
                chip.state.value(name).map(|v| v.raw(fraction).into())
            };
            assert_eq!(
                Some(evaluation.raw(*node)),
                expected,
                "register {name} at sample {k}"
            );
        }
        for (name, node) in &design.graph.probes {
            let fraction = design.graph.node(*node).format.fraction;
            let expected = probes
                .flag(name)
                .map(i128::from)
                .or(probes.value(name).map(|v| v.raw(fraction).into()));
            assert_eq!(
                Some(evaluation.raw(*node)),
                expected,
                "probe {name} at sample {k}"
            );
        }
    }
}
