//! How well any method could see a cause: SNR = ‖P d‖/σ.
//!
//! d is the signal with the cause minus the signal without. P takes off what the five calibration parameters and smooth
//! motion could have done as well. Where the axis vibrates, its random part along the motion is noise to everybody and
//! weighs the tangential component down, line by line. Against a reference, motion and vibration are known and only the
//! zero of the reference is taken off. Of a low pass in both channels, which is late by itself, d is taken from the signal of an axis
//! that stands where the channels show it ([`Visible::across`]).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::motion::State;
use crate::rows::Rows;
use crate::spectrum::weighted;
use crate::world::World;

/// Intervals of the motion's spline that are tried, the fewest that hold the motion are taken.
const INTERVALS: [usize; 14] = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384];

/// What can be seen in an experiment.
pub(crate) struct Visible {
    /// Changes of the channels with the angle, V/rad, for each sample.
    slope: Vec<[f64; 2]>,
    /// Unit vectors along the motion, for each sample.
    along: Vec<[f64; 2]>,
    /// Gain of each line of the tangential component.
    gain: Option<Vec<f64>>,
    /// Nuisances: tangential parts above, the others below.
    nuisance: DMatrix<f64>,
    solver: Cholesky<f64, Dyn>,
    sigma: f64,
    /// A reference shows the motion.
    motion_known: bool,
}

impl Visible {
    /// Of an experiment; `known` where a reference shows the motion. `late`: motion that comes a sample later from some
    /// moment on is as smooth as motion is, and P takes it off; only the step at that moment is to be seen.
    ///
    /// None where the five parameters cannot be told apart from motion: the axis hardly moves.
    #[must_use]
    pub(crate) fn new(world: &World, known: bool, late: bool) -> Option<Self> {
        let n = world.samples;
        let alpha: Vec<f64> = (0..n)
            .map(|k| world.axis(k as f64 / world.rate).alpha)
            .collect();
        let volts = |alpha: f64| [0, 1].map(|c| world.volts(c, world.pair(alpha)[c]));
        let step = 1e-5;
        let slope: Vec<[f64; 2]> = alpha
            .iter()
            .map(|a| {
                let (low, high) = (volts(a - step), volts(a + step));
                [0, 1].map(|c: usize| (high[c] - low[c]) / (2.0 * step))
            })
            .collect();
        let along: Vec<[f64; 2]> = slope
            .iter()
            .map(|v| {
                let size = v[0].hypot(v[1]);
                [v[0] / size, v[1] / size]
            })
            .collect();
        let gain = match &world.vibration {
            Some(vibration) if !known => {
                let white = 2.0 * (world.sigma() / world.mean_amplitude()).powi(2) / world.rate;
                let line = |j: usize| {
                    let frequency = j as f64 * world.rate / n as f64;
                    (1.0 + vibration.power(frequency) / white).sqrt().recip()
                };
                Some((0..=n / 2).map(line).collect())
            }
            _ => None,
        };
        let motion = if known {
            vec![vec![1.0; n]]
        } else {
            splines(world, late)
        };
        let calibration = tangents(world, &alpha);
        let columns = calibration.len() + motion.len();
        let mut nuisance = DMatrix::zeros(2 * n, columns);
        let mut seen = Self {
            slope: slope.clone(),
            along,
            gain,
            nuisance: DMatrix::zeros(0, 0),
            solver: Cholesky::new(DMatrix::identity(1, 1))?,
            sigma: world.sigma(),
            motion_known: known,
        };
        for (j, change) in calibration.iter().enumerate() {
            nuisance.set_column(j, &seen.rotated(change));
        }
        for (j, bend) in motion.iter().enumerate() {
            let change = [0, 1].map(|c| {
                let moved = bend
                    .iter()
                    .zip(&slope)
                    .map(|(b, s): (&f64, &[f64; 2])| b * s[c]);
                moved.collect::<Vec<f64>>()
            });
            nuisance.set_column(calibration.len() + j, &seen.rotated(&change));
        }
        for mut column in nuisance.column_iter_mut() {
            let size = column.norm();
            if size > 0.0 {
                column /= size;
            }
        }
        let mut normal = products(&nuisance, calibration.len());
        for j in 0..columns {
            normal[(j, j)] += 1e-12;
        }
        seen.solver = Cholesky::new(normal)?;
        seen.nuisance = nuisance;
        Some(seen)
    }

