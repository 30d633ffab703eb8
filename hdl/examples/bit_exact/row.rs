//! How the page begins, and a chip's row on it: what it is, and a fingerprint of its files.

use nonius_model::design::Design;
use nonius_model::spec::{Multipliers, Spec};
use sha2::{Digest, Sha256};

/// Rows of the stimuli that a chip's fingerprint is made of.
const FINGERPRINT: usize = 60;

/// The row up to what the simulators say.
pub(crate) fn begins(what: &str, spec: &Spec) -> Result<String, String> {
    Ok(format!(
        "| {} | {} |",
        described(what, spec),
        fingerprint(spec)?
    ))
}

/// What it is.
pub(crate) fn described(what: &str, spec: &Spec) -> String {
    let multipliers = match spec.chip.multipliers {
        Multipliers::Count(n) => n.to_string(),
        Multipliers::All(_) => "all".into(),
    };
    format!(
        "{} | {} | {} | {} | {multipliers} | {}",
        what,
        spec.tracking.method,
        spec.tracking.filter_type,
        spec.calibration.parameters,
        spec.adc.bits
    )
}

/// Twelve digits for what is compared: Verilog, tables, testbench, and the first rows of the stimuli.
fn fingerprint(spec: &Spec) -> Result<String, String> {
    let design = Design::new(spec).map_err(|e| e.to_string())?;
    let package = nonius_package::package(&design, FINGERPRINT).map_err(|e| e.to_string())?;
    let mut hash = Sha256::new();
    let compared = ["rtl/", "tb/", "coefficients/", "vectors/"];
    for (path, content) in &package.files {
        if compared.iter().any(|folder| path.starts_with(folder)) {
            hash.update(path);
            hash.update(content);
        }
    }
    let digits = hash
        .finalize()
        .iter()
        .take(6)
        .map(|b| format!("{b:02x}"))
        .collect();
    Ok(digits)
}

/// The page above the rows.
pub(crate) const HEAD: &str = "\
# Bit-exactness

Written by `cargo run --release -p nonius-hdl --example bit_exact -- docs`; do not edit. Samples of mixed stimuli
(standstill, both directions, sweep, creep, where bends rest, reversals, jolts, loss, fading (to nothing, and for a while) and drift of the signal, step, corners, bounds, ties, random codes) in which every probe and register of the
Verilog equals the model. A variant that is missing was not run. *Chip* is a fingerprint of its Verilog, tables, testbench and
stimuli: run again, the command takes only those whose files have changed since; *earlier* stands where it has not come to them yet.

| design | method | type | parameters | multipliers | ADC bits | chip | Verilator | Icarus |
|---|---|---|---|---|---|---|---|---|
";
