//! Sentences of findings, what is not explained, and what a recording cannot show.

use nonius_diagnosis::{Cause, Diagnosis, unseen};

use crate::harness::{Case, NOISE, PLAIN, arc, damaged, diagnosed, evenly, finds};

/// Numbers have units and prefixes, nouns agree with them, causes are written as people do, and no sentence ends.
pub(crate) fn well_said(found: &Diagnosis) {
    let evidence = found.findings.iter().map(|f| &f.evidence);
    for sentence in evidence.chain(&found.unexplained.parts) {
        let words: Vec<&str> = sentence.split(' ').collect();
        let powers = |w: &&str| {
            let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit() || c == '-');
            w.split_once('e')
                .is_some_and(|(a, b)| digit(a.chars().last()) && digit(b.chars().next()))
        };
        assert!(!words.iter().any(powers), "a power of ten: {sentence}");
        let plural = words.windows(2).any(|w| w[0] == "1" && w[1].ends_with('s'));
        assert!(!plural, "one is singular: {sentence}");
        for odd in ["_", "(s)", "NaN", "inf", "  "] {
            assert!(!sentence.contains(odd), "{odd:?}: {sentence}");
        }
        assert!(
            !sentence.is_empty() && !sentence.ends_with('.'),
            "{sentence}"
        );
    }
}

fn evidence(found: &Diagnosis) -> &str {
    &found.findings[0].evidence
}

#[test]
fn a_sentence_has_units_and_the_digits_that_are_known() {
    let skew = Case {
        seen: |alpha, speed| (alpha, alpha - 1.3e-6 * speed),
        ..PLAIN
    };
    let found = finds(Cause::ChannelSkew, &skew);
    let said = evidence(&found);
    assert!(
        said.contains("grows in proportion to speed, as if cos were sampled 1."),
        "{said}"
    );
    assert!(said.ends_with(" µs after sin"), "{said}");
}

#[test]
fn one_sample_is_singular() {
    let found = damaged(&PLAIN, |rows| {
        rows.remove(4321);
    });
    assert_eq!(
        evidence(&found),
        "1 sample is missing in 1 gap of the time base, before sample 4321"
    );
    assert_eq!(found.findings[0].gain.repaired_samples, Some(1));
}

/// Both names come first where there are two.
#[test]
fn a_group_names_both() {
    let leaking = Case {
        channels: |c, s, t, _, _| (c + 0.02 * t, s - 0.015 * t),
        ..PLAIN
    };
    let found = finds(Cause::OffsetDrift, &leaking);
    let said = evidence(&found);
    assert!(
        said.starts_with("offset drift or AC coupling: the offsets drift"),
        "{said}"
    );
    let named = found.findings[0].named_evidence();
    assert!(
        named.starts_with("offset_drift or ac_coupling: the offsets drift"),
        "{named}"
    );
}

/// What noise gains shows in data that it was not fitted to: as much as in all data, but for chance.
#[test]
fn noise_gains_likelihood_of_held_out_data() {
    let noisy = Case {
        noise: |u, _, _, n| NOISE * n[0] + 3.0 * NOISE * u * n[1],
        ..PLAIN
    };
    let found = finds(Cause::AmplitudeNoise, &noisy);
    let gain = found.findings[0].gain;
    let all = gain.detection_snr.expect("an SNR").powi(2) / 2.0;
    let held_out = gain.held_out_log_likelihood_gain.expect("a gain");
    assert!((held_out / all - 1.0).abs() < 0.05, "{held_out} {all}");
}

/// An error without a name has a size and a place.
#[test]
fn what_is_not_explained_has_a_size_and_a_place() {
    // Of the phase, which no cause of the catalogue changes with time.
    let bump = Case {
        channels: |c, s, t, _, _| {
            let on = f64::from((0.1..0.2).contains(&t));
            (c, s + 0.012 * on * c)
        },
        ..PLAIN
    };
    let found = diagnosed(&bump, 5);
    let parts = found.unexplained.parts.join("\n");
    assert!(
        parts.contains("changes slowly with time, mostly between"),
        "{parts}"
    );
    assert!(parts.contains("% of the amplitude rms"), "{parts}");
}

#[test]
fn what_cannot_be_seen_is_true() {
    let said = |found: &Diagnosis| unseen(found).join("\n");
    let part = said(&arc(0.6, 3).0);
    assert!(
        part.contains("only 6") && part.contains("% of the scale period"),
        "{part}"
    );
    let turn = said(&arc(1.02, 3).0);
    assert!(turn.contains("less than two scale periods"), "{turn}");
    assert!(!turn.contains("% of the scale period"), "{turn}");
    let many = said(&arc(40.0, 3).0);
    for cause in [
        "channel_skew",
        "clock_jitter",
        "amplitude_noise",
        "hysteresis",
    ] {
        assert!(many.contains(cause), "{cause}: {many}");
    }
    assert!(!many.contains("scale periods"), "{many}");
    let moving = said(&diagnosed(&PLAIN, 1));
    assert!(
        !moving.contains("clock_jitter") && !moving.contains("hysteresis"),
        "{moving}"
    );
    let beside = Case {
        reference: true,
        ..PLAIN
    };
    let late = "a latency looks like the angle between";
    assert!(said(&evenly(&beside, 40.0, 1)).contains(late));
    assert!(!said(&diagnosed(&beside, 1)).contains(late));
}

/// What no cause is entered for is said not to be looked for, and nothing else is.
#[test]
fn what_is_not_looked_for_is_said() {
    let said = |found: &Diagnosis| unseen(found).join("\n");
    let few = said(&evenly(&PLAIN, 4.5, 3));
    assert!(few.contains("ac_coupling is not looked for"), "{few}");
    assert!(!few.contains("offset_drift"), "{few}");
    let fewer = said(&evenly(&PLAIN, 2.2, 3));
    for cause in ["ac_coupling", "offset_drift"] {
        assert!(fewer.contains(cause), "{cause}: {fewer}");
    }
    // The speed changes by half a percent: enough for one channel that is late, not for both beside a reference.
    let hardly = Case {
        motion: |t, _| 0.12 * (39.0 * t).sin(),
        ..PLAIN
    };
    let beside = Case {
        reference: true,
        ..hardly
    };
    for cause in ["common_bandwidth", "delayed_crosstalk", "channel_skew"] {
        let alone = said(&evenly(&hardly, 40.0, 3));
        assert!(!alone.contains(cause), "{cause}: {alone}");
        let late = said(&evenly(&beside, 40.0, 3));
        assert_eq!(late.contains(cause), cause != "channel_skew", "{late}");
    }
    // A hundred samples backwards, of twenty thousand.
    let jerks = Case {
        motion: |t, _| -1.88 * ((t - 0.2) / 0.002).tanh(),
        ..PLAIN
    };
    let found = evenly(&jerks, 40.0, 3);
    assert!(found.context.speed.iter().any(|v| *v < -100.0));
    assert!(said(&found).contains("hysteresis"), "{}", said(&found));
}
