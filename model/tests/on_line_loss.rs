//! Loss of signal and return to it, at every sample from the first of the loss on: what it does to the parameters.

mod chip_support;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use chip_support::shipped::variants::{Variant, searches};
use chip_support::{Bench, largest, sensor_of};
use nonius_model::bits::Bits;
use nonius_model::spec::Spec;
use rayon::prelude::*;

/// Samples of a period of travel.
const PERIOD: u32 = 151;

/// What is lost, how, and how it comes back.
#[derive(Clone, Copy, Debug)]
struct Loss {
    /// Share of the cosine and of the sine that is lost.
    lost: [f64; 2],
    /// Samples that it takes to fade, and to come back.
    fade: [u32; 2],
    /// The scale moves all the time, or stands still until the signal is back.
    moves: bool,
}

/// Samples without a signal.
const AWAY: u32 = 3000;
/// Periods of travel that are watched after the signal is back.
const AFTER: u32 = 120;

impl Loss {
    fn samples(&self) -> u32 {
        self.fade[0] + AWAY + self.fade[1]
    }

    /// What is left of the signals at sample `k` of it.
    fn left(&self, k: u32) -> [f64; 2] {
        let back = self.fade[0] + AWAY;
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
struct Seen {
    /// Largest miscalibration in the hundred periods before, radians.
    before: f64,
    /// The same from the first sample of the loss to the end.
    worst: f64,
    /// The same from when the signal is back as it was.
    after: f64,
    /// In the last ten periods.
    end: f64,
    /// Periods of travel from the return until it stays below twice what it was before.
    back: u32,
}

/// A chip that has calibrated for 300 periods of travel.
#[derive(Clone)]
struct Settled<F> {
    bench: Bench,
    signals: F,
    /// Samples, and travel.
    samples: u32,
    turns: f64,
    /// The parameters, their miscalibration, and the largest in the last hundred periods.
    theta: [Bits; 5],
    now: f64,
    before: f64,
}

fn settled(spec: &Spec, seed: u32) -> Settled<impl Fn(f64) -> (f64, f64) + Clone + use<>> {
    // What is not calibrated would hide the rest.
    let beta = if spec.calibration.has_phase() {
        5.0
    } else {
        0.0
    };
    let bench = Bench::new(spec, u64::from(seed));
    let mut all = Settled {
        theta: linear(&bench),
        bench,
        signals: sensor_of(seed, beta),
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

impl<F: Fn(f64) -> (f64, f64)> Settled<F> {
    /// The miscalibration where it may have changed.
    fn look(&mut self, k: u32) {
        if k.is_multiple_of(PERIOD) || linear(&self.bench) != self.theta {
            self.theta = linear(&self.bench);
            self.now = largest(&self.bench.miscalibration_at(72, &self.signals));
        }
    }
}

/// Loses the signal and watches it come back.
fn watch<F: Fn(f64) -> (f64, f64) + Clone>(settled: &Settled<F>, loss: Loss) -> Seen {
    let mut all = settled.clone();
    let back = all.samples + loss.samples();
    let end = back + AFTER * PERIOD;
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
        all.bench.step((left_c * c, left_s * s));
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

/// Periods of travel that a signal fades over, and comes back over.
const FADES: [u32; 3] = [3, 10, 33];

/// Both channels, or one.
const CHANNELS: [[f64; 2]; 3] = [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];

/// The worst that a loss of both channels, or of either, does to a search.
fn worst_of(spec: &Spec) -> impl Fn([u32; 2], bool) -> Seen {
    let settled: Vec<_> = (0..)
        .zip(CHANNELS)
        .map(|(i, lost)| (settled(spec, 3 * i), lost))
        .collect();
    move |fade, moves| {
        let seen = settled.iter().map(|(from, lost)| {
            watch(
                from,
                Loss {
                    lost: *lost,
                    fade,
                    moves,
                },
            )
        });
        seen.reduce(|a, b| Seen {
            before: a.before.max(b.before),
            worst: a.worst.max(b.worst),
            after: a.after.max(b.after),
            end: a.end.max(b.end),
            back: a.back.max(b.back),
        })
        .expect("there are channels")
    }
}

const HEAD: &str = "\
# Loss of signal and return

Written by `model/tests/on_line_loss.rs`; do not edit. Largest miscalibration, mrad, from the first sample of the loss to 120 periods
of travel after the return, whatever is lost (both channels, the cosine, the sine), for the optical design with every search: lost
at once, in motion and at standstill; faded over parts of a period and over periods of travel, and back in the same time. *Before* is the
largest in the hundred periods before. *Left*: of the fades over periods, and of one of 100 periods and an abrupt return, from when the
signal is back as it was; *without recall*: the same of the chip with `calibration.recall = false`. *Back*: without recall the signal is
followed in the fade of 100 periods as if the sensor had changed; the periods of travel until the miscalibration stays below twice what it was.

| search | parameters | before | at once | standing | 1/3 period | 3 | 10 | 33 | left: 3 | 10 | 33 | 100 | without recall: 3 | 10 | 33 | back, periods |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-model --test on_line_loss";

/// A loss within a third of a period, or at standstill, leaves the parameters where they were, but for their own noise. Fades of
/// three to 33 periods, which for some of the way are small changes of amplitude like any, and of a hundred leave nothing either once
/// the signal is back. Without recall they leave less than a tenth of a per cent of a period, and it goes away; after one of a hundred
/// lock comes back and the calibration too.
#[test]
fn the_signal_goes_and_comes_back() {
    let rows: Vec<String> = searches().par_iter().map(row).collect();
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/loss-of-signal.md");
    let page = format!("{HEAD}{}", rows.concat());
    nonius_kept::near(Path::new(file), &page, |x| 0.1 * x.abs() + 0.02, HOW);
}

/// A search's row of the page, and whether it holds.
fn row(variant: &Variant) -> String {
    let parameters = variant.spec.calibration.parameters;
    let name = format!("{}, {parameters}", variant.what);
    let worst = worst_of(&variant.spec);
    let at_once = worst([0, 0], true);
    let standing = worst([0, 0], false);
    let third = worst([PERIOD / 3; 2], true);
    let longer = FADES.map(|n| worst([n * PERIOD; 2], true));
    let longest = worst([100 * PERIOD, 0], true);
    println!("{name}: {at_once:?} {standing:?} {third:?} {longer:?} {longest:?}");
    for seen in [at_once, standing, third] {
        assert!(seen.worst < 1.5 * seen.before + 2e-4, "{name}: {seen:?}");
    }
    for seen in longer.iter().chain([&longest]) {
        assert!(seen.after < 1.5 * seen.before, "{name}: {seen:?}");
    }
    let mut forgetful = variant.clone();
    forgetful.spec.calibration.recall = Some(false);
    let forgetful = worst_of(&forgetful.spec);
    let followed = FADES.map(|n| forgetful([n * PERIOD; 2], true));
    let slow = forgetful([100 * PERIOD, 0], true);
    println!("{name}, no recall: {followed:?} {slow:?}");
    for seen in longer.iter().chain(&followed) {
        assert!(seen.worst < 1e-3 * TAU, "{name}: {seen:?}");
    }
    for seen in followed.iter().chain([&slow]) {
        assert!(seen.end < 2.0 * seen.before + 5e-4, "{name}: {seen:?}");
    }
    let mut row = format!(
        "| {} | {parameters} | {:.2} |",
        variant.what,
        1e3 * at_once.before
    );
    for seen in [at_once, standing, third].iter().chain(&longer) {
        _ = write!(row, " {:.2} |", 1e3 * seen.worst);
    }
    for seen in longer.iter().chain([&longest]).chain(&followed) {
        _ = write!(row, " {:.2} |", 1e3 * seen.after);
    }
    _ = writeln!(row, " {} |", slow.back);
    row
}
