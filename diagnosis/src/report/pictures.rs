//! The pictures that show a finding: which ones depends on where its cause lives.

use nonius_fourier::Complex;
use nonius_plot::{Mark, Plot};
use nonius_recording::Recording;

use super::binned::{Against, Along, Row, Seen};
use super::spectra::Signal;
use super::{noisy, raw};
use crate::context::Context;
use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding, Parameter};

/// What a cause is shown against, and along what.
fn ways(finding: &Finding, context: &Context) -> Vec<(Against, Along)> {
    use Against::{Angle, Code, Line, Revolution, Signal, Speed, Time};
    use Along::{Circle, Gain, Motion, Offset, Phase, Radius};
    let number = |name: &str| finding.parameter(name);
    let of_channels = |against: fn(usize) -> Against, along: fn(usize) -> Along| {
        vec![(against(0), along(0)), (against(1), along(1))]
    };
    let with = |against: Against, along: fn(usize) -> Along| {
        vec![(against, along(0)), (against, along(1))]
    };
    let hertz = number("frequency_hz").unwrap_or(0.0);
    let motion = if context.against_reference.is_some() {
        Motion
    } else {
        Circle
    };
    match finding.cause {
        Cause::EvenNonlinearity | Cause::OddNonlinearity | Cause::Saturation => {
            of_channels(Signal, Offset)
        }
        Cause::SpatialHarmonic => vec![(Angle, Radius), (Angle, Circle)],
        Cause::AdcNonlinearity => {
            let bit = number("bit").unwrap_or(0.0) as u32;
            vec![(Code(0, bit), Offset(0)), (Code(1, bit), Offset(1))]
        }
        Cause::ChannelSkew => vec![(Speed, Phase(1))],
        Cause::BandwidthMismatch => {
            let which = usize::from(number("tau_sin_s").is_some());
            vec![(Speed, Phase(which)), (Speed, Gain(which))]
        }
        Cause::CommonBandwidth => vec![(Speed, Radius)],
        Cause::Latency => vec![(Speed, Circle)],
        Cause::DelayedCrosstalk => with(Speed, Gain),
        Cause::Hysteresis => with(Speed, Offset),
        Cause::AcCoupling | Cause::OffsetDrift => with(Time, Offset),
        Cause::GainDrift => with(Time, Gain),
        Cause::Interference => with(Line(hertz), Offset),
        Cause::AmplitudeRipple => vec![(Line(hertz), Radius)],
        Cause::Vibration => vec![(Line(hertz), motion)],
        Cause::Runout | Cause::Contamination => vec![(Revolution, Radius)],
        Cause::GraduationError => vec![(Revolution, Circle)],
        Cause::Cogging => vec![(Revolution, motion)],
        // In the data themselves, or random: they have pictures of their own.
        Cause::StuckBit
        | Cause::CoarseQuantisation
        | Cause::Glitches
        | Cause::DroppedSamples
        | Cause::RepeatedSamples
        | Cause::ClockJitter
        | Cause::FlickerNoise
        | Cause::AmplitudeNoise => vec![],
        // No findings.
        Cause::Offset
        | Cause::GainMismatch
        | Cause::QuadratureError
        | Cause::WhiteNoise
        | Cause::AccelerationGain => vec![],
    }
}

/// The pictures of a finding.
pub(super) fn of(finding: &Finding, found: &Diagnosis, recording: &Recording) -> Vec<Plot> {
    let context = &found.context;
    let Some(effect) = &finding.effect else {
        return raw::of(finding, found, recording)
            .into_iter()
            .chain(noisy::of(finding, found))
            .collect();
    };
    let (radial, tangential) = &found.residuals[1];
    let at = |values: &[f32], k: usize| values.get(k).map_or(0.0, |v| f64::from(*v));
    let left = |k: usize| -> Row {
        let motion = found.left_motion.as_ref().map_or(0.0, |m| m[k]);
        [radial[k], tangential[k], motion]
    };
    let effect = |k: usize| -> Row {
        [
            at(&effect.radial, k),
            at(&effect.tangential, k),
            at(&effect.motion, k),
        ]
    };
    let seen = Seen {
        context,
        left: &left,
        effect: &effect,
    };
    let mut plots: Vec<Plot> = ways(finding, context)
        .into_iter()
        .filter_map(|(against, along)| seen.plot(&title(against, along), against, along))
        .collect();
    if let Some(hertz) = finding.parameter("frequency_hz") {
        plots.extend(line(finding, &seen, hertz));
    }
    plots
}

/// What is shown against what.
pub(super) fn title(against: Against, along: Along) -> String {
    let what = match along {
        Along::Radius => "Radius",
        Along::Circle => "Angle error",
        Along::Motion => "Motion",
        Along::Offset(0) => "Error of cos",
        Along::Offset(_) => "Error of sin",
        Along::Gain(0) => "Gain of cos",
        Along::Gain(_) => "Gain of sin",
        Along::Phase(0) => "Phase of cos",
        Along::Phase(_) => "Phase of sin",
    };
    let over = match against {
        Against::Angle => "the angle of the scale period",
        Against::Revolution => "the angle of the revolution",
        Against::Time => "time",
        Against::Speed => "speed",
        Against::Signal(_) => "the signal",
        Against::Code(..) => "the ADC code",
        Against::Line(_) => "the phase of the line",
    };
    format!("{what} against {over}")
}

/// The frequency of a line as it stands beside a mark.
pub(super) fn hertz_text(finding: &Finding) -> String {
    let own = finding.parameters.iter().find(|p| p.name == "frequency_hz");
    own.map_or_else(String::new, Parameter::brief)
}

/// The spectrum close to a line.
fn line(finding: &Finding, seen: &Seen, hertz: f64) -> Option<Plot> {
    let context = seen.context;
    let added = finding.cause == Cause::Interference;
    let value = |row: Row, k: usize| {
        if added {
            // In the frame of the channels.
            let (cos, sin) = (context.cos[k], context.sin[k]);
            return Complex::new(row[0] * cos - row[1] * sin, row[0] * sin + row[1] * cos);
        }
        let along = match finding.cause {
            Cause::AmplitudeRipple => row[0],
            _ if context.against_reference.is_some() => row[2],
            _ => row[1],
        };
        Complex::new(along, 0.0)
    };
    let after = |k: usize| value((seen.left)(k), k);
    let before = |k: usize| after(k) + value((seen.effect)(k), k);
    let (label, unit) = match finding.cause {
        Cause::Vibration => ("motion, mrad (electrical)", 1000.0),
        Cause::AmplitudeRipple => ("radius, % of the amplitude", 100.0),
        _ => ("both channels, % of the amplitude", 100.0),
    };
    let signal = Signal {
        context,
        label,
        unit,
    };
    let mark = Mark {
        x: hertz,
        text: hertz_text(finding),
    };
    let title = "Spectrum close to the line";
    signal.frequency(title, &before, &after, Some(hertz), vec![mark])
}
