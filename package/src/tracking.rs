//! The loop in numbers.

use nonius_model::design::Design;
use serde::Serialize;

use crate::curves;

/// The loop in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Tracking {
    /// ω0 ts.
    pub omega0_ts: f64,
    /// p1 + p2.
    pub pole_sum: f64,
    /// p1 p2.
    pub pole_product: f64,
    /// p1 and p2: real and imaginary part.
    pub poles: [[f64; 2]; 2],
    /// The same of the coefficients as they are rounded.
    pub poles_quantised: [[f64; 2]; 2],
    /// Second pole of the filter; 1 is type 2.
    pub filter_pole: f64,
    /// −3 dB of the closed loop, hertz.
    pub bandwidth_3db_hz: f64,
    /// Equivalent noise bandwidth, one-sided, hertz.
    pub noise_bandwidth_hz: f64,
    /// Largest magnification of the closed loop.
    pub peak: f64,
    /// Largest speed, periods per second.
    pub speed_max_periods_per_s: f64,
    /// Position error at that speed, periods.
    pub lag_at_top_speed_periods: f64,
    /// Position error per acceleration, periods per (period/s²).
    pub acceleration_error_s2: f64,
    /// Gears in acquisition, each halving the bandwidth.
    pub acquisition_gears: u32,
}

impl Tracking {
    pub(crate) fn of(design: &Design) -> Self {
        let (t, rate) = (&design.tracking, design.spec.adc.sample_rate_hz);
        let top = design.spec.sensor.speed_max_periods_per_s;
        Self {
            omega0_ts: t.omega,
            pole_sum: t.pole_sum,
            pole_product: t.pole_product,
            poles: roots(t.pole_sum, t.pole_product),
            poles_quantised: poles_quantised(design),
            filter_pole: t.pole,
            bandwidth_3db_hz: curves::bandwidth(t) * rate,
            noise_bandwidth_hz: t.noise_gain * rate / 2.0,
            peak: curves::peak(t),
            speed_max_periods_per_s: top,
            lag_at_top_speed_periods: t.lag(top / rate).min(1.0).asin() / std::f64::consts::TAU,
            acceleration_error_s2: 1.0 / (t.ab * std::f64::consts::TAU * rate * rate),
            acquisition_gears: design.acquisition.gears,
        }
    }
}

/// The roots of z² − `sum` z + `product`, real and imaginary part.
fn roots(sum: f64, product: f64) -> [[f64; 2]; 2] {
    let square = sum * sum / 4.0 - product;
    let root = square.abs().sqrt();
    if square < 0.0 {
        [[sum / 2.0, root], [sum / 2.0, -root]]
    } else {
        [[sum / 2.0 + root, 0.0], [sum / 2.0 - root, 0.0]]
    }
}

/// The poles that the rounded coefficients make: the relations of the paper's sections 4.1 to 4.3 backwards.
fn poles_quantised(design: &Design) -> [[f64; 2]; 2] {
    let (k, tracking) = (&design.constants, &design.spec.tracking);
    let turns = std::f64::consts::TAU;
    let (a, ab) = (k.loop_a.value() * turns, k.loop_ab.value() * turns);
    let filter_pole = if tracking.filter_type == 2 {
        1.0
    } else {
        1.0 - k.loop_leak.value()
    };
    if tracking.method == 2 {
        return roots(1.0 + filter_pole - a, filter_pole);
    }
    let sum = 1.0 + filter_pole - a;
    roots(sum, sum - 1.0 + ab)
}
