//! What a campaign says: counts, one for each row of its table.

use std::collections::BTreeMap;
use std::fmt;

use crate::score::{Outcome, ParameterScore, Score};
use crate::truth::Kind;
use crate::twin::mistaken;

/// Above it a cause should be found.
pub(crate) const VISIBLE: f64 = 8.0;
/// Edges of the bins of SNR.
pub(crate) const BINS: [f64; 9] = [3.0, 5.0, 8.0, 12.0, 20.0, 40.0, 80.0, 150.0, 300.1];

/// So many of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Share {
    /// That are so.
    pub hits: usize,
    /// Of how many.
    pub of: usize,
}

impl Share {
    /// Counts.
    pub fn count<T>(all: impl IntoIterator<Item = T>, so: impl Fn(T) -> bool) -> Self {
        all.into_iter().fold(Self::default(), |share, one| Self {
            hits: share.hits + usize::from(so(one)),
            of: share.of + 1,
        })
    }

    /// As a fraction; NaN of nothing.
    #[must_use]
    pub fn fraction(&self) -> f64 {
        self.hits as f64 / self.of as f64
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.of == 0 {
            return f.write_str("none drawn");
        }
        let percent = 100.0 * self.fraction();
        write!(f, "{percent:.1} % ({}/{})", self.hits, self.of)
    }
}

/// Scores of a campaign, with the questions asked of them.
pub struct Summary<'a> {
    /// Those that count.
    pub scores: Vec<&'a Score>,
}

fn right(score: &Score) -> bool {
    matches!(
        score.outcomes.first(),
        Some(Outcome::First | Outcome::Group)
    )
}

fn motion(score: &Score) -> bool {
    score.truth.hidden.iter().any(|h| h.motion)
}

fn visible(score: &Score) -> bool {
    score.snr().is_some_and(|snr| snr >= VISIBLE)
}

impl<'a> Summary<'a> {
    /// Of these scores.
    pub fn new(scores: impl Iterator<Item = &'a Score>) -> Self {
        Self {
            scores: scores.collect(),
        }
    }

    fn kind(&self, kind: Kind) -> impl Iterator<Item = &'a Score> + '_ {
        let all = self.scores.iter().copied();
        all.filter(move |s| s.truth.kind == kind)
    }

    /// One textbook cause that can be seen.
    fn seen(&self, kind: Kind) -> impl Iterator<Item = &'a Score> + '_ {
        self.kind(kind).filter(|s| visible(s))
    }

    /// Right name first.
    #[must_use]
    pub fn first(&self, kind: Kind) -> Share {
        Share::count(self.seen(kind), |s| s.outcomes == [Outcome::First])
    }

    /// Share of right names first that the best namer can expect, at most; NaN of nothing. A low pass far above the signals is a
    /// delay to anybody: who knows how often each is hidden takes one for the other with a probability that the distance of the two
    /// sets ([`crate::Twin`]). Every other cause counts as named rightly, so this bounds the share from above.
    #[must_use]
    pub fn first_at_most(&self, kind: Kind) -> f64 {
        let right = self.seen(kind).map(|s| {
            let twin = &s.truth.hidden[0].twin;
            1.0 - twin.as_ref().map_or(0.0, mistaken)
        });
        let (sum, count) = right.fold((0.0, 0.0), |(sum, count), p| (sum + p, count + 1.0));
        sum / count
    }

    /// Right name first, or in a declared group of two.
    #[must_use]
    pub fn group(&self, kind: Kind) -> Share {
        Share::count(self.seen(kind), right)
    }

    /// A wrong sensor cause named, beside the right one or in its place.
    #[must_use]
    pub fn wrong(&self) -> Share {
        let cases = self.seen(Kind::One).chain(self.seen(Kind::Wild));
        Share::count(cases, |s| !s.wrong.is_empty())
    }

    /// Recordings with nothing hidden: a sensor cause named.
    #[must_use]
    pub fn false_alarms(&self) -> Share {
        Share::count(self.kind(Kind::Nothing), |s| !s.wrong.is_empty())
    }

    /// Recordings with nothing hidden: something left unexplained.
    #[must_use]
    pub fn nothing_unexplained(&self) -> Share {
        Share::count(self.kind(Kind::Nothing), |s| s.unexplained)
    }

