//! What Yosys makes of the Verilog for an iCE40 still agrees with the model at every port: a comparison that a synthesis
//! tool gets wrong is right in every simulation of the source.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use crate::chip::{self, shipped};
use nonius_hdl::tools::{Tool, require};
use nonius_hdl::verilator::{Effort, simulate};
use nonius_hdl::{ChipDir, Run};
use nonius_kept::every;
use nonius_model::spec::Spec;
use rayon::prelude::*;
use tempfile::TempDir;

/// Samples of each stimulus: enough to lock and to calibrate.
const ROWS: usize = 140;
/// What is played: gates take their time.
const PLAYED: [&str; 2] = ["step", "random"];

/// Netlist and the cells that it is made of, in place of the chip.
fn synthesise(dir: &Path, name: &str) {
    let [yosys] = require([Tool::Yosys]).unwrap_or_else(|e| panic!("{e}"));
    let script = format!(
        "read_verilog rtl/{name}.v; synth_ice40 -top {name}; write_verilog -noattr netlist.v"
    );
    let output = Command::new(&yosys.path)
        .current_dir(dir)
        .args(["-q", "-p", &script])
        .output()
        .expect("Yosys runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let cells = yosys.path.parent().and_then(Path::parent);
    let cells = cells
        .expect("a prefix")
        .join("share/yosys/ice40/cells_sim.v");
    let cells = fs::read_to_string(&cells).unwrap_or_else(|e| panic!("{}: {e}", cells.display()));
    let netlist = fs::read_to_string(dir.join("netlist.v")).expect("a netlist");
    // Icarus knows no default for a pin that is left open.
    let text = format!("`define NO_ICE40_DEFAULT_ASSIGNMENTS\n{cells}\n{netlist}");
    fs::write(dir.join(format!("rtl/{name}.v")), text).expect("the netlist in the chip's place");
}

/// The testbench without what looks into the chip: a netlist has other names inside.
fn ports_only(dir: &Path) {
    let file = dir.join("tb/chip_tb.v");
    let text = fs::read_to_string(&file).expect("a testbench");
    // A comparison with its message: to the end of the statement.
    let (mut ports, mut inside, mut within) = (String::new(), 0, false);
    for line in text.lines() {
        if line.contains("(chip.") {
            (inside, within) = (inside + 1, true);
        }
        if !within {
            ports += &format!("{line}\n");
        }
        within &= !line.ends_with(';');
    }
    assert!(inside > 10 && ports.contains("(position") && ports.contains("(theta_1 !=="));
    fs::write(file, ports).expect("a testbench");
}

/// LUT4 of a hand-made chip of optical's widths without lock detection, gears, bounds and counters, and what all these may
/// take.
const PROTOTYPE: usize = 2533;
const ALLOWED: f64 = 1.25;

/// A chip of the extent that is compared with a hand-made one is not much larger. It has no second memory of its parameters;
/// what that costs stands in docs/on-line-costs.md.
#[test]
fn without_recall_the_chip_is_not_much_larger_than_a_hand_made_one() {
    let mut spec = shipped::optical();
    spec.calibration.recall = Some(false);
    let dir = netlist(&spec, |_| ());
    let netlist = fs::read_to_string(dir.path().join("netlist.v")).expect("a netlist");
    let cells = netlist.matches("SB_LUT4 ").count();
    println!("{cells} LUT4");
    assert!(cells > PROTOTYPE / 2, "{cells} LUT4: not all are counted");
    assert!(cells as f64 <= ALLOWED * PROTOTYPE as f64, "{cells} LUT4");
}

/// A chip, changed, as a netlist.
fn netlist(spec: &Spec, change: impl Fn(&Path)) -> TempDir {
    let dir = tempfile::tempdir().expect("a scratch folder");
    chip::write_with(spec, ROWS, dir.path(), |name| PLAYED.contains(&name));
    change(dir.path());
    synthesise(dir.path(), &spec.name);
    dir
}

fn synthesised(spec: &Spec, change: impl Fn(&Path)) -> Run {
    let dir = netlist(spec, change);
    ports_only(dir.path());
    let chip = ChipDir::open(dir.path()).expect("a chip");
    let limit = Duration::from_secs(900);
    let run = simulate(
        &chip,
        Effort::QuickBuild,
        limit,
        &[],
        &nonius_hdl::progress::silent,
    );
    run.unwrap_or_else(|e| panic!("{e}"))
}

/// The first; in the long form all.
#[test]
fn shipped_designs_as_netlists() {
    let names: Vec<&str> = every(shipped::NAMES.len(), shipped::NAMES).collect();
    names.par_iter().for_each(|name| {
        let run = synthesised(&shipped::spec(name), |_| ());
        assert!(run.passed, "{name}: {run:#?}");
    });
}

/// Yosys 0.23 gets this wrong, and the vectors see it at the ports: of a chip without calibration, which is soonest a netlist.
#[test]
fn a_comparison_that_is_synthesised_wrong_is_seen() {
    let spec = shipped::variants::fixed().spec;
    let run = synthesised(&spec, |dir| {
        let file = dir.join("rtl/optical.v");
        let text = fs::read_to_string(&file).expect("the chip");
        let wrong = text.replace(
            "$signed(~rho_now[17:15]) < 3'sd1",
            "~($signed(rho_now[17:15]) < 3'sh7)",
        );
        assert_ne!(text, wrong);
        fs::write(file, wrong).expect("the chip");
    });
    assert!(!run.passed, "{run:#?}");
}
