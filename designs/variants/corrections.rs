//! Chips that correct what is known beforehand: a sine that is sampled later, stored harmonics.

use std::f64::consts::FRAC_PI_2;

use nonius_model::spec::{
    CalibrationMethod, CalibrationStart, Coding, Harmonic, Multipliers, Spec,
};

use super::{ALL, Variant, type_1};
use CalibrationMethod::{Exact, SumOfSquares};
use CalibrationStart::LeastSquares;

/// Chips for a sine that is sampled later or earlier: each method and type, each parameter set, the series to its first
/// order (so little skew that it is enough) and to its second.
pub(crate) fn skewed() -> Vec<Variant> {
    let one = Multipliers::Count(1);
    let of = |(method, filter_type, parameters, multipliers, delay): (u32, u32, u32, _, f64)| {
        Variant::of(format!("skew {delay:e} s"), |spec| {
            spec.tracking.method = method;
            if filter_type == 1 {
                type_1(spec);
            }
            spec.calibration.parameters = parameters;
            spec.chip.multipliers = multipliers;
            spec.correction.channel_skew_s = delay;
        })
    };
    [
        (3, 2, 5, one, 1e-7),
        (3, 2, 5, ALL, -1e-7),
        (1, 2, 4, ALL, 2e-7),
        (1, 1, 5, one, 1e-9),
        (2, 1, 4, one, -4e-7),
        (3, 1, 9, ALL, 1e-6),
        (3, 2, 9, one, 3e-7),
        (3, 2, 0, one, 3e-7),
    ]
    .map(of)
    .into()
}

/// One order of the scale period, of any phase.
fn harmonic(order: u32, cos: (f64, f64), sin: (f64, f64)) -> Harmonic {
    Harmonic {
        order,
        amplitude_cos: cos.0,
        phase_cos: cos.1,
        amplitude_sin: sin.0,
        phase_sin: sin.1,
    }
}

/// Third and fifth order of free phase.
pub(crate) fn third_and_fifth() -> Vec<Harmonic> {
    vec![
        harmonic(3, (0.012, 0.7), (0.015, -2.1)),
        harmonic(5, (0.006, 2.5), (0.004, 1.1)),
    ]
}

/// Chips with stored harmonics: each parameter set and method, the phase correction followed not at all, to its first and to
/// its second order, with a search that gathers, a start, and a sine that is sampled later.
pub(crate) fn harmonics() -> Vec<Variant> {
    let one = Multipliers::Count(1);
    let of = |what: &str, parameters: u32, multipliers: Multipliers, change: &dyn Fn(&mut Spec)| {
        Variant::of(format!("harmonics, {what}"), |spec| {
            spec.calibration.parameters = parameters;
            spec.chip.multipliers = multipliers;
            spec.correction.harmonics = third_and_fifth();
            change(spec);
        })
    };
    vec![
        of("second order", 5, one, &|_| ()),
        of("first order", 5, ALL, &|spec| {
            spec.sensor.phase_error_max_deg = 0.5;
        }),
        of("no phase by promise", 5, one, &|spec| {
            spec.sensor.phase_error_max_deg = 0.001;
        }),
        of("four parameters", 4, Multipliers::Count(2), &|spec| {
            spec.tracking.method = 1;
            spec.correction.harmonics = vec![harmonic(16, (0.2 / 18.0, 0.0), (0.01, 3.0))];
        }),
        of("fixed, type 1", 0, one, &type_1),
        of("completed", 9, one, &|spec| {
            spec.correction.harmonics = vec![harmonic(2, (0.1, 1.0), (0.1, 1.0 - FRAC_PI_2))];
        }),
        of("completed, skew", 9, ALL, &|spec| {
            spec.correction.channel_skew_s = 3e-7;
        }),
        of("started, skew", 5, Multipliers::Count(3), &|spec| {
            spec.calibration.start = LeastSquares;
            spec.correction.channel_skew_s = -1e-7;
        }),
        of("sum of squares", 5, one, &|spec| {
            spec.calibration.method = SumOfSquares;
        }),
        of("exact, offset binary", 5, one, &|spec| {
            spec.calibration.method = Exact;
            spec.adc.coding = Coding::OffsetBinary;
        }),
    ]
}
