//! On-line calibration: the step of the parameters against the gradient.
//!
//! δΘ = −γ Mᵀ n ρ with n = (cos α̂, sin α̂) and ρ the radial residual, or what another search puts in the gradient's place.
//! γ is a power of two and shifts gear.

use super::gradient::{self, Bent};
use super::seen::Seen;
use super::sensitivity::Sensitivity;
use super::start::Polar;
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

impl<S: Signal> Update<S> {
    /// As it all was before the sample.
    #[inline(always)]
    fn before(searched: [S; 9], state: &State<S>, k: &Coefficients<S>) -> Self {
        Self {
            theta: searched,
            sensitivities: [Sensitivity {
                gradient: k.zero,
                rate: k.zero,
                error: k.zero,
            }; 5],
            gathered: gather::gathered(state),
            start_periods: state.start_periods,
            w_null: k.zero,
        }
    }
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
    let formula = formula(structure);
    seen.rho.begin(formula);
    let mut this = Update::before(searched, state, k);
    if !structure.calibration.is_on() {
        return this;
    }
    let linear = gradient::linear(seen, phase_settled(state, k, structure), k, structure);
    let bent = (!PLAIN && structure.calibration.has_bend())
        .then(|| gradient::bent(seen, gate.bends_taught, k, structure));
    let starting = if PLAIN { None } else { seen.start };
    let start = starting.map(|Polar { running, .. }| {
        // It solves for all but the bends, as the ellipse alone shows them.
        let solved = start::start(linear, seen.theta, gate, state, k, structure);
        (this.gathered, this.start_periods) = (solved.gathered, solved.periods);
        (running, solved.steps)
    });
    if let Some(bent) = &bent {
        this.w_null = bent.w;
    }
    let mut gradient = Gradient::of(linear, bent);
    let method = method::<PLAIN>(structure);
    match method {
        CalibrationMethod::Final => gradient.tell_gains_apart(structure),
        CalibrationMethod::Exact => {
            this.sensitivities = gradient.add_turning(seen, state, k, structure);
        }
        CalibrationMethod::SumOfSquares => {
            gradient.gather(&mut this.gathered, gate, k, structure);
        }
        CalibrationMethod::Batch => {
            gradient.gather(&mut this.gathered, gate, k, structure);
            gradient.solve_gains();
        }
    }
    seen.rho.begin(formula);
    let mover = Mover {
        due: due(gate, start.map(|(running, _)| running), method),
        start,
        nominal: gears::nominal(state, k, structure),
    };
    gradient.move_all(&mut this.theta, mover, gate, (state, k, structure));
    this
}

/// What the Verilog says of the search.
#[inline(always)]
fn formula(structure: &Structure) -> &'static Formula {
    let calibration = &structure.calibration;
    match (calibration.squares(), calibration.waits()) {
        (true, _) => &UPDATE_SQUARES,
        (false, true) if calibration.phase_settles() => &UPDATE_WAITS_PHASE,
        (false, true) => &UPDATE_WAITS,
        (false, false) => &UPDATE,
    }
}

/// The search's method: a plain design has the final form, which the compiler is told here.
#[inline(always)]
fn method<const PLAIN: bool>(structure: &Structure) -> CalibrationMethod {
    if PLAIN {
        CalibrationMethod::Final
    } else {
        structure.calibration.method
    }
}

