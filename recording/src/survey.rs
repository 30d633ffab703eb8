//! A quick look at a recording: what a design has to cope with.

use crate::ellipse::{self, Ellipse, EllipseFit, FitMethod};
use crate::motion::Motion;
use crate::recording::Recording;

/// Speed in periods per sample beyond which periods may have been missed.
const FAST: f64 = 0.35;
/// Periods from which a recording counts as a whole one.
const WHOLE: f64 = 0.95;

/// Signals, noise and motion of a recording, good enough to choose the numbers of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Size, offset and phase of the signals.
    pub fit: EllipseFit,
    /// Angle, speed and distance.
    pub motion: Motion,
    /// Rms of the noise alone, per sample, in fractions of the amplitude: what changes from sample
    /// to sample of the radial residual. The residual's rms holds slow errors of shape as well.
    pub noise_rms: f64,
    /// What to say about the numbers.
    pub notes: Vec<String>,
}

impl Survey {
    /// Looks at a recording.
    #[must_use]
    pub fn of(recording: &Recording) -> Self {
        let fit = Ellipse::fit(&recording.cos, &recording.sin);
        let motion = Motion::of(recording, &fit);
        let mut notes = fit.notes.clone();
        if fit.method == FitMethod::Conic && motion.periods_travelled < WHOLE {
            notes.push(format!(
                "the recording covers {:.2} of a scale period; one or more makes its numbers reliable",
                motion.periods_travelled
            ));
        }
        if motion.max_speed_periods_per_sample > FAST {
            notes.push(format!(
                "the signals turn by {:.2} periods per sample; beyond 0.5 the direction and the count \
                 are lost, so the speed may be another one",
                motion.max_speed_periods_per_sample
            ));
        }
        let noise_rms = noise(&fit, recording);
        Self {
            fit,
            motion,
            noise_rms,
            notes,
        }
    }
}

/// From the second differences of the residual, outliers left out.
fn noise(fit: &EllipseFit, recording: &Recording) -> f64 {
    let rho = ellipse::residuals(&fit.ellipse, &recording.cos, &recording.sin);
    let limit = 5.0 * fit.residual_rms;
    let near = |w: &&[f64]| w.iter().all(|r| r.abs() <= limit);
    let second = rho
        .windows(3)
        .filter(near)
        .map(|w| w[0] - 2.0 * w[1] + w[2]);
    ellipse::rms(second) / 6f64.sqrt()
}
