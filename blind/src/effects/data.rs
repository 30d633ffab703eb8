//! What happens to samples between ADC and file.

use rand::{Rng, seq::index};

use super::Draw;
use crate::effect::Effect;
use crate::rows::Rows;
use crate::world::World;

/// How far off a glitch is at the least, in noise: one that is no further is noise.
const FAR: f64 = 8.0;

/// Samples far off.
struct Glitches {
    /// Sample, channel and size in units of the magnitude (V).
    hits: Vec<(usize, usize, f64)>,
}

impl Effect for Glitches {
    fn name(&self) -> &'static str {
        "glitches"
    }
    fn limit(&self) -> f64 {
        0.7
    }
    fn damage(&self, m: f64, rows: &mut Rows, world: &World) {
        let lsb = world.lsb();
        for (k, channel, size) in &self.hits {
            let value = &mut rows.volts[*channel][*k];
            *value = (*value + ((m * size) / lsb).round() * lsb).clamp(-1.0, 1.0 - lsb);
        }
    }
}

/// One sample each; wild: the next one rings.
pub(crate) fn glitches(draw: &mut Draw) -> Box<dyn Effect> {
    let most = ((draw.snr / FAR).powi(2) as usize).clamp(1, 12);
    let count = draw.random.random_range(1..=most);
    let mut hits = vec![];
    for k in index::sample(draw.random, draw.world.samples - 4, count) {
        let channel = draw.random.random_range(0..2);
        let sign = if draw.random.random() { 1.0 } else { -1.0 };
        let size = sign * draw.random.random_range(1.0..1.5);
        hits.push((k + 1, channel, size));
        if draw.wild {
            hits.push((k + 2, channel, -0.4 * size));
        }
    }
    Box::new(Glitches { hits })
}

/// Sets of places, each from the last to the first, not at the ends: which set is the magnitude.
struct Sets(Vec<Vec<usize>>);

impl Sets {
    fn draw(draw: &mut Draw, most: usize) -> Self {
        let samples = draw.world.samples;
        let set = |_| {
            let count = draw.random.random_range(1..=most);
            let mut places: Vec<usize> =
                index::sample(draw.random, samples - samples / 10, count).into_vec();
            for place in &mut places {
                *place += samples / 20;
            }
            places.sort_unstable_by(|a, b| b.cmp(a));
            places
        };
        Self((0..24).map(set).collect())
    }

    fn limit(&self) -> f64 {
        self.0.len() as f64
    }

    fn choices(&self) -> Vec<f64> {
        (1..=self.0.len()).map(|k| k as f64).collect()
    }

    /// The places of magnitude `m`; none for 0.
    fn chosen(&self, m: f64) -> &[usize] {
        let set = (m as usize).checked_sub(1).and_then(|k| self.0.get(k));
        set.map_or(&[], Vec::as_slice)
    }
}

/// What happens to the sample at a place.
#[derive(Clone, Copy)]
enum Fate {
    /// It is lost; a time base that is a clock shows the gap.
    Dropped { clock: bool },
    /// It is shown twice, and what follows comes later.
    Doubled,
    /// It is shown again in the place of the next one, and the time base goes on as it should.
    Held,
}

/// Samples that are missing or too many; the magnitude, less one, is the number of the set of places.
struct Slips {
    sets: Sets,
    fate: Fate,
}

impl Effect for Slips {
    fn name(&self) -> &'static str {
        match self.fate {
            Fate::Dropped { .. } => "dropped_samples",
            Fate::Doubled | Fate::Held => "repeated_samples",
        }
    }
    fn takes_reference_along(&self) -> bool {
        self.moves_time()
    }
    fn moves_time(&self) -> bool {
        !matches!(self.fate, Fate::Held)
    }
    fn limit(&self) -> f64 {
        self.sets.limit()
    }
    fn choices(&self) -> Option<Vec<f64>> {
        Some(self.sets.choices())
    }
    fn damage(&self, m: f64, rows: &mut Rows, _world: &World) {
        for k in self.sets.chosen(m) {
            match self.fate {
                Fate::Dropped { clock } => rows.drop_sample(*k, clock),
                Fate::Doubled => rows.double(*k),
                Fate::Held => rows.hold(*k),
            }
        }
    }
}

pub(crate) fn dropped(draw: &mut Draw) -> Box<dyn Effect> {
    let sets = Sets::draw(draw, 4);
    // Most loggers count; some have a clock and show the gap.
    let clock = draw.random.random_bool(0.3);
    Box::new(Slips {
        sets,
        fate: Fate::Dropped { clock },
    })
}

/// Wild: held.
pub(crate) fn repeated(draw: &mut Draw) -> Box<dyn Effect> {
    let sets = Sets::draw(draw, 12);
    let fate = if draw.wild { Fate::Held } else { Fate::Doubled };
    Box::new(Slips { sets, fate })
}
