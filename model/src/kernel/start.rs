//! Start by least squares: Θ in two periods of travel.
//!
//! A pair of amplitude 1 that is not yet corrected, at the angle φ, has the radius
//!
//! ```text
//! 1 + δ1 cos² φ + δ3 sin² φ + δ2 cos φ + δ4 sin φ + δ5 sin φ cos φ
//! ```
//!
//! with δ1 and δ3 the relative errors of the gains, δ2 and δ4 the offsets, δ5 the cosine in the sine. Over a whole period
//! the normal equations are known beforehand: 1/8 [3 1; 1 3] for the gains, 1/2 for the offsets, 1/8 for the phase. So each
//! period's gathered gradient is solved by shifts and additions, and what is relative is multiplied by what it is relative
//! to: Newton's step, whose error is of second order. After two the gears go on.
//!
//! Where the loop follows only in part, or still settles after the first step, its estimate is not φ. The start knows
//! both from e = φ − α̂: it turns the estimate's direction by e, adds e²/2 to the radial residual, and counts the sectors that
//! φ crosses. Each sample counts for the sectors since the last one, so that few samples a period are no error.

use super::calibration::{Gate, linear_parameters};
use super::gather::over_a_period;
use super::travel::{Measure, SECTOR_BITS, Travel};
use super::{Coefficients, State, Structure};
use super::{detector, gears};
use crate::format::{Format, Quantiser};
use crate::signal::{Formula, Logic, Signal, Wide};

/// Periods of travel that are solved.
pub const PERIODS: u32 = 2;
/// log2 of the sectors of a period.
const SECTORS_LOG2: i32 = SECTOR_BITS as i32;
/// Sectors that one sample may stand for.
const WEIGHT: Quantiser = Quantiser::saturating(Format::unsigned(4, 0));

static POLAR: Formula = Formula {
    title: "Pair in polar coordinates",
    equation: "radius - 1 = rho + e^2/2, direction (cos_hat - e sin_hat, sin_hat + e cos_hat), times the sectors travelled",
    source: "",
};

static SOLVE: Formula = Formula {
    title: "Start by least squares",
    equation: "delta_1 = 3 m_1 - m_3, delta_3 = 3 m_3 - m_1, delta_2 = 2 m_2, delta_4 = 2 m_4, \
               m the mean gradient of a period of travel",
    source: "Newton's step: the inverse of the normal equations of a whole period",
};

static SOLVE_PHASE: Formula = Formula {
    equation: "delta_1 = 3 m_1 - m_3, delta_3 = 3 m_3 - m_1, delta_2 = 2 m_2, delta_4 = 2 m_4, delta_5 = 8 m_5, \
               m the mean gradient of a period of travel",
    ..SOLVE
};

static STEP: Formula = Formula {
    title: "Step of the start",
    equation: "theta_1 (1 - delta_1), theta_2 (1 - delta_1) - delta_2, theta_3 (1 - delta_3), \
               theta_4 (1 - delta_3) - delta_4",
    source: "paper section 5.2",
};

static STEP_PHASE: Formula = Formula {
    title: "Step of the start",
    equation: "theta_1 (1 - delta_1), theta_2 (1 - delta_1) - delta_2, theta_3 (1 - delta_3), \
               theta_4 (1 - delta_3) - delta_4 and the sine less delta_5 times the new c",
    source: "paper section 5.3",
};

/// What the start sees of a sample.
#[derive(Clone, Copy, Debug)]
pub struct Polar<S: Signal> {
    /// The start is still at work.
    pub running: S::Bool,
    /// Radius less 1, weighed, while it is; afterwards ρ.
    pub residual: S,
    /// Direction of the pair while it is, that of the estimate afterwards.
    pub direction: (S, S),
}

/// Whether the start is still at work.
pub fn running<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    state
        .start_periods
        .less_than(k.start_periods_last)
        .named("starting")
}

/// How travel is measured: by the pair's own angle while the start runs, e/2π ahead of the estimate (e/8 + e/32 is near
/// enough), and in periods that end two sectors early, so that two of them are never more than two: the last sample counts
/// for what is missing.
pub fn measure<S: Signal>(e: S, running: S::Bool, k: &Coefficients<S>) -> Measure<S> {
    e.begin(&POLAR);
    let ahead = e.scale(-3) + e.scale(-5);
    Measure {
        ahead: S::select(running, ahead, k.zero).named("ahead_of_estimate"),
        period: S::select(running, k.start_period, k.one).named("period"),
    }
}