    /// Recordings with nothing hidden and a still axis: motion named.
    #[must_use]
    pub fn imagined_motion(&self) -> Share {
        let still = self.kind(Kind::Nothing);
        let still = still.filter(|s| s.truth.vibration_rad.is_none());
        Share::count(still, |s| !s.motions.is_empty())
    }

    /// A line of vibration or cogging, or broadband vibration with nothing hidden, called a sensor error.
    #[must_use]
    pub fn motion_blamed(&self) -> Share {
        let hidden = self.kind(Kind::One).chain(self.kind(Kind::Wild));
        let hidden = hidden.filter(|s| motion(s));
        let broad = self.kind(Kind::Nothing);
        let broad = broad.filter(|s| s.truth.vibration_rad.is_some());
        Share::count(hidden.chain(broad), |s| !s.wrong.is_empty())
    }

    /// Vibration or cogging that can be seen, named so.
    #[must_use]
    pub fn motion_named(&self) -> Share {
        let cases = self.seen(Kind::One).chain(self.seen(Kind::Wild));
        Share::count(cases.filter(|s| motion(s)), |s| {
            s.outcomes[0] <= Outcome::Later
        })
    }

    /// Latency and graduation error, right name or group.
    #[must_use]
    pub fn against_reference(&self) -> Share {
        let cases = self.seen(Kind::One).filter(|s| {
            let name = &s.truth.hidden[0].name;
            name == "latency" || name == "graduation_error"
        });
        Share::count(cases, right)
    }

    /// A cause outside the library that is given a name: a sensor's, or motion's where the axis does not vibrate.
    #[must_use]
    pub fn strangers_named(&self) -> Share {
        Share::count(self.kind(Kind::Stranger), |s| {
            !s.wrong.is_empty() || (!s.motions.is_empty() && s.truth.vibration_rad.is_none())
        })
    }

    /// Strangers of which something was said: left unexplained.
    #[must_use]
    pub fn strangers_seen(&self) -> Share {
        Share::count(self.kind(Kind::Stranger), |s| s.unexplained)
    }

    /// Two causes, both named.
    #[must_use]
    pub fn both(&self) -> Share {
        Share::count(self.kind(Kind::Two), |s| {
            s.outcomes.iter().all(|o| *o <= Outcome::Later)
        })
    }

    /// Parameters of what can be seen and was named rightly.
    fn parameters(&self) -> Vec<ParameterScore> {
        let seen = self.seen(Kind::One);
        seen.flat_map(|s| s.parameters.clone()).collect()
    }

    /// Standard deviation over the Cramér–Rao bound, by the middle half of the errors; and how many.
    #[must_use]
    pub fn spread(&self) -> (f64, usize) {
        let mut errors: Vec<f64> = self
            .parameters()
            .iter()
            .filter_map(|p| p.bound.map(f64::abs))
            .collect();
        (median(&mut errors) / 0.674_489_75, errors.len())
    }

    /// 95 % intervals that hold the truth.
    #[must_use]
    pub fn coverage(&self) -> Share {
        held(&self.parameters())
    }

    /// The same, of every cause that has its name, however many there are.
    #[must_use]
    pub(crate) fn intervals(&self) -> Share {
        let all = self.scores.iter().flat_map(|s| s.parameters.clone());
        held(&all.collect::<Vec<_>>())
    }

    /// Median of the share of systematic position error that is removed, of electrical causes that can be seen; of how
    /// many.
    #[must_use]
    pub fn removed(&self) -> (f64, usize) {
        let mut shares: Vec<f64> = self
            .seen(Kind::One)
            .filter_map(|s| s.position.map(|[before, after]| 1.0 - after / before))
            .collect();
        (median(&mut shares), shares.len())
    }

