//! What a cause does against what it depends on: means over bins, of what is measured and of what is simulated alike.

use nonius_plot::{Axis, Look, Plot, Series};
use nonius_quantity::{Quantity, Unit, prefixed};

use crate::context::Context;

/// Bins of an axis.
const BINS: usize = 60;
/// Fewest samples of a bin.
const FEWEST: f64 = 6.0;

/// What something depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Against {
    /// Angle of the scale period, in periods.
    Angle,
    /// Angle of the revolution, in revolutions.
    Revolution,
    /// Seconds.
    Time,
    /// Scale periods per second, signed.
    Speed,
    /// Signal of channel 0 or 1, in amplitudes.
    Signal(usize),
    /// Code of a channel modulo twice the weight of a bit.
    Code(usize, u32),
    /// Phase of a line of so many hertz, in its cycles.
    Line(f64),
}

/// What is measured of the residual in a bin: its share along this.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Along {
    /// The radius.
    Radius,
    /// The circle.
    Circle,
    /// Real motion.
    Motion,
    /// The offset of a channel.
    Offset(usize),
    /// The gain of a channel.
    Gain(usize),
    /// The phase of a channel.
    Phase(usize),
}

/// Residuals along the radius, along the circle and as motion, at a sample.
pub(super) type Row = [f64; 3];

/// The unit of a time axis over the recording, and what seconds are multiplied by.
fn time_unit(context: &Context) -> (String, f64) {
    let duration = context.samples() as f64 / context.rate;
    prefixed(duration, Unit::Small("s"))
}

impl Against {
    /// The numbers, and the ends of the axis where they are known.
    fn values(self, context: &Context) -> Option<(Vec<f64>, Option<[f64; 2]>)> {
        let turns = |angle: &[f64]| -> Vec<f64> {
            let turn = |a: &f64| (a / std::f64::consts::TAU).rem_euclid(1.0);
            angle.iter().map(turn).collect()
        };
        let whole = Some([0.0, 1.0]);
        Some(match self {
            Self::Angle => (turns(&context.alpha), whole),
            Self::Revolution => (turns(context.phi.as_ref()?), whole),
            Self::Time => {
                let (_, factor) = time_unit(context);
                (context.time.iter().map(|t| factor * t).collect(), None)
            }
            Self::Speed => {
                let speed = context.speed.iter();
                (speed.map(|v| v / std::f64::consts::TAU).collect(), None)
            }
            Self::Signal(which) => {
                let u = [&context.cos, &context.sin][which];
                (u.clone(), Some([-1.0, 1.0]))
            }
            Self::Code(which, bit) => {
                let fold = 2i64.pow(bit.min(40) + 1);
                let half = 1i64 << (context.bits.min(40) - 1);
                let codes = context.codes[which].iter();
                let folded = codes.map(|c| (c + half).rem_euclid(fold) as f64);
                (folded.collect(), Some([0.0, fold as f64]))
            }
            Self::Line(hertz) => {
                let time = context.time.iter();
                (time.map(|t| (t * hertz).rem_euclid(1.0)).collect(), whole)
            }
        })
    }

    fn label(self, context: &Context) -> String {
        match self {
            Self::Angle => "angle, scale periods".into(),
            Self::Revolution => "angle, revolutions".into(),
            Self::Time => format!("time, {}", time_unit(context).0),
            Self::Speed => "speed, scale periods per second".into(),
            Self::Signal(0) => "cos, in amplitudes".into(),
            Self::Signal(_) => "sin, in amplitudes".into(),
            Self::Code(_, bit) => format!("code modulo {}", 2i64.pow(bit.min(40) + 1)),
            Self::Line(hertz) => {
                let hertz = Quantity::rounded(hertz, 5, Unit::Prefixed("Hz"));
                format!("phase of the line at {}, cycles", hertz.brief())
            }
        }
    }
}

impl Along {
    /// The unit vector of a sample: along the radius, along the circle, as motion.
    fn of(self, context: &Context, k: usize) -> Row {
        let (cos, sin) = (context.cos[k], context.sin[k]);
        // A change of a channel, turned to radius and circle.
        let channel = |which: usize, by: f64| match which {
            0 => [by * cos, -by * sin, 0.0],
            _ => [by * sin, by * cos, 0.0],
        };
        match self {
            Self::Radius => [1.0, 0.0, 0.0],
            Self::Circle => [0.0, 1.0, 0.0],
            Self::Motion => [0.0, 0.0, 1.0],
            Self::Offset(which) => channel(which, 1.0),
            Self::Gain(which) => channel(which, [cos, sin][which]),
            Self::Phase(which) => channel(which, [-sin, cos][which]),
        }
    }

