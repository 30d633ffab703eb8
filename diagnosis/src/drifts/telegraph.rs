//! Whether slow noise of the channels jumps between two levels, as popcorn noise and stray light do. Its spectrum can be
//! that of flicker noise; its likelihood is another: the levels are a hidden Markov chain (Baum and Welch) that shows in
//! the radius, r = cₛ cos α + dₛ sin α in state s, and against a reference, beside white noise.
//!
//! It is no cause of the catalogue. It is fitted so that flicker noise is not named for it.

use crate::drifts::channels::Channels;
use crate::numerics::pair::PairSums;
use crate::numerics::statistics::price;

/// Most samples that are looked at.
pub(crate) const ENOUGH: usize = 60_000;
/// Samples of the stretches whose levels a fit starts from; about as long as it stays.
const STRETCHES: [usize; 3] = [16, 64, 256];
/// Steps of a fit.
const STEPS: usize = 12;
/// Numbers of the model: two levels of two channels, two rates, beside the noise.
const FREEDOM: f64 = 6.0;

/// Offsets of both channels.
type Level = [f64; 2];

/// Two levels, the chance to leave either, variance of the noise.
struct Chain {
    level: [Level; 2],
    leave: [f64; 2],
    variance: f64,
}

/// Log-likelihood that the best two levels explain of what is seen beyond white noise and steady offsets, their numbers paid for;
/// none where they explain nothing.
pub(crate) fn gain(seen: Channels) -> Option<f64> {
    let n = seen.samples().min(ENOUGH);
    let part = seen.first(n);
    let rows = n as f64 * seen.count();
    let white = part.power() / rows.max(1.0);
    if white.is_nan() || white <= 0.0 {
        return None;
    }
    let of_white = -0.5 * rows * (white.ln() + 1.0);
    let price = FREEDOM * price(n as f64);
    let likelihood = STRETCHES
        .into_iter()
        .filter_map(|length| Chain::start(&part, length, white))
        .filter_map(|chain| chain.fitted(&part))
        .max_by(f64::total_cmp)?;
    let steady = part.steady(seen.samples());
    let gain = (likelihood - of_white - steady - price) / n as f64 * seen.samples() as f64;
    (gain > 0.0).then_some(gain)
}

/// What a step of a fit says.
struct Step {
    /// Log-likelihood of the chain before it.
    likelihood: f64,
    /// The chain after it.
    next: Chain,
}

impl Chain {
    /// Levels from stretches of the recording, split in two along the line on which they differ most.
    fn start(seen: &Channels, length: usize, white: f64) -> Option<Self> {
        let levels: Vec<Level> = (0..seen.samples() / length)
            .map(|i| {
                let mut sums = seen.sums(i * length..(i + 1) * length);
                // Where only one offset is seen, the other does not count.
                sums.add_nothing(0.1 * length as f64);
                sums.amounts()
            })
            .collect();
        let count = levels.len() as f64;
        let mean: Level = [0, 1].map(|i| levels.iter().map(|l| l[i]).sum::<f64>() / count);
        let moment = |i: usize, j: usize| -> f64 {
            levels
                .iter()
                .map(|l| (l[i] - mean[i]) * (l[j] - mean[j]))
                .sum()
        };
        let turn = 0.5 * (2.0 * moment(0, 1)).atan2(moment(0, 0) - moment(1, 1));
        let along = |l: &Level| (l[0] - mean[0]) * turn.cos() + (l[1] - mean[1]) * turn.sin();
        let spread = (levels.iter().map(|l| along(l).powi(2)).sum::<f64>() / count).sqrt();
        // Where one side is rare it is further away.
        let skew = levels
            .iter()
            .map(|l| (along(l) / spread).powi(3))
            .sum::<f64>()
            / count;
        let far = 0.5 * (skew + (skew * skew + 4.0).sqrt());
        let at = |by: f64| [mean[0] + by * turn.cos(), mean[1] + by * turn.sin()];
        let share = 1.0 / (1.0 + far * far);
        let rate = 0.5 / length as f64;
        (spread > 0.0 && far.is_finite()).then(|| Self {
            level: [at(-spread / far), at(spread * far)],
            leave: [rate * share, rate * (1.0 - share)],
            variance: white,
        })
    }

