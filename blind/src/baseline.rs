//! Position errors that are no noise: of the five parameters alone, and of positions given.

use std::f64::consts::TAU;

use nalgebra::{SMatrix, SVector};

use crate::rows::Rows;
use crate::world::World;

/// a_c, b_c, a_s, b_s, β.
type Five = SVector<f64, 5>;

/// cos and sin by the five parameters.
fn corrected(five: &Five, cos: f64, sin: f64) -> [f64; 2] {
    let c = (cos - five[1]) / five[0];
    let s = (sin - five[3]) / five[2];
    [c, (s + c * five[4].sin()) / five[4].cos()]
}

/// The five parameters that make the radius most constant (Gauss-Newton from the ranges of the channels).
fn fitted(rows: &Rows) -> Five {
    let range = |channel: usize| {
        let fold = |(low, high): (f64, f64), v: &f64| (low.min(*v), high.max(*v));
        rows.volts[channel].iter().fold((f64::MAX, f64::MIN), fold)
    };
    let ((lc, hc), (ls, hs)) = (range(0), range(1));
    let mut five = Five::from([
        (hc - lc) / 2.0,
        (hc + lc) / 2.0,
        (hs - ls) / 2.0,
        (hs + ls) / 2.0,
        0.0,
    ]);
    let radial = |five: &Five, k: usize| {
        let [c, s] = corrected(five, rows.volts[0][k], rows.volts[1][k]);
        c.hypot(s) - 1.0
    };
    for _ in 0..12 {
        let mut normal = SMatrix::<f64, 5, 5>::zeros();
        let mut right = Five::zeros();
        for k in 0..rows.len() {
            let here = radial(&five, k);
            let slope = Five::from_fn(|j, _| {
                let mut moved = five;
                moved[j] += 1e-6;
                (radial(&moved, k) - here) / 1e-6
            });
            // A glitch is no reason to bend the ellipse.
            let weight = 1.0 / (1.0 + (here / 0.05).powi(2));
            normal += weight * slope * slope.transpose();
            right += weight * slope * here;
        }
        let Some(step) = normal.lu().solve(&right) else {
            break;
        };
        five -= step;
        if step.norm() < 1e-10 {
            break;
        }
    }
    five
}

/// Rms of `angle` against the truth without the noise that the recording has, rad. A constant is taken off.
fn systematic(world: &World, rows: &Rows, angle: &dyn Fn(usize) -> f64) -> f64 {
    let errors: Vec<f64> = (0..rows.len())
        .map(|k| {
            let alpha = rows.alpha[k];
            let [c, s] = world.upright([rows.noise[0][k], rows.noise[1][k]]);
            let noise = s * alpha.cos() - c * alpha.sin();
            let off = angle(k) - alpha - noise;
            off - TAU * (off / TAU).round()
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let square: f64 = errors.iter().map(|e| (e - mean).powi(2)).sum();
    (square / errors.len() as f64).sqrt()
}

/// Systematic error of the five parameters alone, rad rms.
pub(crate) fn five_parameters(world: &World, rows: &Rows) -> f64 {
    let five = fitted(rows);
    systematic(world, rows, &|k| {
        let [c, s] = corrected(&five, rows.volts[0][k], rows.volts[1][k]);
        s.atan2(c)
    })
}

/// Systematic error of positions in periods, rad rms.
pub(crate) fn of_positions(world: &World, rows: &Rows, positions: &[f64]) -> Option<f64> {
    (positions.len() == rows.len()).then(|| systematic(world, rows, &|k| TAU * positions[k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    #[test]
    fn nothing_hidden_leaves_nothing() {
        for seed in [0, 3, 6] {
            let case = Case::draw(seed, 6000).expect("a case");
            let left = five_parameters(&case.world, &case.rows);
            // Second order of the noise and five parameters' errors: far less than the noise itself.
            assert!(left < 0.08 * case.truth.noise, "{seed}: {left}");
            let true_positions: Vec<f64> = case.rows.alpha.iter().map(|a| a / TAU).collect();
            let noise = of_positions(&case.world, &case.rows, &true_positions).expect("a baseline");
            assert!((noise / case.truth.noise - 1.0).abs() < 0.1, "{noise}");
        }
    }
}
