//! `nonius build`: the whole package of a design.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use nonius_model::design::Design;
use nonius_package::{DesignJson, package_with, write};
use nonius_recording::Recording;
use nonius_testvectors::stimulus;

use crate::play;
use crate::recording_args::RecordingArgs;

/// Samples of each named stimulus.
const ROWS: usize = 2000;

/// What to build.
#[derive(Args)]
pub(crate) struct Build {
    /// The design.
    design: PathBuf,
    /// Folder to write; replaced if nonius wrote it before.
    #[arg(short)]
    output: PathBuf,
    /// A recording (CSV) to play into the Verilog too, besides the named stimuli; its waves are written.
    #[arg(long, value_name = "RECORDING")]
    play: Option<PathBuf>,
    /// Plays a recording of whole turns so many times.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "play", value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

pub(crate) fn run(args: &Build) -> Result<()> {
    let spec = crate::design_file::read(&args.design)?;
    let design =
        Design::new(&spec).with_context(|| format!("{} cannot work", args.design.display()))?;
    let mut stimuli = stimulus::named(&design, ROWS);
    if let Some(path) = &args.play {
        let recording = Recording::read(path, &args.recording_args.overrides())?;
        play::check(&spec, &recording, path, args.repeat)?;
        stimuli.push(play::stimulus(&spec, &recording, args.repeat));
    }
    let shown = if args.play.is_some() {
        "recording"
    } else {
        "sweep"
    };
    let package = package_with(&design, stimuli, shown)?;
    write(&package.files, &args.output)?;
    summary(&package.json, &args.output, shown);
    Ok(())
}

fn summary(j: &DesignJson, output: &Path, shown: &str) {
    let rate = j.spec.adc.sample_rate_hz;
    println!("{} (design {})", j.name, j.hash);
    println!(
        "  accuracy    {:.2e} periods rms predicted, {:.2e} simulated, {:.2e} asked",
        j.budget.total, j.simulated.rms_periods, j.budget.asked
    );
    println!(
        "  speed       {:.4} MS/s need a clock of {:.4} MHz: {} clocks per sample",
        rate / 1e6,
        j.latency.clock_hz_min / 1e6,
        j.clocks_per_sample
    );
    println!(
        "  hardware    {} multiplier{} for {} products, {} table bits",
        j.multipliers,
        if j.multipliers == 1 { "" } else { "s" },
        j.products,
        j.sine_table.bits
    );
    println!(
        "  bandwidth   {:.4e} Hz at -3 dB, to {:.4e} periods/s",
        j.tracking.bandwidth_3db_hz, j.tracking.speed_max_periods_per_s
    );
    if j.simulated.rms_periods > j.budget.asked {
        println!(
            "  note        the simulated accuracy misses what was asked for: calibration noise and loop noise add up; \
             a smaller last gamma or a narrower loop would help"
        );
    }
    let folder = output.display();
    println!(
        "  written     {folder}/: rtl, tb, vectors, waves, coefficients, design.json, report.html"
    );
    println!("next: nonius verify {folder}");
    println!("      gtkwave {folder}/waves/{shown}.gtkw");
}
