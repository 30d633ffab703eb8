//! The templates and what they are given.

use askama::Template;
use nonius_model::design::Design;
use nonius_model::graph::{Graph, NodeId};

use crate::layout;
use crate::netlist::{Netlist, Register, Section, width};
use crate::ports::{has_port, ports};
use crate::schedule::{Schedule, schedule_for};
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

/// Format and variables of some columns.
fn scan(columns: &[(String, NodeId, u32)]) -> (String, String) {
    let variables: Vec<_> = columns.iter().map(|c| format!("expect_{}", c.0)).collect();
    (vec!["%h"; columns.len()].join(" "), variables.join(", "))
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
    let schedule = schedule_for(&design.graph, design.spec.chip.multipliers);
    let (name, columns) = (design.spec.name.as_str(), columns(design));
    let texts = Texts::new(design, hash, &schedule, &columns);
    let mut files = vec![
        (format!("rtl/{name}.v"), texts.chip()? + "\n"),
        (format!("rtl/{name}.sdc"), texts.constraints()? + "\n"),
        (format!("example/{name}_example.v"), texts.example()? + "\n"),
        ("tb/chip_tb.v".into(), texts.testbench(stimuli)? + "\n"),
    ];
    files.extend(crate::tables::files(name, hash, &design.graph));
    Ok(Files {
        files,
        clocks: schedule.clocks,
        multipliers: schedule.multipliers,
        columns,
    })
}

/// What the text files of a chip are written from.
struct Texts<'a> {
    design: &'a Design,
    hash: &'a str,
    schedule: &'a Schedule,
    columns: &'a [(String, NodeId, u32)],
    /// The columns as the templates have them.
    signals: Vec<Signal>,
    /// Those that have a port.
    outputs: Vec<Signal>,
    name: &'a str,
    clocks: usize,
    /// Samples per second.
    rate: f64,
    /// Clocks per second that these need.
    clock: f64,
    adc_msb: u32,
    count_bits: u32,
    alpha_bits: u32,
}

impl<'a> Texts<'a> {
    fn new(
        design: &'a Design,
        hash: &'a str,
        schedule: &'a Schedule,
        columns: &'a [(String, NodeId, u32)],
    ) -> Self {
        let signal = |(name, id, bits): &(String, NodeId, u32)| {
            (range(&design.graph, *id), name.clone(), *bits)
        };
        let signals: Vec<Signal> = columns.iter().map(signal).collect();
        let outputs = signals.iter().filter(|s| has_port(&s.1)).cloned().collect();
        let (clocks, rate) = (schedule.clocks, design.spec.adc.sample_rate_hz);
        let formats = &design.structure.formats;
        Self {
            design,
            hash,
            schedule,
            columns,
            signals,
            outputs,
            name: &design.spec.name,
            clocks,
            rate,
            clock: rate * clocks as f64,
            adc_msb: design.spec.adc.bits - 1,
            count_bits: formats.count.format.width,
            alpha_bits: formats.alpha.format.width,
        }
    }

    /// The chip itself. What its parts declare and read is noted on the way: `unread` is asked last.
    fn chip(&self) -> Result<String, askama::Error> {
        let (design, graph) = (self.design, &self.design.graph);
        let writer = Writer::new(graph, self.schedule);
        let tables = crate::units::tables(&writer);
        let netlist = Netlist::new(&writer);
        let multipliers = crate::units::multipliers(&writer);
        for m in &multipliers {
            writer.declare(&format!("product_{}", m.index), m.a + m.b);
        }
        let shifters = crate::shifter::units(&writer);
        self.read_at_ports(&writer);
        let without_port = |r: &&Register| !has_port(&r.name);
        let state: Vec<_> = netlist.state.iter().filter(without_port).cloned().collect();
        let chip = Chip {
            name: self.name,
            title: title(design),
            hash: self.hash,
            summary: self.summary(),
            timetable: crate::units::timetable(&writer),
            purpose: crate::about::purpose(&design.spec),
            constants: crate::constants::listed(graph),
            ports: ports(design, self.clocks, self.columns),
            state: &state,
            held: &netlist.held,
            loads: loads(&netlist.held, design.structure.offset_binary),
            kept: netlist.kept.iter().filter(without_port).collect(),
            multipliers: &multipliers,
            shifters: &shifters,
            tables: &tables,
            sections: &netlist.sections,
            captures: &netlist.captures,
            commits: &netlist.commits,
            clocks: self.clocks,
            step_bits: crate::units::step_bits(&writer),
            alpha_bits: self.alpha_bits,
            unread: writer.unread(),
        };
        chip.render()
    }

