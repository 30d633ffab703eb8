//! Whitening: what the noise keeps from sample to sample is predicted and taken off, from data and shapes alike.

/// Order of the prediction: enough for slopes of the spectrum, too short to swallow a line.
const ORDER: usize = 6;

/// A linear prediction of noise from its past.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Whitener {
    coefficients: Vec<f64>,
    /// Rms of what cannot be predicted.
    pub sigma: f64,
}

impl Whitener {
    /// From a residual, by the autocorrelation method (Levinson and Durbin).
    #[must_use]
    pub(crate) fn of(residual: &[f64]) -> Self {
        let n = residual.len();
        let correlation: Vec<f64> = (0..=ORDER)
            .map(|lag| {
                let pairs = residual.iter().zip(&residual[lag.min(n)..]);
                pairs.map(|(a, b)| a * b).sum::<f64>() / n as f64
            })
            .collect();
        if correlation[0].is_nan() || correlation[0] <= 0.0 {
            return Self {
                coefficients: vec![],
                sigma: f64::MIN_POSITIVE.sqrt(),
            };
        }
        let mut error = correlation[0];
        let mut a: Vec<f64> = vec![];
        for m in 0..ORDER {
            let predicted: f64 = (0..m).map(|i| a[i] * correlation[m - i]).sum();
            let reflection = (correlation[m + 1] - predicted) / error;
            let old = a.clone();
            for i in 0..m {
                a[i] = old[i] - reflection * old[m - 1 - i];
            }
            a.push(reflection);
            error *= 1.0 - reflection * reflection;
        }
        Self {
            coefficients: a,
            sigma: error.max(1e-300).sqrt(),
        }
    }

    /// The unpredictable part in units of its rms.
    #[must_use]
    pub(crate) fn apply(&self, values: &[f64]) -> Vec<f64> {
        (0..values.len())
            .map(|k| {
                let past = self.coefficients.iter().enumerate().take(k);
                let predicted: f64 = past.map(|(i, a)| a * values[k - 1 - i]).sum();
                (values[k] - predicted) / self.sigma
            })
            .collect()
    }
}
