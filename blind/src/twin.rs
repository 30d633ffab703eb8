//! How far a delay is from the low pass that does nearly the same, and the other way round.
//!
//! Below its corner a low pass is a delay by its time constant τ; what tells them apart grows with (ωτ)². So there are recordings that
//! nobody can name for sure. Let d = min ‖P (s − s'(x))‖/σ be the distance between the signal s with the cause and the signal s'
//! with its twin, whose size x, a delay or a time constant, is the one that comes nearest; P and σ are those of the SNR
//! ([`crate::visible`]). The log-likelihood ratio of the two is then normal with mean ±d²/2 and variance d². Who knows that the
//! cause is hidden r times as often as its twin does best by whether that ratio is above −ln r, and takes the cause for its twin with
//! probability Φ(−d/2 − ln r/d). Where d is 0, that is one half of two that are equally frequent, and of others always the rarer one.

use statrs::function::erf::erfc;

use crate::effect::Twins;
use crate::simulate::{Finish, simulate};
use crate::truth::Twin;
use crate::visible::Visible;
use crate::world::World;

/// Most sizes of the twin that are tried.
const STEPS: usize = 8;
/// Change of the distance that no longer counts, in units of the noise.
const NEAR: f64 = 1e-3;

/// Distance of a cause of so large a magnitude and SNR to its twin, in units of the noise. Never more than the SNR, which is the
/// distance to a twin of no size.
#[must_use]
pub(crate) fn distance(
    twins: &Twins,
    (m, snr): (f64, f64),
    world: &World,
    visible: &Visible,
) -> f64 {
    let shown = simulate(world, &[(twins.own.as_ref(), m)], Finish::Clean);
    let left = |size: f64| {
        let other = simulate(world, &[(twins.other.as_ref(), size)], Finish::Clean);
        visible.seen(&shown.less(&other))
    };
    // Least squares in one number: each step as if what is seen were linear between the last two sizes.
    let (mut before, mut size) = (0.0, m * twins.alike);
    let (mut left_before, mut left_here) = (left(before), left(size));
    let mut least = snr.min(left_here.norm());
    for _ in 0..STEPS {
        let slope = (&left_before - &left_here) / (size - before);
        let step = left_here.dot(&slope) / slope.norm_squared();
        // A negative time constant is none: nothing is nearer then than the signal without a twin.
        let next = size + step;
        if !next.is_finite() || (next - size).abs() * slope.norm() < NEAR {
            break;
        }
        (before, size) = (size, next);
        (left_before, left_here) = (left_here, left(size));
        least = least.min(left_here.norm());
    }
    least
}

