//! Poles, loop coefficients, and what the loop can follow.

use std::f64::consts::TAU;

use super::DesignError;
use crate::spec::{CalibrationMethod, Spec};

/// The tracking loop in real numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// ω0 ts.
    pub omega: f64,
    /// p1 + p2.
    pub pole_sum: f64,
    /// p1 p2.
    pub pole_product: f64,
    /// Second pole of the filter; 1 for type 2.
    pub pole: f64,
    /// a, turns per radian.
    pub a: f64,
    /// a + b, turns per radian.
    pub ab: f64,
    /// Noise bandwidth as a fraction of the sample rate: Σ h² of the closed loop.
    pub noise_gain: f64,
}

/// How the loop widens in acquisition: `gears` steps of 2^`stride` in bandwidth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acquisition {
    /// Gears above the designed one.
    pub gears: u32,
    /// Each divides the bandwidth by 2^`stride`.
    pub stride: u32,
}

fn refuse<T>(
    field: &'static str,
    value: impl ToString,
    limit: impl ToString,
    reason: impl ToString,
) -> Result<T, DesignError> {
    let (value, limit, reason) = (value.to_string(), limit.to_string(), reason.to_string());
    Err(DesignError::Field {
        field,
        value,
        limit,
        reason,
    })
}

fn between(
    field: &'static str,
    value: f64,
    low: f64,
    high: f64,
    reason: &str,
) -> Result<(), DesignError> {
    if value.is_finite() && value >= low && value <= high {
        return Ok(());
    }
    refuse(field, value, format!("{low} … {high}"), reason)
}

/// Checks every field for sense.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first = spec.name.chars().next().unwrap_or(' ');
    if !first.is_ascii_alphabetic() || !spec.name.chars().all(word) || spec.name.len() > 64 {
        return refuse(
            "name",
            &spec.name,
            "letters, digits and _, a letter first",
            "it names Verilog modules",
        );
    }
    between(
        "adc.bits",
        spec.adc.bits.into(),
        8.0,
        18.0,
        "the chip is built for ADCs of 8 to 18 bits",
    )?;
    between(
        "adc.full_scale",
        spec.adc.full_scale,
        1e-9,
        1e12,
        "the ADC needs a range",
    )?;
    between(
        "adc.middle",
        spec.adc.middle,
        -1e12,
        1e12,
        "the middle of the range must be a number",
    )?;
    between(
        "adc.sample_rate_hz",
        spec.adc.sample_rate_hz,
        1e-3,
        1e10,
        "samples per second",
    )?;
    let (low, high) = (spec.adc.full_scale / 64.0, spec.adc.full_scale);
    between(
        "sensor.amplitude",
        spec.sensor.amplitude,
        low,
        high,
        "the signal must fit the ADC's range and use some of it",
    )?;
    between(
        "sensor.amplitude_tolerance",
        spec.sensor.amplitude_tolerance,
        0.0,
        0.6,
        "calibration is bounded to what is promised here",
    )?;
    between(
        "sensor.offset_max",
        spec.sensor.offset_max,
        0.0,
        0.6,
        "a larger offset moves the origin out of the ellipse",
    )?;
    between(
        "sensor.phase_error_max_deg",
        spec.sensor.phase_error_max_deg,
        0.0,
        45.0,
        "beyond that the two channels are nearly one",
    )?;
    between(
        "sensor.noise_rms",
        spec.sensor.noise_rms,
        0.0,
        0.25,
        "no loop locks on more noise",
    )?;
    between(
        "accuracy.rms_periods",
        spec.accuracy.rms_periods,
        1e-9,
        0.1,
        "accuracy in scale periods",
    )?;
    between(
        "accuracy.arithmetic_share",
        spec.accuracy.arithmetic_share,
        1e-3,
        1.0,
        "a part of the accuracy",
    )?;
    between(
        "chip.count_bits",
        spec.chip.count_bits.into(),
        32.0,
        44.0,
        "counted periods",
    )?;
    between(
        "sensor.bend_max",
        spec.sensor.bend_max,
        0.0,
        0.2,
        "polynomials of third order mend no more",
    )?;
    calibration(spec)?;
    between(
        "calibration.gamma_first",
        spec.calibration.gamma_first.into(),
        3.0,
        12.0,
        "the sum of gamma over the 64 sectors of a period must stay below 8",
    )?;
    between(
        "calibration.gamma_last",
        spec.calibration.gamma_last.into(),
        spec.calibration.gamma_first.into(),
        18.0,
        "the last gamma is not larger than the first",
    )?;
    between(
        "calibration.gear_periods",
        spec.calibration.gear_periods.into(),
        1.0,
        255.0,
        "periods between gears",
    )?;
    between(
        "calibration.restart_residual",
        spec.calibration.restart_residual,
        0.01,
        1.5,
        "residual as a fraction of the radius",
    )?;
    if let crate::spec::Multipliers::Count(0) = spec.chip.multipliers {
        return refuse(
            "chip.multipliers",
            0,
            "1, 2, … or \"all\"",
            "products need a multiplier",
        );
    }
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    if !(top.is_finite() && top > 0.0 && top <= 0.2) {
        let needed = spec.sensor.speed_max_periods_per_s * 5.0;
        return refuse(
            "adc.sample_rate_hz",
            spec.adc.sample_rate_hz,
            format!("at least {needed} Hz"),
            "the loop needs five samples per period at top speed",
        );
    }
    Ok(())
}

