//! The chip: kernels and registers.

use crate::bits::Bits;
use crate::design::Design;
use crate::graph::{Graph, Node, RangeError, Recorder};
use crate::kernel::{Coefficients, Input, Probes, State, Structure, advance, sample};
use crate::signal::Signal;

/// The chip in one reading: `Chip<Bits>` is bit-true, `Chip<f64>` the same algorithm without rounding.
#[derive(Clone, Debug)]
pub struct Chip<S: Signal> {
    structure: Structure,
    coefficients: Coefficients<S>,
    /// The registers, as they stand between two samples.
    pub state: State<S>,
}

impl Chip<Bits> {
    /// The bit-true chip after reset.
    #[must_use]
    pub fn bit_true(design: &Design) -> Self {
        let state = State::build(|_| Bits::default(), |_| false);
        Self {
            structure: design.structure.clone(),
            coefficients: design.constants.bits(),
            state,
        }
    }

    /// One sample of ADC codes; `zero` and `calibrate` as the pins.
    #[cfg_attr(not(debug_assertions), inline)]
    pub fn step_codes(&mut self, cos: i64, sin: i64, zero: bool, calibrate: bool) -> Probes<Bits> {
        let bits = self.structure.formats.adc.fraction;
        self.step(&Input {
            adc_cos: Bits::from_raw(cos, bits),
            adc_sin: Bits::from_raw(sin, bits),
            preset: zero,
            calibrate,
        })
    }

    /// One sample.
    // A sample is one long function: forty test programs take it from here instead of compiling it again.
    #[cfg_attr(not(debug_assertions), inline)]
    pub fn step(&mut self, input: &Input<Bits>) -> Probes<Bits> {
        advance(input, &mut self.state, &self.coefficients, &self.structure)
    }

    /// Whole periods and phase: α̂ for the next sample, in units of 2^-(phase bits) of a period.
    #[must_use]
    pub fn position_raw(&self) -> i128 {
        let (count, alpha) = (
            self.structure.formats.count.format,
            self.structure.formats.alpha.format,
        );
        (i128::from(self.state.count.raw(count.fraction)) << alpha.fraction)
            + i128::from(self.state.alpha_hat.raw(alpha.fraction))
    }

    /// The parameters θ1 … θ9 that the next sample is corrected with, as the kernels see them.
    #[must_use]
    pub fn theta(&self) -> [f64; 9] {
        use crate::kernel::{bend, correction};
        let state = &self.state;
        let [t1, t2, t3, t4, t5] =
            correction::parameters(state, &self.coefficients, &self.structure);
        let bends = bend::parameters(state, &self.structure);
        let (t6, t7) = (bends.theta_6, bends.theta_7);
        let (t8, t9) = (state.theta_8_deviation, state.theta_9_deviation);
        [t1, t2, t3, t4, t5, t6, t7, t8, t9].map(Bits::to_f64)
    }

    /// The position in periods.
    #[must_use]
    pub fn position(&self) -> f64 {
        let count = self
            .state
            .count
            .raw(self.structure.formats.count.format.fraction);
        count as f64 + self.state.alpha_hat.to_f64()
    }
}

impl Chip<f64> {
    /// The chip without rounding, after reset.
    #[must_use]
    pub fn unrounded(design: &Design) -> Self {
        let state = State::build(|_| 0.0, |_| false);
        Self {
            structure: design.structure.clone(),
            coefficients: design.constants.real(),
            state,
        }
    }

    /// One sample.
    // As above.
    #[cfg_attr(not(debug_assertions), inline)]
    pub fn step(&mut self, input: &Input<f64>) -> Probes<f64> {
        advance(input, &mut self.state, &self.coefficients, &self.structure)
    }

    /// The position in periods.
    #[must_use]
    pub fn position(&self) -> f64 {
        self.state.count * crate::format::exp2(self.structure.formats.count.format.fraction.into())
            + self.state.alpha_hat
    }
}

