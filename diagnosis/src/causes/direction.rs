//! What turns over with the direction of motion, and what follows the acceleration.

use std::rc::Rc;

use super::speed::{ACCELERATION, SIGN, SOFT, STARTED_BACK, Speed, cause};
use crate::causes::candidate::Candidate;
use crate::context::Context;
use crate::finding::{Cause, Parameter};
use crate::shapes::trig::{Trig, channel, normalised};

/// Share of the largest speed below which the scale stands.
const STANDS: f64 = 0.02;
/// Share of the samples that has to move either way.
const EITHER_WAY: f64 = 0.01;

/// Whether a recording surely shows hysteresis: enough of it moves either way. In one direction it does if the scale came the other way to
/// the rest at which the recording begins.
pub(crate) fn can_be_shown(context: &Context) -> bool {
    let least = STANDS * context.top_speed();
    let share = |sign: f64| {
        let with = context.speed.iter().filter(|v| **v * sign > least);
        with.count() as f64 / context.samples() as f64
    };
    share(1.0) > EITHER_WAY && share(-1.0) > EITHER_WAY
}

/// Offsets with the direction of motion, turning over at once or over some way.
pub(super) fn hysteresis(context: &Context, speed: &Speed) -> Vec<Candidate> {
    let either_way = can_be_shown(context).then_some([SIGN, SOFT]);
    let back = speed.may_have_started_back.then_some(STARTED_BACK);
    let turnings: Vec<usize> = either_way.into_iter().flatten().chain(back).collect();
    let trials = turnings.len() as f64;
    let one = |turning: usize| {
        let back = turning == STARTED_BACK;
        let offset = Trig::constant(1.0);
        let shapes = [0, 1].map(|which| {
            speed
                .by
                .shape(turning, &channel(speed.beta, which, &offset))
        });
        let plain = cause(
            Cause::Hysteresis,
            shapes.into(),
            &["offset_cos", "offset_sin"],
            "amplitude",
        );
        let offsets = plain.parameters.clone();
        Candidate {
            trials,
            parameters: Rc::new(move |e| {
                let start = back.then(|| Parameter::exact("start_side", -1.0, "1"));
                offsets(e).into_iter().chain(start).collect()
            }),
            evidence: Rc::new(move |p| {
                format!(
                    "the offsets change at each reversal of the motion, by {} (cos) and {} (sin) of the amplitude{}",
                    p[0].times(2.0).brief(),
                    p[1].times(2.0).brief(),
                    if back {
                        "; to the rest before the first motion the scale came the other way"
                    } else {
                        ""
                    }
                )
            }),
            ..plain
        }
    };
    turnings.into_iter().map(one).collect()
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
