//! What causes do to a channel at a moment.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::cause::Cause;
use crate::lag::Passed;
use crate::sensor::Sensor;

/// A moment of the recording.
pub(crate) struct Moment {
    pub(crate) alpha: f64,
    /// Seconds from the beginning.
    pub(crate) time: f64,
    /// Seconds from the beginning to the end.
    pub(crate) whole: f64,
    /// Radians per second.
    pub(crate) speed: f64,
    /// Direction in which it came, 1 or −1; and what that is where it rested at first after coming the other way.
    pub(crate) side: [f64; 2],
}

/// Part of the amplitude of both channels.
pub(crate) fn of_both(cause: &Cause, time: f64, phi: f64) -> f64 {
    match *cause {
        Cause::AmplitudeRipple {
            frequency_hz,
            depth,
            phase,
        } => depth * (TAU * frequency_hz * time + phase).cos(),
        Cause::Runout {
            order,
            depth,
            phase,
        } => depth * (order * phi + phase).cos(),
        Cause::Contamination {
            depth,
            place,
            width,
        } => {
            let off = (phi - place + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            -depth * (-0.5 * (off / width).powi(2)).exp()
        }
        _ => 0.0,
    }
}

/// What the scale and the bends of a channel add to it, in its amplitudes; delays and filters come behind. The channel is
/// `amplitude` · cos(α + `phase`), and so its powers are waves: u² = (1 + cos 2)/2 and u³ = (3 cos + cos 3)/4.
pub(crate) fn of_scale(
    cause: &Cause,
    which: usize,
    amplitude: f64,
    phase: f64,
    passed: &Passed,
) -> f64 {
    let of = |cos: f64, sin: f64| if which == 0 { cos } else { sin };
    match *cause {
        Cause::EvenNonlinearity { k_cos, k_sin } => {
            let square = 0.5 * (1.0 + passed.wave(2.0, 2.0 * phase));
            of(k_cos, k_sin) * amplitude.powi(2) * square
        }
        Cause::OddNonlinearity { k_cos, k_sin } => {
            let cube = 0.25 * (3.0 * passed.wave(1.0, phase) + passed.wave(3.0, 3.0 * phase));
            of(k_cos, k_sin) * amplitude.powi(3) * cube
        }
        Cause::SpatialHarmonic {
            order,
            amplitude_cos,
            phase_cos,
            amplitude_sin,
            phase_sin,
        } => of(amplitude_cos, amplitude_sin) * passed.wave(order, of(phase_cos, phase_sin)),
        _ => 0.0,
    }
}

/// A rail of a channel.
struct Rail {
    /// In amplitudes.
    threshold: f64,
    /// What of the slope is gone beyond it.
    compression: f64,
}

impl Rail {
    /// Nothing goes beyond it: neither what else is in the channel, nor noise.
    fn clips(&self) -> bool {
        self.compression >= 1.0
    }
}

/// The upper rail of a channel, or the lower, where the cause has rails.
fn rail(cause: &Cause, which: usize, upper: bool) -> Option<Rail> {
    let Cause::Saturation {
        threshold,
        compression,
        compression_upper,
        compression_lower,
        compression_cos_upper,
        compression_cos_lower,
        compression_sin_upper,
        compression_sin_lower,
    } = *cause
    else {
        return None;
    };
    let (of_rail, of_both) = if upper {
        (
            [compression_cos_upper, compression_sin_upper],
            compression_upper,
        )
    } else {
        (
            [compression_cos_lower, compression_sin_lower],
            compression_lower,
        )
    };
    Some(Rail {
        threshold,
        compression: of_rail[which].or(of_both).unwrap_or(compression),
    })
}

/// A channel y with all that is in it, in its amplitudes, behind the rails that clip it.
pub(crate) fn clipped(cause: &Cause, which: usize, y: f64) -> f64 {
    let rail = rail(cause, which, y > 0.0).filter(Rail::clips);
    rail.map_or(y, |rail| y.abs().min(rail.threshold).copysign(y))
}

/// What is added to a channel y, in its amplitudes.
pub(crate) fn of_one(cause: &Cause, which: usize, y: f64, at: &Moment) -> f64 {
    let of = |cos: f64, sin: f64| if which == 0 { cos } else { sin };
    match *cause {
        Cause::Saturation { .. } => rail(cause, which, y > 0.0)
            .filter(|rail| !rail.clips())
            .map_or(0.0, |rail| {
                -rail.compression * (y.abs() - rail.threshold).max(0.0) * y.signum()
            }),
        Cause::Hysteresis {
            offset_cos,
            offset_sin,
            start_side,
        } => of(offset_cos, offset_sin) * at.side[usize::from(start_side < 0.0)],
        Cause::Interference(ref line) => line.at(which, at.time),
        Cause::OffsetDrift(ref drift) => drift.at(which, at.time, at.whole),
        Cause::GainDrift(ref drift) => y * drift.at(which, at.time, at.whole),
        _ => 0.0,
    }
}

impl Sensor {
    /// Phase of a channel, which is cos(α + phase): cos α, and sin(α − β).
    pub(crate) fn phase(&self, which: usize) -> f64 {
        [0.0, -self.signals.beta - FRAC_PI_2][which]
    }

    /// What a channel has of the other, in amplitudes.
    pub(crate) fn of_other(&self, cause: &Cause, which: usize, at: &Moment) -> f64 {
        let Cause::DelayedCrosstalk {
            product_into_cos_s,
            product_into_sin_s,
            delay_s,
        } = *cause
        else {
            return 0.0;
        };
        /// Angle over which the slope of a channel is taken, radians.
        const SMALL: f64 = 1e-4;
        let product = [product_into_cos_s, product_into_sin_s][which];
        let (from, phase) = (1 - which, self.phase(1 - which));
        // The other channel with its bends.
        let other = |alpha: f64| {
            let passed = Passed::undisturbed(alpha);
            passed.wave(1.0, phase) + self.sum(|c| of_scale(c, from, 1.0, phase, &passed))
        };
        if delay_s == 0.0 {
            let slope = (other(at.alpha + SMALL) - other(at.alpha - SMALL)) / (2.0 * SMALL);
            -product * at.speed * slope
        } else {
            // The part that is not delayed stands in gain and phase.
            product * (other(at.alpha - at.speed * delay_s) - other(at.alpha)) / delay_s
        }
    }
}