/// Probability that the best namer takes a cause for its twin.
#[must_use]
pub(crate) fn mistaken(twin: &Twin) -> f64 {
    // Not 0, so that ln r decides, or nothing.
    let distance = twin.distance.max(1e-9);
    let beyond = distance / 2.0 + twin.odds.ln() / distance;
    0.5 * erfc(beyond / 2f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{CATALOGUE, Draw};
    use crate::magnitude::scaled;
    use crate::world::to_and_fro;
    use rand::{SeedableRng, rngs::StdRng};

    /// Distance and ωτ at full speed of a cause with so large an SNR, beside noise that is so many times that of the world.
    fn of(name: &str, seed: u64, reference: bool, snr: f64, noise: f64) -> Option<(f64, f64)> {
        let mut world = to_and_fro(reference, false);
        world.noise *= noise;
        let entry = CATALOGUE.iter().find(|e| e.name == name).expect("a name");
        let mut random = StdRng::seed_from_u64(seed);
        let effect = (entry.draw)(&mut Draw {
            random: &mut random,
            world: &world,
            wild: false,
            snr,
        });
        let visible = Visible::new(&world, reference, false).expect("a world");
        let found = scaled(effect.as_ref(), &world, &visible, 1, snr).expect("a magnitude");
        let speeds = (0..world.samples).map(|k| world.axis(k as f64 / world.rate).speed.abs());
        let fastest = speeds.fold(0.0, f64::max);
        let twins = effect.twins(reference)?;
        let distance = distance(&twins, found, &world, &visible);
        Some((distance, found.0 * fastest))
    }

    const PAIRS: [(&str, &str, bool); 2] = [
        ("bandwidth_mismatch", "channel_skew", false),
        ("common_bandwidth", "latency", true),
    ];

    #[test]
    fn a_low_pass_far_above_the_signals_is_a_delay_and_a_near_one_is_none() {
        let errs = |distance| {
            mistaken(&Twin {
                distance,
                odds: 1.0,
            })
        };
        for (pass, delay, reference) in PAIRS {
            // Of either channel, earlier and later.
            for seed in [0, 2] {
                let all = |name, noise| of(name, seed, reference, 300.0, noise).expect("a twin");
                for name in [pass, delay] {
                    let (far, near) = (all(name, 0.05), all(name, 10.0));
                    assert!(far.1 < 2e-3 && near.1 > 0.09, "{name}: {far:?}, {near:?}");
                    assert!(far.0 < 0.2 && errs(far.0) > 0.46, "{name}: {far:?}");
                    assert!(near.0 > 5.0 && errs(near.0) < 0.01, "{name}: {near:?}");
                }
                // As far from one as from the other.
                let ratio = all(pass, 5.0).0 / all(delay, 5.0).0;
                assert!((0.98..1.02).contains(&ratio), "{pass}: {ratio}");
            }
        }
    }

    /// The radius of a low pass in both channels shrinks by (ωτ)²/2, and of an axis that goes to and fro as a sine with ωτ up to r that
    /// varies by r²/(4√2) rms, where the delay is r/√2 rms: d = SNR · r/4.
    #[test]
    fn the_distance_is_the_change_of_the_radius() {
        let (distance, reach) = of("common_bandwidth", 0, true, 200.0, 1.0).expect("a twin");
        let share = distance / (200.0 * reach / 4.0);
        assert!((0.8..1.2).contains(&share), "{share}");
    }

    #[test]
    fn a_reference_shows_which_channel_is_late() {
        let of = |seed| of("channel_skew", seed, true, 50.0, 0.1).expect("a twin").0;
        let all: Vec<f64> = (0..6).map(of).collect();
        let early = all.iter().filter(|d| **d > 10.0).count();
        let late = all.iter().filter(|d| **d < 1.0).count();
        assert!(early > 0 && late > 0 && early + late == 6, "{all:?}");
    }

    #[test]
    fn other_causes_have_no_twin() {
        for name in ["even_nonlinearity", "ac_coupling", "amplitude_ripple"] {
            assert!(of(name, 0, false, 20.0, 1.0).is_none(), "{name}");
        }
        // Nobody who does not know the motion sees a delay of both channels.
        assert!(of("common_bandwidth", 0, false, 20.0, 1.0).is_none());
    }

    #[test]
    fn the_best_namer_errs_by_distance_and_odds() {
        let errs = |distance, odds| mistaken(&Twin { distance, odds });
        assert!((errs(0.0, 1.0) - 0.5).abs() < 1e-9);
        assert!((errs(2.0, 1.0) - 0.158_655).abs() < 1e-6);
        assert!(errs(20.0, 0.3) < 1e-9);
        // Of two that are alike the more frequent one is named.
        assert!(errs(0.0, 1.5) < 1e-12 && errs(0.0, 0.6) > 1.0 - 1e-12);
        // Over both, weighed by how often they come, no threshold does better.
        let d = 1.3;
        let all = |odds: f64| {
            let threshold = Twin { distance: d, odds };
            let other = Twin {
                distance: d,
                odds: odds.recip(),
            };
            (3.0 * mistaken(&threshold) + mistaken(&other)) / 4.0
        };
        assert!(all(3.0) < all(2.8) && all(3.0) < all(3.2));
    }
}