    /// SNR of a change of the two channels, V.
    #[must_use]
    pub(crate) fn snr(&self, change: &[Vec<f64>; 2]) -> f64 {
        self.left(change).norm() / self.sigma
    }

    /// What is seen of a change of the two channels, V, in units of the noise.
    #[must_use]
    pub(crate) fn seen(&self, change: &[Vec<f64>; 2]) -> DVector<f64> {
        self.left(change) / self.sigma
    }

    /// Weighted, nuisances taken off, V.
    fn left(&self, change: &[Vec<f64>; 2]) -> DVector<f64> {
        let mut left = self.rotated(change);
        // Twice, as the first time leaves what rounding leaves.
        for _ in 0..2 {
            let share = self.solver.solve(&self.nuisance.tr_mul(&left));
            left -= &self.nuisance * share;
        }
        left
    }

    /// SNR of motion that comes earlier or later from some moments on. However far that is: it is motion wherever it is
    /// smooth.
    #[must_use]
    pub(crate) fn moved(&self, with: &Rows, without: &Rows) -> f64 {
        let pairs = || with.alpha.iter().zip(&without.alpha).zip(&self.slope);
        let change = [0, 1].map(|c: usize| pairs().map(|((a, b), v)| (a - b) * v[c]).collect());
        self.snr(&change)
    }

    /// Whether a reference shows the motion.
    pub(crate) fn knows_motion(&self) -> bool {
        self.motion_known
    }

    /// SNR of what is not motion of a simulation: the signal less that of an axis that stands where the signal shows it. However far
    /// that is from where the axis stands, and so from all tangents there, to anybody it is motion.
    #[must_use]
    pub(crate) fn across(&self, world: &World, with: &Rows) -> f64 {
        let pairs = with.volts[0].iter().zip(&with.volts[1]);
        let off_circle: Vec<[f64; 2]> = pairs
            .map(|(c, s)| {
                let volts = [*c, *s];
                let on_circle = world.pair(world.angle(volts));
                [0, 1].map(|c: usize| volts[c] - world.volts(c, on_circle[c]))
            })
            .collect();
        self.snr(&[0, 1].map(|c: usize| off_circle.iter().map(|d| d[c]).collect()))
    }

    /// Along the motion (weighted), then across it.
    fn rotated(&self, change: &[Vec<f64>; 2]) -> DVector<f64> {
        let n = self.along.len();
        let pairs = || change[0].iter().zip(&change[1]).zip(&self.along);
        let mut tangential: Vec<f64> = pairs().map(|((c, s), v)| c * v[0] + s * v[1]).collect();
        if let Some(gain) = &self.gain {
            tangential = weighted(&tangential, gain);
        }
        let across = pairs().map(|((c, s), v)| s * v[0] - c * v[1]);
        DVector::from_iterator(2 * n, tangential.into_iter().chain(across))
    }
}

/// Products of all nuisances. Those of motion, which come after the first ones, have nothing across it, and are many: as a product of
/// matrices that takes a tenth of the time that it would as one of each column with each.
fn products(nuisance: &DMatrix<f64>, first: usize) -> DMatrix<f64> {
    let (rows, columns) = nuisance.shape();
    let mut normal = DMatrix::zeros(columns, columns);
    let calibration = nuisance.tr_mul(&nuisance.columns(0, first));
    normal
        .view_mut((0, 0), (columns, first))
        .copy_from(&calibration);
    let mut right = normal.view_mut((0, 0), (first, columns));
    right.copy_from(&calibration.transpose());
    let motion = nuisance.view((0, first), (rows / 2, columns - first));
    let mut motions = normal.view_mut((first, first), (columns - first, columns - first));
    motions.gemm(1.0, &motion.transpose(), &motion, 0.0);
    normal
}

