//! Clocks and LUTs of the chips, as measured by `nonius-hdl`'s example `costs`.

use std::collections::HashMap;

use nonius_model::design::Design;

/// Clocks per sample and LUT4, by what a design calibrates.
#[derive(Default)]
pub(crate) struct Costs(HashMap<String, [String; 2]>);

impl Costs {
    /// From CSV with a header: method, start, parameters, completion, clocks, LUT4.
    pub(crate) fn read(csv: &str) -> Self {
        let row = |line: &str| {
            let cells: Vec<&str> = line.split(',').collect();
            let (key, [clocks, luts]) = cells.split_at_checked(4).map(|(key, rest)| {
                let cell = |i: usize| rest.get(i).copied().unwrap_or_default().to_owned();
                (key.join(","), [cell(0), cell(1)])
            })?;
            Some((key, [clocks, luts]))
        };
        Self(csv.lines().skip(1).filter_map(row).collect())
    }

    /// Those of a design; empty where they were not measured.
    pub(crate) fn of(&self, design: &Design) -> [String; 2] {
        let c = &design.spec.calibration;
        let completion = design.structure.calibration.completed().is_some();
        let key = format!("{:?},{:?},{},{completion}", c.method, c.start, c.parameters);
        self.0.get(&key).cloned().unwrap_or_default()
    }
}
