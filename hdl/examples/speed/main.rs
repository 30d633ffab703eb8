//! How fast the three readings of a chip are, measured one after the other in one run.
//!
//!     cargo run --release -p nonius-hdl --example speed -- DESIGN.toml DOCS
//!
//! writes DOCS/speed.md: samples per second of the bit-true chip, of the same algorithm in `f64`, of the paper's
//! reference in `f64`, and of the generated Verilog in Verilator.

use std::env;
use std::error::Error;
use std::fs;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::{Duration, Instant};

use nonius_hdl::ChipDir;
use nonius_hdl::progress::silent;
use nonius_hdl::tools::{Tool, require};
use nonius_hdl::verilator::{Effort, simulate};
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::Input;
use nonius_model::reference::Reference;
use nonius_model::reference::from_spec::{self, Normalise};
use nonius_model::spec::Spec;
use nonius_testvectors::stimulus::{self, Sample};

/// Samples of one pass: what fits the cache, so that the chip is measured and not the memory.
const ROWS: usize = 4096;
const PASSES: usize = 50;
/// The fastest of so many repetitions counts: what else the machine does only ever slows.
const REPEATS: usize = 50;
/// Samples for Verilator, where the testbench reads every vector from a file.
const HDL_ROWS: usize = 20_000;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [design, docs] = arguments.as_slice() else {
        eprintln!("usage: speed DESIGN.toml DOCS");
        return ExitCode::from(2);
    };
    match run(design, Path::new(docs)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("speed: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(file: &str, docs: &Path) -> Result<(), Box<dyn Error>> {
    let spec = Spec::from_toml(&fs::read_to_string(file)?, file)?;
    let design = Design::new(&spec)?;
    let samples = stimulus::named(&design, ROWS)
        .into_iter()
        .find(|s| s.name == "forwards")
        .ok_or("there is no stimulus forwards")?
        .samples;
    let bit_true = bit_true(&design, &samples);
    let unrounded = unrounded(&design, &samples);
    let paper = paper(&design, &samples)?;
    let alone = alone(&design, &samples)?;
    let verilated = verilated(&design)?;
    let line = |what: &str, rate: f64| format!("| {what} | {:.3} |\n", rate / 1e6);
    let page = [
        HEAD.to_owned(),
        format!("Design `{}`.\n\n", spec.name),
        "| reading | million samples per second |\n|---|---|\n".to_owned(),
        line("bit-true chip (`Chip<Bits>`)", bit_true),
        line("the same kernels in `f64` (`Chip<f64>`)", unrounded),
        line("the paper in `f64` (`model/src/reference`)", paper),
        line("generated Verilog in Verilator, driven from C++", alone),
        line("the same with testbench, every probe compared", verilated),
    ]
    .concat();
    fs::create_dir_all(docs)?;
    fs::write(docs.join("speed.md"), &page)?;
    print!("{page}");
    Ok(())
}

fn best(mut pass: impl FnMut()) -> f64 {
    let mut least = Duration::MAX;
    for _ in 0..REPEATS {
        let start = Instant::now();
        for _ in 0..PASSES {
            pass();
        }
        least = least.min(start.elapsed());
    }
    (ROWS * PASSES) as f64 / least.as_secs_f64()
}

fn bit_true(design: &Design, samples: &[Sample]) -> f64 {
    let mut chip = Chip::bit_true(design);
    best(|| {
        for s in samples {
            chip.step_codes(s.cos, s.sin, s.preset, s.calibrate);
            black_box(chip.state.alpha_hat);
        }
    })
}

/// Codes as fractions of the ADC's range.
fn fractions(design: &Design, samples: &[Sample]) -> Vec<(f64, f64)> {
    let lsb = 2f64.powi(-(design.structure.formats.adc.fraction as i32));
    let pair = |s: &Sample| (s.cos as f64 * lsb, s.sin as f64 * lsb);
    samples.iter().map(pair).collect()
}

fn unrounded(design: &Design, samples: &[Sample]) -> f64 {
    let inputs: Vec<_> = fractions(design, samples)
        .into_iter()
        .zip(samples)
        .map(|((adc_cos, adc_sin), s)| Input {
            adc_cos,
            adc_sin,
            preset: s.preset,
            calibrate: s.calibrate,
        })
        .collect();
    let mut chip = Chip::unrounded(design);
    best(|| {
        for input in &inputs {
            chip.step(input);
            black_box(chip.state.alpha_hat);
        }
    })
}

fn paper(design: &Design, samples: &[Sample]) -> Result<f64, Box<dyn Error>> {
    let normalise = Normalise::of(&design.spec);
    let mut reference = Reference::new(from_spec::config(&design.spec)?)?;
    let half = 2f64.powi(design.spec.adc.bits as i32 - 1);
    let middle = if design.structure.offset_binary {
        half
    } else {
        0.0
    };
    let volts = |code: i64| normalise.y((code as f64 - middle) / half);
    let pairs: Vec<_> = samples
        .iter()
        .map(|s| (volts(s.cos), volts(s.sin)))
        .collect();
    Ok(best(|| {
        for &(y_c, y_s) in &pairs {
            black_box(reference.step(y_c, y_s));
        }
    }))
}

fn verilated(design: &Design) -> Result<f64, Box<dyn Error>> {
    let dir = tempfile::tempdir()?;
    let package = nonius_package::package(design, HDL_ROWS)?;
    nonius_package::write(&package.files, dir.path())?;
    let chip = ChipDir::open(dir.path())?;
    let run = simulate(
        &chip,
        Effort::QuickRun,
        Duration::from_secs(600),
        &[],
        &silent,
    )?;
    if !run.passed {
        return Err(run.failure.unwrap_or_default().into());
    }
    Ok(run.samples.ok_or("no number of samples")? as f64 / run.seconds)
}

/// The chip alone in Verilator, without testbench and vectors.
fn alone(design: &Design, samples: &[Sample]) -> Result<f64, Box<dyn Error>> {
    let [verilator, _, _] = require([Tool::Verilator, Tool::Cxx, Tool::Make])?;
    let dir = tempfile::tempdir()?;
    nonius_package::write(&nonius_package::package(design, 2)?.files, dir.path())?;
    let mask = (1u64 << design.spec.adc.bits) - 1;
    let codes: String = samples
        .iter()
        .map(|s| format!("{:x} {:x}\n", s.cos as u64 & mask, s.sin as u64 & mask))
        .collect();
    fs::write(dir.path().join("codes.txt"), codes)?;
    fs::write(dir.path().join("driver.cpp"), include_str!("driver.cpp"))?;
    let name = &design.spec.name;
    let run = |command: &mut Command| -> Result<String, Box<dyn Error>> {
        let output = command.current_dir(dir.path()).output()?;
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
        }
        Ok(String::from_utf8(output.stdout)?)
    };
    run(Command::new(&verilator.path)
        .args(["--cc", "--exe", "--build", "-O3", "--prefix", "Vchip"])
        .args(["-MAKEFLAGS", "OPT_FAST=-O3 OPT_GLOBAL=-O3"])
        .args(["--top-module", name, "--Mdir", "alone", "driver.cpp"])
        .arg(format!("rtl/{name}.v")))?;
    let said = run(&mut Command::new(dir.path().join("alone/Vchip")))?;
    match said.split_whitespace().collect::<Vec<_>>().as_slice() {
        [rate, "1", _] => Ok(rate.parse()?),
        _ => Err(format!("the chip does not follow: {said}").into()),
    }
}

const HEAD: &str = "\
# Speed

Written by `cargo run --release -p nonius-hdl --example speed -- designs/optical.toml docs`; do not edit. One core;
the fastest of fifty repetitions of two hundred thousand samples (Verilog from C++: of ten of forty thousand): other work
on the machine only ever slows. The Verilog is compiled with -O3 (its testbench as `nonius verify` does it). The testbench's time includes reading the vectors.

";
