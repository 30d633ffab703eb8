//! The templates and what they are given.

use askama::Template;
use nonius_model::design::Design;
use nonius_model::graph::{Graph, Kind, NodeId};
use nonius_model::registers::STATUS;

use crate::layout;
use crate::netlist::{Netlist, Register, Section, meaning, width};
use crate::schedule::schedule_for;
use crate::shifter::Unit;
use crate::units::{Multiplier, Table};
use crate::writer::{Writer, range};

#[derive(Template)]
#[template(path = "chip.v")]
struct Chip<'a> {
    name: &'a str,
    title: Vec<String>,
    hash: &'a str,
    summary: String,
    timetable: Vec<String>,
    purpose: Vec<String>,
    constants: Vec<String>,
    ports: Vec<(String, String, String)>,
    state: &'a [Register],
    held: &'a [Register],
    loads: Vec<(String, String)>,
    kept: Vec<&'a Register>,
    multipliers: &'a [Multiplier],
    shifters: &'a [Unit],
    tables: &'a [Table],
    sections: &'a [Section],
    captures: &'a [(usize, Vec<String>)],
    commits: &'a [(String, String)],
    clocks: usize,
    step_bits: u32,
    alpha_bits: u32,
    unread: Vec<String>,
}

/// Range, name, bits.
type Signal = (String, String, u32);

#[derive(Template)]
#[template(path = "chip_tb.v")]
struct Testbench<'a> {
    name: &'a str,
    clocks: usize,
    adc_msb: u32,
    count_bits: u32,
    alpha_bits: u32,
    outputs: &'a [Signal],
    /// Where it stands (`chip.` or at a port), name, bits, in the order of the data flow.
    flow: Vec<Signal>,
    columns: &'a [Signal],
    fields: usize,
    /// Formats and variables of the columns, some at a time.
    scans: Vec<(String, String)>,
    stimuli: &'a [(String, usize)],
}

#[derive(Template)]
#[template(path = "example.v")]
struct Example<'a> {
    name: &'a str,
    /// The name where a comment begins with it.
    subject: String,
    clocks: usize,
    rate: f64,
    clock: f64,
    adc_msb: u32,
    count_bits: u32,
    alpha_bits: u32,
    outputs: &'a [Signal],
    idle: Vec<String>,
}

#[derive(Template)]
#[template(path = "chip.sdc")]
struct Constraints<'a> {
    name: &'a str,
    hash: &'a str,
    clocks: usize,
    rate: f64,
    clock: f64,
    megahertz: String,
    period: String,
}

/// The text files of a chip: path below the output folder, content.
pub struct Files {
    /// Path and content.
    pub files: Vec<(String, String)>,
    /// Clocks per sample.
    pub clocks: usize,
    /// Multipliers that the chip has.
    pub multipliers: usize,
    /// Columns of a vector row behind sample number and inputs: name, node, bits.
    pub columns: Vec<(String, NodeId, u32)>,
}

/// Everything that is compared after a sample: probes, then registers.
fn columns(design: &Design) -> Vec<(String, NodeId, u32)> {
    let graph = &design.graph;
    let register = |name: &str| graph.inputs.iter().find(|(n, _)| n == name);
    let registers = graph.next.iter().filter_map(|(name, _)| register(name));
    graph
        .probes
        .iter()
        .chain(registers)
        .map(|(name, id)| (name.clone(), *id, width(graph, *id)))
        .collect()
}

/// The columns in the order in which the sample computes them.
fn flow(graph: &Graph, columns: &[(String, NodeId, u32)]) -> Vec<Signal> {
    let mut flow: Vec<_> = columns.iter().collect();
    flow.sort_by_key(|(name, id, _)| {
        let next = graph.next.iter().find(|(register, _)| register == name);
        next.map_or(*id, |(_, id)| *id)
    });
    let place = |name: &str| if has_port(name) { "" } else { "chip." };
    flow.into_iter()
        .map(|(name, _, bits)| (place(name).into(), name.clone(), *bits))
        .collect()
}

