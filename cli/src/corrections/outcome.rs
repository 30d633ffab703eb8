//! What the design does about findings: switched on, left out, or more than it can hold.

use nonius_diagnosis::{Chip, Diagnosis};

/// A sentence about findings.
pub(crate) struct Outcome {
    sentence: String,
    /// Which findings, by their place in the list.
    findings: Vec<usize>,
    /// The chip of this design can do it.
    possible: bool,
}

impl Outcome {
    /// Done, or left out for a reason that does not lie with the design.
    pub(super) fn said(sentence: String, findings: Vec<usize>) -> Self {
        Self {
            sentence,
            findings,
            possible: true,
        }
    }

    /// The design cannot hold it.
    pub(super) fn impossible(sentence: String, findings: Vec<usize>) -> Self {
        Self {
            possible: false,
            ..Self::said(sentence, findings)
        }
    }

    /// The sentence.
    pub(crate) fn sentence(&self) -> &str {
        &self.sentence
    }

    /// Tells the findings, so that `findings.json` and the report say what the design does and not what another one could.
    pub(crate) fn tell(&self, found: &mut Diagnosis) {
        for &k in &self.findings {
            let finding = &mut found.findings[k];
            finding.design.push(self.sentence.clone());
            if !self.possible {
                finding.chip = Chip::CannotCorrect;
            }
        }
    }
}
