//! Angles from sample to sample, also through those that do not tell it.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::numerics::slopes::lay_straight;

/// Fewest samples over which a speed is taken.
const FEWEST: usize = 4;

/// The same angle, whole turns off it, that is nearest to another, radians.
pub(crate) fn nearest(angle: f64, to: f64) -> f64 {
    angle + TAU * ((to - angle) / TAU).round()
}

/// Continuous angles, radians. Whole periods may pass while nothing tells the angle: as many as the mean of the speeds on either side
/// says, which is right for an axis that accelerates evenly. A cubic is laid over such samples, and beyond the ends it goes straight on.
pub(crate) fn continuous(mut angle: Vec<f64>, tells: &[f64]) -> Vec<f64> {
    let told = |k: &usize| tells[*k] > 0.0;
    let Some(first) = (0..angle.len()).find(told) else {
        return angle;
    };
    let mut last = first;
    for k in (first + 1..angle.len()).filter(told) {
        let since = k - last;
        if since == 1 {
            angle[k] = nearest(angle[k], angle[last]);
        } else {
            let behind = behind(&angle[first..=last], since);
            let ahead = ahead(&angle[k..], &tells[k..], since);
            // A few samples between two gaps know less of the speed than the other side.
            let long = |way: &Way| 2 * way.samples >= over(since);
            let one = behind.iter().chain(&ahead).any(long);
            let [behind, ahead] = [behind, ahead].map(|way| way.filter(|way| !one || long(way)));
            let speeds = [behind, ahead].into_iter().flatten().map(|way| way.speed());
            let speed = speeds.clone().sum::<f64>() / speeds.count().max(1) as f64;
            angle[k] = nearest(angle[k], angle[last] + since as f64 * speed);
            match (behind, ahead) {
                (Some(behind), Some(ahead)) => lay_cubic(&mut angle, last..k, behind, ahead),
                _ => lay_straight(&mut angle, last + 1..k),
            }
        }
        last = k;
    }
    let n = angle.len();
    let goes = |way: Option<Way>| way.map_or(0.0, |way| way.speed());
    let before = goes(ahead(&angle[first..], &tells[first..], first));
    (0..first).for_each(|k| angle[k] = angle[first] - before * (first - k) as f64);
    let after = goes(behind(&angle[first..=last], n - last));
    (last + 1..n).for_each(|k| angle[k] = angle[last] + after * (k - last) as f64);
    angle
}

/// How far an angle moves over some samples, radians.
#[derive(Clone, Copy, Debug)]
struct Way {
    samples: usize,
    moved: f64,
}

impl Way {
    /// Per sample.
    fn speed(&self) -> f64 {
        self.moved / self.samples as f64
    }
}

/// Lays a cubic between two samples, through another one on either side.
fn lay_cubic(angle: &mut [f64], between: Range<usize>, behind: Way, ahead: Way) {
    let Range { start, end } = between;
    let (from, to) = (start as f64, end as f64);
    let points = [
        (from - behind.samples as f64, angle[start] - behind.moved),
        (from, angle[start]),
        (to, angle[end]),
        (to + ahead.samples as f64, angle[end] + ahead.moved),
    ];
    for (k, angle) in angle[..end].iter_mut().enumerate().skip(start + 1) {
        let lagrange = |i: usize| {
            let others = (0..points.len()).filter(|j| *j != i);
            let factors = others.map(|j| (k as f64 - points[j].0) / (points[i].0 - points[j].0));
            points[i].1 * factors.product::<f64>()
        };
        *angle = (0..points.len()).map(lagrange).sum();
    }
}

/// Samples over which a speed is taken that is to reach so far: of few, noise would be a period.
fn over(since: usize) -> usize {
    FEWEST.max(since / 4)
}

/// The way to the end of a continuous angle.
fn behind(angle: &[f64], since: usize) -> Option<Way> {
    let last = angle.len() - 1;
    let samples = over(since).min(last);
    let moved = angle[last] - angle[last - samples];
    (samples > 0).then_some(Way { samples, moved })
}

