//! Waves of the bit-true model (VCD): the signals of the Verilog under their names, samples as close as the chip allows.
//!
//! The model has no clock: its step is a sample. Clock, reset and strobes are drawn as the testbench drives them, with no pause between
//! samples; what the chip works out on its way through a sample stands where it commits, in the last clock.
//!
//! Every change is written as it comes, so that hours of samples need no memory.

use std::collections::HashMap;
use std::io::{self, Write};

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::graph::{Kind, NodeId};
use nonius_model::kernel::Probes;
use nonius_model::registers::STATUS;
use vcd::{IdCode, ReferenceIndex, TimescaleUnit, Value, VarType};

use crate::stimulus::Sample;

/// Clock period of the testbench in nanoseconds.
const CLOCK_NS: u64 = 10;
/// Reset lasts so many clocks in the testbench.
const RESET_CLOCKS: u64 = 2;

/// A signal of the chip: its name, its node, its bits.
type Column = (String, NodeId, u32);

/// Writes waves, sample by sample.
pub struct Waves<W: Write> {
    out: vcd::Writer<W>,
    /// Signal, identifier, fraction bits; no fraction for a flag.
    columns: Vec<(Column, IdCode, Option<u32>)>,
    inputs: [(IdCode, u32); 4],
    clk: IdCode,
    rst_n: IdCode,
    sample_valid: IdCode,
    valid: IdCode,
    position: (IdCode, u32),
    reals: [IdCode; 3],
    last: HashMap<IdCode, u128>,
    clocks: u64,
    samples: u64,
    phase_fraction: u32,
}

impl<W: Write> Waves<W> {
    /// Begins a file: the header, and everything at zero as after reset. `columns` and `clocks` as
    /// `nonius_codegen::generate` gives them.
    ///
    /// # Errors
    /// What writing says.
    pub fn new(out: W, design: &Design, columns: &[Column], clocks: usize) -> io::Result<Self> {
        let mut out = vcd::Writer::new(out);
        out.comment(&format!("bit-true model of {}", design.spec.name))?;
        out.timescale(1, TimescaleUnit::NS)?;
        let vector = |out: &mut vcd::Writer<W>, name: &str, bits: u32| {
            if bits == 1 {
                out.add_var(VarType::Wire, 1, name, None)
            } else {
                let range = ReferenceIndex::Range(bits as i32 - 1, 0);
                out.add_var(VarType::Wire, bits, name, Some(range))
            }
        };
        let f = &design.structure.formats;
        let position_bits = f.count.format.width + f.alpha.format.width;
        out.add_module("chip_tb")?;
        let reals = [
            out.add_var(VarType::Real, 64, "alpha_hat_turns", None)?,
            out.add_var(VarType::Real, 64, "position_periods", None)?,
            out.add_var(VarType::Real, 64, "speed_turns_per_sample", None)?,
        ];
        out.add_module("chip")?;
        let strobes = ["clk", "rst_n", "sample_valid", "valid"];
        let [clk, rst_n, sample_valid, valid] = strobes.map(|name| vector(&mut out, name, 1));
        let adc = design.spec.adc.bits;
        let inputs = [
            (vector(&mut out, "adc_cos", adc)?, adc),
            (vector(&mut out, "adc_sin", adc)?, adc),
            (vector(&mut out, "preset", 1)?, 1),
            (vector(&mut out, "calibrate", 1)?, 1),
        ];
        let position = (vector(&mut out, "position", position_bits)?, position_bits);
        let mut list = vec![];
        for column in columns {
            let node = design.graph.node(column.1);
            let fraction = (node.kind != Kind::Flag).then_some(node.format.fraction);
            let id = vector(&mut out, &column.0, column.2)?;
            list.push((column.clone(), id, fraction));
        }
        out.upscope()?;
        out.upscope()?;
        out.enddefinitions()?;
        let mut waves = Self {
            out,
            columns: list,
            inputs,
            clk: clk?,
            rst_n: rst_n?,
            sample_valid: sample_valid?,
            valid: valid?,
            position,
            reals,
            last: HashMap::new(),
            clocks: clocks as u64,
            samples: 0,
            phase_fraction: f.alpha.format.fraction,
        };
        waves.out.begin(vcd::SimulationCommand::Dumpvars)?;
        for (id, bits) in waves.inputs {
            waves.change(id, 0, bits)?;
        }
        for id in [waves.clk, waves.rst_n, waves.sample_valid, waves.valid] {
            waves.change(id, 0, 1)?;
        }
        waves.change(position.0, 0, position_bits)?;
        for i in 0..waves.columns.len() {
            let (id, bits) = (waves.columns[i].1, waves.columns[i].0.2);
            waves.change(id, 0, bits)?;
        }
        for id in waves.reals {
            waves.out.change_real(id, 0.0)?;
        }
        waves.out.end()?;
        for half in 1..2 * RESET_CLOCKS {
            waves.half(0, half)?;
        }
        Ok(waves)
    }

