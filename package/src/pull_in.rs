//! From power-up into motion: whether the loop locks on every sensor that the design promises.

use std::fmt;

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use rayon::prelude::*;
use serde::Serialize;

use crate::progress::{Event, Progress, silent};
use crate::sensor::{Sensor, Shares};
use nonius_quantity::digits;

/// How the chip pulls in from power-up, with every promised error at either end of its range and the promised noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PullIn {
    /// Sensors: all combinations of the ends.
    pub sensors: u32,
    /// Starts with each: speeds and places in the period.
    pub starts_each: u32,
    /// Sensors on which some start did not lock, or not for good.
    pub not_locked: u32,
    /// Longest time from power-up to lock of those that did, samples.
    pub longest_samples: u64,
    /// The same in seconds.
    pub longest_s: f64,
    /// Of the sensors on which it did not lock the one with the most such starts.
    pub worst: Option<Worst>,
    /// What would make all of them lock, each simulated likewise.
    pub remedies: Vec<String>,
}

/// A sensor on which the loop does not lock.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Amplitudes of cosine and sine, of the nominal one.
    pub amplitudes: [f64; 2],
    /// Their offsets, of the nominal amplitude.
    pub offsets: [f64; 2],
    /// β, degrees.
    pub phase_error_deg: f64,
    /// Bends of the channels, of the amplitude; 0 where fewer than 8 parameters leave them out.
    pub bends: [f64; 2],
    /// Starts that did not lock.
    pub starts: u32,
    /// The first of them: speed in periods per second.
    pub speed_periods_per_s: f64,
    /// And place in the period, periods.
    pub from_periods: f64,
}

/// At the largest speed, forwards and backwards.
pub const BOTH_WAYS: [f64; 2] = [1.0, -1.0];
const PLACES: [f64; 4] = [0.0, 0.13, 0.4, 0.77];

/// A start: of which sensor, at which speed (periods per sample), from where.
#[derive(Clone, Copy)]
pub(crate) struct Start {
    pub(crate) signs: u32,
    pub(crate) speed: f64,
    pub(crate) place: f64,
}

impl PullIn {
    /// Every promised sensor locks from every start.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.not_locked == 0
    }

    /// Which sensors do not lock, in a sentence; nothing where every one does.
    #[must_use]
    pub fn missed(&self) -> Option<String> {
        let worst = self.worst.as_ref()?;
        Some(format!(
            "{} of the {} sensors at the ends of the promise do not lock from power-up into full speed, or lose the lock again; worst: {worst}",
            self.not_locked, self.sensors
        ))
    }

    /// What to change where it does not hold.
    #[must_use]
    pub fn advice(&self) -> String {
        match self.remedies.as_slice() {
            [] => {
                "no smaller promise and no lower speed was found on which every sensor locks".into()
            }
            found => format!("every sensor locks with {}", found.join(", or with ")),
        }
    }
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([cos, sin], [offset_cos, offset_sin]) = (self.amplitudes, self.offsets);
        write!(
            f,
            "amplitudes of {cos:.3} and {sin:.3}, offsets of {offset_cos:+.3} and {offset_sin:+.3}, phase error of {:+.1}°",
            self.phase_error_deg
        )?;
        if self.bends != [0.0; 2] {
            write!(
                f,
                ", bends of {:+.3} and {:+.3}",
                self.bends[0], self.bends[1]
            )?;
        }
        write!(f, ", at {} periods/s", digits(self.speed_periods_per_s, 3))
    }
}

/// Starts the chip with every promised sensor, at each of these parts of the largest speed ([`BOTH_WAYS`], and others for a test).
#[must_use]
pub fn pull_in(design: &Design, parts: &[f64]) -> PullIn {
    pull_in_followed(design, parts, &silent)
}

