//! How often a recording is looked at anew. What is known is followed until its numbers rest; where they only go to and fro, as something
//! large beside it has no name yet, that has to join first.

use crate::finding::Cause;
use crate::select::selection::Accepted;

/// Most times that a recording is looked at anew.
const MOST: usize = 16;
/// Most times for the same causes, unless each time less is left than before.
const ALIKE: usize = 6;
/// Share of the power to which it has to fall for that.
const LESS: f64 = 0.99;
/// Share by which two powers are the same.
const SAME: f64 = 1e-3;

/// For what a look may end, and another one begin.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Anew {
    /// Whenever the tangents do not do.
    Always,
    /// The same, once a cause has joined: those that are known have been followed as far as they go.
    OnceOneJoins,
    /// For nothing: it is the last.
    Never,
}

impl Anew {
    /// Whether it may end for causes that do not rest, of which one has `joined` in this look or none.
    pub(crate) fn with(self, joined: bool) -> bool {
        match self {
            Self::Always => true,
            Self::OnceOneJoins => joined,
            Self::Never => false,
        }
    }
}

/// Looks so far.
#[derive(Default, Debug)]
pub(crate) struct Rounds {
    begun: usize,
    over: bool,
    /// Causes of the last look, and how many looks had the same.
    names: Vec<Cause>,
    alike: usize,
    /// Least power that was left with them, and that of the last two looks.
    least: f64,
    last: [f64; 2],
}

impl Rounds {
    /// One more look, and what it may end for.
    pub(crate) fn begin(&mut self) -> Anew {
        self.begun += 1;
        if self.over || self.begun >= MOST {
            Anew::Never
        } else if self.alike > ALIKE {
            Anew::OnceOneJoins
        } else {
            Anew::Always
        }
    }

    /// The next look is the last.
    pub(crate) fn end(&mut self) {
        self.over = true;
    }

    /// With these causes it went astray: of the same ones as before the tangents have to do until another one joins, of others they have to
    /// do from now on.
    pub(crate) fn went_astray(&mut self, known: &[Accepted]) {
        if names(known) == self.names && self.alike <= ALIKE {
            self.alike = ALIKE + 1;
        } else {
            self.over = true;
        }
    }

    /// Whether to go on from what is known now, by the power that it leaves: of numbers that go to and fro, those that leave least.
    pub(crate) fn goes_on(&mut self, known: &[Accepted], power: f64) -> bool {
        let names = names(known);
        if names != self.names {
            (self.names, self.alike, self.least) = (names, 1, power);
            self.last = [power, 0.0];
            return true;
        }
        if power < LESS * self.least {
            self.alike = 0;
        }
        self.alike += 1;
        let is = |other: f64| (power - other).abs() < SAME * power;
        if is(self.last[1]) && !is(self.last[0]) {
            // To and fro: no other look says more.
            self.alike = ALIKE + 1;
        }
        self.last = [power, self.last[0]];
        let is_least = power * LESS <= self.least;
        self.least = self.least.min(power);
        self.alike <= ALIKE || is_least
    }
}

fn names(known: &[Accepted]) -> Vec<Cause> {
    known.iter().map(|one| one.candidate.name).collect()
}