/// Whether γ has settled, where the step of the phase becomes smaller with that.
#[inline(always)]
fn phase_settled<S: Signal>(
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<S::Bool> {
    structure
        .calibration
        .phase_settles()
        .then(|| gears::settled(state, k, structure))
}

/// How many of θ1 … θ5 are calibrated: the last one where there is phase.
#[inline(always)]
pub fn linear_parameters(structure: &Structure) -> usize {
    if structure.calibration.has_phase() {
        5
    } else {
        4
    }
}

/// Whether the parameters move with this sample: what is gathered, by batches or while the start runs (`starting`), acts where its
/// period ends.
#[inline(always)]
fn due<S: Signal>(gate: Gate<S>, starting: Option<S::Bool>, method: CalibrationMethod) -> S::Bool {
    match starting {
        Some(starting) => gate
            .fresh
            .and(gate.whole_period.or(starting.not()))
            .named("due"),
        None if method == CalibrationMethod::Batch => {
            gate.fresh.and(gate.whole_period).named("batch_due")
        }
        None => gate.fresh,
    }
}

/// The gradient, from what a sample shows to what moves the parameters: each method makes its own of it.
struct Gradient<S: Signal> {
    /// By θ1 … θ5, without phase the last is 0.
    linear: [S::Wide; 5],
    /// By the bends, where they are calibrated.
    bent: Option<Bent<S>>,
}

impl<S: Signal> Gradient<S> {
    /// Of one sample. Where bends are calibrated, offsets and phase are told from them.
    #[inline(always)]
    fn of(mut linear: [S::Wide; 5], bent: Option<Bent<S>>) -> Self {
        if let Some(bent) = &bent {
            (linear[1], linear[3], linear[4]) = (bent.offsets[0], bent.offsets[1], bent.phase);
        }
        Self { linear, bent }
    }

    /// Half of the other gain's gradient is taken from each, where the four parameters have no phase that would bring the
    /// difference of the gains along: see [`Equaliser`].
    #[inline(always)]
    fn tell_gains_apart(&mut self, structure: &Structure) {
        if structure.calibration.parameters == 4 {
            self.mix_gains(|own, other| own - other.scale(-1));
        }
    }

    /// Newton's step of the gains, 3 of the own and −1 of the other: the inverse of the normal equations of a whole period, paper
    /// section 5.2, up to the factor in [`Equaliser`].
    #[inline(always)]
    fn solve_gains(&mut self) {
        self.mix_gains(|own, other| own.scale(2) - own - other);
    }

    /// Each gain's gradient becomes what this makes of it and the other's.
    #[inline(always)]
    fn mix_gains(&mut self, mixed: impl Fn(S::Wide, S::Wide) -> S::Wide) {
        let (cos, sin) = (self.linear[0], self.linear[2]);
        (self.linear[0], self.linear[2]) = (mixed(cos, sin), mixed(sin, cos));
    }

    /// The exact gradient: what turns the pair counts too, (w − ∇α̂)ᵀ e of equation (11). Returns ∇α̂ after the sample.
    #[inline(always)]
    fn add_turning(
        &mut self,
        seen: &Seen<S>,
        state: &State<S>,
        k: &Coefficients<S>,
        structure: &Structure,
    ) -> [Sensitivity<S>; 5] {
        let sensitivities = gradient::sensitivities(seen, state, k, structure);
        let calibrated = self.linear.iter_mut().zip(&sensitivities);
        for (gradient, sensitivity) in calibrated.take(linear_parameters(structure)) {
            *gradient = *gradient + sensitivity.error * seen.e;
        }
        sensitivities
    }

    /// Sums of squares, paper sections 5.2 to 5.4: what moves the parameters is gathered over samples, and `gathered` goes on with
    /// this one.
    #[inline(always)]
    fn gather(
        &mut self,
        gathered: &mut [S; 8],
        gate: Gate<S>,
        k: &Coefficients<S>,
        structure: &Structure,
    ) {
        let gather = |gradient: &mut S::Wide, before: &mut S, gate| {
            let sum = gather::squares(*gradient, *before, gate, k.zero, structure);
            *gradient = sum.gradient.widen();
            *before = sum.next;
        };
        let (linear, bends) = gathered.split_at_mut(5);
        let calibrated = self.linear.iter_mut().zip(linear);
        for (gradient, before) in calibrated.take(linear_parameters(structure)) {
            gather(gradient, before, gate);
        }
        let gate = Gate {
            fresh: gate.for_bends(gate.fresh, "bends_fresh"),
            ..gate
        };
        if let Some(bent) = &mut self.bent {
            let [second_c, second_s] = &mut bent.second;
            let by_bends = [second_c, second_s, &mut bent.third];
            for (gradient, before) in by_bends.into_iter().zip(bends) {
                gather(gradient, before, gate);
            }
        }
    }

    /// Every parameter that is calibrated but θ9 makes its step; bends only where they are taught.
    #[inline(always)]
    fn move_all(
        self,
        theta: &mut [S; 9],
        mover: Mover<S>,
        gate: Gate<S>,
        of: (&State<S>, &Coefficients<S>, &Structure),
    ) {
        let (_, _, structure) = of;
        let by = Equaliser::of(structure);
        let [first, second, third, fourth, fifth] = self.linear;
        // Neither a loop nor a closure: each has its own code, whatever the compiler thinks of them.
        // θ5 first: its product is the last of the paper's.
        if structure.calibration.has_phase() {
            theta[4] = mover.moved(4, theta[4], (fifth, by.phase), of);
        }
        theta[0] = mover.moved(0, theta[0], (first, by.gain), of);
        theta[1] = mover.moved(1, theta[1], (second, by.offset), of);
        theta[2] = mover.moved(2, theta[2], (third, by.gain), of);
        theta[3] = mover.moved(3, theta[3], (fourth, by.offset), of);
        if let Some(Bent { second, third, .. }) = self.bent {
            let due = gate.for_bends(mover.due, "bends_due");
            let mover = Mover { due, ..mover };
            for (i, gradient) in [(5, second[0]), (6, second[1]), (7, third)] {
                theta[i] = mover.moved(i, theta[i], (gradient, by.bend), of);
            }
        }
    }
}