    /// Notes that what has a port is read there, and both parts of the position.
    fn read_at_ports(&self, writer: &Writer) {
        for (port, id, bits) in self.columns {
            if has_port(port) {
                writer.read(port, bits - 1, 0);
            }
            if ["count", "alpha_hat"].contains(&port.as_str()) {
                writer.read(port, self.design.graph.node(*id).format.width - 1, 0);
            }
        }
    }

    /// What the chip is made of, in a line.
    fn summary(&self) -> String {
        let multipliers = self.schedule.multipliers;
        format!(
            "{} products on {multipliers} multiplier{}, {} clocks per sample",
            self.design.graph.products(),
            if multipliers == 1 { "" } else { "s" },
            self.clocks
        )
    }

    /// The testbench, which plays the vector files.
    fn testbench(&self, stimuli: &[(String, usize)]) -> Result<String, askama::Error> {
        let testbench = Testbench {
            name: self.name,
            clocks: self.clocks,
            adc_msb: self.adc_msb,
            count_bits: self.count_bits,
            alpha_bits: self.alpha_bits,
            outputs: &self.outputs,
            flow: flow(&self.design.graph, self.columns),
            columns: &self.signals,
            fields: self.columns.len() + 5,
            scans: self.columns.chunks(3).map(scan).collect(),
            stimuli,
        };
        testbench.render()
    }

    /// A module that has the chip in it, to begin with.
    fn example(&self) -> Result<String, askama::Error> {
        let idle = self.outputs.iter().map(|output| output.1.clone());
        let example = Example {
            name: self.name,
            subject: layout::no_order(self.name),
            clocks: self.clocks,
            rate: self.rate,
            clock: self.clock,
            adc_msb: self.adc_msb,
            count_bits: self.count_bits,
            alpha_bits: self.alpha_bits,
            outputs: &self.outputs,
            idle: idle
                .filter(|name| name != "locked" && name != "signal_lost")
                .collect(),
        };
        example.render()
    }

    /// The constraints of a synthesis: the clock that is there, which is as fast as the samples need or faster.
    fn constraints(&self) -> Result<String, askama::Error> {
        let clock = self.clock;
        let given = self.design.spec.chip.clock_hz.unwrap_or(clock).max(clock);
        let constraints = Constraints {
            name: self.name,
            hash: self.hash,
            clocks: self.clocks,
            rate: self.rate,
            clock,
            // Neither may be slower than what is needed: up for the frequency, down for the period.
            megahertz: format!("{:.3}", (given / 1e3).ceil() / 1e3),
            period: format!("{:.3}", (1e12 / given).floor() / 1e3),
        };
        constraints.render()
    }
}

/// Name, kind and description, as a comment.
fn title(design: &Design) -> Vec<String> {
    let (name, description) = (&design.spec.name, design.spec.description.as_str());
    let kind = crate::about::kind(&design.spec);
    let separator = if description.is_empty() { "." } else { ": " };
    layout::users_comment(&format!("{name}: {kind}{separator}{description}"))
}

/// What each held register takes of its pin: codes of offset binary as they are, without a sign.
fn loads(held: &[Register], offset_binary: bool) -> Vec<(String, String)> {
    let load = |name: &String| {
        let code = offset_binary && name.starts_with("adc_");
        let load = if code {
            format!("{{1'b0, {name}}}")
        } else {
            name.clone()
        };
        (name.clone(), load)
    };
    held.iter().map(|register| load(&register.name)).collect()
}