/// The accumulator whose value a register remembers, or has so far.
fn accumulator(name: &str) -> Option<&'static str> {
    let (_, of) = name
        .split_once('_')
        .filter(|(what, _)| ["recent", "proven", "running"].contains(what))?;
    let theta = format!("theta_{of}_deviation");
    let values = State::<Bits>::VALUES.iter();
    values.copied().find(|value| *value == theta)
}

/// Which registers this structure has.
#[must_use]
pub fn registers(structure: &Structure) -> (Vec<&'static str>, Vec<&'static str>) {
    let c = &structure.calibration;
    let one = structure.method == crate::kernel::Method::One;
    let two_products = structure.method != crate::kernel::Method::Two;
    let exact = c.is_exact();
    let is_used = |name: &str| match name {
        "alpha_hat_previous" => one,
        "rate" => !one,
        "error_previous" => structure.method != crate::kernel::Method::Two,
        "theta_5_deviation" => c.has_phase(),
        "theta_1_deviation" | "theta_2_deviation" | "theta_3_deviation" | "theta_4_deviation" => {
            c.is_on()
        }
        "theta_6_deviation" | "theta_7_deviation" | "theta_8_deviation" => c.has_bend(),
        "gamma_gear" | "gear_periods" | "held_periods" | "travel_origin" | "travel_low"
        | "travel_high" | "disturbed" | "risen" | "held" => c.is_on(),
        "unlocked_samples" => c.may_stray(),
        "failed_periods" => c.may_stray() && c.swings(),
        "astray" | "astray_before" | "astray_long" => structure.catches_up(),
        "rough" | "calm" => c.is_on() && c.settles(),
        "ahead_used" | "behind_used" => c.is_on() && !c.is_batch(),
        "loop_gear" => structure.loop_gears > 0,
        "theta_9_deviation" | "null_gradient" | "null_gradient_rate" | "travel_samples"
        | "gathered_9" | "moving" => c.completed().is_some(),
        "start_periods" => c.starts(),
        "returning" | "fading" | "known" | "halfway" | "apart" => c.recalls(),
        "null_gradient_error" => c.completed().is_some() && two_products,
        name if name.starts_with("alpha_gradient") => {
            let phase = name.ends_with('5');
            let error = name.starts_with("alpha_gradient_error");
            exact && (!phase || c.has_phase()) && (!error || two_products)
        }
        "gathered_5" => c.gathers() && c.has_phase(),
        "gathered_6" | "gathered_7" | "gathered_8" => c.squares() && c.has_bend(),
        name if name.starts_with("gathered") => c.gathers(),
        _ => true,
    };
    let kept = |name: &str| match accumulator(name) {
        Some(theta) if name.starts_with("running") => c.waits() && is_used(theta),
        Some(theta) => c.recalls() && is_used(theta),
        None => is_used(name),
    };
    let keep = |names: &[&'static str]| names.iter().copied().filter(|n| kept(n)).collect();
    (keep(State::<Bits>::VALUES), keep(State::<Bits>::FLAGS))
}

/// Which probes this structure has.
#[must_use]
pub fn probes(structure: &Structure) -> (Vec<&'static str>, Vec<&'static str>) {
    let c = &structure.calibration;
    let used = |name: &str| match name {
        "theta_5" => c.has_phase(),
        "theta_6" | "theta_7" => c.has_bend(),
        "skew" => structure.skew.is_some(),
        "harmonic_cos" | "harmonic_sin" => structure.harmonics.is_some(),
        "theta_2" | "theta_4" | "rho_c" | "rho_s" | "fresh" | "whole_period" => c.is_on(),
        _ => true,
    };
    let keep = |names: &[&'static str]| names.iter().copied().filter(|n| used(n)).collect();
    (keep(Probes::<Bits>::VALUES), keep(Probes::<Bits>::FLAGS))
}

/// The kernel of a sample, with `Node` for numbers; what a test may replace to see that the Verilog follows.
pub type SampleKernel = for<'g> fn(
    &Input<Node<'g>>,
    &State<Node<'g>>,
    &Coefficients<Node<'g>>,
    &Structure,
) -> (State<Node<'g>>, Probes<Node<'g>>);

/// The chip's own kernel as a [`SampleKernel`].
#[must_use]
pub fn chip_kernel<'g>(
    input: &Input<Node<'g>>,
    state: &State<Node<'g>>,
    k: &Coefficients<Node<'g>>,
    structure: &Structure,
) -> (State<Node<'g>>, Probes<Node<'g>>) {
    sample(input, state, k, structure)
}

