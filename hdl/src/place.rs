//! Area and clock frequency of a chip on an FPGA of Lattice: Yosys, then nextpnr with several seeds.
//!
//! Cells are counted in the chip as Yosys maps it by itself, with every port kept. The clock
//! comes from the placed and routed chip in a harness that has few pins: see
//! `harness.v`. What the harness costs is counted apart.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::chip_dir::ChipDir;
use crate::error::Error;
use crate::harness::{HARNESS, Ports, harness};
use crate::process::{Job, Output};
use crate::progress::{Event, Progress};
use crate::tools::{Found, Tool, require};
use crate::yosys;

const PLACE_LIMIT: Duration = Duration::from_secs(1200);

/// Seeds of the published numbers: the best of three.
pub const SEEDS: [u32; 3] = [1, 2, 3];

/// An FPGA of the iCE40 or the ECP5 family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Device {
    /// iCE40 HX8K in the package ct256: fast, without multipliers.
    Hx8k,
    /// iCE40 UP5K in the package sg48: small and slow, with eight multipliers.
    Up5k,
    /// ECP5 LFE5U-25F of the slowest grade in the package CABGA381: faster, with 28 multipliers of 18 bits.
    Ecp5,
}

impl Device {
    /// Name as its maker writes it.
    pub fn name(self) -> &'static str {
        match self {
            Device::Hx8k => "HX8K",
            Device::Up5k => "UP5K",
            Device::Ecp5 => "LFE5U-25F",
        }
    }

    /// Yosys's command.
    fn synthesis(self) -> &'static str {
        match self {
            Device::Hx8k => "synth_ice40 -device hx",
            Device::Up5k => "synth_ice40 -device u -dsp",
            Device::Ecp5 => "synth_ecp5",
        }
    }

    fn nextpnr(self) -> Tool {
        match self {
            Device::Hx8k | Device::Up5k => Tool::Nextpnr,
            Device::Ecp5 => Tool::NextpnrEcp5,
        }
    }

    fn placement_flags(self) -> &'static [&'static str] {
        match self {
            Device::Hx8k => &["--hx8k", "--package", "ct256"],
            Device::Up5k => &["--up5k", "--package", "sg48"],
            Device::Ecp5 => &[
                "--25k",
                "--package",
                "CABGA381",
                "--lpf-allow-unconstrained",
            ],
        }
    }

    /// What nextpnr calls a logic cell.
    fn logic_cell(self) -> &'static str {
        match self {
            Device::Hx8k | Device::Up5k => "ICESTORM_LC",
            Device::Ecp5 => "TRELLIS_COMB",
        }
    }
}

/// Cells that Yosys counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Cells {
    /// SB_LUT4, LUT4.
    pub lut4: u64,
    /// SB_CARRY; CCU2C, two bits each with their LUTs.
    pub carry: u64,
    /// SB_DFF and its variants, TRELLIS_FF.
    pub ff: u64,
    /// SB_RAM40_4K and its variants, DP16KD.
    pub bram: u64,
    /// SB_SPRAM256KA.
    pub spram: u64,
    /// SB_MAC16, MULT18X18D.
    pub dsp: u64,
}

/// One run of nextpnr.
#[derive(Clone, Debug, Serialize)]
pub struct Placement {
    /// Its seed.
    pub seed: u32,
    /// Highest clock, if it found a place and a route for everything.
    pub mhz: Option<f64>,
    /// Logic cells in use, chip and harness.
    pub logic_cells: Option<u64>,
    /// Why there is no clock.
    pub failure: Option<String>,
}

/// Area and clock of a chip, with the versions that the numbers depend on.
#[derive(Clone, Debug, Serialize)]
pub struct Placed {
    /// The device.
    pub device: Device,
    /// Version of Yosys.
    pub yosys: String,
    /// Version of nextpnr.
    pub nextpnr: String,
    /// The chip alone.
    pub chip: Cells,
    /// What the harness adds.
    pub harness: Cells,
    /// One entry per seed.
    pub placements: Vec<Placement>,
    /// The highest clock of all seeds; `None` if the chip does not fit.
    pub best_mhz: Option<f64>,
    /// What Yosys warned of in the chip.
    pub warnings: Vec<String>,
}

