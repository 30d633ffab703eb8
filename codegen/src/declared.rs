//! What a module declares.

use std::collections::BTreeSet;

/// Names of the ports, registers, wires and memories that a module declares, of Verilog as the templates write it: one
/// declaration a line.
#[must_use]
pub fn declared(verilog: &str) -> BTreeSet<&str> {
    verilog.lines().filter_map(of_line).collect()
}

fn of_line(line: &str) -> Option<&str> {
    let line = line.split("//").next()?.trim();
    let (kind, rest) = line.split_once(' ')?;
    if !["input", "output", "reg", "wire"].contains(&kind) {
        return None;
    }
    // Before a value, a semicolon or a comma, and what stands in brackets is a range.
    let rest = rest.split(['=', ';', ',']).next()?;
    let outside = rest
        .split(']')
        .map(|part| part.split('[').next().unwrap_or(""));
    let mut words = outside.flat_map(str::split_whitespace);
    words.rfind(|word| !["reg", "wire", "signed"].contains(word))
}

#[test]
fn a_declaration_has_one_name() {
    let verilog = "
    input  wire               clk, // Clock.
    output reg signed [4:0] theta_1
    reg [23:0] sine_table [0:31];
    wire signed [7:0] c_now = {1'b0, a} + b;
    assign position = count;
    ";
    let names = ["c_now", "clk", "sine_table", "theta_1"];
    assert_eq!(declared(verilog), BTreeSet::from(names));
}
