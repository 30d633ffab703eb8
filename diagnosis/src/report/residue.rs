//! Whether what is left is white noise.

use nonius_plot::{Axis, Look, Plot, Series};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::diagnose::Diagnosis;

/// Probability below which it is said not to be.
const SHOWN: f64 = 1e-3;
/// Points of the plot.
const POINTS: usize = 400;

/// Bartlett's test of the cumulated spectrum of the radial residual: for white noise it rises evenly.
pub(super) struct Residue {
    /// Largest distance from the even rise.
    distance: f64,
    /// Of a distance as large as this in white noise.
    p_value: f64,
    plot: Plot,
}

/// Probability that the supremum of a Brownian bridge exceeds x (Kolmogorov).
fn kolmogorov(x: f64) -> f64 {
    if x < 0.2 {
        return 1.0;
    }
    let term = |j: i32| {
        let sign = if j % 2 == 1 { 1.0 } else { -1.0 };
        sign * (-2.0 * f64::from(j * j) * x * x).exp()
    };
    (2.0 * (1..=20).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

/// Shares of the power of values up to each line of their spectrum.
fn cumulated(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mut buffer: Vec<Complex<f64>> = values.iter().map(|v| Complex::new(*v, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(n).process(&mut buffer);
    let mut sum = 0.0;
    let mut shares: Vec<f64> = buffer[1..n.div_ceil(2)]
        .iter()
        .map(|z| {
            sum += z.norm_sqr();
            sum
        })
        .collect();
    shares
        .iter_mut()
        .for_each(|s| *s /= sum.max(f64::MIN_POSITIVE));
    shares
}

impl Residue {
    /// Of what the extended model leaves along the radius; along the circle, the motion takes a part of any noise.
    pub(super) fn of(found: &Diagnosis) -> Self {
        let rate = found.context.rate;
        let [before, after] = [0, 1].map(|i| cumulated(&found.residuals[i].0));
        let m = after.len().max(1);
        let even = |i: usize| (i + 1) as f64 / m as f64;
        let off = after.iter().enumerate().map(|(i, s)| (s - even(i)).abs());
        let distance = off.fold(0.0, f64::max);
        let per = m.div_ceil(POINTS).max(1);
        let points = |shares: &[f64]| -> Vec<[f64; 2]> {
            let all = shares.iter().enumerate().step_by(per);
            all.map(|(i, s)| [even(i) * rate / 2.0, *s]).collect()
        };
        let plot = Plot {
            title: "Power of the radial residual up to a frequency".into(),
            x: Axis::linear("frequency, Hz", [0.0, rate / 2.0]),
            y: Axis::linear("share of the power", [0.0, 1.0]),
            series: vec![
                Series::new(
                    "white noise",
                    Look::Model,
                    vec![[0.0, 0.0], [rate / 2.0, 1.0]],
                ),
                Series::new("five parameters", Look::BeforeLine, points(&before)),
                Series::new("extended", Look::AfterLine, points(&after)),
            ],
            marks: vec![],
            round: false,
        };
        Self {
            distance,
            p_value: kolmogorov(distance * (m as f64).sqrt()),
            plot,
        }
    }

    /// The plot.
    pub(super) fn plot(&self) -> &Plot {
        &self.plot
    }

    /// A sentence with the number of the test.
    pub(super) fn sentence(&self) -> String {
        let (distance, p) = (self.distance, self.p_value);
        let verdict = if p < SHOWN {
            "is not white"
        } else {
            "cannot be told from white noise"
        };
        format!(
            "The radial residual {verdict}: its cumulated spectrum is off an even rise by {distance:.4} at most (Bartlett's test: p = {p:.2e})"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kolmogorovs_distribution_agrees_with_tables() {
        assert!((kolmogorov(1.358_1) - 0.05).abs() < 1e-4);
        assert!((kolmogorov(1.949_5) - 0.001).abs() < 1e-5);
        assert!((kolmogorov(0.5) - 0.963_9).abs() < 1e-4);
    }
}