/// Records one sample of the chip as a graph.
///
/// # Errors
/// A value that does not fit the container or a format it was promised to fit, with its worst case.
pub fn record(
    structure: &Structure,
    constants: &Coefficients<crate::kernel::Constant>,
    kernel: SampleKernel,
) -> Result<Graph, RangeError> {
    let recorder = Recorder::new();
    {
        let k = constants.record(&recorder);
        let (values, flags) = registers(structure);
        let register = |name: &'static str| {
            if values.contains(&name) {
                recorder.input(name, register_format(name, structure))
            } else {
                k.zero
            }
        };
        let never = recorder.constant_flag();
        let flag = |name: &'static str| {
            if flags.contains(&name) {
                recorder.flag_input(name)
            } else {
                never
            }
        };
        let state = State::build(register, flag);
        let adc = structure.formats.adc;
        let input = Input::build(
            |name| recorder.input(name, adc),
            |name| recorder.flag_input(name),
        );
        let (next, seen) = kernel(&input, &state, &k, structure);
        let (probe_values, probe_flags) = probes(structure);
        for name in probe_values {
            if let Some(node) = seen.value(name) {
                recorder.probe(name, node.id);
            }
        }
        for name in probe_flags {
            if let Some(flag) = seen.flag(name) {
                recorder.probe(name, flag.id());
            }
        }
        for name in values {
            if let Some(node) = next.value(name) {
                recorder.next(name, node.id);
            }
        }
        for name in flags {
            if let Some(flag) = next.flag(name) {
                recorder.next(name, flag.id());
            }
        }
    }
    recorder.finish()
}

/// Format of a register.
#[must_use]
pub fn register_format(name: &str, structure: &Structure) -> crate::format::Format {
    let f = &structure.formats;
    let remembered = name
        .strip_prefix("recent_")
        .or(name.strip_prefix("proven_"));
    if let Some(n) = remembered.and_then(|n| n.parse::<usize>().ok()) {
        return f.remembered[n - 1].format;
    }
    match accumulator(name).unwrap_or(name) {
        "alpha_hat" | "alpha_hat_previous" => f.alpha.format,
        "count" => f.count.format,
        "rate" => f.rate.format,
        "theta_1_deviation" => f.deviation[0].format,
        "theta_2_deviation" => f.deviation[1].format,
        "theta_3_deviation" => f.deviation[2].format,
        "theta_4_deviation" => f.deviation[3].format,
        "theta_5_deviation" => f.deviation[4].format,
        "theta_6_deviation" => f.deviation[5].format,
        "theta_7_deviation" => f.deviation[6].format,
        "theta_8_deviation" => f.deviation[7].format,
        "theta_9_deviation" => f.deviation[8].format,
        "lock_level" => f.level.format,
        "loop_gear" => f.loop_gear.format,
        "gamma_gear" => f.gamma_gear.format,
        "gear_periods" => f.gear_periods.format,
        "held_periods" => f.held_periods.format,
        "unlocked_samples" => f.unlocked_samples.format,
        "failed_periods" => f.failed_periods.format,
        "travel_samples" => f.travel_samples.format,
        "gathered_9" => f.deviation[8].format,
        "start_periods" => f.start_periods.format,
        name if name.contains("gradient_error") => f.signal.format,
        name if name.contains("_gradient") => f.alpha_gradient.format,
        name if name.starts_with("gathered") => f.gathered.format,
        "travel_origin" | "travel_low" | "travel_high" => crate::kernel::travel::SECTOR,
        _ => f.signal.format,
    }
}