fn calibration(spec: &Spec) -> Result<(), DesignError> {
    let c = &spec.calibration;
    if !matches!(c.parameters, 0 | 4 | 5 | 8 | 9) {
        return refuse(
            "calibration.parameters",
            c.parameters,
            "0, 4, 5, 8 or 9",
            "offsets and gains are 4, with the phase 5, with the bends of both channels 8 and 9",
        );
    }
    let bends = c.parameters >= 8;
    if bends && c.method == CalibrationMethod::Exact {
        return refuse(
            "calibration.method",
            "exact",
            "\"final\", which completes itself with one sensitivity, or 4 or 5 parameters",
            "recursion (11) for each of 8 or 9 parameters costs 16 or 18 products a sample for what one scalar shows",
        );
    }
    if bends && c.method != CalibrationMethod::Final {
        return refuse(
            "calibration.method",
            "sum of squares",
            "\"final\", or 4 or 5 parameters",
            "the sum of squares sees the radius alone and cannot be completed: with bends it stands still beside the truth",
        );
    }
    if bends && c.completion && spec.sensor.periods_per_revolution == Some(1.0) {
        return refuse(
            "calibration.completion",
            true,
            "false, or 5 parameters",
            "where a scale period is a revolution, motion at two cycles per revolution looks like a bend and would be learnt",
        );
    }
    between(
        "calibration.forgetting",
        c.forgetting.into(),
        0.0,
        4.0,
        "longer memory than a quarter of a period makes the search swing",
    )?;
    between(
        "calibration.completion_gamma",
        c.completion_gamma.into(),
        1.0,
        18.0,
        "a gamma of 2^-0 does not converge, and 2^-18 takes a million samples",
    )
}

