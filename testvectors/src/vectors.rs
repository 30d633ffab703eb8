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

/// The rows of a stimulus. `columns` names what the testbench compares: `seen_` probes and `reg_` registers after the
/// sample, each with its node and bits.
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
            let flag = entry.kind == Kind::Flag;
            let raw = match (column.strip_prefix("seen_"), column.strip_prefix("reg_")) {
                (Some(name), _) if flag => probes.flag(name).map(i64::from),
                (Some(name), _) => probes.value(name).map(|v| v.raw(entry.format.fraction)),
                (_, Some(name)) if flag => chip.state.flag(name).map(i64::from),
                (_, Some(name)) => chip.state.value(name).map(|v| v.raw(entry.format.fraction)),
                _ => None,
            };
            hex(&mut out, raw.unwrap_or_default(), *bits);
        }
        out.push('\n');
    }
    out
}
