//! A cause that may be in a recording: its shapes, how many were tried, what to say about it.

use crate::column::Shape;
use crate::context::Context;
use crate::finding::{Chip, Parameter};

/// Where a cause lives; what no cause of a domain explains is measured with a generic basis of that domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Domain {
    /// Repeats with the scale period.
    Angle,
    /// Depends on the ADC code.
    Code,
    /// Depends on speed.
    Speed,
    /// Changes slowly with time.
    Time,
    /// A line in the spectrum.
    Line,
    /// Repeats with the revolution.
    Revolution,
    /// Real motion.
    Motion,
}

/// Estimates of a cause's shapes: number per shape, and their standard errors.
pub(crate) struct Estimate<'a> {
    /// Amount of each shape.
    pub x: &'a [f64],
    /// Its standard error.
    pub error: &'a [f64],
}

/// Makes shapes of amounts.
pub(crate) type Refine = Box<dyn Fn(&Context, &[f64]) -> Vec<Shape>>;
/// Makes parameters of an estimate.
pub(crate) type Reads = Box<dyn Fn(&Estimate) -> Vec<Parameter>>;
/// Makes a sentence of parameters.
pub(crate) type Says = Box<dyn Fn(&[Parameter]) -> String>;

/// A cause with one choice of its discrete parameters.
pub(crate) struct Candidate {
    /// Name of the contract.
    pub name: &'static str,
    /// Domain.
    pub domain: Domain,
    /// How many choices like this one were tried.
    pub trials: f64,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// The shapes are real motion: they do not come from the sensor.
    pub motion: bool,
    /// The amounts cannot be negative.
    pub positive: bool,
    /// What the chip can do.
    pub chip: Chip,
    /// The shapes where the first estimate says the cause is, if they change with its size.
    pub refine: Option<Refine>,
    /// Parameters from the estimate.
    pub parameters: Reads,
    /// The middle of the sentence: what was seen, from the parameters.
    pub evidence: Says,
}

/// A change of the raw channels, in fractions of their amplitudes, as a change of the corrected pair.
pub(crate) fn raw(context: &Context, cos: Vec<f64>, sin: Vec<f64>) -> Shape {
    let (tan, secant) = (context.ellipse.beta.tan(), 1.0 / context.ellipse.beta.cos());
    let s = cos.iter().zip(&sin).map(|(c, s)| s * secant + c * tan);
    Shape {
        s: s.collect(),
        c: cos,
    }
}

/// A change of one raw channel.
pub(crate) fn channel(context: &Context, which: usize, change: Vec<f64>) -> Shape {
    let zero = vec![0.0; change.len()];
    if which == 0 {
        raw(context, change, zero)
    } else {
        raw(context, zero, change)
    }
}

/// Normalised raw channels: cos α and sin(α − β).
pub(crate) fn normalised(context: &Context) -> [Vec<f64>; 2] {
    let beta = context.ellipse.beta;
    [
        context.cos.clone(),
        context.alpha.iter().map(|a| (a - beta).sin()).collect(),
    ]
}

/// Their derivatives by α.
pub(crate) fn derivatives(context: &Context) -> [Vec<f64>; 2] {
    let beta = context.ellipse.beta;
    [
        context.sin.iter().map(|s| -s).collect(),
        context.alpha.iter().map(|a| (a - beta).cos()).collect(),
    ]
}

/// One parameter per shape, with the same unit.
pub(crate) fn each(names: &'static [&'static str], unit: &'static str) -> Reads {
    Box::new(move |e| {
        let list = names.iter().zip(e.x).zip(e.error);
        list.map(|((name, x), error)| Parameter::measured(name, *x, *error, unit))
            .collect()
    })
}

/// Amplitude and phase of a cos and a sin.
pub(crate) fn polar(x: &[f64], error: &[f64]) -> (f64, f64, f64, f64) {
    let (amplitude, spread) = (
        x[0].hypot(x[1]),
        (error[0].powi(2) + error[1].powi(2)).sqrt() / 2f64.sqrt(),
    );
    let phase = (-x[1]).atan2(x[0]);
    (
        amplitude,
        spread,
        phase,
        spread / amplitude.max(f64::MIN_POSITIVE),
    )
}