/// Changes of the two channels with each calibration parameter, by differences.
fn tangents(world: &World, alpha: &[f64]) -> Vec<[Vec<f64>; 2]> {
    let show = |world: &World| {
        [0, 1].map(|c| {
            let shown = alpha.iter().map(|a| world.volts(c, world.pair(*a)[c]));
            shown.collect::<Vec<f64>>()
        })
    };
    let step = 1e-4;
    let here = show(world);
    (0..5)
        .map(|which| {
            let mut moved = world.clone();
            match which {
                0 | 1 => moved.amplitude[which] += step,
                2 | 3 => moved.offset[which - 2] += step,
                _ => moved.beta += step,
            }
            let there = show(&moved);
            [0, 1].map(|c: usize| {
                let pairs = there[c].iter().zip(&here[c]);
                pairs.map(|(a, b)| (a - b) / step).collect()
            })
        })
        .collect()
}

/// Cubic B-splines on equal intervals, the fewest that follow the drive to a fifth of the noise, and where it may be late
/// what one sample changes of it so well that all of it together is below that.
fn splines(world: &World, late: bool) -> Vec<Vec<f64>> {
    let target = 0.2 * world.sigma() / world.mean_amplitude();
    let all = (world.samples as f64).sqrt() / world.rate;
    let follow = |count: &&usize| {
        misfit(world, **count, |state| state.alpha) < target
            && (!late || misfit(world, **count, |state| state.speed * all) < target)
    };
    let few = *INTERVALS
        .iter()
        .find(follow)
        .unwrap_or(&INTERVALS[INTERVALS.len() - 1]);
    let n = world.samples;
    let mut all = vec![vec![0.0; n]; few + 3];
    (0..n).for_each(|k| {
        let (first, values) = basis(k as f64 / n as f64, few);
        for (column, value) in all[first..].iter_mut().zip(values) {
            column[k] = value;
        }
    });
    all
}

/// Rms of what so many intervals leave of something of the drive, in its unit.
fn misfit(world: &World, intervals: usize, of: impl Fn(&State) -> f64) -> f64 {
    let points = (8 * intervals).max(200);
    let columns = intervals + 3;
    let mut normal = DMatrix::<f64>::zeros(columns, columns);
    let mut right = DVector::<f64>::zeros(columns);
    let moment = |k: usize| k as f64 / points as f64 * world.seconds();
    let value = |k: usize| of(&world.motion.at(moment(k)));
    for k in 0..points {
        let (first, b) = basis(k as f64 / points as f64, intervals);
        for i in 0..4 {
            right[first + i] += b[i] * value(k);
            for j in 0..4 {
                normal[(first + i, first + j)] += b[i] * b[j];
            }
        }
    }
    let Some(solver) = Cholesky::new(normal) else {
        return f64::INFINITY;
    };
    let x = solver.solve(&right);
    let off = (0..points).map(|k| {
        let (first, b) = basis(k as f64 / points as f64, intervals);
        let fit: f64 = (0..4).map(|j| b[j] * x[first + j]).sum();
        (value(k) - fit).powi(2)
    });
    (off.sum::<f64>() / points as f64).sqrt()
}

