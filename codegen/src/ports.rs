//! The ports of a chip: names, widths and what they are.

use nonius_model::design::Design;
use nonius_model::graph::{Kind, NodeId};
use nonius_model::registers::STATUS;

use crate::netlist::meaning;
use crate::writer::range;

/// Registers and probes that have a port of their own.
pub(crate) fn has_port(name: &str) -> bool {
    let parameter = name
        .strip_prefix("theta_")
        .is_some_and(|n| n.chars().all(|c| c.is_ascii_digit()));
    parameter || STATUS.contains(&name)
}

/// Direction with range, name and what it is, of every port, in the order of the module: pins, position, what has a port of its own.
pub(crate) fn ports(
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
