//! The direct simulation, and what is asked of a diagnosis.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, ContextError, Diagnosis, Finding, diagnose};
use nonius_recording::{Overrides, Recording};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 20_000;
/// Enough for what is large to be found in a part of them first.
const LONG: usize = 250_000;
const RATE: f64 = 50e3;
pub(crate) const NOISE: f64 = 0.001;
/// Scale periods of a revolution.
pub(crate) const PERIODS: f64 = 8.0;
/// One code of the ADC: 14 bits from −1 to 1.
pub(crate) const LSB: f64 = 2.0 / 16_384.0;
/// Steps of a low pass between two samples.
const FINE: usize = 24;
/// Samples before the first, in which a low pass settles.
const SETTLING: i64 = 200;

/// What happens to angle, channels, reference and samples.
pub(crate) struct Case {
    /// Change of the angle that is real motion, radians.
    pub(crate) motion: fn(t: f64, alpha: f64) -> f64,
    /// Angles that the two channels see, radians, given angle and angular speed.
    pub(crate) seen: fn(alpha: f64, speed: f64) -> (f64, f64),
    /// Channels in amplitudes, given themselves, time, angle and speed.
    pub(crate) channels: fn(c: f64, s: f64, t: f64, alpha: f64, speed: f64) -> (f64, f64),
    /// Time constants of a low pass in each channel, seconds; integrated between the samples.
    pub(crate) tau: [f64; 2],
    /// Noise of a sample: of the amplitude, given channel, slope and speed, and two normal numbers.
    pub(crate) noise: fn(u: f64, slope: f64, speed: f64, normal: [f64; 2]) -> f64,
    pub(crate) reference: bool,
    pub(crate) revolution: bool,
    /// °C after a time in seconds, where there is such a column.
    pub(crate) temperature: Option<fn(t: f64) -> f64>,
}

pub(crate) const PLAIN: Case = Case {
    motion: |_, _| 0.0,
    seen: |alpha, _| (alpha, alpha),
    channels: |c, s, _, _, _| (c, s),
    tau: [0.0; 2],
    noise: |_, _, _, normal| NOISE * normal[0],
    reference: false,
    revolution: false,
    temperature: None,
};

/// Periods per revolution are known.
pub(crate) const REVOLVING: Case = Case {
    revolution: true,
    ..PLAIN
};

/// How the scale moves, to and fro and on, and the five parameters.
struct Drive {
    swing: f64,
    turns: f64,
    start: f64,
    run: f64,
    beta: f64,
    amplitude: [f64; 2],
    offset: [f64; 2],
}

const LENGTH: f64 = SAMPLES as f64 / RATE;

impl Drive {
    fn drawn(random: &mut StdRng) -> Self {
        Self {
            swing: random.random_range(8.0..25.0) * TAU,
            turns: TAU * random.random_range(1.2..3.0) / LENGTH,
            start: random.random_range(0.0..6.0),
            run: random.random_range(2.0..10.0) * TAU / LENGTH,
            beta: random.random_range(-0.07..0.07),
            amplitude: [0.0; 2].map(|_| random.random_range(0.7..0.9)),
            offset: [0.0; 2].map(|_| random.random_range(-0.05..0.05)),
        }
    }

    /// Up to 3.4e3 rad/s.
    fn known() -> Self {
        Self {
            swing: 14.0 * TAU,
            turns: TAU * 2.2 / LENGTH,
            start: 0.7,
            run: 6.0 * TAU / LENGTH,
            beta: 0.04,
            amplitude: [0.6, 0.55],
            offset: [0.02, -0.03],
        }
    }

    /// Angle and angular speed.
    fn at(&self, t: f64) -> (f64, f64) {
        let phase = self.turns * t + self.start;
        (
            self.swing * phase.sin() + self.run * t,
            self.swing * self.turns * phase.cos() + self.run,
        )
    }
}

/// What the channels have at a moment.
struct Moment {
    channels: [f64; 2],
    slopes: [f64; 2],
    alpha: f64,
    speed: f64,
}

fn moment(case: &Case, drive: &Drive, t: f64) -> Moment {
    let (smooth, speed) = drive.at(t);
    let alpha = smooth + (case.motion)(t, smooth);
    let (at_c, at_s) = (case.seen)(alpha, speed);
    let (c, s) = (case.channels)(at_c.cos(), (at_s - drive.beta).sin(), t, alpha, speed);
    Moment {
        channels: [c, s],
        slopes: [-at_c.sin(), (at_s - drive.beta).cos()],
        alpha,
        speed,
    }
}

/// Time, cos, sin, reference.
pub(crate) type Rows = Vec<[f64; 4]>;

