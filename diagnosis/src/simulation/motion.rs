//! `motion.csv`: the smooth motion of a recording, which the extended simulation is moved along.

use std::f64::consts::TAU;
use std::fmt::Write;

use nonius_recording::Recording;

use crate::checks::timebase::GAP;
use crate::context::Context;
use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding};
use crate::motion::spline::Spline;
use crate::numerics::slopes::lay_straight;

/// Where the axis is by the extended model, as a spline of the sample's number: radians of the scale period.
#[derive(Clone, Debug)]
pub(crate) struct Motion {
    spline: Spline,
    coefficients: Vec<f64>,
}

impl Motion {
    /// Of an angle less all that the sensor does to it, radians, with knots as close as the angle is followed.
    pub(crate) fn of(context: &Context, angle: &[f64]) -> Self {
        let n = context.samples();
        let spacing = context.followed().map_or(n as f64, Spline::spacing);
        let weights = context.leads();
        let spline = Spline::new(n, spacing, &weights);
        let coefficients = spline.fit(angle, &weights);
        Self {
            spline,
            coefficients,
        }
    }

    /// The same less what findings add to it, which the simulation adds itself.
    fn smooth(&self, context: &Context, findings: &[Finding]) -> Self {
        let mut added = vec![0.0; context.samples()];
        for finding in findings {
            let at = added_by(finding, context);
            let each = added.iter_mut().enumerate();
            each.for_each(|(k, added)| *added += at(k));
        }
        let added = self.spline.fit(&added, &context.leads());
        let pairs = self.coefficients.iter().zip(added);
        Self {
            spline: self.spline.clone(),
            coefficients: pairs.map(|(all, added)| all - added).collect(),
        }
    }
}

/// Where samples tell nothing, the axis goes along its smooth motion from the one before to the one after.
pub(crate) fn bridge(context: &Context, angle: &mut [f64]) {
    let smooth = &context.alpha;
    let mut off: Vec<f64> = angle.iter().zip(smooth).map(|(a, s)| a - s).collect();
    let mut from = 0;
    for run in context.tells().chunk_by(|a, b| (*a == 0.0) == (*b == 0.0)) {
        let to = from + run.len();
        if run.first() == Some(&0.0) {
            lay_straight(&mut off, from..to);
            (from..to).for_each(|k| angle[k] = smooth[k] + off[k]);
        }
        from = to;
    }
}

/// What the simulation of a finding adds to the angle at each sample, radians, and the positions hold yet: real motion, and the lag of a
/// low pass that was seen in the radius.
fn added_by<'a>(finding: &'a Finding, context: &'a Context) -> impl Fn(usize) -> f64 + 'a {
    let cause = finding.cause;
    let [amplitude, phase, frequency, order, tau] =
        ["amplitude", "phase", "frequency_hz", "order", "tau_s"]
            .map(|name| finding.parameter(name).unwrap_or(0.0));
    move |k| {
        let angle = match (cause, &context.phi) {
            (Cause::Vibration, _) => TAU * frequency * context.time[k],
            (Cause::Cogging, Some(phi)) => order * phi[k],
            // Against a reference it was seen along the circle, and is off the positions.
            (Cause::CommonBandwidth, _) if context.against_reference.is_none() => {
                return -(tau * context.speed[k]).atan();
            }
            _ => return 0.0,
        };
        amplitude * (angle + phase).cos()
    }
}

/// Samples in a row, each a usual time after the one before: the first's number, its time in seconds, the last's number.
struct Run {
    first: usize,
    time: f64,
    last: usize,
}

/// The recording without its pauses.
fn runs(context: &Context) -> Vec<Run> {
    let (time, rate) = (&context.time, context.rate);
    let mut runs = vec![Run {
        first: 0,
        time: 0.0,
        last: 0,
    }];
    for k in 1..time.len() {
        let pause = (time[k] - time[k - 1]) * rate > GAP;
        match runs.last_mut() {
            Some(run) if pause => {
                // Times that scatter never run back.
                let next = run.time + (k - run.first) as f64 / rate;
                runs.push(Run {
                    first: k,
                    time: time[k].max(next),
                    last: k,
                });
            }
            Some(run) => run.last = k,
            None => {}
        }
    }
    runs
}

/// The motion of a recording without what findings of motion are: position and speed at its start, at its end, at the knots of its
/// spline between them, and on either side of a pause. The cubics between these rows are the spline.
#[must_use]
pub fn motion_csv(found: &Diagnosis, recording: &Recording) -> String {
    let context = &found.context;
    let motion = found.motion.smooth(context, &found.findings);
    let (spline, rate) = (&motion.spline, context.rate);
    let start = recording.time_s.first().copied().unwrap_or_default();
    let mut out = String::from("time_s,position_periods,speed_periods_per_s\n");
    let mut written = f64::NEG_INFINITY;
    for run in runs(context) {
        let [first, last] = [run.first, run.last].map(|k| k as f64);
        let inside = spline.knots().filter(|knot| *knot > first && *knot < last);
        let end = (run.last > run.first).then_some(last);
        for knot in std::iter::once(first).chain(inside).chain(end) {
            let time = start + (run.time + (knot - first) / rate);
            // A knot beside the end may be no later, as such a number says it.
            if time <= written {
                continue;
            }
            written = time;
            // Of a clock that counts from long ago, this time may be rounded: the position is that of the time that is written.
            let at = first + (time - start - run.time) * rate;
            let (angle, speed) = spline.between(&motion.coefficients, at);
            let _ = writeln!(out, "{time},{},{}", angle / TAU, speed * rate / TAU);
        }
    }
    out
}
