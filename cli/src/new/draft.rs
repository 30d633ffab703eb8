//! The numbers of a new design, before it is one.

use nonius_quantity::digits;

use super::FINEST;
use super::promise::Promise;

/// Numbers of a design, each with where it comes from.
pub(super) struct Draft {
    pub(super) name: String,
    pub(super) description: String,
    pub(super) head: String,
    pub(super) amplitude: (f64, String),
    pub(super) amplitude_tolerance: Promise,
    pub(super) offset_max: Promise,
    pub(super) phase_error_max_deg: Promise,
    pub(super) noise_rms: (f64, String),
    pub(super) speed_max: (f64, String),
    pub(super) scale_period_m: Option<f64>,
    pub(super) periods_per_revolution: Option<u32>,
    pub(super) bits: (u32, String),
    pub(super) full_scale: (f64, String),
    pub(super) middle: f64,
    pub(super) sample_rate: (f64, String),
    pub(super) bandwidth: (f64, String),
    pub(super) accuracy: f64,
}

impl Draft {
    /// What is promised of the sensor, with its keys in `[sensor]`.
    pub(super) fn promises(&self) -> [(&'static str, &Promise); 3] {
        [
            ("amplitude_tolerance", &self.amplitude_tolerance),
            ("offset_max", &self.offset_max),
            ("phase_error_max_deg", &self.phase_error_max_deg),
        ]
    }
}

/// A draft whose numbers are examples.
pub(super) fn plain(name: &str) -> Draft {
    let note = String::from;
    Draft {
        name: name.into(),
        description: "a sin/cos encoder".into(),
        head: "A sin/cos encoder. Every number below is an example: replace it with your sensor's."
            .into(),
        amplitude: (0.8, note("nominal, in the unit of full_scale")),
        amplitude_tolerance: Promise::example(0.15, "of the amplitude, each channel"),
        offset_max: Promise::example(0.1, "of the amplitude, each channel"),
        phase_error_max_deg: Promise::example(5.0, "degrees of a scale period"),
        noise_rms: (0.001, note("of the amplitude, each channel")),
        speed_max: (20e3, note("")),
        scale_period_m: Some(20e-6),
        periods_per_revolution: None,
        bits: (12, note("8 to 18")),
        full_scale: (
            1.0,
            note("the ADC spans middle - full_scale ... middle + full_scale"),
        ),
        middle: 0.0,
        sample_rate: (500e3, note("both channels at the same instant")),
        bandwidth: (5e3, note("omega_0 / 2 pi of the closed loop")),
        accuracy: FINEST,
    }
}

/// The next number of two digits.
pub(super) fn rounded_up(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    short((value / unit - 1e-9).ceil() * unit)
}

/// Four digits.
pub(super) fn short(value: f64) -> f64 {
    digits(value, 4)
}
