//! Stored harmonics: what may be asked, the table, and what it leaves.

use std::f64::consts::TAU;

use super::budget::rounding;
use super::promised::{Promised, errors, promised};
use super::refuse::{between, number, refuse};
use super::{Budget, DesignError, Followers, Words};
use crate::format::{Format, exp2};
use crate::kernel::harmonics::{Harmonics as Stored, Order, correct};
use crate::kernel::{Coefficients, Constant, Structure};
use crate::rom::{Column, Rom};
use crate::spec::{Correction, Harmonic, Spec};

/// Highest order of the scale period.
pub const ORDER_MAX: u32 = 16;

/// Largest sum of the amplitudes of a channel: beyond it the pair is not near a circle.
const AMPLITUDE_MAX: f64 = 0.2;

/// Largest change of the phase error with the angle, radians per radian: beyond it the loop's gain would halve or worse, and
/// in the end one pair would stand for several angles.
const SLOPE_MAX: f64 = 0.5;

/// log2 of the most rows that the table may have.
pub(super) const ROWS_LOG2_MAX: u32 = 12;

/// Angles at which what is left is looked at: above twice the highest order with its own.
const ANGLES: u32 = 256;

/// The correction of stored harmonics in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonics {
    /// How far the phase correction is followed: as far as what is left would be more than arithmetic may add.
    pub order: Order,
    /// What it leaves of the angle error, at worst over what the design promises of phase and amplitude, periods rms.
    pub residual_rms_periods: f64,
    /// Largest error of cosine or sine that it leaves, over the same.
    pub pair_error_max: f64,
    /// Angle error of the harmonics themselves, periods rms.
    pub uncorrected_rms_periods: f64,
    /// Largest error of the table's interpolation, as a fraction of the amplitude.
    pub interpolation_max: f64,
}

/// Refuses harmonics that are none, or that no table mends.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    let list = &spec.correction.harmonics;
    let mut orders = vec![];
    for (n, h) in (1..).zip(list) {
        let field = |name: &str| format!("correction.harmonics[{n}].{name}");
        between(
            field("order"),
            h.order.into(),
            2.0,
            ORDER_MAX.into(),
            "the first order is the signal itself, and the table resolves no higher ones",
        )?;
        if orders.contains(&h.order) {
            return refuse(
                field("order"),
                h.order,
                "each order once",
                "two cosines of one order are one: add them",
            );
        }
        orders.push(h.order);
        for (name, amplitude) in [
            ("amplitude_cos", h.amplitude_cos),
            ("amplitude_sin", h.amplitude_sin),
        ] {
            between(
                field(name),
                amplitude,
                0.0,
                AMPLITUDE_MAX,
                "a fraction of the amplitude; a negative one is half a turn of its phase",
            )?;
        }
        for (name, phase) in [("phase_cos", h.phase_cos), ("phase_sin", h.phase_sin)] {
            between(
                field(name),
                phase,
                -2.0 * TAU,
                2.0 * TAU,
                "radians; two turns either way are enough",
            )?;
        }
    }
    for which in 0..2 {
        let sum: f64 = list.iter().map(|h| h.channels()[which].0).sum();
        if sum > AMPLITUDE_MAX {
            return refuse(
                "correction.harmonics",
                format!("amplitudes of {} altogether", number(sum)),
                format!("{AMPLITUDE_MAX} in each channel"),
                "with more than that the pair is not near a circle",
            );
        }
    }
    let steepest = steepest(&spec.correction);
    if steepest > SLOPE_MAX {
        return refuse(
            "correction.harmonics",
            format!("{steepest:.2} rad per rad"),
            SLOPE_MAX,
            "so much the phase error changes with the angle: the loop would lose or gain half its bandwidth along a period",
        );
    }
    Ok(())
}