    /// Log-likelihood of the best chain near.
    fn fitted(self, seen: &Channels) -> Option<f64> {
        let mut best: Option<f64> = None;
        let mut now = self;
        for _ in 0..STEPS {
            let step = now.step(seen);
            if !step.likelihood.is_finite() {
                break;
            }
            best = Some(best.map_or(step.likelihood, |b| b.max(step.likelihood)));
            now = step.next;
        }
        best
    }

    /// What each state makes of a sample, up to a common factor.
    fn density(&self, seen: &Channels, k: usize) -> [f64; 2] {
        self.level.map(|[c, d]| {
            let off = seen
                .rows(k)
                .map(|row| row.left - c * row.of[0] - d * row.of[1]);
            let off: f64 = off.map(|off| off * off).sum();
            (-0.5 * off / self.variance).exp().max(f64::MIN_POSITIVE)
        })
    }

    /// A step of expectation and maximisation.
    fn step(&self, seen: &Channels) -> Step {
        let n = seen.samples();
        let rows = n as f64 * seen.count();
        let stay = self.leave.map(|l| 1.0 - l);
        let mut now = [0.5, 0.5];
        let mut forward = Vec::with_capacity(n);
        let mut likelihood = -0.5 * rows * self.variance.ln();
        for k in 0..n {
            let density = self.density(seen, k);
            let come = [
                now[0] * stay[0] + now[1] * self.leave[1],
                now[1] * stay[1] + now[0] * self.leave[0],
            ];
            let both = [come[0] * density[0], come[1] * density[1]];
            let total = both[0] + both[1];
            likelihood += total.ln();
            now = both.map(|b| b / total);
            forward.push(now);
        }
        let (mut sums, mut left, mut stood) = ([PairSums::default(); 2], [0.0; 2], [0.0; 2]);
        let mut back = [1.0, 1.0];
        for k in (0..n).rev() {
            let both = [forward[k][0] * back[0], forward[k][1] * back[1]];
            let total = both[0] + both[1];
            for (sums, share) in sums.iter_mut().zip(both) {
                for row in seen.rows(k) {
                    sums.add(row.of[0], row.of[1], row.left, share / total);
                }
            }
            let Some(before) = k.checked_sub(1).map(|b| forward[b]) else {
                break;
            };
            let density = self.density(seen, k);
            let on = [density[0] * back[0], density[1] * back[1]];
            let moved = [
                before[0] * self.leave[0] * on[1],
                before[1] * self.leave[1] * on[0],
            ];
            let stood_still = [before[0] * stay[0] * on[0], before[1] * stay[1] * on[1]];
            let all = moved[0] + moved[1] + stood_still[0] + stood_still[1];
            for i in 0..2 {
                left[i] += moved[i] / all;
                stood[i] += stood_still[i] / all;
            }
            back = [
                stay[0] * on[0] + self.leave[0] * on[1],
                stay[1] * on[1] + self.leave[1] * on[0],
            ];
            let scale = back[0].max(back[1]).max(f64::MIN_POSITIVE);
            back = back.map(|b| b / scale);
        }
        let level = sums.map(|s| s.amounts());
        let explained: f64 = sums.iter().map(PairSums::explained).sum();
        let rate = |i: usize| (left[i] / (left[i] + stood[i])).clamp(1e-6, 0.5);
        let next = Self {
            level,
            leave: [rate(0), rate(1)],
            variance: ((seen.power() - explained) / rows).max(f64::MIN_POSITIVE),
        };
        Step { likelihood, next }
    }
}
