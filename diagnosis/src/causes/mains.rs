//! The mains: where a line is likelier than anywhere else, so that less of it tells.

/// Frequencies of the mains of this world, Hz.
const MAINS: [f64; 2] = [50.0, 60.0];
/// Highest harmonic: a rectifier of three phases ripples at the sixth and the twelfth.
const TOP: u32 = 12;
/// Share by which the mains may be off (EN 50160: one hundredth in 99.5 % of a year).
const OFF: f64 = 0.01;

/// From where to where its harmonics may be, Hz.
pub(crate) fn places() -> impl Iterator<Item = [f64; 2]> {
    let all = MAINS.into_iter();
    let all = all.flat_map(|f| (1..=TOP).map(move |harmonic| f * f64::from(harmonic)));
    all.map(|f| [f * (1.0 - OFF), f * (1.0 + OFF)])
}

/// Trials of a line at a frequency of the mains: as many as such frequencies can be told apart in so many seconds, and twice that,
/// for the mains has half of all that may be named by chance. `None` at any other frequency.
pub(crate) fn trials(hertz: f64, seconds: f64) -> Option<f64> {
    let off = 0.5 / seconds;
    let mut inside = places().filter(|[low, high]| (low - off..=high + off).contains(&hertz));
    inside.next()?;
    let many: f64 = places()
        .map(|[low, high]| (high - low) * seconds + 1.0)
        .sum();
    Some(2.0 * many)
}

#[cfg(test)]
mod tests {
    use super::trials;

    #[test]
    fn the_mains_has_few_frequencies_and_a_long_recording_tells_more_of_them() {
        assert_eq!(trials(331.0, 0.1), None);
        assert_eq!(trials(61.0, 10.0), None);
        let (short, long) = (trials(50.2, 0.1), trials(50.2, 100.0));
        assert!(
            short.is_some_and(|t| (48.0..100.0).contains(&t)),
            "{short:?}"
        );
        assert!(long.is_some_and(|t| t > 10_000.0), "{long:?}");
        assert_eq!(trials(600.0, 10.0), trials(59.9, 10.0));
    }
}