/// Largest change of the phase error with the angle.
fn steepest(correction: &Correction) -> f64 {
    (0..4 * ANGLES)
        .map(|i| {
            let alpha = TAU * f64::from(i) / f64::from(4 * ANGLES);
            let [(c, dc), (s, ds)] = [0, 1].map(|which| correction.harmonics_at(which, alpha));
            let (sin, cos) = alpha.sin_cos();
            (ds * cos - s * sin - dc * sin - c * cos).abs()
        })
        .fold(0.0, f64::max)
}

/// What the words of the table add to the angle, radians rms.
pub(super) fn terms(words: &Words, follow: &Followers, spec: &Spec) -> Vec<(&'static str, f64)> {
    let list = &spec.correction.harmonics;
    if list.is_empty() {
        return vec![];
    }
    let (read, value) = (follow.harmonic_fraction, follow.harmonic_value_fraction);
    let f = words.signal_fraction;
    let half = TAU * exp2(-i64::from(words.harmonic_rows_log2) - 1);
    // Of a cosine in each channel, of which cosine and sine of the angle take half each: over a segment x²/2 less its half at
    // the ends is 0.171 of that end's, and a cosine has 0.707.
    let over_orders = |of: &dyn Fn(f64) -> f64| {
        let squares = list.iter().map(|h| {
            let pair = h.amplitude_cos.powi(2) + h.amplitude_sin.powi(2);
            of(h.order.into()).powi(2) * pair
        });
        squares.sum::<f64>().sqrt() / 2.0
    };
    let within = (1.0f64 / 20.0 - 1.0 / 12.0 + 1.0 / 16.0).sqrt();
    let phase = TAU * rounding(words.sine_phase_bits);
    // Each channel: the table's word, what is read, and the sine once more behind the phase.
    let roundings =
        2.0 * rounding(value).powi(2) + 2.0 * rounding(read).powi(2) + rounding(f).powi(2);
    vec![
        (
            "harmonic table interpolation",
            over_orders(&|n| within * (n * half).powi(2)),
        ),
        ("harmonic table rounding", (roundings / 2.0).sqrt()),
        ("phase in the harmonics", over_orders(&|n| n * phase)),
    ]
}

/// Table and structure; how far the phase is followed is settled later.
pub(super) fn structure(
    spec: &Spec,
    words: &Words,
    follow: &Followers,
) -> Result<Option<Stored>, DesignError> {
    let list = &spec.correction.harmonics;
    if list.is_empty() {
        return Ok(None);
    }
    Ok(Some(Stored {
        table: table(&spec.correction, words, follow)?,
        order: Order::Second,
    }))
}

/// A period, each segment expanded about its centre; the value of each order is lowered by half its error at the ends. It
/// carries the half bit that rounds the interpolated result.
fn table(correction: &Correction, words: &Words, follow: &Followers) -> Result<Rom, DesignError> {
    let rows = words.harmonic_rows_log2;
    let segment = TAU * exp2(-i64::from(rows));
    let lowered = correction.harmonics.iter().map(|h| {
        let lower = 1.0 - (f64::from(h.order) * segment / 2.0).powi(2) / 4.0;
        Harmonic {
            amplitude_cos: lower * h.amplitude_cos,
            amplitude_sin: lower * h.amplitude_sin,
            ..*h
        }
    });
    let lowered = Correction {
        harmonics: lowered.collect(),
        ..Correction::default()
    };
    let centres = || (0..1u32 << rows).map(|i| segment * (f64::from(i) + 0.5));
    let values = |which| -> Vec<f64> {
        centres()
            .map(|x| lowered.harmonics_at(which, x).0)
            .collect()
    };
    let slopes = |which| -> Vec<f64> {
        centres()
            .map(|x| TAU * correction.harmonics_at(which, x).1)
            .collect()
    };
    let steepest = slopes(0)
        .into_iter()
        .chain(slopes(1))
        .fold(0.0f64, |m, x| m.max(x.abs()));
    let slope_fraction = follow.harmonic_slope_fraction;
    let slope_integer = (steepest + 1.0).log2().ceil().max(0.0) as u32;
    let slope_format = Format::signed(1 + slope_integer + slope_fraction, slope_fraction);
    let unfit = |row: usize| DesignError::Field {
        field: "correction.harmonics".into(),
        value: format!("{} orders", correction.harmonics.len()),
        limit: "smaller amplitudes".into(),
        reason: format!("row {row} of the table of harmonics does not fit its word"),
    };
    let carried = exp2(-i64::from(follow.harmonic_fraction) - 1);
    let value_fraction = follow.harmonic_value_fraction;
    let largest = values(0)
        .into_iter()
        .chain(values(1))
        .fold(0.0f64, |m, x| m.max(x.abs()));
    // The sign, and the bits that the largest has.
    let raw = ((largest + carried) * exp2(value_fraction.into())).ceil() as u64;
    let value_format = Format::signed(1 + (u64::BITS - raw.leading_zeros()), value_fraction);
    let value =
        |name, which| Column::new(name, value_format, values(which), carried).map_err(unfit);
    let slope = |name, which| Column::new(name, slope_format, slopes(which), 0.0).map_err(unfit);
    Ok(Rom {
        name: "harmonic_table",
        address_bits: rows,
        index_fraction: rows,
        columns: vec![
            value("value_cos", 0)?,
            slope("slope_cos", 0)?,
            value("value_sin", 1)?,
            slope("slope_sin", 1)?,
        ],
    })
}

