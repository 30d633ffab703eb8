//! Tables and coefficients as files: for programs, for `include` and `$readmemh`, for the vendors' memory generators.

use std::fmt::Write;

use nonius_model::graph::Graph;
use nonius_model::rom::Rom;
use serde_json::{Value, json};

use crate::constants::coefficients;

/// A table or coefficient file: path below the output folder, content.
type File = (String, String);

/// Every file under `coefficients/`.
pub(crate) fn files(name: &str, hash: &str, graph: &Graph) -> Vec<File> {
    let head = format!("design {name} {hash}");
    let mut files = vec![
        (
            "coefficients/coefficients.json".into(),
            coefficients_json(&head, graph),
        ),
        (
            "coefficients/coefficients.vh".into(),
            coefficients_vh(&head, graph),
        ),
    ];
    for rom in &graph.roms {
        let path = |ending: &str| format!("coefficients/{}.{ending}", rom.name);
        let rows = hex_rows(rom);
        files.extend([
            (path("mem"), rows.clone()),
            (path("hex"), rows),
            (path("json"), rom_json(&head, rom)),
            (path("vh"), rom_vh(&head, rom)),
            (path("coe"), rom_coe(&head, rom)),
            (path("mif"), rom_mif(&head, rom)),
        ]);
    }
    files
}

fn digits(rom: &Rom) -> usize {
    rom.row_width().div_ceil(4) as usize
}

fn word(rom: &Rom, row: usize) -> String {
    format!("{:0digits$x}", rom.word(row), digits = digits(rom))
}

/// One word per line, hexadecimal: `$readmemh`.
fn hex_rows(rom: &Rom) -> String {
    (0..rom.rows()).map(|row| word(rom, row) + "\n").collect()
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

fn rom_json(head: &str, rom: &Rom) -> String {
    let columns: Vec<Value> = rom
        .columns
        .iter()
        .map(|c| {
            json!({
                "name": c.name,
                "format": c.format,
                "raw": c.raw,
                "exact": c.exact,
            })
        })
        .collect();
    pretty(&json!({
        "made_for": head,
        "name": rom.name,
        "rows": rom.rows(),
        "row_bits": rom.row_width(),
        "columns": columns,
        "words": (0..rom.rows()).map(|row| word(rom, row)).collect::<Vec<_>>(),
    }))
}

/// What stands in a word, the highest bits first.
fn layout(rom: &Rom) -> String {
    let columns: Vec<String> = rom
        .columns
        .iter()
        .map(|c| format!("{} {}", c.name, c.format))
        .collect();
    format!("a word is {{{}}}", columns.join(", "))
}

fn rom_vh(head: &str, rom: &Rom) -> String {
    let (width, address) = (rom.row_width(), rom.address_bits);
    let mut out = format!(
        "// Table {} of {head}: {}\nfunction [{}:0] {}_word;\n    input [{}:0] address;\n    case (address)\n",
        rom.name,
        layout(rom),
        width - 1,
        rom.name,
        address - 1
    );
    for row in 0..rom.rows() {
        let last = row + 1 == rom.rows();
        let label = if last {
            "default".to_owned()
        } else {
            format!("{address}'d{row}")
        };
        let _ = writeln!(
            out,
            "        {label}: {}_word = {width}'h{};",
            rom.name,
            word(rom, row)
        );
    }
    out + "    endcase\nendfunction\n"
}

/// For Vivado's and ISE's memory generators.
fn rom_coe(head: &str, rom: &Rom) -> String {
    let words: Vec<String> = (0..rom.rows()).map(|row| word(rom, row)).collect();
    format!(
        "; Table {} of {head}: {}\nmemory_initialization_radix=16;\nmemory_initialization_vector=\n{};\n",
        rom.name,
        layout(rom),
        words.join(",\n")
    )
}

/// For Quartus.
fn rom_mif(head: &str, rom: &Rom) -> String {
    let mut out = format!(
        "-- Table {} of {head}: {}\nWIDTH={};\nDEPTH={};\nADDRESS_RADIX=HEX;\nDATA_RADIX=HEX;\nCONTENT BEGIN\n",
        rom.name,
        layout(rom),
        rom.row_width(),
        rom.rows()
    );
    for row in 0..rom.rows() {
        let _ = writeln!(out, "    {row:x} : {};", word(rom, row));
    }
    out + "END;\n"
}

fn coefficients_json(head: &str, graph: &Graph) -> String {
    let list: Vec<Value> = coefficients(graph)
        .into_iter()
        .map(|c| {
            json!({
                "name": c.name,
                "raw": c.raw,
                "bits": c.bits,
                "fraction_bits": c.fraction,
                "value": c.value,
                "meaning": c.meaning,
            })
        })
        .collect();
    pretty(&json!({"made_for": head, "coefficients": list}))
}

fn coefficients_vh(head: &str, graph: &Graph) -> String {
    let mut out = format!("// Coefficients of {head}\n");
    for c in coefficients(graph) {
        let _ = writeln!(
            out,
            "localparam signed [{}:0] {} = {}; // {}, {} fraction bits. {}",
            c.bits - 1,
            c.name.to_uppercase(),
            crate::writer::literal(c.raw.into(), c.bits),
            c.value,
            c.fraction,
            c.meaning
        );
    }
    out
}
