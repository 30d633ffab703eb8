//! The correction of stored harmonics in numbers.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::design::Design;
use nonius_model::kernel::harmonics::{Order, stored};
use serde::Serialize;

use crate::sine::phases;

/// The table of harmonics and what is made of it.
#[derive(Clone, Debug, Serialize)]
pub struct HarmonicTable {
    /// Orders of the scale period that it holds.
    pub orders: Vec<u32>,
    /// Rows, a period of them.
    pub rows: usize,
    /// Bits of a row.
    pub row_bits: u32,
    /// Bits altogether.
    pub bits: u64,
    /// Largest error of what is read, as a fraction of the amplitude.
    pub largest_error: f64,
    /// Every phase was tried.
    pub exhaustive: bool,
    /// Phases tried.
    pub phases: u64,
    /// Order in tan(beta) to which the phase correction is followed.
    pub phase_order: u32,
    /// Angle error that this order leaves, at worst over what the design promises, periods rms.
    pub left_periods: f64,
    /// Angle error of the harmonics without it, periods rms.
    pub uncorrected_periods: f64,
}

impl HarmonicTable {
    /// Measures the table.
    pub(crate) fn of(design: &Design) -> Option<Self> {
        let (found, structure) = (design.harmonics?, &design.structure);
        let known = structure.harmonics.as_ref()?;
        let (k, correction) = (design.constants.bits(), &design.spec.correction);
        let bits = structure.formats.sine_phase.format.fraction;
        let (exhaustive, places) = phases(bits);
        let (mut largest, mut count) = (0.0f64, 0);
        for phase in places {
            let alpha = (phase as f64 + 0.5) / 2f64.powi(bits as i32) * TAU;
            let turns = Bits::from_raw(phase as i64, bits);
            let (c, s) = stored(turns, None, &k, (structure, known));
            for (which, read) in [c, s].into_iter().enumerate() {
                let (exact, _) = correction.harmonics_at(which, alpha);
                largest = largest.max((read.to_f64() - exact).abs());
            }
            count += 1;
        }
        Some(Self {
            orders: correction.harmonics.iter().map(|h| h.order).collect(),
            rows: known.table.rows(),
            row_bits: known.table.row_width(),
            bits: known.table.bits(),
            largest_error: largest,
            exhaustive,
            phases: count,
            phase_order: match found.order {
                Order::Zeroth => 0,
                Order::First => 1,
                Order::Second => 2,
            },
            left_periods: found.residual_rms_periods,
            uncorrected_periods: found.uncorrected_rms_periods,
        })
    }
}
