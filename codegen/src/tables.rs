//! Tables and coefficients as files: for programs, for `include` and `$readmemh`, for the vendors' memory generators.

use std::fmt::Write;

use nonius_model::graph::Graph;
use nonius_model::rom::Rom;
use serde_json::{Value, json};

use crate::constants::{Coefficient, coefficients};

/// A table or coefficient file: path below the output folder, content.
type File = (String, String);

/// Words of one width, as memories are filled with them.
struct Memory {
    name: &'static str,
    /// What stands in a word, in lines.
    layout: Vec<String>,
    width: u32,
    words: Vec<u128>,
}

impl Memory {
    fn of_rom(rom: &Rom) -> Self {
        let columns: Vec<String> = rom
            .columns
            .iter()
            .map(|c| format!("{} {}", c.name, c.format))
            .collect();
        Self {
            name: rom.name,
            // The highest bits first.
            layout: vec![format!("a word is {{{}}}", columns.join(", "))],
            width: rom.row_width(),
            words: (0..rom.rows()).map(|row| rom.word(row)).collect(),
        }
    }

    /// One word for each coefficient, as wide as the widest.
    fn of_coefficients(all: &[Coefficient]) -> Self {
        let width = all.iter().map(|c| c.bits).max().unwrap_or(1);
        let mut layout = vec!["a word is a coefficient in two's complement".to_owned()];
        layout.extend(
            all.iter()
                .enumerate()
                .map(|(row, c)| format!("row {row}: {}, {} fraction bits", c.name, c.fraction)),
        );
        let mask = (1u128 << width) - 1;
        Self {
            name: "coefficients",
            layout,
            width,
            words: all
                .iter()
                .map(|c| i128::from(c.raw) as u128 & mask)
                .collect(),
        }
    }

    fn word(&self, row: usize) -> String {
        let digits = self.width.div_ceil(4) as usize;
        format!("{:0digits$x}", self.words[row])
    }

    fn rows(&self) -> impl Iterator<Item = String> {
        (0..self.words.len()).map(|row| self.word(row))
    }

    /// What it is and what stands in it, each line behind `comment`.
    fn heading(&self, comment: &str, head: &str) -> String {
        let (first, more) = self.layout.split_at(1);
        let mut out = format!(
            "{comment} Table {} of {head}: {}\n",
            self.name,
            first.concat()
        );
        for line in more {
            let _ = writeln!(out, "{comment} {line}");
        }
        out
    }

    /// One word per line, hexadecimal: `$readmemh`.
    fn hex(&self) -> String {
        self.rows().map(|word| word + "\n").collect()
    }

    /// For Vivado's and ISE's memory generators.
    fn coe(&self, head: &str) -> String {
        format!(
            "{}memory_initialization_radix=16;\nmemory_initialization_vector=\n{};\n",
            self.heading(";", head),
            self.rows().collect::<Vec<_>>().join(",\n")
        )
    }

    /// For Quartus.
    fn mif(&self, head: &str) -> String {
        let mut out = format!(
            "{}WIDTH={};\nDEPTH={};\nADDRESS_RADIX=HEX;\nDATA_RADIX=HEX;\nCONTENT BEGIN\n",
            self.heading("--", head),
            self.width,
            self.words.len()
        );
        for (row, word) in self.rows().enumerate() {
            let _ = writeln!(out, "    {row:x} : {word};");
        }
        out + "END;\n"
    }

    /// In every form that a memory is filled from.
    fn files(&self, head: &str) -> Vec<File> {
        let path = |ending: &str| format!("coefficients/{}.{ending}", self.name);
        vec![
            (path("mem"), self.hex()),
            (path("hex"), self.hex()),
            (path("coe"), self.coe(head)),
            (path("mif"), self.mif(head)),
        ]
    }
}

/// Every file under `coefficients/`.
pub(crate) fn files(name: &str, hash: &str, graph: &Graph) -> Vec<File> {
    let head = format!("design {name} {hash}");
    let all = coefficients(graph);
    let mut files = vec![
        (
            "coefficients/coefficients.json".into(),
            coefficients_json(&head, &all),
        ),
        (
            "coefficients/coefficients.vh".into(),
            coefficients_vh(&head, &all),
        ),
    ];
    files.extend(Memory::of_coefficients(&all).files(&head));
    for rom in &graph.roms {
        let memory = Memory::of_rom(rom);
        let path = |ending: &str| format!("coefficients/{}.{ending}", rom.name);
        files.push((path("json"), rom_json(&head, rom, &memory)));
        files.push((path("vh"), rom_vh(&head, rom, &memory)));
        files.extend(memory.files(&head));
    }
    files
}

fn pretty(value: &Value) -> String {
    format!("{value:#}\n")
}

fn rom_json(head: &str, rom: &Rom, memory: &Memory) -> String {
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
        "words": memory.rows().collect::<Vec<_>>(),
    }))
}

fn rom_vh(head: &str, rom: &Rom, memory: &Memory) -> String {
    let (name, width, address) = (rom.name, memory.width, rom.address_bits);
    let mut out = format!(
        "{}function [{}:0] {name}_word;\n    input [{}:0] address;\n    case (address)\n",
        memory.heading("//", head),
        width - 1,
        address - 1
    );
    let rows = rom.rows();
    for (row, word) in memory.rows().enumerate() {
        let label = if row + 1 == rows {
            "default".to_owned()
        } else {
            format!("{address}'d{row}")
        };
        let _ = writeln!(out, "        {label}: {name}_word = {width}'h{word};");
    }
    out + "    endcase\nendfunction\n"
}

fn coefficients_json(head: &str, all: &[Coefficient]) -> String {
    let list: Vec<Value> = all
        .iter()
        .enumerate()
        .map(|(row, c)| {
            json!({
                "row": row,
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

fn coefficients_vh(head: &str, all: &[Coefficient]) -> String {
    let mut out = format!("// Coefficients of {head}\n");
    for c in all {
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
