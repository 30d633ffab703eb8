//! The model's waves beside those of the testbench in Icarus: one hierarchy, one set of names, and the same values.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

use crate::chip::shipped::variants::kinds;
use nonius_hdl::tools::{Tool, require};
use nonius_kept::every;
use nonius_model::design::Design;
use nonius_testvectors::stimulus;
use vcd::{Command as Change, IdCode, ScopeItem, Value, VarType};

/// Samples that are played.
const ROWS: usize = 60;

/// What a viewer shows of a signal of the chip.
struct Waves {
    /// Name and bits.
    signals: BTreeMap<String, u32>,
    /// All of them where `valid` rises.
    results: Vec<BTreeMap<String, String>>,
}

/// Reads `chip_tb.chip` of a VCD.
fn read(file: &Path) -> Waves {
    let opened = fs::File::open(file).expect("waves");
    let mut parser = vcd::Parser::new(BufReader::new(opened));
    let header = parser.parse_header().expect("a header");
    let scope = header.find_scope(&["chip_tb", "chip"]).expect("the chip");
    let vars = scope.items.iter().filter_map(|item| match item {
        ScopeItem::Var(var) => Some(var),
        _ => None,
    });
    let constant = |kind: VarType| kind == VarType::Parameter;
    let vars: Vec<_> = vars.filter(|var| !constant(var.var_type)).collect();
    let valid = scope.find_var("valid").expect("valid").code;
    let mut now: BTreeMap<IdCode, String> = BTreeMap::new();
    let (mut results, mut before) = (vec![], true);
    let word = |bits: &mut dyn Iterator<Item = Value>, width: u32| {
        let text: String = bits.map(|v| v.to_string()).collect();
        // Leading zeros may be left out.
        format!("{text:0>width$}", width = width as usize)
    };
    let width: BTreeMap<IdCode, u32> = vars.iter().map(|var| (var.code, var.size)).collect();
    for change in parser {
        match change.expect("a change") {
            Change::Timestamp(_) => {
                let is = now.get(&valid).is_some_and(|v| v == "1");
                if is && !before {
                    let value = |var: &&vcd::Var| {
                        Some((var.reference.clone(), now.get(&var.code)?.clone()))
                    };
                    results.push(vars.iter().filter_map(value).collect());
                }
                before = is;
            }
            Change::ChangeScalar(id, value) => {
                now.insert(id, value.to_string());
            }
            Change::ChangeVector(id, values) => {
                let bits = width.get(&id).copied().unwrap_or(0);
                now.insert(id, word(&mut values.iter(), bits));
            }
            _ => {}
        }
    }
    Waves {
        signals: vars
            .iter()
            .map(|var| (var.reference.clone(), var.size))
            .collect(),
        results,
    }
}

/// What the chip's header lists as ports.
fn ports(verilog: &str) -> BTreeSet<String> {
    let header = verilog.split_once("\nmodule ").expect("a module").1;
    let header = header.split_once(");").expect("a header").0;
    let declared = |line: &str| {
        let line = line.split("//").next().unwrap_or_default().trim();
        let rest = line
            .strip_prefix("input ")
            .or_else(|| line.strip_prefix("output "))?;
        let name = rest.trim_end_matches(',').split_whitespace().last()?;
        Some(name.to_owned())
    };
    header.lines().filter_map(declared).collect()
}

/// The chip in Icarus, everything dumped.
fn dumped(dir: &Path, design: &Design) {
    let [iverilog, vvp] = require([Tool::Iverilog, Tool::Vvp]).unwrap_or_else(|it| panic!("{it}"));
    let dump = "module dump;\ninitial begin $dumpfile(\"icarus.vcd\"); $dumpvars(0, chip_tb); end\nendmodule\n";
    fs::write(dir.join("dump.v"), dump).expect("a file");
    let chip = format!("rtl/{}.v", design.spec.name);
    let built = Command::new(&iverilog.path)
        .current_dir(dir)
        .args([
            "-g2005",
            "-s",
            "chip_tb",
            "-s",
            "dump",
            "-o",
            "chip_tb.vvp",
            "dump.v",
            "tb/chip_tb.v",
            &chip,
        ])
        .output()
        .expect("iverilog runs");
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    let run = Command::new(&vvp.path)
        .current_dir(dir)
        .args(["-N", "chip_tb.vvp"])
        .output()
        .expect("vvp runs");
    let said = String::from_utf8_lossy(&run.stdout);
    assert!(said.lines().last().is_some_and(|l| l == "PASS"), "{said}");
}

/// Of every third kind of chip; in the long form of all.
#[test]
fn the_models_waves_are_those_of_the_verilog() {
    for kind in every(3, kinds()) {
        let design = kind.design();
        let sweep = stimulus::named(&design, ROWS)
            .into_iter()
            .find(|s| s.name == "sweep");
        let sweep = sweep.expect("a sweep");
        let package =
            nonius_package::package_with(&design, vec![sweep], "sweep").expect("a package");
        let dir = tempfile::tempdir().expect("scratch");
        nonius_package::write(&package.files, dir.path()).expect("a folder");
        dumped(dir.path(), &design);
        let model = read(&dir.path().join("waves/sweep.vcd"));
        let verilog = read(&dir.path().join("icarus.vcd"));
        let what = &kind.what;
        for (name, bits) in &model.signals {
            assert_eq!(verilog.signals.get(name), Some(bits), "{what}: {name}");
        }
        let chip = dir.path().join(format!("rtl/{}.v", design.spec.name));
        let ports = ports(&fs::read_to_string(chip).expect("the chip"));
        assert!(
            ports.len() > 12 && ports.contains("clk"),
            "{what}: {ports:?}"
        );
        for port in ports {
            assert!(model.signals.contains_key(&port), "{what}: no port {port}");
        }
        // Pins that the testbench turns round between samples are compared by its strobes alone.
        let driven = [
            "clk",
            "sample_valid",
            "adc_cos",
            "adc_sin",
            "preset",
            "calibrate",
        ];
        assert_eq!(
            (model.results.len(), verilog.results.len()),
            (ROWS, ROWS),
            "{what}"
        );
        for (k, (of_model, of_verilog)) in model.results.iter().zip(&verilog.results).enumerate() {
            for (name, value) in of_model
                .iter()
                .filter(|(name, _)| !driven.contains(&name.as_str()))
            {
                assert_eq!(
                    of_verilog.get(name),
                    Some(value),
                    "{what}: {name} at sample {k}"
                );
            }
        }
    }
}
