//! Several causes in one recording: which, and how large.

use rand::{Rng, rngs::StdRng, seq::IndexedRandom};

use crate::effects::{CATALOGUE, Entry};

/// So many causes, at least and at most.
pub(crate) const COUNT: std::ops::RangeInclusive<usize> = 3..=5;
/// Each cause by itself has an SNR from the first to the second, evenly in the logarithm.
const SNR: [f64; 2] = [10.0, 300.0];
/// Where one of a row is there, no recording shows how much of another one is.
const ALIKE: [&[&str]; 5] = [
    &[
        "even_nonlinearity",
        "odd_nonlinearity",
        "spatial_harmonic",
        "saturation",
    ],
    &["channel_skew", "bandwidth_mismatch"],
    &["latency", "common_bandwidth"],
    &["stuck_bit", "coarse_quantisation", "adc_nonlinearity"],
    &["offset_drift", "gain_drift", "flicker_noise"],
];

/// Three to five causes of the catalogue with the SNR of each, the first one by turns; whether each is as the world draws it.
pub(crate) fn plan(turn: u64, random: &mut StdRng) -> Vec<(&'static Entry, bool, f64)> {
    let count = random.random_range(COUNT);
    let mut chosen = vec![&CATALOGUE[(turn % CATALOGUE.len() as u64) as usize]];
    while chosen.len() < count {
        let next = CATALOGUE.choose(random).expect("a catalogue");
        if chosen.iter().all(|other| !alike(other.name, next.name)) {
            chosen.push(next);
        }
    }
    let each = chosen.into_iter().map(|entry| {
        let wild = entry.wild && random.random_bool(0.5);
        let snr = SNR[0] * (SNR[1] / SNR[0]).powf(random.random());
        (entry, wild, snr)
    });
    each.collect()
}

fn alike(one: &str, other: &str) -> bool {
    let both = |row: &&[&str]| row.contains(&one) && row.contains(&other);
    one == other || ALIKE.iter().any(both)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn no_two_of_a_plan_are_alike() {
        let mut random = StdRng::seed_from_u64(1);
        for turn in 0..500 {
            let plan = plan(turn, &mut random);
            assert!(COUNT.contains(&plan.len()));
            for (k, (entry, wild, snr)) in plan.iter().enumerate() {
                assert!(!wild || entry.wild);
                assert!((SNR[0]..=SNR[1]).contains(snr));
                let others = plan[..k].iter().map(|p| p.0.name);
                assert!(others.into_iter().all(|other| !alike(other, entry.name)));
            }
        }
    }

    #[test]
    fn names_of_the_rows_are_of_the_catalogue() {
        for name in ALIKE.iter().flat_map(|row| row.iter()) {
            assert!(CATALOGUE.iter().any(|e| e.name == *name), "{name}");
        }
    }
}