/// The way from the first of the angles, each within a turn, on: as far as they tell.
fn ahead(angle: &[f64], tells: &[f64], since: usize) -> Option<Way> {
    let told = tells.iter().take_while(|tells| **tells > 0.0).count();
    let samples = over(since).min(told.saturating_sub(1));
    let steps = angle.windows(2).take(samples).map(|w| w[1] - w[0]);
    let moved = steps.map(|step| nearest(step, 0.0)).sum();
    (samples > 0).then_some(Way { samples, moved })
}

#[cfg(test)]
mod tests {
    use super::continuous;
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};
    use rand_distr::StandardNormal;
    use std::f64::consts::TAU;

    /// To and fro, up to a fifth of a period per sample, and what does not tell holds anything.
    fn moved() -> Vec<f64> {
        let at = |k: usize| 300.0 * TAU * (k as f64 / 1500.0).sin();
        (0..6000).map(at).collect()
    }

    fn wrapped_but(angle: &[f64], tells: &[f64]) -> Vec<f64> {
        let pairs = angle.iter().zip(tells).enumerate();
        let of = |(k, (a, tells)): (usize, (&f64, &f64))| {
            if *tells > 0.0 {
                a.sin().atan2(a.cos())
            } else {
                (k % 7) as f64 - 3.0
            }
        };
        pairs.map(of).collect()
    }

    #[test]
    fn periods_that_pass_unseen_are_counted() {
        let angle = moved();
        for (every, lost) in [(2, 1), (9, 5), (40, 20), (200, 70)] {
            let tells: Vec<f64> = (0..angle.len())
                .map(|k| f64::from(u8::from(k % every < every - lost || k >= 5900)))
                .collect();
            let found = continuous(wrapped_but(&angle, &tells), &tells);
            for (k, (found, angle)) in found.iter().zip(&angle).enumerate() {
                let off = found - angle;
                let most = if tells[k] > 0.0 { 1e-9 } else { 0.05 };
                assert!(off.abs() < most, "{every} {lost} {k}: {off}");
            }
        }
    }

    /// A link that comes back for a few samples between two long gaps.
    #[test]
    fn a_few_samples_between_gaps_lose_no_period() {
        let mut random = StdRng::seed_from_u64(1);
        for few in 1..12 {
            for _ in 0..200 {
                let told = |k: usize| k < 1000 || (1400..1400 + few).contains(&k) || k >= 1800;
                let tells: Vec<f64> = (0..3000).map(|k| f64::from(u8::from(told(k)))).collect();
                let mut noise = || -> f64 { 0.02 * random.sample::<f64, _>(StandardNormal) };
                let angle: Vec<f64> = (0..3000).map(|k| 0.3 * k as f64 + noise()).collect();
                let found = continuous(wrapped_but(&angle, &tells), &tells);
                for (k, (found, angle)) in found.iter().zip(&angle).enumerate() {
                    assert!((found - angle).abs() < 1.5, "{few} {k}");
                }
            }
        }
    }

    #[test]
    fn nothing_that_tells_is_left_as_it_is() {
        assert_eq!(continuous(vec![1.0, 9.0], &[0.0; 2]), [1.0, 9.0]);
        assert_eq!(continuous(vec![], &[]), Vec::<f64>::new());
    }

    #[test]
    fn beyond_the_ends_it_goes_on() {
        let angle: Vec<f64> = (0..20).map(|k| 0.1 * f64::from(k)).collect();
        let tells: Vec<f64> = (0..20)
            .map(|k| f64::from(u8::from((5..15).contains(&k))))
            .collect();
        let found = continuous(wrapped_but(&angle, &tells), &tells);
        for (found, angle) in found.iter().zip(&angle) {
            assert!((found - angle).abs() < 1e-9);
        }
    }
}