/// First B-spline that lives at `x` (0 … 1), and the values of it and the next three.
fn basis(x: f64, intervals: usize) -> (usize, [f64; 4]) {
    let place = x * intervals as f64;
    let first = (place as usize).min(intervals - 1);
    let u = place - first as f64;
    let v = 1.0 - u;
    let middle = |u: f64| (3.0 * u.powi(3) - 6.0 * u * u + 4.0) / 6.0;
    (
        first,
        [v.powi(3) / 6.0, middle(u), middle(v), u.powi(3) / 6.0],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::{Finish, simulate};
    use crate::world::to_and_fro;

    fn change(world: &World, f: impl Fn(f64, f64) -> [f64; 2]) -> [Vec<f64>; 2] {
        [0, 1].map(|c: usize| {
            (0..world.samples)
                .map(|k| {
                    let t = k as f64 / world.rate;
                    f(t, world.axis(t).alpha)[c]
                })
                .collect()
        })
    }

    #[test]
    fn splines_sum_to_one() {
        for x in [0.0, 0.013, 0.5, 0.999] {
            let sum: f64 = basis(x, 12).1.iter().sum();
            assert!((sum - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn calibration_and_smooth_motion_are_invisible() {
        let world = to_and_fro(false, false);
        let visible = Visible::new(&world, false, false).expect("a world");
        let offset = change(&world, |_, _| [1e-3, 0.0]);
        assert!(visible.snr(&offset) < 1e-3, "{}", visible.snr(&offset));
        let slow = change(&world, |t, a| {
            let moved = 1e-3 * (9.0 * t / world.seconds()).sin();
            [
                -world.amplitude[0] * a.sin() * moved,
                world.amplitude[1] * (a - world.beta).cos() * moved,
            ]
        });
        assert!(visible.snr(&slow) < 1e-2, "{}", visible.snr(&slow));
    }

    #[test]
    fn what_is_late_altogether_is_motion_and_what_shrinks_with_speed_is_seen() {
        let world = to_and_fro(false, false);
        let visible = Visible::new(&world, false, false).expect("a world");
        let fastest = (0..world.samples)
            .map(|k| world.motion.at(k as f64 / world.rate).speed.abs())
            .fold(0.0, f64::max);
        // Of the size at rest, and of the fastest.
        let rows = |rest: f64, fast: f64| {
            let mut rows = simulate(&world, &[], Finish::Clean);
            for k in 0..world.samples {
                let late = world.axis((k as f64 - 0.7) / world.rate).alpha;
                let pair = world.pair(late);
                let speed = world.motion.at(k as f64 / world.rate).speed / fastest;
                let size = rest + (fast - rest) * speed * speed;
                for (c, u) in pair.into_iter().enumerate() {
                    rows.volts[c][k] = world.volts(c, size * u);
                }
            }
            rows
        };
        let late = visible.across(&world, &rows(1.0, 1.0));
        assert!(late < 1e-6, "{late}");
        // A gain of both channels is calibrated.
        let calibrated = visible.across(&world, &rows(0.999, 0.999));
        assert!(calibrated < 0.1, "{calibrated}");
        let seen = visible.across(&world, &rows(1.0, 0.999));
        let noise = world.sigma() / world.mean_amplitude();
        let most = 1e-3 * (world.samples as f64).sqrt() / noise;
        assert!(
            (0.05 * most..0.5 * most).contains(&seen),
            "{seen} of {most}"
        );
    }

    #[test]
    fn a_harmonic_is_seen_nearly_whole_and_vibration_hides_half_of_it() {
        let (still, shaken) = (to_and_fro(false, false), to_and_fro(false, true));
        let whole = |world: &World| {
            let harmonic = change(world, |_, a| [1e-3 * (5.0 * a).cos(), 0.0]);
            let size: f64 = harmonic[0].iter().map(|d| d * d).sum();
            let seen = Visible::new(world, false, false)
                .expect("a world")
                .snr(&harmonic);
            seen / (size.sqrt() / world.sigma())
        };
        assert!((0.9..=1.0).contains(&whole(&still)), "{}", whole(&still));
        assert!(whole(&shaken) < whole(&still));
        assert!(whole(&shaken) > 0.6, "{}", whole(&shaken));
    }
}