/// The same; `progress` hears of every start.
#[must_use]
pub fn pull_in_followed(design: &Design, parts: &[f64], progress: Progress) -> PullIn {
    let spec = &design.spec;
    let rate = spec.adc.sample_rate_hz;
    let sensors = sensors(spec);
    let each: Vec<Start> = (0..sensors)
        .flat_map(|signs| starts(design, signs, parts))
        .collect();
    progress(Event::Starting { starts: each.len() });
    let found: Vec<Option<u64>> = each
        .par_iter()
        .map(|start| {
            let found = samples_to_lock(design, start);
            progress(Event::Started);
            found
        })
        .collect();
    let starts_each = each.len() / sensors as usize;
    let (mut not_locked, mut worst): (u32, Option<Worst>) = (0, None);
    for (starts, found) in each.chunks(starts_each).zip(found.chunks(starts_each)) {
        let count = found.iter().filter(|found| found.is_none()).count() as u32;
        let first = starts.iter().zip(found).find(|(_, found)| found.is_none());
        if let Some((first, _)) = first {
            not_locked += 1;
            if worst.as_ref().is_none_or(|w| w.starts < count) {
                worst = Some(Worst::of(spec, first, count));
            }
        }
    }
    let longest_samples = found.iter().flatten().copied().max().unwrap_or(0);
    PullIn {
        sensors,
        starts_each: starts_each as u32,
        not_locked,
        longest_samples,
        longest_s: longest_samples as f64 / rate,
        remedies: match not_locked {
            0 => vec![],
            _ => {
                progress(Event::Remedying);
                remedies(spec, parts)
            }
        },
        worst,
    }
}

/// Amplitudes, offsets and the phase error at either end; with 8 and 9 parameters the bends too.
pub(crate) fn sensors(spec: &Spec) -> u32 {
    if spec.calibration.has_bend() {
        1 << 7
    } else {
        1 << 5
    }
}

fn starts(design: &Design, signs: u32, parts: &[f64]) -> impl Iterator<Item = Start> {
    let spec = &design.spec;
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    // Where acquisition takes long it passes all places anyway.
    let places = if patience(design) > 10_000 { 2 } else { 4 };
    parts.iter().flat_map(move |part| {
        PLACES[..places].iter().map(move |&place| Start {
            signs,
            speed: part * top,
            place,
        })
    })
}

/// Samples in which the lock level fills; in each further gear it fills from half.
fn fill(design: &Design) -> u64 {
    design.constants.lock_full.value() as u64
}

/// Samples within which it must lock: twice what acquisition takes at least, and some to begin with.
fn patience(design: &Design) -> u64 {
    1000 + fill(design) * (2 + u64::from(design.acquisition.gears))
}

/// Each bit turns one of the errors round.
pub(crate) fn shares(spec: &Spec, signs: u32) -> Shares {
    let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
    Shares {
        gains: [sign(0), sign(1)],
        offsets: [sign(2), sign(3)],
        phase: sign(4),
        bends: if spec.calibration.has_bend() {
            [sign(5), sign(6)]
        } else {
            [0.0; 2]
        },
    }
}