/// Registers and probes that have a port of their own.
pub(crate) fn has_port(name: &str) -> bool {
    let parameter = name
        .strip_prefix("theta_")
        .is_some_and(|n| n.chars().all(|c| c.is_ascii_digit()));
    parameter || STATUS.contains(&name)
}

/// Format and variables of some columns.
fn scan(columns: &[(String, NodeId, u32)]) -> (String, String) {
    let variables: Vec<_> = columns.iter().map(|c| format!("expect_{}", c.0)).collect();
    (vec!["%h"; columns.len()].join(" "), variables.join(", "))
}

fn ports(
    design: &Design,
    clocks: usize,
    columns: &[(String, NodeId, u32)],
) -> Vec<(String, String, String)> {
    let f = &design.structure.formats;
    let adc = format!("[{}:0] ", design.spec.adc.bits - 1);
    let coding = if design.structure.offset_binary {
        "offset binary"
    } else {
        "two's complement"
    };
    let input = |range: &str, name: &str, what: String| {
        (format!("input  wire {range}"), format!("{name},"), what)
    };
    let mut list = vec![
        input(
            "",
            "clk",
            "every register changes at the rising edge".into(),
        ),
        input("", "rst_n", "asynchronous reset, active low".into()),
        input(
            "",
            "sample_valid",
            format!(
                "one clock per sample, {clocks} clocks apart or more; the inputs below are valid"
            ),
        ),
        input(
            &adc,
            "adc_cos",
            format!("code of the cosine channel, {coding}"),
        ),
        input(
            &adc,
            "adc_sin",
            format!("code of the sine channel, {coding}"),
        ),
        input(
            "",
            "preset",
            "this sample's period becomes number 0; clears lock_lost".into(),
        ),
        input(
            "",
            "calibrate",
            crate::about::calibrate(&design.spec).into(),
        ),
        (
            format!(
                "output wire signed [{}:0] ",
                f.count.format.width + f.alpha.format.width - 1
            ),
            "position,".into(),
            format!(
                "periods, s{}.{}: whole periods and alpha_hat for the next sample",
                f.count.format.width + f.alpha.format.width,
                f.alpha.format.width
            ),
        ),
    ];
    for (name, id, _) in columns.iter().filter(|c| has_port(&c.0)) {
        let node = design.graph.node(*id);
        let format = if node.kind == Kind::Flag {
            String::new()
        } else {
            format!(" {}", node.format)
        };
        list.push((
            format!("output reg {}", range(&design.graph, *id)),
            format!("{name},"),
            format!("{}{format}", meaning(name)),
        ));
    }
    list.push((
        "output reg ".into(),
        "valid".into(),
        "one clock per sample: the outputs are those of the sample".into(),
    ));
    list
}

