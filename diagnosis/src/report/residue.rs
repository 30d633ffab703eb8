//! Whether what is left is white noise.

use nonius_plot::{Axis, Look, Plot, Series};

use crate::diagnose::Diagnosis;
use crate::left::Bartlett;

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

impl Residue {
    /// Of what the extended model leaves along the radius; along the circle, the motion takes a part of any noise.
    pub(super) fn of(found: &Diagnosis) -> Self {
        let rate = found.context.rate;
        let [before, after] = [0, 1].map(|i| Bartlett::of(&found.residuals[i].0));
        let m = after.shares.len().max(1);
        let even = |i: usize| (i + 1) as f64 / m as f64;
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
                Series::new("five parameters", Look::BeforeLine, points(&before.shares)),
                Series::new("extended", Look::AfterLine, points(&after.shares)),
            ],
            marks: vec![],
            round: false,
        };
        Self {
            distance: after.distance,
            p_value: after.p_value,
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