    /// One sample: what went in, and what the chip shows after it.
    ///
    /// # Errors
    /// What writing says.
    ///
    /// # Panics
    /// If a column is neither a probe nor a register, which is a defect of the generator.
    pub fn sample(
        &mut self,
        input: &Sample,
        probes: &Probes<Bits>,
        chip: &Chip<Bits>,
    ) -> io::Result<()> {
        let start = (RESET_CLOCKS + self.samples * self.clocks) * CLOCK_NS;
        self.samples += 1;
        self.half(start, 0)?;
        let values = [
            input.cos,
            input.sin,
            input.preset.into(),
            input.calibrate.into(),
        ];
        for ((id, bits), value) in self.inputs.into_iter().zip(values) {
            self.change(id, value.into(), bits)?;
        }
        self.change(self.rst_n, 1, 1)?;
        self.change(self.sample_valid, 1, 1)?;
        // The testbench changes its side of the pins at the falling edge of the clock, the chip at the rising one, and it
        // commits at that of its last clock.
        let last = 2 * self.clocks - 1;
        for half in 1..=last {
            self.half(start, half)?;
            match half {
                1 => self.change(self.valid, 0, 1)?,
                2 => self.change(self.sample_valid, 0, 1)?,
                _ => {}
            }
        }
        self.change(self.valid, 1, 1)?;
        for i in 0..self.columns.len() {
            let ((name, _, bits), code, fraction) = &self.columns[i];
            let (code, bits) = (*code, *bits);
            let raw = match fraction {
                None => {
                    let flag = probes.flag(name).or_else(|| chip.state.flag(name));
                    flag.map(i64::from)
                }
                Some(fraction) => {
                    let value = probes.value(name).or_else(|| chip.state.value(name));
                    value.map(|v| v.raw(*fraction))
                }
            };
            let raw = raw.expect("every column is a probe or a register");
            self.change(code, raw.into(), bits)?;
        }
        let raw = chip.position_raw();
        self.change(self.position.0, raw, self.position.1)?;
        let [alpha, position, speed] = self.reals;
        let scale = 2f64.powi(-(self.phase_fraction as i32));
        self.out.change_real(alpha, chip.state.alpha_hat.to_f64())?;
        self.out.change_real(position, raw as f64 * scale)?;
        self.out.change_real(speed, probes.speed.to_f64())
    }

    /// The end of the last sample.
    ///
    /// # Errors
    /// What writing says.
    pub fn finish(mut self) -> io::Result<()> {
        let end = (RESET_CLOCKS + self.samples * self.clocks) * CLOCK_NS;
        self.half(end, 0)?;
        self.out.flush()
    }

    /// So many half clocks after `start`; the clock falls at even ones.
    fn half(&mut self, start: u64, half: u64) -> io::Result<()> {
        self.out.timestamp(start + half * CLOCK_NS / 2)?;
        self.change(self.clk, (half % 2).into(), 1)
    }

