//! The reference angle, made continuous.

use std::f64::consts::TAU;

/// Unwraps an angle in radians in place, where it is wrapped.
///
/// A column that stays within one turn wraps at a turn (a step counts as the shorter way round); one
/// that also falls back by whole revolutions of `periods` turns wraps there; any other is continuous
/// already, however fast it moves.
pub(crate) fn unwrap(angle: &mut [f64], periods: Option<u32>) {
    let (low, high) = angle
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), a| (l.min(*a), h.max(*a)));
    // A little more than a turn, for noise and rounding at its ends.
    let within = |turn: f64| high - low <= 1.01 * turn;
    let revolution = TAU * f64::from(periods.unwrap_or(1));
    let turn = if within(TAU) {
        TAU
    } else if within(revolution) && falls_back(angle, revolution) {
        revolution
    } else {
        return;
    };
    let mut offset = 0.0;
    let mut last = angle.first().copied().unwrap_or_default();
    for a in angle {
        offset -= turn * ((*a - last) / turn).round();
        last = *a;
        *a += offset;
    }
}

/// True where the angle jumps by most of a revolution against its usual direction.
fn falls_back(angle: &[f64], revolution: f64) -> bool {
    let jump = |d: &f64| d.abs() > 0.75 * revolution;
    let steps = || angle.windows(2).map(|w| w[1] - w[0]);
    let usual: f64 = steps().filter(|d| !jump(d)).sum();
    steps().filter(jump).any(|d| d * usual < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn continuous(per_sample: f64) -> Vec<f64> {
        (0..500).map(|k| 0.3 + f64::from(k) * per_sample).collect()
    }

    #[track_caller]
    fn assert_unwraps(mut wrapped: Vec<f64>, periods: Option<u32>, expected: &[f64]) {
        unwrap(&mut wrapped, periods);
        let constant = wrapped[0] - expected[0];
        for (a, b) in wrapped.iter().zip(expected) {
            assert!((a - b - constant).abs() < 1e-9, "{a} {b}");
        }
    }

    #[test]
    fn wrapped_angles_of_either_direction_and_range_become_continuous() {
        for per_sample in [0.7, -0.7, 2.9, -0.01] {
            let angle = continuous(per_sample);
            let positive = angle.iter().map(|a| a.rem_euclid(TAU)).collect();
            assert_unwraps(positive, None, &angle);
            let about_zero = angle.iter().map(|a| a - TAU * (a / TAU).round()).collect();
            assert_unwraps(about_zero, None, &angle);
        }
    }

    #[test]
    fn continuous_angles_stay_even_where_they_leap() {
        assert_unwraps(continuous(5.0), Some(3), &continuous(5.0));
        assert_unwraps(continuous(0.001), None, &continuous(0.001));
        let mut gap = continuous(0.1);
        gap[250..].iter_mut().for_each(|a| *a += 100.0);
        assert_unwraps(gap.clone(), Some(20), &gap);
    }

    #[test]
    fn angles_that_wrap_at_a_revolution_become_continuous() {
        let angle = continuous(0.9);
        let wrapped = angle.iter().map(|a| a.rem_euclid(10.0 * TAU)).collect();
        assert_unwraps(wrapped, Some(10), &angle);
    }

    #[test]
    fn nothing_is_nothing() {
        unwrap(&mut [], None);
    }
}
