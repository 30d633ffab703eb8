//! What a design may be called.

use super::DesignError;
use super::keywords::{KEYWORDS, SYSTEM_KEYWORDS};
use super::refuse::refuse;
use crate::graph::Graph;
use crate::spec::Spec;

/// Name and description can stand in Verilog.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first = spec.name.chars().next().unwrap_or(' ');
    if !first.is_ascii_alphabetic() || !spec.name.chars().all(word) || spec.name.len() > 64 {
        return refuse(
            "name",
            format!("{:?}", spec.name),
            "letters, digits and _, a letter first",
            "it names Verilog modules",
        );
    }
    if spec.description.chars().any(char::is_control) {
        return refuse(
            "description",
            format!("{:?}", spec.description),
            "one line without control characters",
            "it stands in the Verilog and in the report",
        );
    }
    let name = spec.name.as_str();
    if KEYWORDS.contains(&name) || SYSTEM_KEYWORDS.contains(&name) || name == "chip_tb" {
        return refuse(
            "name",
            format!("{:?}", spec.name),
            "no word of Verilog, and not chip_tb",
            "it names a Verilog module, and this is a keyword or the testbench",
        );
    }
    Ok(())
}

/// Signals of the module that are no nodes of the graph.
const PINS: [&str; 8] = [
    "clk",
    "rst_n",
    "sample_valid",
    "valid",
    "position",
    "step",
    "start",
    "last",
];

/// The module is called like none of its signals: linters would say that one hides the other.
pub(super) fn apart(name: &str, graph: &Graph) -> Result<(), DesignError> {
    let nodes = graph.nodes.iter().filter_map(|n| n.name.as_deref());
    let tables = graph.roms.iter().map(|rom| rom.name);
    let hides = |signal: &str| {
        let rest = name.strip_prefix(signal);
        matches!(
            rest,
            Some("" | "_now" | "_held" | "_next" | "_address" | "_row")
        )
    };
    if nodes.chain(tables).chain(PINS).any(hides) {
        return Err(DesignError::name_of_a_signal(name));
    }
    Ok(())
}