/// Largest error of cosine or sine and rms angle error, radians, at worst: the kernel itself, unrounded. `None` in place of an
/// order: no correction.
fn left(
    order: Option<Order>,
    spec: &Spec,
    structure: &Structure,
    k: &Coefficients<f64>,
) -> (f64, f64) {
    let each = promised(spec, structure, k).map(|Promised { tan, thetas }| {
        errors(ANGLES, |alpha, cos, sin| {
            let [h_c, h_s] = [0, 1].map(|which| spec.correction.harmonics_at(which, alpha).0);
            let pair = (cos + h_c, sin + tan * h_c + h_s * tan.hypot(1.0));
            order.map_or(pair, |order| {
                correct(pair, (h_c, h_s), thetas, k, (structure, order))
            })
        })
    });
    each.fold((0.0, 0.0), |all, one| (all.0.max(one.0), all.1.max(one.1)))
}

/// Settles how far the phase correction is followed: until what is left is less than half of what arithmetic may add. It
/// counts with what is promised and not corrected.
pub(super) fn settle(
    spec: &Spec,
    budget: &mut Budget,
    structure: &mut Structure,
    constants: &Coefficients<Constant>,
) -> Option<Harmonics> {
    structure.harmonics.as_ref()?;
    let k = constants.real();
    let orders = [Order::Zeroth, Order::First, Order::Second];
    let tried = orders.map(|order| (order, left(Some(order), spec, structure, &k)));
    let enough = |(_, left): &&(Order, (f64, f64))| left.1 / TAU <= budget.allowed / 2.0;
    let (order, (pair_error_max, residual)) = *tried.iter().find(enough).unwrap_or(&tried[2]);
    let residual = residual / TAU;
    let uncorrected = left(None, spec, structure, &k).1 / TAU;
    budget.uncorrected = budget.uncorrected.hypot(residual);
    let stored = structure.harmonics.as_mut()?;
    stored.order = order;
    let half = TAU * exp2(-i64::from(stored.table.index_fraction) - 1);
    let list = &spec.correction.harmonics;
    let interpolation = |which: usize| -> f64 {
        let each = list.iter().map(|h| {
            let x = f64::from(h.order) * half;
            h.channels()[which].0 * x * x / 4.0
        });
        each.sum()
    };
    Some(Harmonics {
        order,
        residual_rms_periods: residual,
        pair_error_max,
        uncorrected_rms_periods: uncorrected,
        interpolation_max: interpolation(0).max(interpolation(1)),
    })
}
