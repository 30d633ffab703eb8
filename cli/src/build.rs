//! `nonius build`: the whole package of a design.

use std::path::Path;

use anyhow::{Context, Result};
use nonius_model::design::Design;
use nonius_package::{DesignJson, package, write};

/// Samples of each named stimulus.
const ROWS: usize = 2000;

pub(crate) fn run(design: &Path, output: &Path) -> Result<()> {
    let spec = crate::design_file::read(design)?;
    let design = Design::new(&spec).with_context(|| format!("{} cannot work", design.display()))?;
    let package = package(&design, ROWS)?;
    write(&package.files, output)?;
    summary(&package.json, output);
    Ok(())
}

fn summary(j: &DesignJson, output: &Path) {
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
    println!("      gtkwave {folder}/waves/sweep.gtkw");
}