/// Synthesises the chip's clean top for the device, then places it once per seed. Without seeds no nextpnr is needed.
pub fn place(
    chip: &ChipDir,
    device: Device,
    seeds: &[u32],
    progress: Progress,
) -> Result<Placed, Error> {
    let [yosys] = require([Tool::Yosys])?;
    let placing = !seeds.is_empty();
    let nextpnr = placing.then(|| require([device.nextpnr()])).transpose()?;
    let scratch = tempfile::tempdir().map_err(Error::Scratch)?;
    progress(Event::Synthesising);
    let (top, warnings) = synthesise(&yosys, chip, device, scratch.path())?;
    let chip_cells = top.count()?;
    let whole = put_in_harness(&yosys, &chip.name, &top, device, scratch.path())?.count()?;

    let mut placements = Vec::new();
    for (&seed, [nextpnr]) in seeds.iter().zip(nextpnr.iter().cycle()) {
        progress(Event::Placing { seed });
        placements.push(place_once(nextpnr, device, seed, scratch.path())?);
    }
    Ok(Placed {
        device,
        yosys: yosys.version(),
        nextpnr: nextpnr.map_or("not run".to_owned(), |[it]| it.version()),
        chip: chip_cells,
        harness: whole.less(chip_cells),
        best_mhz: placements.iter().filter_map(|it| it.mhz).reduce(f64::max),
        placements,
        warnings,
    })
}

/// The chip alone, mapped to cells: `chip.json` in the scratch directory.
fn synthesise(
    yosys: &Found,
    chip: &ChipDir,
    device: Device,
    scratch: &Path,
) -> Result<(Netlist, Vec<String>), Error> {
    let json = scratch.join("chip.json");
    let script = format!(
        "{}; {} -top {}; write_json \"{}\"",
        yosys::read(chip),
        device.synthesis(),
        chip.name,
        json.display()
    );
    let output = yosys::run(yosys, &chip.root, &script)?;
    accepted("yosys", "did not synthesise the chip", &output)?;
    Ok((netlist(&json, &chip.name)?, yosys::warnings_in(&output)))
}

/// The mapped chip in a mapped harness: `whole.json` in the scratch directory. The chip is a
/// black box while the harness is mapped, so that neither changes the other.
fn put_in_harness(
    yosys: &Found,
    name: &str,
    top: &Netlist,
    device: Device,
    scratch: &Path,
) -> Result<Netlist, Error> {
    let source = harness(name, &top.ports).map_err(|detail| Error::Tool {
        tool: "the harness",
        did: format!("cannot connect {name}"),
        detail,
    })?;
    fs::write(scratch.join("harness.v"), source).map_err(Error::Scratch)?;
    let script = format!(
        "read_json chip.json; design -save chip; blackbox ={name}; read_verilog harness.v; \
         {} -top {HARNESS}; design -copy-from chip -as {name} ={name}; flatten; \
         write_json whole.json",
        device.synthesis()
    );
    let output = yosys::run(yosys, scratch, &script)?;
    accepted("yosys", "did not put the chip in its harness", &output)?;
    netlist(&scratch.join("whole.json"), HARNESS)
}

fn place_once(
    nextpnr: &Found,
    device: Device,
    seed: u32,
    scratch: &Path,
) -> Result<Placement, Error> {
    // Beside the netlist, by its name alone: the nextpnr of PyPI sees no other folder.
    let report = format!("report{seed}.json");
    let output = Job::new(&nextpnr.path, scratch, PLACE_LIMIT)
        .args(device.placement_flags())
        .args(["--json", "whole.json", "--timing-allow-fail", "--quiet"])
        .args(["--seed", &seed.to_string(), "--report"])
        .arg(&report)
        .run()?;
    if let Some(trouble) = output.trouble() {
        return Ok(Placement {
            seed,
            mhz: None,
            logic_cells: None,
            failure: Some(format!("nextpnr {trouble}\n{}", output.tail())),
        });
    }
    let report: Report = read_json("nextpnr", &scratch.join(report))?;
    Ok(Placement {
        seed,
        mhz: report.fmax.values().map(|it| it.achieved).reduce(f64::min),
        logic_cells: report
            .utilization
            .get(device.logic_cell())
            .map(|it| it.used),
        failure: None,
    })
}