/// Samples from power-up to a lock that stays, or `None`.
fn samples_to_lock(design: &Design, start: &Start) -> Option<u64> {
    let spec = &design.spec;
    let shares = shares(spec, start.signs);
    // Neighbouring seeds begin alike.
    let seed = u64::from(start.signs + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut sensor = Sensor::of(spec, &shares, spec.sensor.amplitude, seed);
    let mut chip = Chip::bit_true(design);
    let patience = patience(design);
    // Until a lock that would not hold is lost: some periods, or where the loop follows them, its own settling time.
    let periods = 4.0 / start.speed.abs().max(f64::MIN_POSITIVE);
    let stays = fill(design) + periods.min(20.0 / design.tracking.omega) as u64;
    let mut locked = None;
    for k in 0..patience + stays {
        let at = start.place + start.speed * k as f64;
        let sample = sensor.sample(at, start.speed);
        chip.step_codes(sample.cos, sample.sin, false, true);
        if chip.state.lock_lost {
            return None;
        }
        match locked {
            None if chip.state.locked => locked = Some(k + 1),
            None if k >= patience => return None,
            Some(since) if k >= since + stays => return locked,
            _ => {}
        }
    }
    locked
}

impl Worst {
    pub(crate) fn of(spec: &Spec, start: &Start, count: u32) -> Self {
        let (s, shares) = (&spec.sensor, shares(spec, start.signs));
        Self {
            amplitudes: shares
                .gains
                .map(|share| 1.0 + share * s.amplitude_tolerance),
            offsets: shares.offsets.map(|share| share * s.offset_max),
            phase_error_deg: shares.phase * s.phase_error_max_deg,
            bends: shares.bends.map(|share| share * s.bend_max),
            starts: count,
            speed_periods_per_s: start.speed * spec.adc.sample_rate_hz,
            from_periods: start.place,
        }
    }
}

/// The same design with so much of every error that [`sensors`] vary, and what it says of them.
fn less(spec: &Spec, tenth: f64) -> (Spec, String) {
    let mut less = spec.clone();
    let bent = spec.calibration.has_bend() && spec.sensor.bend_max > 0.0;
    let s = &mut less.sensor;
    let mut errors = vec![
        ("amplitude_tolerance", &mut s.amplitude_tolerance),
        ("offset_max", &mut s.offset_max),
        ("phase_error_max_deg", &mut s.phase_error_max_deg),
    ];
    if bent {
        errors.push(("bend_max", &mut s.bend_max));
    }
    let said = errors.into_iter().map(|(key, error)| {
        *error = digits(*error * tenth, 3);
        format!("sensor.{key} = {error}")
    });
    let said: Vec<String> = said.collect();
    let said = match said.split_last() {
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    };
    (less, said)
}

/// The largest promise and the largest speed, by tenths, of which every sensor locks.
fn remedies(spec: &Spec, parts: &[f64]) -> Vec<String> {
    let tenths = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];
    let slower = |tenth: f64| {
        let mut slower = spec.clone();
        let top = &mut slower.sensor.speed_max_periods_per_s;
        *top = digits(*top * tenth, 3);
        let text = format!("sensor.speed_max_periods_per_s = {}", *top);
        (slower, text)
    };
    let first = |change: &dyn Fn(f64) -> (Spec, String)| {
        let mut changed = tenths.iter().map(|&tenth| change(tenth));
        changed.find(|(spec, _)| locks(spec, parts)).map(|it| it.1)
    };
    let found = [first(&|tenth| less(spec, tenth)), first(&slower)];
    found.into_iter().flatten().collect()
}

/// Whether every sensor that this promises locks; the first that does not ends the search.
fn locks(spec: &Spec, parts: &[f64]) -> bool {
    Design::new(spec).is_ok_and(|design| {
        (0..sensors(spec)).into_par_iter().all(|signs| {
            starts(&design, signs, parts).all(|start| samples_to_lock(&design, &start).is_some())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A promise is made less in every error that the sensors have: in bends where they are calibrated and promised.
    #[test]
    fn bends_are_promised_less_where_there_are_any() {
        let text = include_str!("../../designs/optical.toml");
        let mut spec = Spec::from_toml(text, "optical.toml").expect("a shipped design");
        for (parameters, bend, left, said) in [
            (5, 0.05, 0.05, None),
            (8, 0.05, 0.02, Some(" and sensor.bend_max = 0.02")),
            (9, 0.0, 0.0, None),
        ] {
            (spec.calibration.parameters, spec.sensor.bend_max) = (parameters, bend);
            let (less, all) = less(&spec, 0.4);
            assert_eq!(less.sensor.bend_max, left, "{parameters}");
            assert_eq!(less.sensor.offset_max, 0.04);
            let end = said.unwrap_or(" and sensor.phase_error_max_deg = 2");
            assert!(all.ends_with(end), "{parameters}: {all}");
        }
    }
}