impl Loop {
    pub(super) fn new(spec: &Spec) -> Result<Self, DesignError> {
        let t = &spec.tracking;
        if !matches!(t.method, 1..=3) {
            return refuse(
                "loop.method",
                t.method,
                "1, 2 or 3",
                "the paper has three methods",
            );
        }
        if !matches!(t.filter_type, 1 | 2) {
            return refuse(
                "loop.type",
                t.filter_type,
                "1 or 2",
                "poles of the filter at 1",
            );
        }
        if t.method == 2 && t.filter_type == 2 {
            return refuse(
                "loop.type",
                2,
                "1",
                "Method 2 uses its filter pole to place the closed loop's poles, so a type 2 filter is impossible (paper, 4.2); take Method 3",
            );
        }
        if let Some(pole) = t.pole {
            if t.filter_type == 2 || t.method == 2 {
                return refuse(
                    "loop.pole",
                    pole,
                    "absent",
                    "only a type 1 filter of Method 1 or 3 has a free second pole",
                );
            }
            between(
                "loop.pole",
                pole,
                0.0,
                0.999_999,
                "the filter's second pole lies inside the unit circle",
            )?;
        }
        between(
            "loop.damping",
            t.damping,
            0.2,
            10.0,
            "less rings, more is slow",
        )?;
        let omega = TAU * t.bandwidth_hz / spec.adc.sample_rate_hz;
        if !(omega.is_finite() && (5e-4..=1.0).contains(&omega)) {
            let rate = spec.adc.sample_rate_hz / TAU;
            return refuse(
                "loop.bandwidth_hz",
                t.bandwidth_hz,
                format!("{} … {} Hz", 5e-4 * rate, rate),
                "poles too fast for the sample rate, or so slow that the loop never locks",
            );
        }
        let xi = t.damping;
        let (pole_sum, pole_product) = if xi >= 1.0 {
            let root = (xi * xi - 1.0).sqrt();
            let (p1, p2) = ((-omega * (xi - root)).exp(), (-omega * (xi + root)).exp());
            (p1 + p2, p1 * p2)
        } else {
            let angle = omega * (1.0 - xi * xi).sqrt();
            (
                2.0 * (-omega * xi).exp() * angle.cos(),
                (-2.0 * omega * xi).exp(),
            )
        };
        let pole = if t.filter_type == 2 {
            1.0
        } else {
            t.pole.unwrap_or(pole_product)
        };
        let ab = (1.0 - pole_sum + pole_product) / TAU;
        let a = if t.method == 2 {
            ab
        } else {
            (1.0 + pole - pole_sum) / TAU
        };
        let mut this = Self {
            omega,
            pole_sum,
            pole_product,
            pole,
            a,
            ab,
            noise_gain: 0.0,
        };
        this.noise_gain = this.noise();
        let lag = this.lag(spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz);
        if lag > 0.3 {
            let limit = spec.sensor.speed_max_periods_per_s * 0.3 / lag;
            return refuse(
                "sensor.speed_max_periods_per_s",
                spec.sensor.speed_max_periods_per_s,
                format!("{limit:.4} with this loop"),
                "a type 1 loop lags at speed, and here by more than 0.3 rad; take type 2 or a wider loop",
            );
        }
        Ok(this)
    }

    /// Steady phase error, radians, at `rate` turns per sample. 0 for type 2.
    #[must_use]
    pub fn lag(&self, rate: f64) -> f64 {
        (1.0 - self.pole) * rate / self.ab
    }

    fn noise(&self) -> f64 {
        let (b1, b0) = (TAU * self.a, TAU * (self.ab - self.a));
        let (mut y1, mut y2, mut u1, mut u2, mut sum) = (0.0, 0.0, 1.0, 0.0, 0.0);
        let steps = (40.0 / self.omega) as usize + 100;
        for _ in 0..steps {
            let y = self.pole_sum * y1 - self.pole_product * y2 + b1 * u1 + b0 * u2;
            sum += y * y;
            (y2, y1) = (y1, y);
            (u2, u1) = (u1, 0.0);
        }
        sum
    }
}

impl Acquisition {
    /// The widest loop that is still well damped. Type 1 loops are not widened: their damping would suffer.
    pub(super) fn new(spec: &Spec, tracking: &Loop) -> Self {
        if spec.tracking.filter_type == 1 {
            return Self {
                gears: 0,
                stride: 1,
            };
        }
        let wide = |shift: i32| {
            let (g, h) = (
                TAU * tracking.a * 2f64.powi(shift),
                TAU * tracking.ab * 4f64.powi(shift),
            );
            // z² + (g − 2) z + 1 − g + h
            let (linear, constant) = (g - 2.0, 1.0 - g + h);
            let discriminant = linear * linear / 4.0 - constant;
            let radius = if discriminant < 0.0 {
                constant.sqrt()
            } else {
                linear.abs() / 2.0 + discriminant.sqrt()
            };
            radius < 0.85 && g < 1.9
        };
        let most = (1..24).rev().find(|&shift| wide(shift)).unwrap_or(0) as u32;
        let gears = most.min(3);
        Self {
            gears,
            stride: most.checked_div(gears).unwrap_or(1),
        }
    }
}
