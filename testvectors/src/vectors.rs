//! Vector files: one row per sample, hexadecimal columns: sample number, inputs, every probe and every register.

use std::fmt::Write;

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::graph::{Kind, NodeId};

use crate::stimulus::Stimulus;

fn hex(out: &mut String, raw: i64, bits: u32) {
    let mask = if bits >= 64 {
        u64::MAX
    } else {
        (1u64 << bits) - 1
    };
    let _ = write!(out, " {:x}", raw as u64 & mask);
}

/// The rows of a stimulus. `columns` names what the testbench compares: probes of the sample and registers after it,
/// each with its node and bits.
///
/// # Panics
/// If a column is neither a probe nor a register, which is a defect of the generator.
#[must_use]
pub fn rows(design: &Design, stimulus: &Stimulus, columns: &[(String, NodeId, u32)]) -> String {
    let mut chip = Chip::bit_true(design);
    let mut out = String::new();
    for (number, sample) in stimulus.samples.iter().enumerate() {
        let probes = chip.step_codes(sample.cos, sample.sin, sample.preset, sample.calibrate);
        let _ = write!(out, "{number:x}");
        hex(&mut out, sample.cos, design.spec.adc.bits);
        hex(&mut out, sample.sin, design.spec.adc.bits);
        hex(&mut out, sample.preset.into(), 1);
        hex(&mut out, sample.calibrate.into(), 1);
        for (column, id, bits) in columns {
            let entry = design.graph.node(*id);
            let raw = if entry.kind == Kind::Flag {
                let flag = probes.flag(column).or_else(|| chip.state.flag(column));
                flag.map(i64::from)
            } else {
                let value = probes.value(column).or_else(|| chip.state.value(column));
                value.map(|v| v.raw(entry.format.fraction))
            };
            let raw = raw.expect("every column is a probe or a register");
            hex(&mut out, raw, *bits);
        }
        out.push('\n');
    }
    out
}
