//! How a sensor moved during a recording: angle, speed, distance.

use crate::ellipse::{self, EllipseFit, FitMethod};
use crate::recording::Recording;
use crate::time::{self, GAP};

/// Share of the speeds that may exceed the largest one reported.
const ABOVE: f64 = 0.001;
/// Shortest window over which speed is averaged, in samples.
const SHORTEST_WINDOW: usize = 4;
/// Longest run of samples far off the ellipse that is bridged.
const LONGEST_BRIDGE: usize = 8;

/// Motion in scale periods. Speeds beyond half a period per sample cannot be told from slower ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The corrected angle of each sample in periods, continuous; the first is within ±0.5.
    pub angle_periods: Vec<f64>,
    /// Largest magnitude of the smoothed speed in periods per second; one value in a thousand may
    /// be above.
    pub max_speed_periods_per_s: f64,
    /// The same speed in periods per sample, 0 … 0.5.
    pub max_speed_periods_per_sample: f64,
    /// Largest single step from sample to sample in periods, noise and glitches included.
    pub max_step_periods: f64,
    /// Path: to and fro both count, noise does not.
    pub periods_travelled: f64,
    /// Last angle less first, signed.
    pub periods_net: f64,
}

impl Motion {
    /// The motion that a recording shows, seen through its ellipse.
    #[must_use]
    pub fn of(recording: &Recording, fit: &EllipseFit) -> Self {
        let rho = ellipse::residuals(&fit.ellipse, &recording.cos, &recording.sin);
        let limit = match fit.method {
            FitMethod::Conic => f64::max(6.0 * fit.residual_rms, 0.3),
            FitMethod::Extremes => f64::INFINITY,
        };
        let far: Vec<bool> = rho.iter().map(|r| r.abs() > limit).collect();
        let pairs = recording.cos.iter().zip(&recording.sin);
        let raw = pairs.map(|(c, s)| fit.ellipse.angle(*c, *s));
        let angle = unwrap(raw, &far);
        let noise = fit.residual_rms / std::f64::consts::TAU;
        let interval = time::interval(&recording.time_s);
        let speed = largest_speed(&angle, &far, &recording.time_s, interval, noise);
        Self {
            max_speed_periods_per_s: speed / interval.max(f64::MIN_POSITIVE),
            max_speed_periods_per_sample: speed,
            max_step_periods: angle
                .windows(2)
                .map(|w| (w[1] - w[0]).abs())
                .fold(0.0, f64::max),
            periods_travelled: path(&angle, f64::max(0.05, 4.0 * noise)),
            periods_net: angle.last().copied().unwrap_or_default()
                - angle.first().copied().unwrap_or_default(),
            angle_periods: angle,
        }
    }
}

/// Continuous angles in turns. A sample far off the ellipse gets its own angle but leads no other
/// astray: the next one continues from the last good one.
fn unwrap(raw: impl Iterator<Item = f64>, far: &[bool]) -> Vec<f64> {
    let nearest = |angle: f64, to: f64| angle - (angle - to).round();
    let mut angles: Vec<f64> = Vec::with_capacity(far.len());
    // Last good angle, the step per sample there, and samples since.
    let (mut last, mut step, mut since) = (None, 0.0, 0usize);
    for (k, (raw, far)) in raw.zip(far).enumerate() {
        since += 1;
        let Some(anchor) = last else {
            angles.push(raw);
            if !far || k >= LONGEST_BRIDGE {
                angles.iter_mut().for_each(|a| *a = nearest(*a, raw));
                (last, since) = (Some(raw), 0);
            }
            continue;
        };
        if *far && since <= LONGEST_BRIDGE {
            angles.push(nearest(raw, anchor));
            continue;
        }
        let bridged = if since > 1 { step * since as f64 } else { 0.0 };
        let angle = nearest(raw, anchor + bridged);
        step += ((angle - anchor) / since as f64 - step) / 2.0;
        angles.push(angle);
        (last, since) = (Some(angle), 0);
    }
    angles
}

/// Largest speed in turns per sample, over windows long enough that noise adds little to it.
fn largest_speed(angle: &[f64], far: &[bool], time: &[f64], interval: f64, noise: f64) -> f64 {
    let mut window = SHORTEST_WINDOW;
    loop {
        let speed = speed_over(window, angle, far, time, interval);
        let error = 3.0 * std::f64::consts::SQRT_2 * noise / window as f64;
        let enough = error < 0.05 * speed || speed * window as f64 > 0.5;
        if enough || window * 16 > angle.len() {
            return speed;
        }
        window *= 2;
    }
}

/// Nearly the largest speed over windows of that many samples, without those that hold a gap.
fn speed_over(window: usize, angle: &[f64], far: &[bool], time: &[f64], interval: f64) -> f64 {
    let longest = (window as f64 + GAP - 1.0) * interval;
    let mut speeds: Vec<f64> = (window..angle.len())
        .map(|k| (k - window, k))
        .filter(|(j, k)| !far[*j] && !far[*k] && time[*k] - time[*j] <= longest)
        .map(|(j, k)| (angle[k] - angle[j]).abs() / window as f64)
        .collect();
    let Some(rank) = speeds
        .len()
        .checked_sub(1 + (speeds.len() as f64 * ABOVE) as usize)
    else {
        return 0.0;
    };
    *speeds.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// The way travelled, counted whenever it exceeds a play.
fn path(angle: &[f64], play: f64) -> f64 {
    let mut from = angle.first().copied().unwrap_or_default();
    let mut path = 0.0;
    for a in angle {
        if (a - from).abs() > play {
            path += (a - from).abs();
            from = *a;
        }
    }
    path + angle.last().map_or(0.0, |last| (last - from).abs())
}
