//! A chip that has settled loses its signal, and gets it back.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::spec::Spec;

use super::{Bench, largest, sensor_of};

/// Samples of a period of travel.
pub(crate) const PERIOD: u32 = 151;

/// What is lost, how, and how it comes back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loss {
    /// Share of the cosine and of the sine that is lost.
    pub(crate) lost: [f64; 2],
    /// Where a channel is that is lost, in units of the amplitude from the middle of the ADC's range.
    pub(crate) level: f64,
    /// Samples that it takes to fade, that there is no signal, and that it takes to come back.
    pub(crate) fade: [u32; 2],
    pub(crate) away: u32,
    /// The scale moves all the time, or stands still until the signal is back.
    pub(crate) moves: bool,
}

/// Periods of travel that are watched after the signal is back.
const AFTER: u32 = 120;

impl Loss {
    fn samples(&self) -> u32 {
        self.fade[0] + self.away + self.fade[1]
    }

    /// What is left of the signals at sample `k` of it.
    fn left(&self, k: u32) -> [f64; 2] {
        let back = self.fade[0] + self.away;
        let gone = if k < self.fade[0] {
            f64::from(k) / f64::from(self.fade[0])
        } else if k < back {
            1.0
        } else if k < back + self.fade[1] {
            1.0 - f64::from(k - back) / f64::from(self.fade[1])
        } else {
            0.0
        };
        self.lost.map(|share| 1.0 - share * gone)
    }
}

/// The linear parameters, to see when one moves.
fn linear(bench: &Bench) -> [Bits; 5] {
    let s = &bench.chip.state;
    [
        s.theta_1_deviation,
        s.theta_2_deviation,
        s.theta_3_deviation,
        s.theta_4_deviation,
        s.theta_9_deviation,
    ]
}

/// What a loss does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Largest miscalibration in the hundred periods before, radians.
    pub(crate) before: f64,
    /// The same from the first sample of the loss to the end.
    pub(crate) worst: f64,
    /// The same from when the signal is back as it was.
    pub(crate) after: f64,
    /// In the last ten periods.
    pub(crate) end: f64,
    /// Periods of travel from the return until it stays below twice what it was before.
    pub(crate) back: u32,
}

/// A chip that has calibrated for 300 periods of travel.
#[derive(Clone)]
pub(crate) struct Settled<F> {
    pub(crate) bench: Bench,
    pub(crate) signals: F,
    /// Share of the cosine and of the sine that it is to lose.
    pub(crate) lost: [f64; 2],
    /// Samples, and travel.
    pub(crate) samples: u32,
    pub(crate) turns: f64,
    /// The parameters, their miscalibration, and the largest in the last hundred periods.
    theta: [Bits; 5],
    now: f64,
    pub(crate) before: f64,
}

/// A sensor for a search.
pub(crate) fn sensor_for(spec: &Spec, signs: u32) -> impl Fn(f64) -> (f64, f64) + Clone + use<> {
    // What is not calibrated would hide the rest.
    let beta = if spec.calibration.has_phase() {
        5.0
    } else {
        0.0
    };
    sensor_of(signs, beta)
}

fn settled(
    spec: &Spec,
    lost: [f64; 2],
    seed: u32,
) -> Settled<impl Fn(f64) -> (f64, f64) + Clone + use<>> {
    let bench = Bench::new(spec, u64::from(seed));
    let mut all = Settled {
        theta: linear(&bench),
        bench,
        signals: sensor_for(spec, seed),
        lost,
        // At another place of the period each time.
        samples: 300 * PERIOD + 83 * seed % PERIOD,
        turns: 0.0,
        now: 0.0,
        before: 0.0,
    };
    for k in 0..all.samples {
        all.bench.step((all.signals)(TAU * all.turns));
        all.turns += 1.0 / f64::from(PERIOD);
        if k > all.samples - 100 * PERIOD {
            all.look(k);
            all.before = all.before.max(all.now);
        }
    }
    all
}

/// Both channels, or one.
const CHANNELS: [[f64; 2]; 3] = [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];

/// Chips of a search that have settled, each to lose a channel, or both.
pub(crate) fn each_settled(
    spec: &Spec,
) -> Vec<Settled<impl Fn(f64) -> (f64, f64) + Clone + use<>>> {
    let each = (0..).zip(CHANNELS);
    each.map(|(i, lost)| settled(spec, lost, 3 * i)).collect()
}

impl<F: Fn(f64) -> (f64, f64) + Clone> Settled<F> {
    /// So many samples later.
    pub(crate) fn moved(&self, samples: u32) -> Self {
        let mut later = self.clone();
        for _ in 0..samples {
            later.bench.step((later.signals)(TAU * later.turns));
            later.turns += 1.0 / f64::from(PERIOD);
        }
        later.samples += samples;
        later
    }

    /// The miscalibration where it may have changed.
    fn look(&mut self, k: u32) {
        if k.is_multiple_of(PERIOD) || linear(&self.bench) != self.theta {
            self.theta = linear(&self.bench);
            self.now = largest(&self.bench.miscalibration_at(72, &self.signals));
        }
    }
}

/// Loses the signal and watches it come back.
///
/// # Panics
///
/// Where the chip does not lock again.
pub(crate) fn watch<F: Fn(f64) -> (f64, f64) + Clone>(settled: &Settled<F>, loss: Loss) -> Seen {
    watch_for(settled, loss, AFTER)
}

/// The same, for so many periods of travel after the signal is back.
pub(crate) fn watch_for<F: Fn(f64) -> (f64, f64) + Clone>(
    settled: &Settled<F>,
    loss: Loss,
    after: u32,
) -> Seen {
    let mut all = settled.clone();
    let back = all.samples + loss.samples();
    let end = back + after * PERIOD;
    let mut seen = Seen {
        before: all.before,
        worst: 0.0,
        after: 0.0,
        end: 0.0,
        back: 0,
    };
    for k in all.samples..end {
        let (c, s) = (all.signals)(TAU * all.turns);
        let [left_c, left_s] = loss.left(k - all.samples);
        let gone = |share: f64| (1.0 - share) * loss.level;
        all.bench
            .step((left_c * c + gone(left_c), left_s * s + gone(left_s)));
        let speed = if loss.moves {
            1.0
        } else {
            (f64::from(k.saturating_sub(back + 500)) / 2000.0).min(1.0)
        };
        all.turns += speed / f64::from(PERIOD);
        all.look(k);
        seen.worst = seen.worst.max(all.now);
        if k >= back {
            seen.after = seen.after.max(all.now);
        }
        if k >= back && all.now > 2.0 * seen.before {
            seen.back = (k - back) / PERIOD + 1;
        }
        if k >= end - 10 * PERIOD {
            seen.end = seen.end.max(all.now);
        }
    }
    assert!(all.bench.chip.state.locked, "{loss:?}: no lock again");
    seen
}
