//! Tail probabilities.

use statrs::function::gamma::{checked_gamma_ur, ln_gamma};

/// ln of the probability that χ² of `freedom` degrees exceeds `value`.
pub(crate) fn log_tail(value: f64, freedom: usize) -> f64 {
    if value <= 0.0 || freedom == 0 {
        return 0.0;
    }
    let (a, x) = (freedom as f64 / 2.0, value / 2.0);
    if x > a + 60.0 {
        return -x + (a - 1.0) * x.ln() - ln_gamma(a);
    }
    checked_gamma_ur(a, x).map_or(0.0, |q| q.max(1e-300).ln())
}

/// A probability after so many trials.
pub(crate) fn after_trials(log_p: f64, trials: f64) -> f64 {
    (log_p + trials.max(1.0).ln()).min(0.0)
}

/// ln of the probability that so many numbers explain so much log-likelihood by chance, after so many trials, where noise has so many
/// times the variance of white noise alone in them.
pub(crate) fn by_chance(gain: f64, inflation: f64, freedom: usize, trials: f64) -> f64 {
    after_trials(log_tail(2.0 * gain / inflation, freedom), trials)
}

/// Log-likelihood that so many free numbers explain of noise alone at most: two standard deviations above the mean.
pub(crate) fn at_most_of_noise(freedom: usize) -> f64 {
    let freedom = freedom as f64;
    freedom / 2.0 + 2.0 * (2.0 * freedom).sqrt()
}

/// Log-likelihood that a free number has to be worth among so many samples (Bayesian information criterion).
pub(crate) fn price(samples: f64) -> f64 {
    0.5 * samples.ln()
}

#[cfg(test)]
mod tests {
    use super::{by_chance, log_tail};

    #[test]
    fn inflated_noise_explains_more_by_chance() {
        assert!((by_chance(20.0, 1.0, 2, 1.0) + 20.0).abs() < 1e-9);
        assert!((by_chance(20.0, 4.0, 2, 1.0) + 5.0).abs() < 1e-9);
    }

    #[test]
    fn tails_agree_with_tables() {
        assert!((log_tail(3.841_459, 1).exp() - 0.05).abs() < 1e-6);
        assert!((log_tail(13.276_704, 4).exp() - 0.01).abs() < 1e-6);
        let (near, far) = (log_tail(2.0 * 61.9, 4), log_tail(2.0 * 62.1, 4));
        assert!((near - far - 0.2).abs() < 0.05, "{near} {far}");
    }
}
