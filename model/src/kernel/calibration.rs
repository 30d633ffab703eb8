//! On-line calibration: the step of the parameters against the gradient.
//!
//! δΘ = −γ Mᵀ n ρ with n = (cos α̂, sin α̂) and ρ the radial residual, or what another search puts in the gradient's place.
//! γ is a power of two and shifts gear.

use super::gradient::{self, Bent, Seen};
use super::sensitivity::Sensitivity;
use super::step::{Equaliser, Mover};
use super::{Coefficients, State, Structure, gather, gears, start};
use crate::signal::{Formula, Logic, Signal, Wide};
use crate::spec::CalibrationMethod;

static UPDATE: Formula = Formula {
    title: "Parameter update",
    equation: "theta -= gamma gradient, each component times a power of two that lets all parameters converge alike",
    source: "paper section 5.5.1, M of equation (7)",
};

static UPDATE_WAITS: Formula = Formula {
    equation: "theta -= gamma gradient, each component times a power of two that lets all parameters converge alike; \
               once gamma has settled, the sum over a period of travel where it ends",
    ..UPDATE
};

static UPDATE_WAITS_PHASE: Formula = Formula {
    equation: "theta -= gamma gradient, each component times a power of two that lets all parameters converge alike; \
               once gamma has settled (theta_5: by a quarter of it then), the sum over a period of travel where it ends",
    ..UPDATE
};

static UPDATE_SQUARES: Formula = Formula {
    source: "paper sections 5.2 to 5.4, the sum of squares",
    ..UPDATE
};

/// Which samples count.
#[derive(Clone, Copy, Debug)]
pub struct Gate<S: Signal> {
    /// This sample moves the parameters.
    pub fresh: S::Bool,
    /// A period of travel ends, with a sample that counts, be the parameters held or not.
    pub tick: S::Bool,
    /// A period of travel ends.
    pub whole_period: S::Bool,
    /// The map of sectors is cleared: a period ends, or nothing counts.
    pub clear: S::Bool,
    /// Where parameters move at the end of a period: it ends, and what it taught is dropped.
    pub dropped: Option<S::Bool>,
    /// Where bends are calibrated: this speed shows them, and they do not rest.
    pub bends_taught: Option<S::Bool>,
}

impl<S: Signal> Gate<S> {
    /// A condition as it is for the bends, where there are any: not met while they rest.
    pub fn for_bends(&self, condition: S::Bool, name: &'static str) -> S::Bool {
        let taught = self.bends_taught;
        taught.map_or(condition, |taught| condition.and(taught).named(name))
    }
}

/// The parameters after a sample, and what their search remembers.
pub struct Update<S: Signal> {
    /// Accumulators of θ1 … θ9.
    pub theta: [S; 9],
    /// ∇α̂ by θ1 … θ5.
    pub sensitivities: [Sensitivity<S>; 5],
    /// Gathered gradients by θ1 … θ8.
    pub gathered: [S; 8],
    /// Periods that the start has solved.
    pub start_periods: S,
    /// sin α̂ cos α̂, where bends are calibrated.
    pub w_null: S,
}

