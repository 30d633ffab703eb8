//! What a caller may show while it waits.

/// A step of a package begins or goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The Verilog is written.
    Generating,
    /// The chip is simulated on a slow sweep.
    Simulating,
    /// So many starts from power-up are ahead.
    Starting {
        /// How many.
        starts: usize,
    },
    /// One of them is done.
    Started,
    /// Promises are looked for that every sensor locks with.
    Remedying,
    /// Vectors, waves and report are made.
    Writing,
}

/// Who listens. Several starts may report at once.
pub type Progress<'a> = &'a (dyn Fn(Event) + Sync);

/// Listens to nothing.
pub fn silent(_: Event) {}
