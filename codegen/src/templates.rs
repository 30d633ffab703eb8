//! The templates and what they are given.

use askama::Template;
use nonius_model::design::Design;
use nonius_model::graph::{Kind, NodeId, Op};

use crate::netlist::{Netlist, Wire, base_name, reference, width};
use crate::schedule::{Schedule, schedule};

/// A port of the core: range, name, source, bits.
type Port = (String, String, String, u32);

struct Unit {
    index: usize,
    a: u32,
    b: u32,
    loads: Vec<(usize, String, String, String)>,
    idle_a: String,
    idle_b: String,
}

struct Table {
    name: String,
    width: u32,
    rows: usize,
    address: u32,
    reads: Vec<(usize, String)>,
    fallback: String,
}

#[derive(Template)]
#[template(path = "core.v")]
struct Core<'a> {
    name: &'a str,
    hash: &'a str,
    products: usize,
    multipliers: usize,
    clocks: usize,
    step_bits: u32,
    adc_msb: u32,
    ports: &'a [Port],
    constants: &'a [String],
    registers: &'a [(String, String, String)],
    inputs: &'a [(String, String)],
    captured: &'a [(usize, String)],
    captured_names: &'a [(String, String)],
    probes: &'a [(String, String, String)],
    sections: Vec<&'a (String, String, String, Vec<Wire>)>,
    units: &'a [Unit],
    roms: &'a [Table],
    adc_cos: String,
    adc_sin: String,
}

#[derive(Template)]
#[template(path = "top.v")]
struct Top<'a> {
    name: &'a str,
    description: &'a str,
    hash: &'a str,
    clocks: usize,
    adc_msb: u32,
    count_bits: u32,
    alpha_bits: u32,
    speed_bits: u32,
    thetas: &'a [(String, u32, u32)],
}

#[derive(Template)]
#[template(path = "chip_tb.v")]
struct Testbench<'a> {
    name: &'a str,
    clocks: usize,
    adc_msb: u32,
    count_bits: u32,
    alpha_bits: u32,
    ports: &'a [Port],
    thetas: &'a [(String, u32, u32)],
    columns: usize,
    scan: String,
    scan_args: String,
    stimuli: &'a [(String, usize)],
}

/// The text files of a chip: path below the output folder, content.
pub struct Files {
    /// Path and content.
    pub files: Vec<(String, String)>,
    /// Clocks per sample.
    pub clocks: usize,
    /// Columns of a vector row behind sample number and inputs: name, node, bits.
    pub columns: Vec<(String, NodeId, u32)>,
}

/// Everything that is compared after a sample: probes, then registers.
fn ports(design: &Design) -> (Vec<Port>, Vec<(String, NodeId, u32)>) {
    let graph = &design.graph;
    let mut columns = vec![];
    let mut list = vec![];
    let mut add = |name: String, source: String, id: NodeId| {
        let bits = width(graph, id);
        let flag = graph.node(id).kind == Kind::Flag;
        let range = if flag {
            String::new()
        } else {
            format!("signed [{}:0] ", bits - 1)
        };
        list.push((range, name.clone(), source, bits));
        columns.push((name, id, bits));
    };
    for (name, id) in &graph.probes {
        add(format!("seen_{name}"), format!("probe_{name}"), *id);
    }
    for (name, _) in &graph.next {
        if let Some((_, id)) = graph.inputs.iter().find(|(n, _)| n == name) {
            add(format!("reg_{name}"), name.clone(), *id);
        }
    }
    (list, columns)
}

fn units(design: &Design, schedule: &Schedule) -> Vec<Unit> {
    let graph = &design.graph;
    (0..schedule.multipliers)
        .map(|index| {
            let mut loads: Vec<(usize, NodeId, NodeId, String)> = graph
                .ids()
                .filter_map(|id| match (graph.node(id).op, schedule.issue[id.index()]) {
                    (Op::Mul(a, b), Some((m, cycle))) if m == index => {
                        let text = format!("{} * {}", base_name(graph, a), base_name(graph, b));
                        Some((cycle - 1, a, b, text))
                    }
                    _ => None,
                })
                .collect();
            loads.sort_by_key(|l| l.0);
            let a = loads.iter().map(|l| width(graph, l.1)).max().unwrap_or(1);
            let b = loads.iter().map(|l| width(graph, l.2)).max().unwrap_or(1);
            let operand = |id: NodeId, cycle: usize, to: u32| {
                crate::expression::extended(
                    &reference(graph, schedule, id, cycle),
                    width(graph, id),
                    to,
                )
            };
            let loads: Vec<_> = loads
                .into_iter()
                .map(|(cycle, x, y, text)| {
                    (cycle, operand(x, cycle, a), operand(y, cycle, b), text)
                })
                .collect();
            let (idle_a, idle_b) = loads
                .last()
                .map_or(("0".into(), "0".into()), |l| (l.1.clone(), l.2.clone()));
            Unit {
                index,
                a,
                b,
                loads,
                idle_a,
                idle_b,
            }
        })
        .collect()
}

