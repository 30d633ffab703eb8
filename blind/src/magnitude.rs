//! Scales a cause until it has the SNR asked for.

use crate::effect::Effect;
use crate::simulate::{Finish, simulate};
use crate::visible::Visible;
use crate::world::World;

/// How near the SNR has to be, relative.
const NEAR: f64 = 0.003;

/// Magnitude and SNR of a cause, or None where no sensible magnitude has the SNR.
#[must_use]
pub(crate) fn scaled(
    effect: &dyn Effect,
    world: &World,
    visible: &Visible,
    noise_seed: u64,
    asked: f64,
) -> Option<(f64, f64)> {
    let measured = measure(effect, world, visible, noise_seed);
    if let Some(choices) = effect.choices() {
        let off = |snr: f64| (snr.max(1e-9) / asked).ln().abs();
        return choices
            .into_iter()
            .map(|m| (m, measured(m)))
            .filter(|(_, snr)| *snr > 1.0)
            .min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    }
    let limit = effect.limit();
    let (mut m, mut power) = (limit * 1e-2, 1.0);
    let mut last: Option<(f64, f64)> = None;
    for _ in 0..40 {
        let snr = measured(m);
        if (snr / asked - 1.0).abs() < NEAR {
            return Some((m, snr));
        }
        if !snr.is_finite() {
            return None;
        }
        if let Some((m0, snr0)) = last {
            // SNR goes with a power of the magnitude: one, two for what shows as a square.
            let slope = (snr / snr0).ln() / (m / m0).ln();
            if slope.is_finite() && (0.2..=5.0).contains(&slope) {
                power = slope;
            }
        }
        last = Some((m, snr.max(1e-12)));
        let factor = (asked / snr.max(1e-12)).powf(1.0 / power).clamp(1e-4, 1e4);
        let next = m * factor;
        if next > limit && m >= limit {
            return None;
        }
        m = next.min(limit);
    }
    None
}

/// SNR by magnitude.
fn measure<'a>(
    effect: &'a dyn Effect,
    world: &'a World,
    visible: &'a Visible,
    noise_seed: u64,
) -> impl Fn(f64) -> f64 + 'a {
    let finish = if effect.works_on_codes() {
        Finish::Codes(noise_seed)
    } else {
        Finish::Clean
    };
    let without = simulate(world, &[], finish);
    move |m| {
        if let Some(snr) = effect.noise_snr(m, world) {
            return snr;
        }
        let with = simulate(world, &[(effect, m)], finish);
        if effect.moves_time() {
            visible.moved(&with, &without)
        } else if effect.delays_both() && !visible.knows_motion() {
            visible.across(world, &with)
        } else {
            visible.snr(&with.less(&without))
        }
    }
}
