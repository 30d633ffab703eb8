//! Channels that are cut off at an end.

use crate::extremes::ends;
use crate::samples::code_step;
use crate::words;

/// Samples at the end that are no accident.
const LEAST: usize = 8;
/// So many times as many as at the code beside it. Where a sine turns there are 2.4 times as many.
const MORE: usize = 4;
/// Share of its span over which the other channel moves meanwhile: an axis that rests there does not move.
const MOVES: f64 = 0.2;

/// What to say of each end of each channel that is cut off.
pub(crate) fn clipped(cos: &[f64], sin: &[f64]) -> Vec<String> {
    let channels = [("cos", cos, sin), ("sin", sin, cos)];
    let ends = channels.map(|(name, own, other)| {
        let negative: Vec<f64> = own.iter().map(|y| -y).collect();
        let highest = at_top(own, other).map(|(n, y)| words::of_clipped(name, "highest", n, y));
        let lowest =
            at_top(&negative, other).map(|(n, y)| words::of_clipped(name, "lowest", n, -y));
        [highest, lowest]
    });
    ends.into_iter().flatten().flatten().collect()
}

/// Samples at the highest value, and that value, where the channel is cut off there.
fn at_top(own: &[f64], other: &[f64]) -> Option<(usize, f64)> {
    // Fewer beyond it are glitches.
    let mut sorted = own.to_vec();
    let (_, top, _) = sorted.select_nth_unstable_by(own.len().checked_sub(LEAST)?, f64::total_cmp);
    let top = *top;
    // Half a step beside a code are its neighbours' ends; what has no codes has no neighbours.
    let step = code_step(own).unwrap_or(0.0);
    let near = |y: &&f64| (top - **y).abs() <= 0.5 * step;
    let next = |y: &&f64| (top - step - **y).abs() < 0.5 * step;
    let pairs = own.iter().zip(other);
    let meanwhile: Vec<f64> = pairs.filter(|(y, _)| near(y)).map(|(_, y)| *y).collect();
    let (count, beside) = (meanwhile.len(), own.iter().filter(next).count());
    if count < LEAST || count < MORE * beside {
        return None;
    }
    let span = |values: &[f64]| {
        let (low, high) = ends(values);
        high - low
    };
    (span(&meanwhile) > MOVES * span(other)).then_some((count, top))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Codes of an amplitude, cut off at a share of it, at so many samples a period.
    fn codes(amplitude: f64, limit: f64, samples: f64) -> (Vec<f64>, Vec<f64>) {
        let code = |y: f64| (amplitude * y.min(limit)).round();
        let at = |k: i32| f64::from(k) * std::f64::consts::TAU / samples;
        (0..5000)
            .map(|k| (code(at(k).cos()), code(at(k).sin())))
            .unzip()
    }

    #[test]
    fn a_channel_that_is_cut_off_is_named_and_one_that_turns_is_not() {
        for amplitude in [20.0, 200.0, 2000.0, 30_000.0] {
            for samples in [5.3, 97.7, 1234.5] {
                let (cos, sin) = codes(amplitude, 1.0, samples);
                assert_eq!(
                    clipped(&cos, &sin),
                    Vec::<String>::new(),
                    "{amplitude} {samples}"
                );
                let (cos, sin) = codes(amplitude, 0.9, samples);
                let said = clipped(&cos, &sin);
                assert_eq!(said.len(), 2, "{amplitude} {samples}: {said:?}");
                assert!(
                    said[0].contains("of cos stand at its highest value"),
                    "{said:?}"
                );
            }
        }
    }

    #[test]
    fn a_glitch_beyond_the_end_hides_nothing() {
        let (mut cos, sin) = codes(2000.0, 0.9, 97.7);
        (cos[17], cos[900]) = (2600.0, 2047.0);
        assert!(clipped(&cos, &sin)[0].contains("of cos stand at its highest value 1800"));
    }

    #[test]
    fn an_axis_that_rests_at_the_top_is_not_cut_off() {
        let (mut cos, mut sin) = codes(200.0, 1.0, 97.7);
        cos.extend([200.0; 3000]);
        sin.extend((0..3000).map(|k| f64::from(k % 3)));
        assert_eq!(clipped(&cos, &sin), Vec::<String>::new());
    }
}
