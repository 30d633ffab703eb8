//! How the axis is driven: smooth motion, known at every time.

use std::f64::consts::TAU;
use std::ops::Range;

use rand::Rng;
use serde::Serialize;

/// A kind of drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// One speed, with the half per cent of slow change that every real drive has.
    Constant,
    /// One direction, from one speed to another.
    Sweeping,
    /// To and fro.
    Reversing,
    /// Jerk-limited moves between standstills.
    StopAndGo,
    /// Turned by hand: moves to and fro over a few periods, with little rests. Drawn only where it is asked for.
    Hand,
}

/// The axis at one time, before vibration.
#[derive(Clone, Copy, Debug, Default)]
pub struct State {
    /// Angle, radians of the scale period.
    pub alpha: f64,
    /// Its derivative, rad/s.
    pub speed: f64,
    /// And the next, rad/s².
    pub acceleration: f64,
}

/// A move: starts, takes, goes that far (s, s, rad).
#[derive(Clone, Copy, Debug)]
struct Move(f64, f64, f64);

#[derive(Clone, Debug)]
enum Parts {
    /// Straight line and sines: rad/s; (rad, rad/s, rad) each.
    Sines(f64, Vec<(f64, f64, f64)>),
    /// Speed from the first to the second (rad/s) as half a cosine over the time (s).
    Sweep(f64, f64, f64),
    /// One after the other.
    Moves(Vec<Move>),
}

/// Smooth motion.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Which kind.
    pub drive: Drive,
    start: f64,
    parts: Parts,
}

impl Motion {
    /// Draws one of a kind that lasts `seconds`, at most `fastest` rad/s.
    pub fn draw(random: &mut impl Rng, drive: Drive, seconds: f64, fastest: f64) -> Self {
        let start = random.random_range(0.0..TAU);
        let way = if random.random() { 1.0 } else { -1.0 };
        let parts = match drive {
            Drive::Constant => {
                let speed = way * fastest * random.random_range(0.1..0.9);
                let slow = TAU * random.random_range(0.5..2.0) / seconds;
                let depth = 0.005 * speed / slow;
                Parts::Sines(speed, vec![(depth, slow, random.random_range(0.0..TAU))])
            }
            Drive::Sweeping => {
                let (slow, fast) = (
                    random.random_range(0.02..0.2),
                    random.random_range(0.6..1.0),
                );
                let (from, to) = if random.random() {
                    (slow, fast)
                } else {
                    (fast, slow)
                };
                Parts::Sweep(way * fastest * from, way * fastest * to, seconds)
            }
            Drive::Reversing => {
                let first = TAU * random.random_range(1.2..3.2) / seconds;
                let second = first * random.random_range(1.3..2.1);
                let share = random.random_range(0.05..0.4);
                let peak = fastest * random.random_range(0.4..0.85);
                let run = way * fastest * random.random_range(0.0..0.12);
                let wave = |share: f64, rate: f64, phase: f64| (peak * share / rate, rate, phase);
                Parts::Sines(
                    run,
                    vec![
                        wave(1.0 - share, first, random.random_range(0.0..TAU)),
                        wave(share, second, random.random_range(0.0..TAU)),
                    ],
                )
            }
            Drive::StopAndGo => {
                let slots = (seconds, random.random_range(3..=6));
                moves(random, slots, (0.5..0.85, 0.02..0.14), |random, takes| {
                    way * reach(fastest * random.random_range(0.3..1.0), takes)
                })
            }
            Drive::Hand => {
                let slots = (seconds, random.random_range(2..=6));
                moves(random, slots, (0.6..0.95, 0.0..0.05), |random, takes| {
                    way * (TAU * random.random_range(0.3..2.5)).min(reach(fastest, takes))
                })
            }
        };
        Self {
            drive,
            start,
            parts,
        }
    }

    /// The state at time `t`, seconds; also before the recording begins.
    #[must_use]
    pub fn at(&self, t: f64) -> State {
        let mut state = State {
            alpha: self.start,
            ..State::default()
        };
        match &self.parts {
            Parts::Sines(run, sines) => {
                state.alpha += run * t;
                state.speed += run;
                for (size, rate, phase) in sines {
                    let (sin, cos) = (rate * t + phase).sin_cos();
                    state.alpha += size * sin;
                    state.speed += size * rate * cos;
                    state.acceleration -= size * rate * rate * sin;
                }
            }
            Parts::Sweep(from, to, seconds) => {
                let (rate, middle, half) =
                    (TAU / 2.0 / seconds, (from + to) / 2.0, (from - to) / 2.0);
                let (sin, cos) = (rate * t).sin_cos();
                state.alpha += middle * t + half * sin / rate;
                state.speed += middle + half * cos;
                state.acceleration -= half * rate * sin;
            }
            Parts::Moves(moves) => {
                for Move(begins, takes, far) in moves {
                    let x = ((t - begins) / takes).clamp(0.0, 1.0);
                    let rest = 1.0 - x;
                    state.alpha += far * x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x);
                    state.speed += far / takes * 30.0 * (x * rest).powi(2);
                    state.acceleration += far / (takes * takes) * 60.0 * x * rest * (1.0 - 2.0 * x);
                }
            }
        }
        state
    }
}

/// How far a move goes, radians, whose fastest point has this speed, rad/s, and that takes so long, s: that point of the quintic is 15/8 of
/// the mean speed.
fn reach(peak: f64, takes: f64) -> f64 {
    peak * takes * 8.0 / 15.0
}

/// Moves in as many slots of so many seconds together, each of which takes a share of its slot and begins after another; how far it goes
/// forwards, radians, follows from how long it takes.
fn moves<R: Rng>(
    random: &mut R,
    (seconds, count): (f64, u32),
    (takes, begins): (Range<f64>, Range<f64>),
    far: impl Fn(&mut R, f64) -> f64,
) -> Parts {
    let slot = seconds / f64::from(count);
    let moves = (0..count).map(|k| {
        let takes = slot * random.random_range(takes.clone());
        let begins = slot * (f64::from(k) + random.random_range(begins.clone()));
        let far = far(random, takes);
        let forwards = random.random_bool(0.6);
        Move(begins, takes, if forwards { far } else { -far })
    });
    Parts::Moves(moves.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::StdRng};

    #[test]
    fn speed_and_acceleration_are_the_derivatives() {
        let mut random = StdRng::seed_from_u64(1);
        for drive in [
            Drive::Constant,
            Drive::Sweeping,
            Drive::Reversing,
            Drive::StopAndGo,
            Drive::Hand,
        ] {
            let motion = Motion::draw(&mut random, drive, 0.4, 5000.0);
            for k in 1..40 {
                let (t, h) = (f64::from(k) * 0.01, 1e-6);
                let (a, b) = (motion.at(t - h), motion.at(t + h));
                let now = motion.at(t);
                assert!(now.speed.abs() <= 5000.0);
                let speed = (b.alpha - a.alpha) / (2.0 * h);
                assert!((speed - now.speed).abs() < 0.05, "{drive:?} {t}");
                let acceleration = (b.speed - a.speed) / (2.0 * h);
                let size = 1.0 + now.acceleration.abs();
                assert!((acceleration - now.acceleration).abs() < 1e-3 * size);
            }
        }
    }
}
