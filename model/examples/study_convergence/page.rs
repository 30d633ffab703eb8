//! The table as a page.

use std::fmt::Write as _;

const HEAD: &str = "\
# Every calibration in every scenario

Written by the example `study_convergence` with `methods.csv`, which has the same numbers; do not edit. See
[convergence.md](../convergence.md) for what the rows and scenarios are. Miscalibration is the angle of the noise-free
corrected pair less the true one at the end of the run; *periods* are those travelled until it stays within a tenth of its final
value. Products, clocks and LUT4 (one multiplier, iCE40) are the whole chip's; rows without are `f64`.
";

/// One table for each scenario.
pub(crate) fn page(csv: &str) -> String {
    let mut page = HEAD.to_owned();
    let mut scenario = String::new();
    for line in csv.lines().skip(1) {
        let Some((method, rest)) = line.trim_start_matches('"').split_once("\",") else {
            continue;
        };
        let cells: Vec<&str> = rest.split(',').collect();
        let Some((first, numbers)) = cells.split_first() else {
            continue;
        };
        if scenario != *first {
            (*first).clone_into(&mut scenario);
            _ = write!(
                page,
                "\n## {scenario}\n\n| method | parameter error | miscalibration rms, mrad | largest | α̂ rms, mrad | largest | periods | products | clocks | LUT4 |\n|---|---|---|---|---|---|---|---|---|---|\n"
            );
        }
        _ = writeln!(page, "| {method} | {} |", numbers.join(" | "));
    }
    page
}
