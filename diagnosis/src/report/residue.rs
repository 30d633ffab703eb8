//! Whether what is left is white noise.

use nonius_plot::{Axis, Look, Plot, Series};
use nonius_quantity::{Unit, prefixed};

use super::words::probability;
use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding};
use crate::select::score::SHOWN;
use crate::unnamed::left::Bartlett;

/// Points of the plot.
const POINTS: usize = 400;

/// Bartlett's test of the cumulated spectrum of the radial residual: for white noise it rises evenly.
pub(super) struct Residue {
    /// How it differs from white noise.
    words: String,
    /// Of a difference as large as this in white noise.
    p_value: f64,
    /// What is named and makes it another.
    made_by: Option<String>,
    plot: Plot,
}

impl Residue {
    /// Of what the extended model leaves along the radius; along the circle, the motion takes a part of any noise.
    pub(super) fn of(found: &Diagnosis) -> Self {
        let rate = found.context.rate;
        let (unit, factor) = prefixed(rate / 2.0, Unit::Prefixed("Hz"));
        let highest = factor * rate / 2.0;
        let [before, after] = [0, 1].map(|i| Bartlett::of(&found.residuals[i].0));
        let m = after.shares.len().max(1);
        let even = |i: usize| (i + 1) as f64 / m as f64;
        let per = m.div_ceil(POINTS).max(1);
        let points = |shares: &[f64]| -> Vec<[f64; 2]> {
            let all = shares.iter().enumerate().step_by(per);
            all.map(|(i, s)| [even(i) * highest, *s]).collect()
        };
        let plot = Plot {
            title: "Cumulative spectrum of the radial residual".into(),
            x: Axis::linear(&format!("frequency, {unit}"), [0.0, highest]),
            y: Axis::linear("share of the power below that frequency", [0.0, 1.0]),
            series: vec![
                Series::new("white noise", Look::Model, vec![[0.0, 0.0], [highest, 1.0]]),
                Series::new("five parameters", Look::BeforeLine, points(&before.shares)),
                Series::new("extended", Look::AfterLine, points(&after.shares)),
            ],
            marks: vec![],
            round: false,
        };
        Self {
            words: after.words(rate),
            p_value: after.p_value,
            made_by: made_by(&found.findings),
            plot,
        }
    }

    /// The plot.
    pub(super) fn plot(&self) -> &Plot {
        &self.plot
    }

    /// A sentence with the number of the test.
    pub(super) fn sentence(&self) -> String {
        let p = probability(self.p_value);
        if self.p_value < SHOWN {
            let made_by = self.made_by.as_deref();
            let made_by = made_by.map_or(String::new(), |cause| format!(", as {cause} makes it"));
            format!(
                "The radial residual is not white: {} (Bartlett's test, {p}){made_by}",
                self.words
            )
        } else {
            format!(
                "The radial residual cannot be told from white noise (Bartlett's test of its spectrum: {p})"
            )
        }
    }
}

/// What of the findings stays in what is left and is no white noise.
fn made_by(findings: &[Finding]) -> Option<String> {
    let stays = |f: &&Finding| f.cause == Cause::FlickerNoise || f.cause.errs_in_codes();
    findings.iter().find(stays).map(|f| f.cause.plain())
}
