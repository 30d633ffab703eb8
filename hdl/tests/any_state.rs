//! One sample from any state: every register is set to any value of its range, its ends among them, and the Verilog
//! goes on from there as the recorded graph does. No run from reset comes to most of these: the count of periods wraps
//! after years.

use std::collections::HashMap;
use std::fmt::Write;
use std::fs;

use crate::chip::{self, shipped::variants::kinds};
use nonius_hdl::verify::{Options, verify};
use nonius_kept::{every, figure_of_all, long};
use nonius_model::design::Design;
use nonius_model::graph::Evaluation;
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

const ROWS: usize = 1000;

/// A register or an input of the chip.
struct Word {
    name: String,
    bits: u32,
    range: (i128, i128),
}

impl Word {
    /// Half of them somewhere, a quarter at each end or next to it.
    fn draw(&self, random: &mut StdRng) -> i128 {
        let (low, high) = self.range;
        let near = random.random_range(0..=1);
        match random.random_range(0..4) {
            0 => (low + near).min(high),
            1 => (high - near).max(low),
            _ => random.random_range(low..=high),
        }
    }
}

fn hex(raw: i128, bits: u32) -> String {
    format!("{:x}", raw as u128 & ((1 << bits) - 1))
}

fn reg(prefix: &str, name: &str, bits: u32) -> String {
    format!("    reg [{}:0] {prefix}_{name};\n", bits - 1)
}

/// Plays rows of inputs, all registers before the sample, and everything that is compared after it.
fn testbench(design: &Design, words: &[Word], columns: &[(String, u32)]) -> String {
    let module = &design.spec.name;
    let (mut regs, mut set, mut compare) = (String::new(), String::new(), String::new());
    let (mut format, mut into) = (String::new(), String::new());
    for Word { name, bits, .. } in words {
        regs += &reg("before", name, *bits);
        format += "%h ";
        write!(into, ", before_{name}").expect("text");
        let to = match name.as_str() {
            "adc_cos" | "adc_sin" | "preset" | "calibrate" => name.clone(),
            register => format!("chip.{register}"),
        };
        writeln!(set, "            {to} = before_{name};").expect("text");
    }
    for (name, bits) in columns {
        regs += &reg("expect", name, *bits);
        format += "%h ";
        write!(into, ", expect_{name}").expect("text");
        writeln!(
            compare,
            "            if (!bad && chip.{name} !== expect_{name}) begin\n                bad = 1'b1;\n                \
             $display(\"signal {name} row %0d expected %0h actual %0h\", played, expect_{name}, chip.{name});\n            end"
        )
        .expect("text");
    }
    let adc = design.spec.adc.bits - 1;
    let format = format.trim_end();
    let fields = words.len() + columns.len();
    format!(
        "`timescale 1ns / 1ps
module chip_tb;
    reg clk = 1'b0;
    initial forever #5 clk = ~clk;
    reg rst_n = 1'b0, sample_valid = 1'b0, preset = 1'b0, calibrate = 1'b0;
    reg [{adc}:0] adc_cos = 0, adc_sin = 0;
    wire valid;
    {module} chip (.clk(clk), .rst_n(rst_n), .sample_valid(sample_valid), .adc_cos(adc_cos), .adc_sin(adc_sin),
        .preset(preset), .calibrate(calibrate), .valid(valid));
{regs}
    integer file, waited, played;
    reg bad = 1'b0;
    initial begin
        file = $fopen(\"vectors/any_state.vec\", \"r\");
        @(negedge clk);
        rst_n = 1'b1;
        played = 0;
        while (!bad && $fscanf(file, \"{format}\"{into}) == {fields}) begin
            @(negedge clk);
{set}            @(negedge clk);
            sample_valid = 1'b1;
            @(negedge clk);
            sample_valid = 1'b0;
            waited = 0;
            while (!valid && waited < 1000) begin
                @(negedge clk);
                waited = waited + 1;
            end
            bad = !valid;
{compare}            played = played + 1;
        end
        if (bad || played != {ROWS}) $display(\"FAIL any_state\\nFAIL\");
        else $display(\"PASS any_state: %0d samples\\nPASS\", played);
        $finish(0);
    end
endmodule
"
    )
}

fn goes_on(kind: &str, design: &Design, options: &Options, random: &mut StdRng) {
    let graph = &design.graph;
    let files = nonius_codegen::generate(design, "any state", &[]).expect("templates render");
    let words: Vec<Word> = graph
        .inputs
        .iter()
        .map(|(name, id)| {
            let column = files.columns.iter().find(|c| c.0 == *name);
            let bits = match name.as_str() {
                "adc_cos" | "adc_sin" => design.spec.adc.bits,
                "preset" | "calibrate" => 1,
                _ => column.expect("every register is compared").2,
            };
            let (name, range) = (name.clone(), graph.node(*id).range);
            Word { name, bits, range }
        })
        .collect();
    let mut rows = String::new();
    let mut wraps = 0;
    for _ in 0..ROWS {
        let state: HashMap<&str, i128> = words
            .iter()
            .map(|w| (w.name.as_str(), w.draw(random)))
            .collect();
        let next = Evaluation::new(graph, |name| state[name]);
        for word in &words {
            write!(rows, "{} ", hex(state[word.name.as_str()], word.bits)).expect("text");
        }
        for (name, id, bits) in &files.columns {
            let after = graph.next.iter().find(|n| n.0 == *name).map(|n| n.1);
            let raw = next.raw(after.unwrap_or(*id));
            write!(rows, "{} ", hex(raw, *bits)).expect("text");
            wraps += usize::from(name == "count" && (raw - state["count"]).abs() > 1 << 30);
        }
        rows += "\n";
    }
    assert!(wraps > 0, "{kind}: the count never wraps");

    // A chip as it is built, but for what is played.
    let dir = tempfile::tempdir().expect("a scratch folder");
    chip::write(&design.spec, 2, dir.path());
    fs::remove_dir_all(dir.path().join("vectors")).expect("vectors");
    fs::create_dir(dir.path().join("vectors")).expect("a folder");
    let write = |path: &str, text: &str| fs::write(dir.path().join(path), text).expect("a file");
    let columns: Vec<_> = files.columns.iter().map(|c| (c.0.clone(), c.2)).collect();
    write("tb/chip_tb.v", &testbench(design, &words, &columns));
    write("vectors/any_state.vec", &rows);
    let report = verify(dir.path(), options, &nonius_hdl::progress::silent);
    let report = report.unwrap_or_else(|e| panic!("{kind}: {e}"));
    assert!(report.passed, "{kind}: {report:#?}");
    for run in report.runs {
        assert_eq!(run.samples, Some(ROWS as u64), "{kind}");
    }
}

/// Every second kind of chip, whose searches are not those of bit_exact.rs; in the long form all.
#[test]
fn from_any_state_the_verilog_goes_on_as_the_graph() {
    let all = kinds().len();
    let kinds: Vec<_> = every(2, kinds().into_iter().skip(usize::from(!long()))).collect();
    kinds.par_iter().enumerate().for_each(|(i, kind)| {
        let mut random = StdRng::seed_from_u64(11);
        // Icarus takes most of the time.
        let options = Options {
            icarus: i % 4 == 0,
            ..Options::PATIENT
        };
        goes_on(&kind.what, &kind.design(), &options, &mut random);
    });
    figure_of_all(
        "every register set to any value of its range, one sample on: the graph and the Verilog agree",
        &format!("{all} chips, {ROWS} states each"),
        "hdl/tests/any_state.rs",
    );
}
