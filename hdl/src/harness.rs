//! The harness in which a chip is placed: see the head of `harness.v`.

use serde::Deserialize;
use serde_json::{Map, Value};

/// Name of the harness module.
pub(crate) const HARNESS: &str = "nonius_harness";

/// A port as Yosys writes it.
#[derive(Debug, Deserialize)]
pub(crate) struct Port {
    direction: String,
    bits: Vec<Value>,
}

/// Ports of a chip in their order.
pub(crate) type Ports = Map<String, Value>;

/// The harness for a chip with these ports, or the port that it cannot connect.
pub(crate) fn harness(chip: &str, ports: &Ports) -> Result<String, String> {
    let (mut inputs, mut outputs) = (0, 0);
    let mut connections = Vec::new();
    for (name, port) in ports {
        let port: Port =
            serde_json::from_value(port.clone()).map_err(|it| format!("port {name}: {it}"))?;
        let width = port.bits.len();
        let net = match (port.direction.as_str(), name.as_str()) {
            ("input", "clk" | "rst_n") => name.clone(),
            // Bit 0 of the shift register is the pin's own.
            ("input", _) => slice("in", &mut inputs, width, 1),
            ("output", _) => slice("caught", &mut outputs, width, 0),
            (other, _) => return Err(format!("port {name} is {other}")),
        };
        connections.push(format!(".{name}({net})"));
    }
    if !ports.contains_key("clk") {
        return Err("there is no input clk".to_owned());
    }
    if inputs == 0 || outputs == 0 {
        return Err("there is no input or no output".to_owned());
    }
    Ok(include_str!("harness.v")
        .replace("@INPUTS@", &inputs.to_string())
        .replace("@OUTPUTS@", &outputs.to_string())
        .replace("@CHIP@", chip)
        .replace("@CONNECTIONS@", &connections.join(", ")))
}

fn slice(bus: &str, used: &mut usize, width: usize, first: usize) -> String {
    let low = first + *used;
    *used += width;
    format!("{bus}[{}:{low}]", low + width - 1)
}