fn tables(design: &Design, schedule: &Schedule) -> Vec<Table> {
    let graph = &design.graph;
    let table = |(index, rom): (usize, &nonius_model::rom::Rom)| {
        let mut reads: Vec<(usize, String)> = graph
            .ids()
            .filter_map(|id| match graph.node(id).op {
                Op::Lookup {
                    rom,
                    column: 0,
                    address,
                } if rom == index => {
                    let cycle = schedule.ready[id.index()] - 1;
                    let drop = graph.node(address).format.fraction - graph.roms[rom].index_fraction;
                    let name = reference(graph, schedule, address, cycle);
                    Some((
                        cycle,
                        format!("{name}[{}:{drop}]", drop + graph.roms[rom].address_bits - 1),
                    ))
                }
                _ => None,
            })
            .collect();
        reads.sort();
        let fallback = reads.pop().map_or_else(|| "0".into(), |r| r.1);
        Table {
            name: rom.name.into(),
            width: rom.row_width(),
            rows: rom.rows(),
            address: rom.address_bits,
            reads,
            fallback,
        }
    };
    graph.roms.iter().enumerate().map(table).collect()
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
    let schedule = schedule(graph, design.spec.chip.multipliers.count(graph.products()));
    let netlist = Netlist::new(graph, &schedule);
    let (ports, columns) = ports(design);
    let units = units(design, &schedule);
    let roms = tables(design, &schedule);
    let name = design.spec.name.as_str();
    let adc_bits = design.spec.adc.bits;
    let f = &design.structure.formats;
    let code = |pin: &str| {
        if design.structure.offset_binary {
            format!("$signed({{1'b0, {pin}}})")
        } else {
            format!("$signed({pin})")
        }
    };
    let thetas: Vec<(String, u32, u32)> = graph
        .probes
        .iter()
        .filter(|(n, id)| n.starts_with("theta_") && graph.node(*id).kind != Kind::Flag)
        .map(|(n, id)| {
            (
                n.clone(),
                width(graph, *id),
                graph.node(*id).format.fraction,
            )
        })
        .collect();
    let speed_bits = columns
        .iter()
        .find(|c| c.0 == "seen_speed")
        .map_or(1, |c| c.2);
    let core = Core {
        name,
        hash,
        products: graph.products(),
        multipliers: schedule.multipliers,
        clocks: schedule.clocks,
        step_bits: usize::BITS - schedule.clocks.leading_zeros(),
        adc_msb: adc_bits - 1,
        ports: &ports,
        constants: &netlist.constants,
        registers: &netlist.registers,
        inputs: &netlist.inputs,
        captured: &netlist.captured,
        captured_names: &netlist.captured_names,
        probes: &netlist.probes,
        sections: netlist
            .sections
            .iter()
            .filter(|s| !s.3.is_empty())
            .collect(),
        units: &units,
        roms: &roms,
        adc_cos: code("adc_cos_pin"),
        adc_sin: code("adc_sin_pin"),
    };
    let top = Top {
        name,
        description: &design.spec.description.replace(['\n', '\r'], " "),
        hash,
        clocks: schedule.clocks,
        adc_msb: adc_bits - 1,
        count_bits: f.count.width,
        alpha_bits: f.alpha.width,
        speed_bits,
        thetas: &thetas,
    };
    let args: Vec<String> = columns
        .iter()
        .map(|c| format!(", expect_{}", c.0))
        .collect();
    let testbench = Testbench {
        name,
        clocks: schedule.clocks,
        adc_msb: adc_bits - 1,
        count_bits: f.count.width,
        alpha_bits: f.alpha.width,
        ports: &ports,
        thetas: &thetas,
        columns: columns.len() + 5,
        scan: vec!["%h"; columns.len() + 5].join(" "),
        scan_args: format!(
            ", sample, adc_cos, adc_sin, preset, calibrate{}",
            args.concat()
        ),
        stimuli,
    };
    let mut files = vec![
        (format!("rtl/{name}_core.v"), core.render()? + "\n"),
        (format!("rtl/{name}.v"), top.render()? + "\n"),
        ("tb/chip_tb.v".into(), testbench.render()? + "\n"),
    ];
    for rom in &graph.roms {
        let digits = rom.row_width().div_ceil(4) as usize;
        let rows: String = (0..rom.rows())
            .map(|row| format!("{:0digits$x}\n", rom.word(row)))
            .collect();
        files.push((format!("coefficients/{}.mem", rom.name), rows));
    }
    Ok(Files {
        files,
        clocks: schedule.clocks,
        columns,
    })
}
