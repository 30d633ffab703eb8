//! `nonius build`: everything is written to a temporary folder beside the target, which then takes its name.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_testvectors::{stimulus, vectors};

const ROWS: usize = 2000;

pub(crate) fn run(design: &Path, output: &Path) -> Result<()> {
    let file = design.display().to_string();
    let text = fs::read_to_string(design).with_context(|| format!("cannot read {file}"))?;
    let spec = Spec::from_toml(&text, &file)?;
    let design = Design::new(&spec).with_context(|| format!("{file} cannot work"))?;
    if output.exists() && !output.join("design.json").is_file() {
        bail!(
            "{} exists and was not written by nonius; name another folder",
            output.display()
        );
    }
    let parent = output
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    fs::create_dir_all(parent)?;
    let scratch = tempfile::tempdir_in(parent)?;
    let stimuli = stimulus::named(&design, ROWS);
    let names: Vec<_> = stimuli
        .iter()
        .map(|s| (s.name.clone(), s.samples.len()))
        .collect();
    let hash = nonius_codegen::hash(&design);
    let chip = nonius_codegen::generate(&design, &hash, &names)?;
    let write = |path: &str, content: &str| -> Result<()> {
        let path = scratch.path().join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, content).with_context(|| format!("cannot write {}", path.display()))
    };
    for (path, content) in &chip.files {
        write(path, content)?;
    }
    for one in &stimuli {
        write(
            &format!("vectors/{}.vec", one.name),
            &vectors::rows(&design, one, &chip.columns),
        )?;
    }
    let (b, t, w) = (&design.budget, &design.tracking, &design.words);
    let json = serde_json::json!({
        "name": spec.name,
        "hash": hash,
        "clocks_per_sample": chip.clocks,
        "products": design.graph.products(),
        "loop": {"omega0_ts": t.omega, "pole_sum": t.pole_sum, "pole_product": t.pole_product, "a": t.a, "a_plus_b": t.ab,
            "a_quantised": design.constants.loop_a.value(), "a_plus_b_quantised": design.constants.loop_ab.value()},
        "words": {"signal_fraction": w.signal_fraction, "phase_bits": w.phase_bits, "sine_phase_bits": w.sine_phase_bits,
            "sine_rows_log2": w.sine_rows_log2, "accumulator_fraction": w.accumulator_fraction},
        "budget_periods_rms": {"adc": b.adc, "noise": b.noise, "allowed_arithmetic": b.allowed,
            "arithmetic": b.arithmetic(), "total": b.total(),
            "terms": b.terms.iter().map(|t| (t.source.to_owned(), t.rms_periods)).collect::<std::collections::BTreeMap<_, _>>()},
        "sine_table": {"rows": design.structure.sine.rows(), "row_bits": design.structure.sine.row_width()},
    });
    write(
        "design.json",
        &(serde_json::to_string_pretty(&json)? + "\n"),
    )?;
    if output.exists() {
        fs::remove_dir_all(output)?;
    }
    fs::rename(scratch.keep(), output)?;
    println!(
        "{}: {} clocks per sample, {} products, {} table bits",
        spec.name,
        chip.clocks,
        design.graph.products(),
        design.structure.sine.bits()
    );
    println!(
        "accuracy predicted {:.3e} periods rms (asked {:.3e})",
        b.total(),
        spec.accuracy.rms_periods
    );
    println!("next: nonius verify {}", output.display());
    Ok(())
}
