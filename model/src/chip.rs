//! The chip: kernels and registers.

use crate::bits::Bits;
use crate::design::Design;
use crate::graph::{Graph, Node, RangeError, Recorder};
use crate::kernel::{Coefficients, Input, Probes, State, Structure, advance, sample};
use crate::registers;
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
        let [t6, t7, t8, t9] = [bends.theta_6, bends.theta_7, bends.theta_8, bends.theta_9];
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
        let (values, flags) = registers::registers(structure);
        let register = |name: &'static str| {
            registers::format(name, structure).map_or(k.zero, |format| recorder.input(name, format))
        };
        let never = recorder.constant_flag();
        let flag = |name: &'static str| {
            if registers::flag(name, structure) {
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
        let (probe_values, probe_flags) = registers::probes(structure);
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
