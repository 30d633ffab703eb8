//! The gradient of one sample, component by component.

use super::seen::Seen;
use super::sensitivity::{self, Names, Sensitivity, names};
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Signal, Wide};
use crate::spec::Calibration;

static BENDS: Formula = Formula {
    title: "Gradient by the bends",
    equation: "theta_2: 2 rho_c (1 - cos 2a), without cos 2a where bends rest, theta_6: 2 rho_c (2 cos 2a - 1), theta_8: rho cos 4a, a = alpha_hat",
    source: "paper section 5.5.1 for section 5.4; offset and second order decoupled",
};

static BENDS_OF_PAIR: Formula = Formula {
    title: "Gradient by the bends",
    equation: "theta_2: 2 rho_c (1 - cos 2a), without cos 2a where bends rest, theta_6: 2 rho_c (2 cos 2a - 1), theta_8: epsilon cos 4a, (cos a, sin a) = (c, s)",
    source: "paper section 5.4, the sum of squares; offset and second order decoupled",
};

static EXACT: Formula = Formula {
    title: "Exact gradient",
    equation: "M^T n rho + (w - grad alpha_hat)^T e, w = (-sin(alpha_hat), cos(alpha_hat)) M",
    source: "paper equations (8), (10) and (11)",
};

/// By θ1 … θ5 in the final form: Mᵀ n ρ. The last is 0 without phase. While the start runs, by δ1 … δ5 of a pair of
/// amplitude 1. Where the phase is moved by less once γ has `settled`, by so much of it then: a part of the step would have to be
/// rounded once more, and what rounding loses moves parameters where samples lie at few places of the period.
#[inline(always)]
pub fn linear<S: Signal>(
    seen: &Seen<S>,
    settled: Option<S::Bool>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> [S::Wide; 5] {
    let ((mut y_c, mut y_s), (rho_c, rho_s)) = (seen.y, seen.along);
    if let Some(start) = &seen.start {
        let (cos, sin) = start.direction;
        y_c = S::select(start.running, cos, y_c).named("m_c");
        y_s = S::select(start.running, sin, y_s).named("m_s");
    }
    let fifth = match settled {
        Some(settled) => {
            let less = y_c.scale(-(Calibration::PHASE_HALVINGS as i32));
            S::select(settled, less, y_c).named("y_5") * rho_s
        }
        None if structure.calibration.has_phase() => y_c * rho_s,
        None => k.zero.widen(),
    };
    let (offset_c, offset_s) = seen.by_offset(k);
    [
        y_c * rho_c,
        offset_c.widen(),
        y_s * rho_s,
        offset_s.widen(),
        fifth,
    ]
}

/// By θ2, θ4 (which the bend of second order disturbs), θ5, θ6, θ7 and θ8; and w = sin α̂ cos α̂.
pub struct Bent<S: Signal> {
    /// By the offsets of both channels.
    pub offsets: [S::Wide; 2],
    /// By the phase.
    pub phase: S::Wide,
    /// By the bends of second order.
    pub second: [S::Wide; 2],
    /// By the common bend of third order.
    pub third: S::Wide,
    /// sin α̂ cos α̂.
    pub w: S,
}

/// The bends are small, so M is taken as it is without them, in α̂ (for the sum of squares in the pair's own angle): T2 is
/// cos 2α̂ in the cosine and −cos 2α̂ in the sine. Where the speed shows no bends (`shown` is false) the offsets need not be told
/// from them: at four samples a period, where 1 − cos 2α̂ can be 0 at all of a channel's, they would not be seen.
pub fn bent<S: Signal>(
    seen: &Seen<S>,
    shown: Option<S::Bool>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Bent<S> {
    seen.rho.begin(if structure.calibration.squares() {
        &BENDS_OF_PAIR
    } else {
        &BENDS
    });
    let signal = &structure.formats.signal;
    let ((cos_hat, sin_hat), (rho_c, rho_s)) = (seen.frame, seen.by_offset(k));
    let w = (sin_hat * cos_hat).quantise(signal).named("half_sin_2");
    let half_cos_2 =
        ((cos_hat * cos_hat).quantise(signal).named("cos_square") - k.half).named("half_cos_2");
    let phase = seen.ellipse_by_e().map_or(w, |by_e| {
        S::select(by_e, half_cos_2, w).named("phase_direction")
    });
    let half_cos_2_shown = shown.map_or(half_cos_2, |shown| {
        S::select(shown, half_cos_2, k.zero).named("half_cos_2_shown")
    });
    // cos 4α̂ = 1 − 8 w²; along the circle −sin 4α̂ = −8 w (½ cos 2α̂).
    let third = seen
        .sparse
        .and_then(|sparse| Some((sparse.third?, sparse.e)));
    let (factor, one, residual) = third.map_or((w, k.one, seen.rho), |(by_e, e)| {
        (
            S::select(by_e, half_cos_2, w).named("third_factor"),
            S::select(by_e, k.zero, k.one),
            S::select(by_e, e, seen.rho).named("third_residual"),
        )
    });
    let square = (w * factor).quantise(signal).named("half_sin_2_square");
    let cos_4 = (one - square.scale(3)).quantise(signal).named("cos_4");
    let (second_c, second_s) = (rho_c * half_cos_2_shown, rho_s * half_cos_2_shown);
    let twice = |rho: S| rho.widen().scale(1);
    Bent {
        offsets: [
            twice(rho_c) - second_c.scale(2),
            twice(rho_s) + second_s.scale(2),
        ],
        phase: if structure.calibration.has_phase() {
            phase * seen.rho
        } else {
            k.zero.widen()
        },
        second: [
            second_c.scale(3) - twice(rho_c),
            twice(-rho_s) - second_s.scale(3),
        ],
        third: residual * cos_4,
        w,
    }
}

/// ∇α̂ by θ1 … θ5 after this sample.
pub fn sensitivities<S: Signal>(
    seen: &Seen<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> [Sensitivity<S>; 5] {
    seen.e.begin(&EXACT);
    let signal = &structure.formats.signal;
    let ((y_c, y_s), (cos_hat, sin_hat)) = (seen.y, seen.frame);
    let before = [
        (
            state.alpha_gradient_1,
            state.alpha_gradient_rate_1,
            state.alpha_gradient_error_1,
        ),
        (
            state.alpha_gradient_2,
            state.alpha_gradient_rate_2,
            state.alpha_gradient_error_2,
        ),
        (
            state.alpha_gradient_3,
            state.alpha_gradient_rate_3,
            state.alpha_gradient_error_3,
        ),
        (
            state.alpha_gradient_4,
            state.alpha_gradient_rate_4,
            state.alpha_gradient_error_4,
        ),
        (
            state.alpha_gradient_5,
            state.alpha_gradient_rate_5,
            state.alpha_gradient_error_5,
        ),
    ]
    .map(|(gradient, rate, error)| Sensitivity {
        gradient,
        rate,
        error,
    });
    let next = |w: S, i: usize, names: &'static Names| {
        sensitivity::advance(w, before[i], names, k, structure)
    };
    let fifth = if structure.calibration.has_phase() {
        let w = (cos_hat * y_c).quantise(signal).named("w_5");
        next(w, 4, names!("w_5"))
    } else {
        before[4]
    };
    let w_1 = (-(sin_hat * y_c).quantise(signal)).named("w_1");
    let w_3 = (cos_hat * y_s).quantise(signal).named("w_3");
    [
        next(w_1, 0, names!("w_1")),
        next((-sin_hat).named("w_2"), 1, names!("w_2")),
        next(w_3, 2, names!("w_3")),
        // w_4 is cos α̂.
        next(cos_hat, 3, names!("w_4")),
        fifth,
    ]
}
