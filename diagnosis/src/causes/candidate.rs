//! A cause that may be in a recording: its shapes, how many were tried, what to say about it.

use std::rc::Rc;

use nonius_fourier::Complex;

use crate::finding::{Cause, Chip, Parameter};
use crate::shapes::library::{Library, Shape};
use crate::shapes::trig::Trig;

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

impl Domain {
    /// What depends on the code depends on the angle too.
    pub(crate) fn home(self) -> Self {
        if self == Self::Code {
            Self::Angle
        } else {
            self
        }
    }
}

/// Estimates of a cause's shapes: number per shape, and their standard errors.
pub(crate) struct Estimate<'a> {
    /// Amount of each shape.
    pub x: &'a [f64],
    /// Its standard error.
    pub error: &'a [f64],
    /// Numbers that are no amounts.
    pub inner: &'a [f64],
    /// Their standard errors, where they were fitted.
    pub inner_error: Option<&'a [f64]>,
}

/// Makes the shapes of inner parameters, as functions of their own.
pub(crate) type Make = Rc<dyn Fn(&[f64], &mut Library) -> Vec<Shape>>;

/// How the shapes of a cause depend on numbers that are no amounts.
#[derive(Clone)]
pub(crate) struct Exact {
    /// The shapes.
    pub make: Make,
    /// The numbers: a frequency, a threshold, a place.
    pub inner: Vec<f64>,
    /// Changes of them that are small.
    pub steps: Vec<f64>,
    /// The one inner number is the first amount itself.
    pub follows: bool,
}
/// A factor of the pair, by what its shape says of the radius, less one, and of the angle, radians.
pub(crate) type Factor = fn(f64, f64) -> Complex<f64>;
/// What amounts add to each channel, in its amplitudes, at each angle, by the phase error in radians.
pub(crate) type Adds = Rc<dyn Fn(f64, &[f64]) -> [Trig; 2]>;
/// Makes parameters of an estimate.
pub(crate) type Reads = Rc<dyn Fn(&Estimate) -> Vec<Parameter>>;
/// Makes a sentence of parameters.
pub(crate) type Says = Rc<dyn Fn(&[Parameter]) -> String>;

/// What the amounts of a cause can be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sign {
    /// Anything.
    Any,
    /// Not negative.
    Positive,
    /// The first is the inner number itself, which the shapes know too, and at least this; the others are anything.
    Known(f64),
}

/// A cause with one choice of its discrete parameters.
#[derive(Clone)]
pub(crate) struct Candidate {
    /// Its name.
    pub name: Cause,
    /// Domain.
    pub domain: Domain,
    /// How many choices like this one were tried.
    pub trials: f64,
    /// Choices that the radius has to make up for where the axis vibrates and it judges what was found.
    pub by_radius: f64,
    /// The shapes.
    pub shapes: Vec<Shape>,
    /// Its number among those of its name in the catalogue: that may hold other names after another look.
    pub id: usize,
    /// Of a harmonic of the scale period, its order.
    pub order: Option<usize>,
    /// Order of the revolution, of cogging.
    pub of_revolution: Option<usize>,
    /// The shapes are real motion: they do not come from the sensor.
    pub motion: bool,
    /// What the amounts can be.
    pub sign: Sign,
    /// A drift may be the same: it is named alone only where no drift explains nearly as much, and never without it.
    pub as_drift: bool,
    /// Where its first shape is a factor of the pair, which is the same as something added only where it is small.
    pub factor: Option<Factor>,
    /// What it adds to the channels, where that is the same in every period: what delays and filters see, too.
    pub adds: Option<Adds>,
    /// What the chip can do.
    pub chip: Chip,
    /// How the shapes depend on numbers that are no amounts, where they do.
    pub exact: Option<Exact>,
    /// Parameters from the estimate.
    pub parameters: Reads,
    /// The middle of the sentence: what was seen, from the parameters.
    pub evidence: Says,
}

impl Candidate {
    /// The first of the numbers that its shapes depend on, where there is one: of a line its frequency, Hz.
    pub(crate) fn inner(&self) -> Option<f64> {
        self.exact.as_ref()?.inner.first().copied()
    }

    /// One choice, of amounts that can be anything, of shapes that are what they are; the chip cannot correct it, and
    /// nothing is said of it yet.
    pub(crate) fn new(name: Cause, domain: Domain, shapes: Vec<Shape>) -> Self {
        Self {
            name,
            domain,
            trials: 1.0,
            by_radius: 1.0,
            shapes,
            id: 0,
            order: None,
            of_revolution: None,
            motion: false,
            sign: Sign::Any,
            as_drift: false,
            factor: None,
            adds: None,
            chip: Chip::CannotCorrect,
            exact: None,
            parameters: Rc::new(|_| vec![]),
            evidence: Rc::new(|_| String::new()),
        }
    }

    /// Numbers that are no part of the cause, but of how it was when the recording began.
    pub(crate) fn given(&self) -> usize {
        match self.sign {
            Sign::Known(_) => self.shapes.len() - 1,
            Sign::Any | Sign::Positive => 0,
        }
    }
}

/// One parameter per shape, with the same unit.
pub(crate) fn each(names: &'static [&'static str], unit: &'static str) -> Reads {
    Rc::new(move |e| {
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
