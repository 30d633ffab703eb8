//! The experiment that tells two causes apart: the first of a list to which they answer differently.

use crate::finding::Cause;

/// An experiment, and what each cause does in it; causes that do not answer stand in none.
struct Experiment {
    /// What to do.
    setup: &'static str,
    /// Causes with the same answer, and the answer.
    answers: &'static [(&'static [Cause], &'static str)],
}

impl Experiment {
    fn answer(&self, cause: Cause) -> Option<&'static str> {
        let own = self
            .answers
            .iter()
            .find(|(causes, _)| causes.contains(&cause));
        own.map(|(_, answer)| *answer)
    }
}

/// Errors that repeat with the scale period.
const PERIOD: &[Cause] = &[
    Cause::EvenNonlinearity,
    Cause::OddNonlinearity,
    Cause::SpatialHarmonic,
    Cause::Saturation,
    Cause::AdcNonlinearity,
];
const REVOLUTION: &[Cause] = &[Cause::Runout, Cause::Contamination, Cause::GraduationError];
const SPEED: &[Cause] = &[
    Cause::ChannelSkew,
    Cause::BandwidthMismatch,
    Cause::CommonBandwidth,
    Cause::Latency,
    Cause::DelayedCrosstalk,
    Cause::Hysteresis,
    Cause::AcCoupling,
];
const LINES: &[Cause] = &[Cause::Interference, Cause::AmplitudeRipple];
const DRIFTS: &[Cause] = &[Cause::OffsetDrift, Cause::GainDrift];
const MOTION: &[Cause] = &[Cause::Vibration, Cause::Cogging];

const ALONE: &str = "is in this sensor alone";
const KEEPS: &str = "keeps its size and its place on the scale";
const STAYS: &str = "stays as it is";

/// The clearest first.
const EXPERIMENTS: &[Experiment] = &[
    Experiment {
        setup: "Compare with a second sensor on the same axis",
        answers: &[
            (MOTION, "is in both sensors"),
            (PERIOD, ALONE),
            (REVOLUTION, ALONE),
            (SPEED, ALONE),
            (LINES, ALONE),
            (DRIFTS, ALONE),
        ],
    },
    Experiment {
        setup: "Clean the scale and record again",
        answers: &[
            (&[Cause::Contamination], "is gone, or elsewhere"),
            (REVOLUTION, STAYS),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Start the recording long after power-up, and stop the motion a few times",
        answers: &[
            (
                &[Cause::AcCoupling],
                "makes the offsets decay after each stop, and none from the start on",
            ),
            (DRIFTS, "does not follow the stops"),
        ],
    },
    Experiment {
        setup: "Reverse the motion several times",
        answers: &[
            (&[Cause::Hysteresis], "turns over at each reversal"),
            (DRIFTS, "goes on through the reversals"),
        ],
    },
    Experiment {
        setup: "Let the scale stand still at several angles",
        answers: &[
            (
                &[Cause::Interference, Cause::OffsetDrift],
                "is the same at every angle",
            ),
            (
                &[Cause::AmplitudeRipple, Cause::GainDrift],
                "is gone from a channel where its signal crosses zero",
            ),
        ],
    },
    Experiment {
        setup: "Record ten times as long",
        answers: &[
            (LINES, "stays a line of the same frequency and amplitude"),
            (
                &[Cause::FlickerNoise],
                "keeps its spectrum, which is the same in each part of the recording",
            ),
            (DRIFTS, "goes on changing, and does not repeat"),
        ],
    },
    Experiment {
        setup: "Record at a speed ten times as high",
        answers: &[
            (
                &[Cause::ChannelSkew],
                "makes ten times the phase error, at full amplitude of both channels",
            ),
            (
                &[Cause::BandwidthMismatch],
                "lowers the amplitude of one channel with the square of the speed",
            ),
            (
                &[Cause::CommonBandwidth],
                "lowers the amplitude of both channels with the square of the speed",
            ),
            (
                &[Cause::Latency],
                "makes ten times the lag, at full amplitude",
            ),
            (
                &[Cause::DelayedCrosstalk],
                "changes the gains of both channels in proportion to the speed, with its sign",
            ),
            (
                &[Cause::Hysteresis],
                "stays as large, for it depends on the direction alone",
            ),
            (&[Cause::AcCoupling], "gets smaller"),
            (LINES, "keeps its frequency"),
            (&[Cause::Vibration], "keeps its frequency"),
            (&[Cause::Cogging], "has ten times the frequency"),
            (DRIFTS, "follows time, and not the motion"),
            (PERIOD, KEEPS),
            (REVOLUTION, KEEPS),
        ],
    },
    Experiment {
        setup: "Centre the scale anew on its axis",
        answers: &[
            (&[Cause::Runout], "changes with the eccentricity"),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Exchange the scale (disc, tape or magnet) for another of its kind",
        answers: &[
            (&[Cause::GraduationError], "is another"),
            (&[Cause::Runout], STAYS),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Halve the amplitude in front of the ADC",
        answers: &[
            (
                &[Cause::EvenNonlinearity],
                "falls to a half of its share of the amplitude",
            ),
            (
                &[Cause::OddNonlinearity],
                "falls to a fourth of its share of the amplitude",
            ),
            (
                &[Cause::SpatialHarmonic],
                "keeps its share of the amplitude",
            ),
            (&[Cause::Saturation], "is gone"),
            (
                &[Cause::AdcNonlinearity],
                "stays as large at the same codes",
            ),
        ],
    },
];

/// The experiment that tells a cause from another, and what either does in it.
pub(super) fn experiment(cause: Cause, other: Cause) -> String {
    let told = EXPERIMENTS.iter().find_map(|e| {
        let (a, b) = (e.answer(cause)?, e.answer(other)?);
        (a != b).then_some((e.setup, a, b))
    });
    match told {
        Some((setup, a, b)) => {
            let (cause, other) = (cause.plain(), other.plain());
            format!("{setup}: {cause} {a}; {other} {b}.")
        }
        None => "Record several speeds, both directions and more revolutions, with a reference if there is one.".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_has_an_experiment_that_tells() {
        let causes = [PERIOD, REVOLUTION, SPEED, LINES, DRIFTS, MOTION].concat();
        assert_eq!(causes.len(), 21);
        for (i, a) in causes.iter().enumerate() {
            for b in &causes[..i] {
                let text = experiment(*a, *b);
                assert!(
                    text.contains(&a.plain()) && text.contains(&b.plain()),
                    "{a} {b}: {text}"
                );
            }
        }
    }

    #[test]
    fn slow_noise_is_told_from_a_drift_by_more_of_it() {
        let text = experiment(Cause::FlickerNoise, Cause::OffsetDrift);
        assert!(
            text.starts_with("Record ten times as long: flicker noise keeps its spectrum"),
            "{text}"
        );
    }

    #[test]
    fn a_delay_keeps_the_amplitude_and_a_low_pass_does_not() {
        let text = experiment(Cause::Latency, Cause::CommonBandwidth);
        assert!(text.starts_with("Record at a speed ten times as high: latency makes ten times the lag, at full amplitude;"));
        assert!(text.contains("square of the speed"), "{text}");
        let text = experiment(Cause::ChannelSkew, Cause::Latency);
        assert!(text.contains("phase error"), "{text}");
    }
}
