//! The correction of channel skew in numbers.

use nonius_model::design::Design;
use nonius_model::kernel::skew::Order;
use serde::Serialize;

/// The correction of a sine that is sampled later than the cosine.
#[derive(Clone, Debug, Serialize)]
pub struct ChannelSkew {
    /// Delay of the sine as asked for, seconds.
    pub delay_s: f64,
    /// As the chip has it.
    pub delay_quantised_s: f64,
    /// The difference, seconds.
    pub delay_error_s: f64,
    /// Phase that it makes at the largest speed, radians.
    pub phase_at_top_speed_rad: f64,
    /// Order of the series that takes it off.
    pub order: u32,
    /// Angle error there that the series leaves, at worst over what the design promises, periods rms.
    pub left_at_top_speed_periods: f64,
    /// What would be there without it, periods rms.
    pub uncorrected_at_top_speed_periods: f64,
}

impl ChannelSkew {
    pub(crate) fn of(design: &Design) -> Option<Self> {
        let delay_s = design.spec.correction.channel_skew_s;
        design.skew.map(|skew| Self {
            delay_s,
            delay_quantised_s: skew.delay_quantised_s,
            delay_error_s: skew.delay_quantised_s - delay_s,
            phase_at_top_speed_rad: skew.phase_max,
            order: match skew.order {
                Order::First => 1,
                Order::Second => 2,
            },
            left_at_top_speed_periods: skew.residual_rms_periods,
            uncorrected_at_top_speed_periods: skew.uncorrected_rms_periods,
        })
    }
}
