//! The time base: it goes forward, and its regular step is the sample rate.

use crate::error::ErrorKind;

/// Relative difference from which a declared rate and `time_s` are said to disagree.
const AGREE: f64 = 1e-3;
/// A step longer than this many regular ones is a gap.
pub(crate) const GAP: f64 = 1.5;

/// Checks row after row that time goes forward. A row that repeats time and sample is data.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    last: Option<(f64, f64, f64)>,
}

impl Clock {
    pub(crate) fn check(&mut self, time: f64, cos: f64, sin: f64) -> Result<(), ErrorKind> {
        if let Some((previous, ..)) = self.last
            && time < previous
        {
            let hint =
                "expected a time that goes forward: sort the rows, or give one record at a time"
                    .to_owned();
            return Err(ErrorKind::TimeBack {
                previous,
                time,
                hint,
            });
        }
        if let Some((previous, c, s)) = self.last
            && time == previous
            && (c, s) != (cos, sin)
        {
            return Err(ErrorKind::TimeStill { time });
        }
        self.last = Some((time, cos, sin));
        Ok(())
    }
}

/// The regular step in seconds: the mean of the steps that are no gaps. 0 where there is none.
pub(crate) fn interval(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time
        .windows(2)
        .map(|w| w[1] - w[0])
        .filter(|d| *d > 0.0)
        .collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let regular = steps.iter().filter(|d| **d <= GAP * median);
    let (sum, count) = regular.fold((0.0, 0.0), |(s, n), d| (s + d, n + 1.0));
    sum / f64::max(count, 1.0)
}

/// The sample rate in hertz of a time column.
pub(crate) fn rate(time: &[f64]) -> Result<f64, ErrorKind> {
    let interval = interval(time);
    if !(1e-15..1e15).contains(&interval) {
        return Err(ErrorKind::NoInterval { interval });
    }
    // A round rate comes out round in spite of the last binary digit of the times.
    let rate = 1.0 / interval;
    let round: f64 = format!("{rate:.8e}").parse().unwrap_or(rate);
    Ok(if (rate / round - 1.0).abs() < 1e-12 {
        round
    } else {
        rate
    })
}

/// What to say where the time strays from equal steps, and not because it is rounded.
pub(crate) fn uneven(time: &[f64], interval: f64) -> Option<String> {
    /// Share of the interval.
    const STRAYS: f64 = 0.02;
    /// Rounded times are no more than so many lengths apart.
    const ROUNDED: usize = 6;
    let steps = time.windows(2).map(|w| w[1] - w[0]);
    let regular: Vec<f64> = steps.filter(|s| *s > 0.0 && *s < GAP * interval).collect();
    let square: f64 = regular.iter().map(|s| (s - interval).powi(2)).sum();
    let rms = (square / regular.len().max(1) as f64).sqrt();
    // Single precision rounds late times more coarsely than early ones.
    let coarse = time.iter().fold(0.0f64, |m, t| m.max(t.abs())) * f64::from(f32::EPSILON);
    if rms.is_nan() || rms <= (STRAYS * interval).max(coarse) {
        return None;
    }
    let lengths = regular.iter().map(|s| (s / interval * 1e4).round() as i64);
    let lengths: std::collections::HashSet<i64> = lengths.collect();
    let share = 100.0 * rms / interval;
    (lengths.len() > ROUNDED).then(|| {
        format!("the time strays from equal steps by {share:.0} % of a step rms; the samples are taken as equally far apart in time")
    })
}

/// What to say where the declared rate is not that of `time_s`.
pub(crate) fn disagreement(declared: f64, from_time: f64) -> Option<String> {
    let apart = (declared / from_time - 1.0).abs();
    (apart > AGREE).then(|| {
        let [from_time, declared] = [from_time, declared].map(crate::estimate::tidy);
        format!(
            "times and sample_rate_hz disagree: {from_time} Hz and {declared} Hz; the times win"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_rounding_do_not_move_the_rate() {
        let time: Vec<f64> = (0..1000)
            .map(|k| f64::from(k + 500 * i32::from(k > 300)) / 120.0)
            .map(|t| (t * 1e3).round() / 1e3)
            .collect();
        let rate = rate(&time).expect("a rate");
        assert!((rate - 120.0).abs() < 0.02, "{rate}");
        assert_eq!(disagreement(120.0, rate), None);
        let note = disagreement(100.0, 120.0).expect("a note");
        assert_eq!(
            note,
            "times and sample_rate_hz disagree: 120 Hz and 100 Hz; the times win"
        );
    }

    #[test]
    fn times_that_stray_are_said_and_rounded_ones_are_not() {
        let even = |k: i32| f64::from(k) / 1e4;
        let rounded: Vec<f64> = (0..1000)
            .map(|k| (even(k) * 2e4 / 3.0).round() * 1.5e-4)
            .collect();
        assert_eq!(uneven(&rounded, 1e-4), None);
        let single: Vec<f64> = (0..2_500_000)
            .step_by(25)
            .map(|k| f64::from((f64::from(k) / 25e3) as f32))
            .collect();
        assert_eq!(uneven(&single, 1e-3), None);
        let exact: Vec<f64> = (0..1000).map(even).collect();
        assert_eq!(uneven(&exact, 1e-4), None);
        let strays: Vec<f64> = (0..1000)
            .map(|k| even(k) + 1e-5 * f64::from(k).sin())
            .collect();
        let said = uneven(&strays, 1e-4).expect("a note");
        assert!(
            said.contains("strays from equal steps by 7 % of a step"),
            "{said}"
        );
    }

    #[test]
    fn time_may_repeat_only_with_its_sample() {
        let mut clock = Clock::default();
        clock.check(0.0, 1.0, 2.0).expect("in time");
        clock.check(0.0, 1.0, 2.0).expect("in time");
        let still = clock.check(0.0, 1.0, 3.0).expect_err("a refusal");
        assert!(matches!(still, ErrorKind::TimeStill { .. }));
        let back = clock.check(-1.0, 1.0, 3.0).expect_err("a refusal");
        assert!(matches!(back, ErrorKind::TimeBack { .. }));
    }

    #[test]
    fn a_time_without_steps_gives_no_rate() {
        assert!(rate(&[1.0, 1.0]).is_err());
        assert!(rate(&[]).is_err());
        assert!(rate(&[0.0, 5e-324, 1e-323]).is_err());
    }
}
