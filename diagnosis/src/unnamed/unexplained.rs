//! What no cause explains, in words: how large it is, where it shows, and what it looks like.

use nonius_quantity::{Quantity, Unit};
use serde::Serialize;

use crate::causes::Catalogue;
use crate::causes::candidate::Domain;
use crate::finding::{Cause, Finding};
use crate::model::{Fit, System};
use crate::numerics::statistics::by_chance;
use crate::select::beside::Beside;
use crate::select::score::SHOWN;
use crate::unnamed::whereabouts::Left;

/// What no cause explains.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unexplained {
    /// p < 0.001 after all trials.
    pub significant: bool,
    /// The smallest.
    pub p_value: f64,
    /// Where it lives and what it looks like.
    pub signature: String,
    /// The same, a sentence for each part.
    #[serde(skip)]
    pub parts: Vec<String>,
}

impl Unexplained {
    /// Nothing, beside these findings.
    pub(crate) fn nothing(beside: &[Finding]) -> Self {
        let codes_err = beside.iter().any(|f| f.cause.errs_in_codes());
        let signature = if codes_err {
            "nothing significant is left: the residue is noise and what codes that err leave"
        } else {
            "nothing significant is left: the residue is noise"
        };
        Self::not_significant(signature)
    }

    /// Not looked for: there are too few samples.
    pub(crate) fn not_looked_for() -> Self {
        Self::not_significant("what is left was not looked at: there are too few samples")
    }

    fn not_significant(signature: &str) -> Self {
        Self {
            significant: false,
            p_value: 1.0,
            signature: signature.into(),
            parts: vec![],
        }
    }

    pub(crate) fn add(&mut self, log_p: f64, sentence: String) {
        self.parts.push(sentence);
        self.signature = self.parts.join("; ");
        self.significant = true;
        self.p_value = self.p_value.min(log_p.exp());
    }
}

/// What cannot be named.
#[derive(Clone, Debug, Default)]
pub(crate) struct Unnamed {
    pub(crate) log_p: f64,
    /// Gain in log-likelihood of the shape that is nearest to it.
    pub(crate) gain: f64,
    pub(crate) what: What,
}

/// What is said of it.
#[derive(Clone, Debug)]
pub(crate) enum What {
    /// An error that lives in a domain; a line at so many hertz. What looks most like it, and why it is not that.
    Error(Domain, Option<f64>, String),
    /// A sentence.
    Said(String),
}

impl What {
    /// The sentence, or what it looks like where the sentence needs a residual.
    pub(crate) fn said(&self) -> String {
        match self {
            Self::Said(sentence) | Self::Error(_, _, sentence) => sentence.clone(),
        }
    }
}

impl Default for What {
    fn default() -> Self {
        Self::Said(String::new())
    }
}

impl Unnamed {
    /// The domain of an error that is no line of its own: what is said of it is all that is known of the domain.
    pub(crate) fn domain(&self) -> Option<Domain> {
        match self.what {
            What::Error(domain, None, _) => Some(domain),
            What::Error(..) | What::Said(_) => None,
        }
    }

    /// The sentence; `noise` is that of a sample in amplitudes.
    pub(crate) fn sentence(&self, left: &Left, noise: f64) -> String {
        let (domain, hertz, likeness) = match &self.what {
            What::Said(sentence) => return sentence.clone(),
            What::Error(domain, hertz, likeness) => (*domain, hertz, likeness),
        };
        let place = left.place(domain);
        let samples: f64 = left.context.weight.iter().sum();
        // In white noise, of what its log-likelihood says.
        let likely = noise * (self.gain.max(0.0) / samples.max(1.0)).sqrt();
        let size = place.rms.unwrap_or(likely);
        let size = Quantity::rounded(size, 2, Unit::Percent).brief();
        let hertz = hertz.map_or_else(String::new, |f| {
            let f = Quantity::rounded(f, 4, Unit::Prefixed("Hz"));
            format!(", {}", f.brief())
        });
        let (does, place) = (does(domain), place.text);
        format!("an error of {size} of the amplitude rms {does}{hertz}{place}; {likeness}")
    }
}

/// What an error of a domain does.
fn does(domain: Domain) -> &'static str {
    match domain {
        Domain::Angle => "repeats with the scale period",
        Domain::Code => "depends on the ADC code",
        Domain::Speed => "depends on the speed",
        Domain::Time => "changes slowly with time",
        Domain::Line => "has a fixed frequency",
        Domain::Revolution => "repeats with the revolution",
        Domain::Motion => "is faster than the motion's spline follows",
    }
}

/// What it looks like, but is not.
pub(crate) fn like(nearest: Cause, but: &str) -> String {
    format!("nearest likeness: {}, but {but}", nearest.plain())
}

/// Why a name that explains this share of an error is none.
pub(crate) fn explains_only(share: f64) -> String {
    format!("it explains only {:.0} % of it", share.max(0.0) * 100.0)
}

/// Domains in which something significant is left that no cause was found for.
pub(crate) fn leftover(
    system: &System,
    catalogue: &Catalogue,
    fit: &Fit,
    closed: &[Domain],
) -> Vec<Unnamed> {
    let beside = Beside::new(&system.total, &system.sure(&fit.shapes));
    let open = [
        Domain::Angle,
        Domain::Speed,
        Domain::Time,
        Domain::Revolution,
    ];
    let tell = |domain: Domain| {
        let (gain, freedom) = beside.gain(&system.sure(catalogue.basis(domain)));
        let log_p = by_chance(gain, 1.0, freedom, 40.0);
        (log_p < SHOWN.ln()).then(|| Unnamed {
            log_p,
            gain,
            what: What::Error(
                domain,
                None,
                "no cause of the catalogue looks like it".into(),
            ),
        })
    };
    let left = open.into_iter().filter(|d| !closed.contains(d));
    left.filter_map(tell).collect()
}
