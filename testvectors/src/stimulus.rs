//! Named stimuli: what the testbench plays.

use nonius_model::design::Design;

use crate::plant::{Codes, Plant};
use crate::ties::Ties;
use crate::{fades, limits, motions};

/// What arrives with one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// ADC code of the cosine channel.
    pub cos: i64,
    /// ADC code of the sine channel.
    pub sin: i64,
    /// Zero preset.
    pub preset: bool,
    /// Calibration on.
    pub calibrate: bool,
}

/// A named sequence of samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stimulus {
    /// Name of its vector file.
    pub name: String,
    /// The samples.
    pub samples: Vec<Sample>,
}

/// What the ADC says at each sample.
type Played = fn(&Plant, usize) -> Codes;

/// The stimuli in the order of their vectors, but for those that are searched or drawn.
const NAMED: [(&str, Played); 18] = [
    ("standstill", motions::standstill),
    ("forwards", motions::forwards),
    ("backwards", motions::backwards),
    ("sweep", motions::sweep),
    ("creep", motions::creep),
    ("loss", fades::loss),
    ("fade", fades::fade),
    ("vanish", fades::vanish),
    ("early", fades::early),
    ("weak", fades::weak),
    ("step", fades::step),
    ("corners", limits::corners),
    ("bounds", limits::bounds),
    ("drift", fades::drift),
    ("jolts", motions::jolts),
    ("reversals", motions::reversals),
    ("small", limits::small),
    ("smaller", limits::smaller),
];

/// All named stimuli, `rows` samples each, from one seed.
#[must_use]
pub fn named(design: &Design, rows: usize) -> Vec<Stimulus> {
    let plant = Plant::new(design, rows);
    let stimulus = |name: &str, samples: Vec<Sample>| Stimulus {
        name: name.into(),
        samples,
    };
    let played = |codes: Played| -> Vec<Sample> {
        let each = (0..rows).map(|k| sample(&plant, k, codes(&plant, k)));
        each.collect()
    };
    let motion = |name: &str, codes: Played| stimulus(name, played(codes));
    let mut all: Vec<Stimulus> = NAMED
        .iter()
        .map(|(name, codes)| motion(name, *codes))
        .collect();
    let slow = played(motions::slow_turn);
    all.push(stimulus("ties", Ties::new(design).search(design, &slow)));
    let random = limits::random(&plant).into_iter().enumerate();
    let random = random.map(|(k, codes)| sample(&plant, k, codes));
    all.push(stimulus("random", random.collect()));
    if design.spec.calibration.has_bend() {
        all.push(motion("fast", motions::fast));
    }
    all
}

/// Codes with what the pins say at that sample.
fn sample(plant: &Plant, k: usize, (cos, sin): Codes) -> Sample {
    let rows = plant.rows;
    Sample {
        cos,
        sin,
        // The second one stands after every loss of lock.
        preset: k == rows / 3 || k == rows - rows / 8,
        calibrate: k % 701 > 3,
    }
}