    /// Median wall-clock time of a diagnosis, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        let mut seconds: Vec<f64> = self.scores.iter().map(|s| s.seconds).collect();
        median(&mut seconds)
    }

    /// Right name or group by bins of SNR.
    #[must_use]
    pub fn efficiency(&self, kind: Kind) -> Vec<Share> {
        let within =
            |s: &Score, bin: &[f64]| s.snr().is_some_and(|snr| snr >= bin[0] && snr < bin[1]);
        BINS.windows(2)
            .map(|bin| Share::count(self.kind(kind).filter(|s| within(s, bin)), right))
            .collect()
    }

    /// SNR at which half are found: a logistic curve in the logarithm, by maximum likelihood.
    #[must_use]
    pub fn half_found(&self) -> Option<f64> {
        let cases: Vec<(f64, f64)> = self
            .kind(Kind::One)
            .filter_map(|s| Some((s.snr()?.ln(), f64::from(right(s)))))
            .collect();
        // Upper end of the curve is what is found of all that is plain to see.
        let plain = cases.iter().filter(|(x, _)| *x > 40f64.ln());
        let (found, count) = plain.fold((0.0, 0.0), |(f, c), (_, y)| (f + y, c + 1.0));
        let most = (found + 0.5) / (count + 1.0);
        let likelihood = |half: f64, slope: f64| -> f64 {
            let each = cases.iter().map(|(x, y)| {
                let p: f64 = most / (1.0 + (-slope * (x - half)).exp());
                let p = p.clamp(1e-9, 1.0 - 1e-9);
                y * p.ln() + (1.0 - y) * (1.0 - p).ln()
            });
            each.sum()
        };
        let grid = (0..=120).flat_map(|i| (1..=24).map(move |j| (i, j)));
        let best = grid
            .map(|(i, j)| {
                let half = 1.0 + f64::from(i) * 0.03;
                (half, likelihood(half, f64::from(j) * 0.5))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        (cases.len() >= 20).then(|| best.0.exp())
    }

    /// What came first by what was hidden, of single causes that can be seen.
    #[must_use]
    pub fn confusion(&self) -> BTreeMap<String, BTreeMap<String, usize>> {
        let mut table = BTreeMap::<String, BTreeMap<String, usize>>::new();
        for kind in [Kind::One, Kind::Wild, Kind::Stranger] {
            for score in self.seen(kind) {
                let mut shown = score.first.clone();
                if score.outcomes[0] == Outcome::Group {
                    shown += " (group)";
                }
                let row = table.entry(score.truth.hidden[0].name.clone());
                *row.or_default().entry(shown).or_default() += 1;
            }
        }
        table
    }
}

/// 95 % intervals that hold the truth.
fn held(all: &[ParameterScore]) -> Share {
    Share::count(all, |p| p.stated.abs() < 1.96)
}

/// Median; NaN of nothing.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => (values[n / 2 - 1] + values[n / 2]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::truth::{HiddenCause, Truth, Twin};

    fn score(name: &str, snr: f64, distance: Option<f64>) -> Score {
        let twin = distance.map(|distance| Twin {
            distance,
            odds: 1.0,
        });
        Score {
            truth: Truth {
                seed: 1,
                kind: Kind::One,
                hidden: vec![HiddenCause {
                    name: name.into(),
                    brings: vec![],
                    snr_asked: snr,
                    snr,
                    twin,
                    magnitude: 1e-6,
                    parameters: vec![],
                    motion: false,
                    electrical: true,
                }],
                samples: 20_000,
                drive: "reversing".into(),
                vibration_rad: None,
                reference: false,
                noise: 1e-3,
                bits: 14,
                rate: 1e5,
            },
            outcomes: vec![Outcome::Group],
            first: "channel_skew".into(),
            wrong: vec![],
            motions: vec![],
            unexplained: false,
            signature: String::new(),
            parameters: vec![],
            position: None,
            seconds: 1.0,
        }
    }

    #[test]
    fn what_nobody_can_tell_apart_is_half_of_it_named_rightly() {
        let at_most = |scores: &[Score]| Summary::new(scores.iter()).first_at_most(Kind::One);
        let other = || score("saturation", 50.0, None);
        let near = |distance| score("bandwidth_mismatch", 50.0, Some(distance));
        assert!(at_most(&[]).is_nan());
        assert!((at_most(&[other()]) - 1.0).abs() < 1e-12);
        assert!((at_most(&[near(0.0)]) - 0.5).abs() < 1e-9);
        assert!((at_most(&[near(40.0)]) - 1.0).abs() < 1e-12);
        // What is too weak does not count.
        let weak = score("latency", 5.0, Some(0.1));
        let mean = at_most(&[other(), near(0.0), near(2.0), weak]);
        assert!(
            (mean - (1.0 + 0.5 + 0.841_345) / 3.0).abs() < 1e-6,
            "{mean}"
        );
    }
}
