//! The table as a page.

use std::fmt::Write as _;

const HEAD: &str = "\
# Every calibration in every scenario

Written by the example `study_convergence` from the numbers of `methods.csv`; do not edit. What the rows and scenarios are:
[convergence.md](../convergence.md). Miscalibration is the angle of the noise-free corrected pair less the true one at the
end of the run, the *parameter error* the largest difference of a parameter from those that correct the sensor best as it is then; *periods* are those travelled until it stays within a tenth of its final value, or, where noise moves it out of
that for ever, until it first is there. Products, clocks and LUT4 (one
multiplier, iCE40) are the whole chip's; rows without are `f64`.

## Miscalibration, mrad rms

";

/// Columns of a scenario's own table.
const COLUMNS: &str = "| method | parameter error | miscalibration rms, mrad | largest | α̂ rms, mrad | largest | periods |";

/// A row of the CSV: what was run where, and its numbers.
struct Row<'a> {
    method: &'a str,
    scenario: &'a str,
    numbers: Vec<&'a str>,
}

impl<'a> Row<'a> {
    fn read(line: &'a str) -> Option<Self> {
        let (method, rest) = line.strip_prefix('"')?.split_once("\",")?;
        let mut cells = rest.split(',');
        Some(Self {
            method,
            scenario: cells.next()?,
            numbers: cells.collect(),
        })
    }

    /// A number of the row; empty where it has none.
    fn number(&self, column: usize) -> &'a str {
        self.numbers.get(column).copied().unwrap_or_default()
    }
}

/// All scenarios beside each other, then a table for each.
pub(crate) fn page(csv: &str) -> String {
    let rows: Vec<Row<'_>> = csv.lines().skip(1).filter_map(Row::read).collect();
    let mut scenarios: Vec<&str> = rows.iter().map(|row| row.scenario).collect();
    scenarios.dedup();
    let mut page = HEAD.to_owned();
    let rule = |columns: usize| format!("|{}\n", "---|".repeat(columns));
    _ = writeln!(
        page,
        "| method | {} | products | clocks | LUT4 |",
        scenarios.join(" | ")
    );
    page += &rule(scenarios.len() + 4);
    let first = scenarios.first().copied().unwrap_or_default();
    for row in rows.iter().filter(|row| row.scenario == first) {
        _ = write!(page, "| {} |", row.method);
        for other in rows.iter().filter(|other| other.method == row.method) {
            _ = write!(page, " {} |", other.number(1));
        }
        _ = writeln!(
            page,
            " {} | {} | {} |",
            row.number(6),
            row.number(7),
            row.number(8)
        );
    }
    for scenario in scenarios {
        _ = writeln!(page, "\n## {scenario}\n\n{COLUMNS}");
        page += &rule(7);
        for row in rows.iter().filter(|row| row.scenario == scenario) {
            let numbers: Vec<&str> = (0..6).map(|column| row.number(column)).collect();
            _ = writeln!(page, "| {} | {} |", row.method, numbers.join(" | "));
        }
    }
    page
}
