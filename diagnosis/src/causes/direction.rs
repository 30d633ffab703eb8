//! What turns over with the direction of motion, and what follows the acceleration.

use std::rc::Rc;

use super::speed::{ACCELERATION, SIGN, SOFT, Speed, cause};
use crate::causes::candidate::Candidate;
use crate::context::Context;
use crate::finding::Cause;
use crate::shapes::trig::{Trig, channel, normalised};

/// Share of the largest speed below which the scale stands.
const STANDS: f64 = 0.02;
/// Share of the samples that has to move either way.
const EITHER_WAY: f64 = 0.01;

/// Whether a recording can show hysteresis: enough of it moves either way.
pub(crate) fn can_be_shown(context: &Context) -> bool {
    let least = STANDS * context.top_speed();
    let share = |sign: f64| {
        let with = context.speed.iter().filter(|v| **v * sign > least);
        with.count() as f64 / context.samples() as f64
    };
    share(1.0) > EITHER_WAY && share(-1.0) > EITHER_WAY
}

/// The direction of motion; at rest, the one in which it came. What the speed is below a small share of the largest is its
/// sign only if it goes on to more.
pub(super) fn sides(context: &Context) -> Vec<f64> {
    const REST: f64 = 0.01;
    let (speed, rest) = (&context.speed, REST * context.top_speed());
    let moves = |v: &f64| v.abs() > rest;
    let mut side = speed.iter().find(|v| moves(v)).map_or(1.0, |v| v.signum());
    let mut list = vec![side; speed.len()];
    for k in 0..speed.len() {
        if moves(&speed[k]) && speed[k].signum() != side {
            side = speed[k].signum();
            // It turned where the speed last was zero.
            let turned = speed[..k].iter().rposition(|v| v.signum() != side);
            list[turned.map_or(0, |t| t + 1)..k].fill(side);
        }
        list[k] = side;
    }
    list
}

/// Offsets with the direction of motion, turning over at once or over some way.
pub(super) fn hysteresis(context: &Context, speed: &Speed) -> Vec<Candidate> {
    if !can_be_shown(context) {
        return vec![];
    }
    let turnings = [SIGN, SOFT];
    let one = |turning: usize| {
        let offset = Trig::constant(1.0);
        let shapes = [0, 1].map(|which| {
            speed
                .by
                .shape(turning, &channel(speed.beta, which, &offset))
        });
        Candidate {
            trials: turnings.len() as f64,
            evidence: Rc::new(|p| {
                format!(
                    "the offsets change at each reversal of the motion, by {} (cos) and {} (sin) of the amplitude",
                    p[0].times(2.0).brief(),
                    p[1].times(2.0).brief()
                )
            }),
            ..cause(
                Cause::Hysteresis,
                shapes.into(),
                &["offset_cos", "offset_sin"],
                "amplitude",
            )
        }
    };
    turnings.map(one).into()
}

/// A head that tilts with the acceleration is no cause of the catalogue, and must not be taken for one.
pub(super) fn tilt(speed: &Speed) -> Candidate {
    let beta = speed.beta;
    let gain = |which: usize| {
        let own = channel(beta, which, &normalised(beta)[which]);
        speed.by.shape(ACCELERATION, &own)
    };
    let shapes = [0, 1].map(gain).into();
    cause(
        Cause::AccelerationGain,
        shapes,
        &["gain_cos", "gain_sin"],
        "1",
    )
}
