//! The direction in which the scale came to where it is.

use std::f64::consts::TAU;

/// Way back, radians of the scale period, from which on a scale has turned: noise of a motion that was measured turns back and forth
/// by less at rest.
const BACK: f64 = TAU / 100.0;

/// 1 or −1 at each angle (radians): at rest the direction before goes on, until the scale has gone back; then it turned where it
/// stood last. Before any motion it is the first that comes times `start`.
pub(crate) fn sides(alpha: &[f64], start: f64) -> Vec<f64> {
    let Some(first) = alpha.first() else {
        return vec![];
    };
    let way = alpha.iter().map(|a| a - first).find(|way| way.abs() > BACK);
    let mut side = start * way.map_or(1.0, f64::signum);
    let mut sides = vec![side; alpha.len()];
    let mut farthest = 0;
    for (k, a) in alpha.iter().enumerate() {
        let on = (a - alpha[farthest]) * side;
        if on >= 0.0 {
            farthest = k;
        } else if on < -BACK {
            // It may have rested there: it turned where it went on or stood last.
            let stood = |j: &usize| (alpha[j + 1] - alpha[*j]) * side >= 0.0;
            let turn = (farthest..k).rev().find(stood).map_or(farthest, |j| j + 1);
            side = -side;
            sides[turn + 1..k].fill(side);
            farthest = k;
        }
        sides[k] = side;
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::{BACK, sides};

    #[test]
    fn what_rests_keeps_its_direction_until_it_has_gone_back() {
        let places = [0.0, 2.0, 2.01, 1.99, 2.01, 4.0, 3.99, 3.98, 2.5, 2.4];
        let alpha = places.map(|p| p * BACK);
        let expected = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0];
        assert_eq!(sides(&alpha, 1.0), expected);
        assert_eq!(sides(&[1.0, 1.0], 1.0), [1.0, 1.0]);
        assert_eq!(sides(&[], 1.0), [0.0; 0]);
        assert_eq!(sides(&[0.0, -1.0], 1.0), [-1.0, -1.0]);
    }

    #[test]
    fn what_came_the_other_way_turns_when_it_moves() {
        let alpha = [0.0, 0.1, 0.0, 2.0, 4.0, 3.0, 2.0].map(|p| p * BACK);
        let expected = [-1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0];
        assert_eq!(sides(&alpha, -1.0), expected);
    }

    /// However slow it goes back beside the way out.
    #[test]
    fn a_slow_way_back_is_one() {
        let fast = (0..10).map(|k| f64::from(k) * 100.0 * BACK);
        let slow = (0..1000).map(|k| (900.0 - f64::from(k) * 0.1) * BACK);
        let sides = sides(&fast.chain(slow).collect::<Vec<_>>(), 1.0);
        assert!(
            sides[..=10].iter().all(|s| *s == 1.0),
            "{:?}",
            &sides[..=10]
        );
        assert!(sides[11..].iter().all(|s| *s == -1.0));
    }
}
