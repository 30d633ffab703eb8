//! At how many places of the period the samples stand.

/// A gap of 20° and more parts two places, turns.
const APART: f64 = 20.0 / 360.0;

/// Gaps between neighbouring angles all round, in turns; without any angle one of a turn.
pub(crate) fn gaps(mut turns: Vec<f64>) -> impl Iterator<Item = f64> {
    turns.sort_unstable_by(f64::total_cmp);
    let across = match (turns.first(), turns.last()) {
        (Some(first), Some(last)) => first + 1.0 - last,
        _ => 1.0,
    };
    let between: Vec<f64> = turns.windows(2).map(|pair| pair[1] - pair[0]).collect();
    between.into_iter().chain([across])
}

/// The largest of them.
pub(crate) fn widest_gap(turns: &[f64]) -> f64 {
    gaps(turns.to_vec()).fold(0.0, f64::max)
}

/// Gaps that part two places.
fn apart(turns: Vec<f64>) -> Vec<f64> {
    gaps(turns).filter(|gap| *gap > APART).collect()
}

/// Places of vectors from their mean. A cloud about its mean, and an arc, have one. Near the mean noise alone makes the angle; places of a
/// ring stand away from it.
pub(crate) fn seen_from_the_mean(centred: &[nalgebra::Vector2<f64>]) -> usize {
    /// Share of the rms distance.
    const AWAY: f64 = 0.5;
    let rms = (centred.iter().map(|y| y.norm_squared()).sum::<f64>() / centred.len() as f64).sqrt();
    let away = centred.iter().filter(|y| y.norm() > AWAY * rms);
    let turns = away.map(|y| y.y.atan2(y.x) / std::f64::consts::TAU);
    apart(turns.collect()).len().max(1)
}

/// Places of angles on the curve, in turns, where these are so many, or the places so narrow, that it is no chance.
pub(crate) fn on_the_curve(turns: Vec<f64>) -> Option<usize> {
    /// Angles of which hardly any place of the period would be left out.
    const MANY: usize = 128;
    /// Angles of each place, and share of the period that all places fill, of fewer.
    const EACH: usize = 8;
    const NARROW: f64 = 0.1;
    let samples = turns.len();
    let gaps = apart(turns);
    let filled = 1.0 - gaps.iter().sum::<f64>();
    let narrow = filled < NARROW && samples >= EACH * gaps.len();
    (samples >= MANY || narrow).then_some(gaps.len().max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_widest_gap_is_the_arc_without_samples() {
        let turning = |turns: f64| -> Vec<f64> {
            let at = (0..4000).map(|k| turns * f64::from(k) / 4000.0);
            at.map(|a| a - a.round()).collect()
        };
        assert!((widest_gap(&turning(0.75)) - 0.25).abs() < 0.005);
        assert!(widest_gap(&turning(3.0)) < 0.002);
    }
}