    fn label(self) -> (&'static str, f64) {
        match self {
            Self::Radius => ("radial error, % of the amplitude", 100.0),
            Self::Circle => ("angle error, mrad (electrical)", 1000.0),
            Self::Motion => ("motion, mrad (electrical)", 1000.0),
            Self::Offset(0) => ("error of cos, % of the amplitude", 100.0),
            Self::Offset(_) => ("error of sin, % of the amplitude", 100.0),
            Self::Gain(0) => ("gain error of cos, %", 100.0),
            Self::Gain(_) => ("gain error of sin, %", 100.0),
            Self::Phase(0) => ("phase error of cos, mrad", 1000.0),
            Self::Phase(_) => ("phase error of sin, mrad", 1000.0),
        }
    }
}

/// Sums of a bin.
#[derive(Clone, Copy, Default)]
struct Bin {
    place: f64,
    count: f64,
    square: f64,
    measured: f64,
    simulated: f64,
}

/// Where a plot is taken from: what is left of a sample, and what the cause does there.
pub(super) struct Seen<'a> {
    pub(super) context: &'a Context,
    pub(super) left: &'a dyn Fn(usize) -> Row,
    pub(super) effect: &'a dyn Fn(usize) -> Row,
}

impl Seen<'_> {
    /// Means over bins; `None` where the recording does not have what they are against.
    pub(super) fn plot(&self, title: &str, against: Against, along: Along) -> Option<Plot> {
        let context = self.context;
        let (values, ends) = against.values(context)?;
        let ends = ends.unwrap_or_else(|| crate::numerics::ends::ends(values.iter().copied()));
        let count = match against {
            // A code is not divided.
            Against::Code(..) => BINS.min(ends[1] as usize).max(1),
            _ => BINS,
        };
        let mut bins = vec![Bin::default(); count];
        let (mut noise, mut total) = (0.0, 0.0);
        for (k, value) in values.iter().enumerate() {
            let place = (value - ends[0]) / (ends[1] - ends[0]) * count as f64;
            if context.weight[k] == 0.0 || !place.is_finite() {
                continue;
            }
            let (left, effect, unit) = ((self.left)(k), (self.effect)(k), along.of(context, k));
            let dot = |a: &Row| a.iter().zip(&unit).map(|(a, u)| a * u).sum::<f64>();
            let bin = &mut bins[(place.max(0.0) as usize).min(count - 1)];
            let square = dot(&unit);
            noise += dot(&left).powi(2);
            total += square;
            bin.place += value;
            bin.count += 1.0;
            bin.square += square;
            bin.measured += dot(&left) + dot(&effect);
            bin.simulated += dot(&effect);
        }
        let sigma = (noise / total.max(f64::MIN_POSITIVE)).sqrt();
        let (label, unit) = along.label();
        let (mut measured, mut errors, mut simulated) = (vec![], vec![], vec![]);
        for bin in bins
            .iter()
            .filter(|b| b.count >= FEWEST && b.square > 1e-3 * b.count)
        {
            let x = bin.place / bin.count;
            measured.push([x, unit * bin.measured / bin.square]);
            simulated.push([x, unit * bin.simulated / bin.square]);
            errors.push(unit * sigma / bin.square.sqrt());
        }
        let shown = measured.iter().zip(&errors);
        let reach = shown
            .flat_map(|(p, e)| [p[1] - e, p[1] + e])
            .chain(simulated.iter().map(|p| p[1]))
            .chain([0.0]);
        Some(Plot {
            title: title.into(),
            x: Axis::linear(&against.label(context), ends),
            y: Axis::fitted(label, reach),
            series: vec![
                Series {
                    name: "measured, ± standard error".into(),
                    look: Look::Bars,
                    points: measured,
                    errors,
                },
                Series::new("simulated with the cause", Look::Model, simulated),
            ],
            marks: vec![],
            round: false,
        })
    }
}
