//! Area and clock frequency of generated chips, as a table for people and one for programs.
//!
//!     cargo run --release -p nonius-hdl --example synthesise -- DOCS DIR… [--up5k]
//!
//! places on the HX8K (and with `--up5k` on the UP5K too, which takes much longer), what needs a faster clock than the HX8K
//! reaches on an ECP5 too, and writes DOCS/synthesis.md and DOCS/synthesis.json for the chips in the directories that
//! `nonius build` wrote. `scripts/synthesise` calls it for all shipped designs.

use std::collections::VecDeque;
use std::env;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use nonius_hdl::ChipDir;
use nonius_hdl::place::{Device, Placed, SEEDS, place};
use nonius_hdl::progress::silent;
use serde::Serialize;

#[derive(Serialize)]
struct Table {
    schema: &'static str,
    rows: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    design: String,
    /// The clock that the design's own sample rate needs.
    needed_mhz: Option<f64>,
    clocks_per_sample: Option<u64>,
    megasamples_per_s: Option<f64>,
    #[serde(flatten)]
    placed: Placed,
}

fn main() -> ExitCode {
    let mut arguments: Vec<String> = env::args().skip(1).collect();
    let mut devices = vec![Device::Hx8k];
    if arguments.iter().any(|a| a == "--up5k") {
        arguments.retain(|a| a != "--up5k");
        devices.push(Device::Up5k);
    }
    let Some((docs, chips)) = arguments.split_first().filter(|(_, it)| !it.is_empty()) else {
        eprintln!("usage: synthesise DOCS DIR… [--up5k]");
        return ExitCode::from(2);
    };
    match run(Path::new(docs), chips, &devices) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("synthesise: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(docs: &Path, chips: &[String], devices: &[Device]) -> Result<(), Box<dyn Error>> {
    let mut rows = Vec::new();
    for dir in chips {
        let chip = ChipDir::open(dir)?;
        let needed = needed(dir)?;
        let mut devices: VecDeque<Device> = devices.iter().copied().collect();
        while let Some(device) = devices.pop_front() {
            eprintln!("{} on {} …", chip.name, device.name());
            let placed = place(&chip, device, &SEEDS, &silent)?;
            if device == Device::Hx8k && needed > placed.best_mhz {
                devices.push_back(Device::Ecp5);
            }
            for warning in &placed.warnings {
                eprintln!("  {warning}");
            }
            for failure in placed
                .placements
                .iter()
                .filter_map(|it| it.failure.as_ref())
            {
                eprintln!("  {failure}");
            }
            rows.push(Row {
                design: chip.name.clone(),
                needed_mhz: needed,
                clocks_per_sample: chip.clocks_per_sample,
                megasamples_per_s: chip
                    .clocks_per_sample
                    .zip(placed.best_mhz)
                    .map(|(clocks, mhz)| mhz / clocks as f64),
                placed,
            });
        }
    }
    let table = Table {
        schema: "nonius.synthesis/1",
        rows,
    };
    fs::create_dir_all(docs)?;
    fs::write(docs.join("synthesis.md"), markdown(&table.rows)?)?;
    let json = serde_json::to_string_pretty(&table)?;
    fs::write(docs.join("synthesis.json"), json + "\n")?;
    Ok(())
}

/// The clock that the design's own sample rate needs, MHz: `design.json` says.
fn needed(dir: &str) -> Result<Option<f64>, Box<dyn Error>> {
    let text = fs::read_to_string(Path::new(dir).join("design.json"))?;
    let json: serde_json::Value = serde_json::from_str(&text)?;
    Ok(json["latency"]["clock_hz_min"]
        .as_f64()
        .map(|hertz| hertz / 1e6))
}

fn markdown(rows: &[Row]) -> Result<String, std::fmt::Error> {
    let mut text = String::from(HEAD);
    for row in rows {
        let Placed { chip, harness, .. } = &row.placed;
        writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} + {} | Yosys {}, nextpnr {} |",
            row.design,
            row.placed.device.name(),
            chip.lut4,
            chip.carry,
            chip.ff,
            chip.bram,
            chip.dsp,
            number(row.placed.best_mhz, 1, "not placed"),
            number(row.needed_mhz, 1, "–"),
            row.clocks_per_sample
                .map_or("?".to_owned(), |it| it.to_string()),
            number(row.megasamples_per_s, 2, "–"),
            harness.lut4,
            harness.ff,
            row.placed.yosys,
            row.placed.nextpnr,
        )?;
    }
    Ok(text)
}

fn number(value: Option<f64>, digits: usize, none: &str) -> String {
    value.map_or(none.to_owned(), |it| format!("{it:.digits$}"))
}

const HEAD: &str = "\
# Area and clock frequency

Written by `scripts/synthesise`; do not edit. Counts depend on the version of Yosys.

LUT4, carry, FF, BRAM and DSP are the cells of the chip's clean top by itself, every port
kept. The clock is the best of three seeds of nextpnr, from register to register, with the
chip in a harness that feeds its inputs from a shift register and catches every output in a
register behind one multiplexer; the harness is not counted with the chip and stands in its
own column. *Needed* is the clock for the design's own sample rate: where it is more than what the
HX8K reaches, the design is placed on an ECP5 too (the slowest grade of the LFE5U-25F; there a carry is
a cell of two bits with their LUTs, a DSP a multiplier of 18 bits).

| design | device | LUT4 | carry | FF | BRAM | DSP | MHz | MHz needed | clocks per sample | MS/s | harness LUT4 + FF | tools |
|---|---|---|---|---|---|---|---|---|---|---|---|---|
";