    fn change(&mut self, id: IdCode, raw: i128, bits: u32) -> io::Result<()> {
        let word = raw as u128 & ((1u128 << bits) - 1);
        if self.last.insert(id, word) == Some(word) {
            return Ok(());
        }
        let bit = |b: u32| Value::from(word >> b & 1 == 1);
        if bits == 1 {
            self.out.change_scalar(id, bit(0))
        } else {
            self.out.change_vector(id, (0..bits).rev().map(bit))
        }
    }
}

/// What the loop makes of a pair and remembers; all else is calibration.
const LOOP: [&str; 20] = [
    "y_c",
    "y_s",
    "skew",
    "harmonic_cos",
    "harmonic_sin",
    "c",
    "s",
    "cos_hat",
    "sin_hat",
    "e",
    "rho",
    "in_window",
    "alpha_hat",
    "alpha_hat_previous",
    "count",
    "rate",
    "error_previous",
    "lock_level",
    "loop_gear",
    "unlocked_samples",
];

/// A GTKWave save file, `name`.gtkw, that shows the waves in `name`.vcd beside it sensibly: position and phase as curves, then inputs, outputs,
/// the signals of the loop, those of the calibration.
#[must_use]
pub fn gtkw(name: &str, design: &Design, columns: &[Column], clocks: usize) -> String {
    // GTKWave's flags: right justified, signed, analogue step, full scale; a stretched blank gives a curve height.
    const CURVE: &str = "@88420";
    const SIGNED: &str = "@420";
    const FLAG: &str = "@28";
    const HEX: &str = "@22";
    const TITLE: &str = "@200";
    let mut out = format!(
        // With the place of this file GTKWave finds the waves beside it, wherever it was started.
        "[dumpfile] \"{name}.vcd\"\n[savefile] \"{name}.gtkw\"\n[timestart] 0\n*-{:.1} 0 -1\n[sst_expanded] 1\n",
        (clocks as f64 * CLOCK_NS as f64 * 8.0).log2()
    );
    let mut curve = |name: &str| {
        out += &format!("{CURVE}\n{name}\n@20000\n-\n-\n-\n");
    };
    for name in [
        "position_periods",
        "alpha_hat_turns",
        "speed_turns_per_sample",
    ] {
        curve(&format!("chip_tb.{name}"));
    }
    for name in ["c", "s", "e", "rho"] {
        if let Some((_, _, bits)) = columns.iter().find(|c| c.0 == name) {
            curve(&format!("chip_tb.chip.{name}[{}:0]", bits - 1));
        }
    }
    let adc = design.spec.adc.bits - 1;
    out += &format!(
        "{TITLE}\n-inputs\n{SIGNED}\nchip_tb.chip.adc_cos[{adc}:0]\nchip_tb.chip.adc_sin[{adc}:0]\n{FLAG}\nchip_tb.chip.clk\nchip_tb.chip.rst_n\nchip_tb.chip.sample_valid\nchip_tb.chip.preset\nchip_tb.chip.calibrate\n"
    );
    let f = &design.structure.formats;
    out += &format!(
        "{TITLE}\n-outputs\n{FLAG}\nchip_tb.chip.valid\n{HEX}\nchip_tb.chip.position[{}:0]\n",
        f.count.format.width + f.alpha.format.width - 1
    );
    let group = |title: &str, member: &dyn Fn(&str) -> bool| {
        let mut text = format!("{TITLE}\n-{title}\n");
        for (name, _, bits) in columns.iter().filter(|c| member(&c.0)) {
            text += &if *bits == 1 {
                format!("{FLAG}\nchip_tb.chip.{name}\n")
            } else {
                format!("{SIGNED}\nchip_tb.chip.{name}[{}:0]\n", bits - 1)
            };
        }
        text
    };
    let of_calibration = |n: &str| !STATUS.contains(&n) && !LOOP.contains(&n);
    out += &group("flags and speed", &|n| STATUS.contains(&n));
    out += &group("loop", &|n| LOOP.contains(&n));
    out += &group("calibration", &of_calibration);
    out
}
