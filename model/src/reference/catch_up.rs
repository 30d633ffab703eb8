//! What the loop sees while it catches up with a stop or a start is no error of the sensor. The paper has nothing of the kind.
//!
//! The chip guards its search before γ has settled, too, and bounds the phase error that its completion learns from; this reference, which
//! shows what the paper does, does neither.

/// When the loop catches up: such a sample teaches nothing. Where two periods of travel one after the other have one, that is not what it
/// is, and all teach until a period has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatchUp {
    /// From so many halvings of γ on.
    pub settled: u32,
    /// |e| from which on it does, radians.
    pub e: f64,
    /// A period that has one is dropped where it ends.
    pub drops: bool,
}

/// The loop was far behind the axis: in the running period of travel, in the one before, in two and more before this.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Behind {
    running: bool,
    before: bool,
    long: bool,
}

/// What a sample is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// One in which the loop catches up.
    pub catches_up: bool,
    /// The end of a period that had one.
    pub ends_so: bool,
}

impl Behind {
    /// Takes a sample that is `far` behind or not, and may be the end of a period; without lock nothing is travelled.
    #[must_use]
    pub fn step(&mut self, far: bool, ends: bool, locked: bool) -> Seen {
        let running = self.running || far;
        let seen = Seen {
            catches_up: far && !self.long,
            ends_so: ends && running && !self.long,
        };
        let (before, long) = if ends {
            (running, running && self.before)
        } else {
            (self.before, self.long)
        };
        *self = Self {
            running: locked && running && !ends,
            before: locked && before,
            long: locked && long,
        };
        seen
    }
}
