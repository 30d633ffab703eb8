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
    /// From a residual whose frequencies below `gone` (cycles per sample) were taken off with the motion: there the noise
    /// is taken to be what it is just above, for a hole in the spectrum must not be amplified. Autocorrelation method
    /// (Levinson and Durbin).
    #[must_use]
    pub(crate) fn of(residual: &[f64], gone: f64) -> Self {
        let n = residual.len();
        let (mut power, length) = crate::lines::spectrum(residual);
        let index = |f: f64| ((f * length as f64).ceil() as usize).min(power.len() - 1);
        let (first, last) = (index(gone), index((2.0 * gone).min(0.5)));
        if first > 0 && last > first {
            let level = power[first..last].iter().sum::<f64>() / (last - first) as f64;
            power[..first].iter_mut().for_each(|p| *p = level);
        }
        // Back to the autocorrelation: the spectrum is even.
        let correlation: Vec<f64> = (0..=ORDER)
            .map(|lag| {
                let wave =
                    |k: usize| (std::f64::consts::TAU * (k * lag) as f64 / length as f64).cos();
                let ends = power[0] + power[power.len() - 1] * wave(power.len() - 1);
                let inner: f64 = (1..power.len() - 1).map(|k| 2.0 * power[k] * wave(k)).sum();
                (ends + inner) / length as f64 / n as f64
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