fn simulated(case: &Case, drive: &Drive, samples: usize, random: &mut StdRng) -> Rows {
    let mut normal = || -> f64 { StandardNormal.sample(random) };
    let filters = case.tau.iter().any(|tau| *tau > 0.0);
    let first = if filters { -SETTLING } else { 0 };
    let mut filtered = moment(case, drive, first as f64 / RATE).channels;
    let step = 1.0 / RATE / FINE as f64;
    let mut rows = vec![];
    for k in first..samples as i64 {
        let t = k as f64 / RATE;
        let now = moment(case, drive, t);
        if filters {
            for i in 0..FINE {
                // The middle of each step: second order in it.
                let inside = moment(case, drive, t - (FINE - i) as f64 * step + 0.5 * step);
                let inputs = inside.channels.iter().zip(case.tau);
                for (y, (u, tau)) in filtered.iter_mut().zip(inputs) {
                    *y = u + (*y - u) * (-step / tau).exp();
                }
            }
        }
        if k < 0 {
            continue;
        }
        let [c, s] = [0, 1].map(|i| {
            let y = if case.tau[i] > 0.0 {
                filtered[i]
            } else {
                now.channels[i]
            };
            let noise = (case.noise)(
                now.channels[i],
                now.slopes[i],
                now.speed,
                [normal(), normal()],
            );
            let volts = drive.amplitude[i] * (y + noise) + drive.offset[i];
            (volts / LSB).round() * LSB
        });
        rows.push([t, c, s, 1.0 - now.alpha]);
    }
    rows
}

fn recording(case: &Case, rows: &Rows) -> Recording {
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\n");
    if case.revolution {
        text += &format!("# periods_per_revolution: {PERIODS}\n");
    }
    text += "time_s,cos,sin";
    if case.reference {
        text += ",reference_rad";
    }
    if case.temperature.is_some() {
        text += ",temperature_c";
    }
    text += "\n";
    for [t, c, s, r] in rows {
        text += &format!("{t:.7},{c},{s}");
        if case.reference {
            text += &format!(",{r:.9}");
        }
        if let Some(temperature) = case.temperature {
            text += &format!(",{:.3}", temperature(*t));
        }
        text += "\n";
    }
    Recording::read_from(text.as_bytes(), "test", &Overrides::default())
        .expect("a recording that can be read")
}

/// A long recording, motion and parameters known.
pub(crate) fn long(case: &Case) -> Diagnosis {
    let mut random = StdRng::seed_from_u64(13);
    of_true_rows(case, &simulated(case, &Drive::known(), LONG, &mut random))
}

/// A recording of that many samples, motion and parameters known; the faster, the shorter it is.
pub(crate) fn diagnosed_of(case: &Case, samples: usize) -> Result<Diagnosis, ContextError> {
    let mut random = StdRng::seed_from_u64(17);
    let share = (SAMPLES as f64 / samples as f64).min(20.0);
    let drive = Drive {
        turns: Drive::known().turns * share,
        ..Drive::known()
    };
    diagnose(&recording(
        case,
        &simulated(case, &drive, samples, &mut random),
    ))
}

/// A recording of a part of a period, one way, and the true offset of the sine and amplitude of the cosine.
pub(crate) fn arc(periods: f64, seed: u64) -> (Diagnosis, [f64; 2]) {
    let known = Drive::known();
    (
        evenly(&PLAIN, periods, seed),
        [known.offset[1], known.amplitude[0]],
    )
}

/// A recording of so many periods, one way at a speed that does not change.
pub(crate) fn evenly(case: &Case, periods: f64, seed: u64) -> Diagnosis {
    evenly_followed(case, periods, seed).0
}

/// The same, and how far the positions are off, radians rms.
pub(crate) fn evenly_followed(case: &Case, periods: f64, seed: u64) -> (Diagnosis, f64) {
    let mut random = StdRng::seed_from_u64(seed);
    let drive = Drive {
        swing: 0.0,
        run: periods * TAU / LENGTH,
        ..Drive::known()
    };
    let rows = simulated(case, &drive, SAMPLES, &mut random);
    let found = of_true_rows(case, &rows);
    let off = farthest(&found, &rows).1;
    (found, off)
}

/// How far the positions are off what the axis did, but for where they count from: the most, and rms, radians.
pub(crate) fn farthest(found: &Diagnosis, rows: &Rows) -> (f64, f64) {
    let pairs = found.positions.iter().zip(rows);
    let off: Vec<f64> = pairs.map(|(p, [.., r])| TAU * p - (1.0 - r)).collect();
    let n = off.len() as f64;
    let mean = off.iter().sum::<f64>() / n;
    let most = off
        .iter()
        .fold(0.0, |most: f64, o| most.max((o - mean).abs()));
    let square = off.iter().map(|o| (o - mean).powi(2)).sum::<f64>();
    (most, (square / n).sqrt())
}

fn of_rows(case: &Case, rows: &Rows) -> Diagnosis {
    let found = diagnose(&recording(case, rows)).expect("signals that draw an ellipse");
    crate::words::well_said(&found);
    found
}

/// The same of rows whose reference is the simulated axis.
fn of_true_rows(case: &Case, rows: &Rows) -> Diagnosis {
    let found = of_rows(case, rows);
    if let Some(claimed) = found.extended.position_error_rms_rad {
        follows_as_claimed(&found, rows, claimed);
    }
    found
}