/// The residual that the gradient is made of, and its direction: of the pair while the start runs, else `limited` along
/// the estimate.
pub fn polar<S: Signal>(
    (rho, limited, e): (S, S, S),
    (cos_hat, sin_hat): (S, S),
    running: S::Bool,
    travel: &Travel<S>,
    structure: &Structure,
) -> Polar<S> {
    let radius = detector::radius(rho, e);
    rho.begin(&POLAR);
    let signal = &structure.formats.signal;
    let sectors = travel.advance.scale(SECTORS_LOG2).quantise(&WEIGHT);
    let weighed = radius.quantise(signal).named("radius_error") * sectors.named("sectors");
    let cos = (cos_hat.widen() - e * sin_hat).quantise(signal);
    let sin = (sin_hat.widen() + e * cos_hat).quantise(signal);
    let residual = S::select(running, weighed.quantise(signal), limited);
    Polar {
        running,
        residual: residual.named("residual_weighed"),
        direction: (
            S::select(running, cos, cos_hat).named("direction_cos"),
            S::select(running, sin, sin_hat).named("direction_sin"),
        ),
    }
}

/// The start after a sample.
pub struct Start<S: Signal> {
    /// What θ1 … θ5 move back by where a period ends.
    pub steps: [S; 5],
    /// Gathered gradients.
    pub gathered: [S; 8],
    /// Periods solved.
    pub periods: S,
}

/// Gathers one sample, `gradient` by δ1 … δ5, and says by how much its period's solution moves θ1 … θ5.
pub fn start<S: Signal>(
    gradient: [S::Wide; 5],
    theta: [S; 5],
    gate: Gate<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Start<S> {
    let mut gathered = super::gather::gathered(state);
    let mut mean = [k.zero; 5];
    let components = gradient.into_iter().zip(&mut gathered).zip(&mut mean);
    for ((gradient, gathered), mean) in components.take(linear_parameters(structure)) {
        let sum = over_a_period(gradient, *gathered, gate, k.zero, structure);
        *gathered = sum.next;
        *mean = sum.gradient.scale(-SECTORS_LOG2);
    }
    let steps = steps(mean, theta, k, structure);
    let solved = gate.fresh.and(gate.whole_period).and(running(state, k));
    let periods = (state.start_periods + S::select(solved, k.one, k.zero))
        .quantise(&structure.formats.start_periods);
    Start {
        steps,
        gathered,
        periods: S::select(gears::restart(gate, state, k, structure), k.zero, periods)
            .quantise(&structure.formats.start_periods),
    }
}

fn steps<S: Signal>(
    [m_1, m_2, m_3, m_4, m_5]: [S; 5],
    theta: [S; 5],
    k: &Coefficients<S>,
    structure: &Structure,
) -> [S; 5] {
    let (signal, to) = (&structure.formats.signal, &structure.formats.step);
    let phase = structure.calibration.has_phase();
    k.zero.begin(if phase { &SOLVE_PHASE } else { &SOLVE });
    let gain = |own: S, other: S| (own.scale(2) - own - other).quantise(signal);
    let (delta_1, delta_3) = (
        gain(m_1, m_3).named("delta_1"),
        gain(m_3, m_1).named("delta_3"),
    );
    let (delta_2, delta_4) = (m_2.scale(1), m_4.scale(1));
    let delta_5 = m_5.scale(3).quantise(signal).named("delta_5");

    k.zero.begin(if phase { &STEP_PHASE } else { &STEP });
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = theta;
    let short = |offset: S, name: &'static str| offset.quantise(signal).named(name);
    let (offset_c, offset_s) = (short(theta_2, "offset_c"), short(theta_4, "offset_s"));
    let step_1 = (theta_1 * delta_1).quantise(to).named("solved_1");
    // What δ5 takes of the new c goes to θ5 and, where that acts on y_c, to θ4. With bends θ5 acts on the corrected
    // cosine, and what θ5 took of the old one has moved.
    let (step_5, shared) = match (
        structure.calibration.has_phase(),
        structure.calibration.has_bend(),
    ) {
        (false, _) => (k.zero, k.zero.widen()),
        (true, false) => {
            let theta_1 = (theta_1 - step_1).quantise(&structure.formats.theta[0]);
            let moved = (offset_c - delta_2)
                .quantise(signal)
                .named("offset_c_solved");
            let step = theta_1.named("theta_1_solved") * delta_5;
            (step.quantise(to), delta_5 * moved)
        }
        (true, true) => {
            let moved = delta_2.quantise(signal).named("delta_2");
            let step = delta_5.widen() - theta_5 * delta_1;
            (step.quantise(to), k.zero.widen() - theta_5 * moved)
        }
    };
    [
        step_1,
        (delta_2.widen() + offset_c * delta_1).quantise(to),
        (theta_3 * delta_3).quantise(to),
        (delta_4.widen() + shared + offset_s * delta_3).quantise(to),
        step_5,
    ]
}