/// Writes the Verilog of a design; `stimuli` are the names of the vector files and their rows.
///
/// # Errors
/// Only if a template fails to render, which is a defect of this crate.
pub fn generate(
    design: &Design,
    hash: &str,
    stimuli: &[(String, usize)],
) -> Result<Files, askama::Error> {
    let graph = &design.graph;
    let schedule = schedule_for(graph, design.spec.chip.multipliers);
    let writer = Writer::new(graph, &schedule);
    let tables = crate::units::tables(&writer);
    let netlist = Netlist::new(&writer);
    let multipliers = crate::units::multipliers(&writer);
    for m in &multipliers {
        writer.declare(&format!("product_{}", m.index), m.a + m.b);
    }
    let shifters = crate::shifter::units(&writer);
    let columns = columns(design);
    let name = design.spec.name.as_str();
    let kind = crate::about::kind(&design.spec);
    let description = design.spec.description.as_str();
    let separator = if description.is_empty() { "." } else { ": " };
    let title = layout::users_comment(&format!("{name}: {kind}{separator}{description}"));
    let adc_msb = design.spec.adc.bits - 1;
    let f = &design.structure.formats;
    for (port, id, bits) in &columns {
        if has_port(port) {
            writer.read(port, bits - 1, 0);
        }
        // Both parts of the position.
        if ["count", "alpha_hat"].contains(&port.as_str()) {
            writer.read(port, design.graph.node(*id).format.width - 1, 0);
        }
    }
    let offset_binary = design.structure.offset_binary;
    let loads = netlist.held.iter().map(|r| {
        let code = offset_binary && r.name.starts_with("adc_");
        let load = if code {
            format!("{{1'b0, {}}}", r.name)
        } else {
            r.name.clone()
        };
        (r.name.clone(), load)
    });
    let (clocks, rate) = (schedule.clocks, design.spec.adc.sample_rate_hz);
    let clock = rate * clocks as f64;
    let chip = Chip {
        name,
        title,
        hash,
        summary: format!(
            "{} products on {} multiplier{}, {clocks} clocks per sample",
            graph.products(),
            schedule.multipliers,
            if schedule.multipliers == 1 { "" } else { "s" }
        ),
        timetable: crate::units::timetable(&writer),
        purpose: crate::about::purpose(&design.spec),
        constants: crate::constants::listed(graph),
        ports: ports(design, clocks, &columns),
        state: &netlist
            .state
            .iter()
            .filter(|r| !has_port(&r.name))
            .cloned()
            .collect::<Vec<_>>(),
        held: &netlist.held,
        loads: loads.collect(),
        kept: netlist.kept.iter().filter(|r| !has_port(&r.name)).collect(),
        multipliers: &multipliers,
        shifters: &shifters,
        tables: &tables,
        sections: &netlist.sections,
        captures: &netlist.captures,
        commits: &netlist.commits,
        clocks,
        step_bits: crate::units::step_bits(&writer),
        alpha_bits: f.alpha.format.width,
        unread: writer.unread(),
    };
    let signals: Vec<Signal> = columns
        .iter()
        .map(|(name, id, bits)| (range(graph, *id), name.clone(), *bits))
        .collect();
    let outputs: Vec<Signal> = signals.iter().filter(|s| has_port(&s.1)).cloned().collect();
    let testbench = Testbench {
        name,
        clocks,
        adc_msb,
        count_bits: f.count.format.width,
        alpha_bits: f.alpha.format.width,
        outputs: &outputs,
        flow: flow(graph, &columns),
        columns: &signals,
        fields: columns.len() + 5,
        scans: columns.chunks(3).map(scan).collect(),
        stimuli,
    };
    let example = Example {
        name,
        subject: layout::no_order(name),
        clocks,
        rate,
        clock,
        adc_msb,
        count_bits: f.count.format.width,
        alpha_bits: f.alpha.format.width,
        outputs: &outputs,
        idle: outputs
            .iter()
            .map(|o| o.1.clone())
            .filter(|n| n != "locked" && n != "signal_lost")
            .collect(),
    };
    let given = design.spec.chip.clock_hz.unwrap_or(clock).max(clock);
    let constraints = Constraints {
        name,
        hash,
        clocks,
        rate,
        clock,
        // Neither may be slower than what is needed: up for the frequency, down for the period.
        megahertz: format!("{:.3}", (given / 1e3).ceil() / 1e3),
        period: format!("{:.3}", (1e12 / given).floor() / 1e3),
    };
    let mut files = vec![
        (format!("rtl/{name}.v"), chip.render()? + "\n"),
        (format!("rtl/{name}.sdc"), constraints.render()? + "\n"),
        (
            format!("example/{name}_example.v"),
            example.render()? + "\n",
        ),
        ("tb/chip_tb.v".into(), testbench.render()? + "\n"),
    ];
    files.extend(crate::tables::files(name, hash, graph));
    Ok(Files {
        files,
        clocks,
        multipliers: schedule.multipliers,
        columns,
    })
}
