//! The experiment that tells two causes apart: the first of a list to which they answer differently.

use super::words::capital;
use crate::finding::names::plain;

/// An experiment, and what each cause does in it; causes that do not answer stand in none.
struct Experiment {
    /// What to do.
    setup: &'static str,
    /// Causes with the same answer, and the answer.
    answers: &'static [(&'static [&'static str], &'static str)],
}

impl Experiment {
    fn answer(&self, cause: &str) -> Option<&'static str> {
        let own = self
            .answers
            .iter()
            .find(|(causes, _)| causes.contains(&cause));
        own.map(|(_, answer)| *answer)
    }
}

/// Errors that repeat with the scale period.
const PERIOD: &[&str] = &[
    "even_nonlinearity",
    "odd_nonlinearity",
    "spatial_harmonic",
    "saturation",
    "adc_nonlinearity",
];
const REVOLUTION: &[&str] = &["runout", "contamination", "graduation_error"];
const SPEED: &[&str] = &[
    "channel_skew",
    "bandwidth_mismatch",
    "common_bandwidth",
    "latency",
    "delayed_crosstalk",
    "hysteresis",
    "ac_coupling",
];
const LINES: &[&str] = &["interference", "amplitude_ripple"];
const DRIFTS: &[&str] = &["offset_drift", "gain_drift"];
const MOTION: &[&str] = &["vibration", "cogging"];

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
            (&["contamination"], "is gone, or elsewhere"),
            (REVOLUTION, STAYS),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Start the recording long after power-up, and stop the motion a few times",
        answers: &[
            (
                &["ac_coupling"],
                "makes the offsets decay after each stop, and none from the start on",
            ),
            (DRIFTS, "does not follow the stops"),
        ],
    },
    Experiment {
        setup: "Reverse the motion several times",
        answers: &[
            (&["hysteresis"], "turns over at each reversal"),
            (DRIFTS, "goes on through the reversals"),
        ],
    },
    Experiment {
        setup: "Let the scale stand still at several angles",
        answers: &[
            (
                &["interference", "offset_drift"],
                "is the same at every angle",
            ),
            (
                &["amplitude_ripple", "gain_drift"],
                "is gone from a channel where its signal crosses zero",
            ),
        ],
    },
    Experiment {
        setup: "Record ten times as long",
        answers: &[
            (LINES, "stays a line of the same frequency and amplitude"),
            (DRIFTS, "goes on changing, and does not repeat"),
        ],
    },
    Experiment {
        setup: "Record at a speed ten times as high",
        answers: &[
            (
                &["channel_skew"],
                "makes ten times the phase error, at full amplitude of both channels",
            ),
            (
                &["bandwidth_mismatch"],
                "lowers the amplitude of one channel with the square of the speed",
            ),
            (
                &["common_bandwidth"],
                "lowers the amplitude of both channels with the square of the speed",
            ),
            (&["latency"], "makes ten times the lag, at full amplitude"),
            (
                &["delayed_crosstalk"],
                "changes the gains of both channels in proportion to the speed, with its sign",
            ),
            (
                &["hysteresis"],
                "stays as large, for it depends on the direction alone",
            ),
            (&["ac_coupling"], "gets smaller"),
            (LINES, "keeps its frequency"),
            (&["vibration"], "keeps its frequency"),
            (&["cogging"], "has ten times the frequency"),
            (DRIFTS, "follows time, and not the motion"),
            (PERIOD, KEEPS),
            (REVOLUTION, KEEPS),
        ],
    },
    Experiment {
        setup: "Centre the scale anew on its axis",
        answers: &[
            (&["runout"], "changes with the eccentricity"),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Exchange the scale (disc, tape or magnet) for another of its kind",
        answers: &[
            (&["graduation_error"], "is another"),
            (&["runout"], STAYS),
            (PERIOD, STAYS),
        ],
    },
    Experiment {
        setup: "Halve the amplitude in front of the ADC",
        answers: &[
            (
                &["even_nonlinearity"],
                "falls to a half of its share of the amplitude",
            ),
            (
                &["odd_nonlinearity"],
                "falls to a fourth of its share of the amplitude",
            ),
            (&["spatial_harmonic"], "keeps its share of the amplitude"),
            (&["saturation"], "is gone"),
            (&["adc_nonlinearity"], "stays as large at the same codes"),
        ],
    },
];

/// The experiment that tells a cause from another, and what either does in it.
pub(super) fn experiment(cause: &str, other: &str) -> String {
    let told = EXPERIMENTS.iter().find_map(|e| {
        let (a, b) = (e.answer(cause)?, e.answer(other)?);
        (a != b).then_some((e.setup, a, b))
    });
    match told {
        Some((setup, a, b)) => {
            let (cause, other) = (plain(cause), plain(other));
            format!("{setup}: {cause} {a}; {other} {b}.")
        }
        None => capital(
            "record several speeds, both directions and more revolutions, with a reference if there is one.",
        ),
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
                let text = experiment(a, b);
                assert!(
                    text.contains(&plain(a)) && text.contains(&plain(b)),
                    "{a} {b}: {text}"
                );
            }
        }
    }

    #[test]
    fn a_delay_keeps_the_amplitude_and_a_low_pass_does_not() {
        let text = experiment("latency", "common_bandwidth");
        assert!(text.starts_with("Record at a speed ten times as high: latency makes ten times the lag, at full amplitude;"));
        assert!(text.contains("square of the speed"), "{text}");
        let text = experiment("channel_skew", "latency");
        assert!(text.contains("phase error"), "{text}");
    }
}