/// The parameter accumulators after this sample, all but θ9; the search goes on from those that it has `searched`. `PLAIN` as [`Structure::is_plain`].
#[inline(always)]
pub fn update<S: Signal, const PLAIN: bool>(
    seen: &Seen<S>,
    searched: [S; 9],
    gate: Gate<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Update<S> {
    let calibration = &structure.calibration;
    let formula = match (calibration.squares(), calibration.waits()) {
        (true, _) => &UPDATE_SQUARES,
        (false, true) if calibration.phase_settles() => &UPDATE_WAITS_PHASE,
        (false, true) => &UPDATE_WAITS,
        (false, false) => &UPDATE,
    };
    seen.rho.begin(formula);
    let mut this = Update {
        theta: searched,
        sensitivities: [Sensitivity {
            gradient: k.zero,
            rate: k.zero,
            error: k.zero,
        }; 5],
        gathered: gather::gathered(state),
        start_periods: state.start_periods,
        w_null: k.zero,
    };
    if !structure.calibration.is_on() {
        return this;
    }
    let starting = if PLAIN {
        None
    } else {
        seen.start.map(|start| start.running)
    };
    let settled = structure
        .calibration
        .phase_settles()
        .then(|| gears::settled(state, k, structure));
    let mut gradient = gradient::linear(seen, settled, k, structure);
    let mut bent = (!PLAIN && structure.calibration.has_bend())
        .then(|| gradient::bent(seen, gate.bends_taught, k, structure));
    let solved = starting.map(|_| {
        let solved = start::start(gradient, seen.theta, gate, state, k, structure);
        (this.gathered, this.start_periods) = (solved.gathered, solved.periods);
        solved.steps
    });
    let method = if PLAIN {
        CalibrationMethod::Final
    } else {
        structure.calibration.method
    };
    // θ1 … θ4, and θ5 where there is phase.
    let linear = if structure.calibration.has_phase() {
        5
    } else {
        4
    };
    if let Some(bent) = &bent {
        (gradient[1], gradient[3], gradient[4]) = (bent.offsets[0], bent.offsets[1], bent.phase);
        this.w_null = bent.w;
    }
    match method {
        CalibrationMethod::Final if structure.calibration.parameters == 4 => {
            let apart = |own: S::Wide, other: S::Wide| own - other.scale(-1);
            (gradient[0], gradient[2]) = (
                apart(gradient[0], gradient[2]),
                apart(gradient[2], gradient[0]),
            );
        }
        CalibrationMethod::Final => {}
        CalibrationMethod::Exact => {
            this.sensitivities = gradient::sensitivities(seen, state, k, structure);
            let calibrated = gradient.iter_mut().zip(&this.sensitivities);
            for (gradient, sensitivity) in calibrated.take(linear) {
                *gradient = *gradient + sensitivity.error * seen.e;
            }
        }
        CalibrationMethod::SumOfSquares | CalibrationMethod::Batch => {
            let (plain, bends) = this.gathered.split_at_mut(5);
            let of_bends = bent.iter_mut().flat_map(|bent| {
                let [second_c, second_s] = &mut bent.second;
                [second_c, second_s, &mut bent.third]
            });
            let gather = |gradient: &mut S::Wide, before: &mut S, gate| {
                let gathered = gather::squares(*gradient, *before, gate, k.zero, structure);
                *gradient = gathered.gradient.widen();
                *before = gathered.next;
            };
            for (gradient, before) in gradient.iter_mut().zip(plain).take(linear) {
                gather(gradient, before, gate);
            }
            let gate = Gate {
                fresh: gate.for_bends(gate.fresh, "bends_fresh"),
                ..gate
            };
            for (gradient, before) in of_bends.zip(bends) {
                gather(gradient, before, gate);
            }
        }
    }
    if method == CalibrationMethod::Batch {
        let newton = |own: S::Wide, other: S::Wide| own.scale(2) - own - other;
        (gradient[0], gradient[2]) = (
            newton(gradient[0], gradient[2]),
            newton(gradient[2], gradient[0]),
        );
    }
    seen.rho.begin(formula);
    // What is gathered acts where its period ends.
    let period_ends = || gate.fresh.and(gate.whole_period);
    let due = match starting {
        Some(starting) => gate
            .fresh
            .and(gate.whole_period.or(starting.not()))
            .named("due"),
        None if method == CalibrationMethod::Batch => period_ends().named("batch_due"),
        None => gate.fresh,
    };
    let nominal = gears::nominal(state, k, structure);
    let mover = Mover {
        due,
        start: starting.zip(solved),
        nominal,
    };
    // θ5 first: its product is the last of the paper's.
    let by = Equaliser::of(structure);
    let [first, second, third, fourth, fifth] = gradient;
    // Neither a loop nor a closure: each has its own code, whatever the compiler thinks of them.
    let of = (state, k, structure);
    if linear == 5 {
        this.theta[4] = mover.moved(4, this.theta[4], (fifth, by.phase), of);
    }
    this.theta[0] = mover.moved(0, this.theta[0], (first, by.gain), of);
    this.theta[1] = mover.moved(1, this.theta[1], (second, by.offset), of);
    this.theta[2] = mover.moved(2, this.theta[2], (third, by.gain), of);
    this.theta[3] = mover.moved(3, this.theta[3], (fourth, by.offset), of);
    if let Some(Bent { second, third, .. }) = bent {
        let due = gate.for_bends(mover.due, "bends_due");
        let mover = Mover { due, ..mover };
        for (i, gradient) in [(5, second[0]), (6, second[1]), (7, third)] {
            this.theta[i] = mover.moved(i, this.theta[i], (gradient, by.bend), of);
        }
    }
    this
}