#[derive(Deserialize)]
struct Report {
    fmax: BTreeMap<String, Clock>,
    utilization: BTreeMap<String, Utilization>,
}

#[derive(Deserialize)]
struct Clock {
    achieved: f64,
}

#[derive(Deserialize)]
struct Utilization {
    used: u64,
}

/// What Yosys writes, as far as it matters here.
#[derive(Deserialize)]
struct Netlists {
    modules: BTreeMap<String, Netlist>,
}

#[derive(Deserialize)]
struct Netlist {
    #[serde(default)]
    ports: Ports,
    #[serde(default)]
    cells: BTreeMap<String, Cell>,
}

#[derive(Deserialize)]
struct Cell {
    #[serde(rename = "type")]
    kind: String,
}

fn netlist(path: &Path, module: &str) -> Result<Netlist, Error> {
    let mut netlists: Netlists = read_json("yosys", path)?;
    netlists
        .modules
        .remove(module)
        .ok_or_else(|| unreadable("yosys", format!("no module {module} in its netlist")))
}

fn read_json<T: serde::de::DeserializeOwned>(tool: &'static str, path: &Path) -> Result<T, Error> {
    let text = fs::read_to_string(path).map_err(Error::Scratch)?;
    serde_json::from_str(&text).map_err(|it| unreadable(tool, it.to_string()))
}

fn unreadable(tool: &'static str, detail: String) -> Error {
    Error::Tool {
        tool,
        did: "wrote something that cannot be read".to_owned(),
        detail,
    }
}

fn accepted(tool: &'static str, did: &str, output: &Output) -> Result<(), Error> {
    match output.trouble() {
        None => Ok(()),
        Some(trouble) => Err(Error::Tool {
            tool,
            did: format!("{did} and {trouble}"),
            detail: output.tail(),
        }),
    }
}

impl Netlist {
    /// An unknown cell is an error: a count that leaves something out is worse than none.
    fn count(&self) -> Result<Cells, Error> {
        let mut cells = Cells::default();
        for Cell { kind } in self.cells.values() {
            let count = match kind.as_str() {
                "SB_LUT4" | "LUT4" => &mut cells.lut4,
                "SB_CARRY" | "CCU2C" => &mut cells.carry,
                "SB_MAC16" | "MULT18X18D" => &mut cells.dsp,
                "TRELLIS_FF" => &mut cells.ff,
                "DP16KD" => &mut cells.bram,
                "SB_SPRAM256KA" => &mut cells.spram,
                it if it.starts_with("SB_DFF") => &mut cells.ff,
                it if it.starts_with("SB_RAM40_4K") => &mut cells.bram,
                // Multiplexers that stand beside the LUTs of an ECP5 and join them.
                "PFUMX" | "L6MUX21" => continue,
                "$scopeinfo" => continue,
                other => {
                    return Err(unreadable("yosys", format!("unknown cell {other}")));
                }
            };
            *count += 1;
        }
        Ok(cells)
    }
}

impl Cells {
    fn less(self, other: Cells) -> Cells {
        Cells {
            lut4: self.lut4.saturating_sub(other.lut4),
            carry: self.carry.saturating_sub(other.carry),
            ff: self.ff.saturating_sub(other.ff),
            bram: self.bram.saturating_sub(other.bram),
            spram: self.spram.saturating_sub(other.spram),
            dsp: self.dsp.saturating_sub(other.dsp),
        }
    }
}