/// The positions are off the reference by what the model is said to leave there.
fn follows_as_claimed(found: &Diagnosis, rows: &Rows, claimed: f64) {
    let (_, off) = farthest(found, rows);
    let what = names(found);
    assert!(
        off < 1.1 * claimed + 1e-5,
        "{off}, claimed {claimed}: {what:?}"
    );
}

pub(crate) fn names(found: &Diagnosis) -> Vec<Cause> {
    found.findings.iter().map(|f| f.cause).collect()
}

/// Motion and parameters drawn by a seed.
pub(crate) fn diagnosed(case: &Case, seed: u64) -> Diagnosis {
    let mut random = StdRng::seed_from_u64(seed);
    let drive = Drive::drawn(&mut random);
    of_true_rows(case, &simulated(case, &drive, SAMPLES, &mut random))
}

/// Nothing is named and nothing is left unexplained.
pub(crate) fn finds_nothing(case: &Case, seed: u64) {
    let found = diagnosed(case, seed);
    assert!(names(&found).is_empty(), "{seed}: {:?}", names(&found));
    let left = found.unexplained;
    assert!(!left.significant, "{seed}: {}", left.signature);
}

/// The only finding is the cause.
pub(crate) fn finds(name: Cause, case: &Case) -> Diagnosis {
    let found = diagnosed(case, 7);
    is_only(&found, name);
    found
}

/// The only finding is a cause that the other may be as well.
pub(crate) fn finds_beside(other: Cause, name: Cause, case: &Case) -> Diagnosis {
    let found = finds(name, case);
    assert_eq!(found.findings[0].confounded_with, [other]);
    found
}

fn is_only(found: &Diagnosis, name: Cause) {
    let left = &found.unexplained.signature;
    assert_eq!(names(found), [name], "{left}");
    let first = &found.findings[0];
    assert!(first.p_value < 1e-3 && !first.evidence.is_empty());
}

/// An effect a hundred times what can be seen, and more: what second order leaves of it is above the noise and must not be
/// given another name. Nothing but the cause is named, nothing is left unexplained, and the residue is the noise.
pub(crate) fn alone(name: Cause, case: &Case) -> Diagnosis {
    let mut random = StdRng::seed_from_u64(11);
    let found = of_true_rows(
        case,
        &simulated(case, &Drive::known(), SAMPLES, &mut random),
    );
    let left = &found.unexplained;
    assert_eq!(names(&found), [name], "{name}: {}", left.signature);
    assert!(!left.significant, "{name}: {}", left.signature);
    let rms = found.extended.residual_rms;
    let before = found.simulation.residual_rms;
    assert!(rms < 1.1 * NOISE, "{name}: residual {rms}, before {before}");
    found
}

/// A plain recording that is `damaged` shows the cause of that name and nothing else, and keeps its length.
pub(crate) fn shows(name: Cause, damage: impl Fn(&mut Rows)) {
    shows_in(&PLAIN, name, damage);
}

/// The same of any recording.
pub(crate) fn shows_in(case: &Case, name: Cause, damage: impl Fn(&mut Rows)) {
    let found = damaged(case, damage);
    assert_eq!(names(&found), [name], "{}", found.unexplained.signature);
}

/// What is found in a recording that is `damaged`; it keeps its length.
pub(crate) fn damaged(case: &Case, damage: impl FnOnce(&mut Rows)) -> Diagnosis {
    let mut random = StdRng::seed_from_u64(3);
    let drive = Drive::drawn(&mut random);
    let mut rows = simulated(case, &drive, SAMPLES, &mut random);
    damage(&mut rows);
    let found = of_rows(case, &rows);
    assert_eq!(found.positions.len(), rows.len());
    found
}

/// Standard error of a parameter of a finding, which is within four of them of what it truly is.
fn off(of: &Finding, parameter: &str, value: f64) -> f64 {
    let p = of.parameters.iter().find(|p| p.name == parameter);
    let p = p.expect("a parameter of that name");
    let off = (p.value - value).abs();
    assert!(
        off < 4.0 * p.std_error + 1e-12,
        "{parameter} {} +/- {}, true {value}",
        p.value,
        p.std_error
    );
    p.std_error
}

/// A parameter of a cause is within four standard errors of what it truly is.
pub(crate) fn of_cause(found: &Diagnosis, cause: Cause, parameter: &str, value: f64) {
    let own = found.findings.iter().find(|f| f.cause == cause);
    off(own.expect("the cause is found"), parameter, value);
}

/// A parameter of the first finding is within four standard errors of what it truly is.
pub(crate) fn within_errors(found: &Diagnosis, parameter: &str, value: f64) {
    off(&found.findings[0], parameter, value);
}

/// The same, and the standard error says something.
pub(crate) fn near(found: &Diagnosis, parameter: &str, value: f64) {
    let error = off(&found.findings[0], parameter, value);
    assert!(error < 0.3 * value.abs(), "{parameter} +/- {error}");
}
