//! What a hidden cause does: a hook at each stage between axis and file.

use crate::rows::Rows;
use crate::world::World;

/// The world at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct At {
    /// Seconds.
    pub(crate) t: f64,
    /// Angle that the head sees, radians of the scale period.
    pub(crate) alpha: f64,
    /// Angle of the revolution, radians.
    pub(crate) phi: f64,
    /// What the drive does, rad/s.
    pub(crate) speed: f64,
    /// And rad/s².
    pub(crate) acceleration: f64,
}

/// The pair of some time ago, added to the pair of now.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Echo {
    /// How long ago, s.
    pub(crate) delay: f64,
    /// Share of the old sin in cos, and of the old cos in sin.
    pub(crate) share: [f64; 2],
}

/// A circuit with memory, in amplitudes, on a grid finer than the samples.
pub(crate) trait Circuit {
    /// Output after the input has gone on to `pair` within `dt` seconds.
    fn step(&mut self, dt: f64, at: &At, pair: [f64; 2]) -> [f64; 2];
}

/// A cause of magnitude `m`; nothing happens at zero. Each hook is one stage, in the order of the signal.
pub(crate) trait Effect: Send + Sync {
    /// Its name.
    fn name(&self) -> &'static str;

    /// The largest magnitude that makes sense.
    fn limit(&self) -> f64;

    /// Magnitudes to choose among, where they are not continuous.
    fn choices(&self) -> Option<Vec<f64>> {
        None
    }

    /// Parameters by the words of `findings.json`, and whether value over SNR bounds the standard error.
    fn parameters(&self, _m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        vec![]
    }

    /// Real motion, rad.
    fn motion(&self, _m: f64, _t: f64, _phi: f64) -> f64 {
        0.0
    }

    /// Error of the scale that both channels see, rad.
    fn scale(&self, _m: f64, _at: &At) -> f64 {
        0.0
    }

    /// Light, field and amplifiers: without memory, in amplitudes.
    fn channels(&self, _m: f64, _at: &At, pair: [f64; 2]) -> [f64; 2] {
        pair
    }

    /// Coupling from an earlier time.
    fn echo(&self, _m: f64) -> Option<Echo> {
        None
    }

    /// A circuit with memory, and the seconds before the recording that it remembers.
    fn circuit(&self, _m: f64, _world: &World) -> Option<(Box<dyn Circuit>, f64)> {
        None
    }

    /// Sampled later than sample `k` says, s.
    fn late(&self, _m: f64, _channel: usize, _k: usize) -> f64 {
        0.0
    }

    /// Noise of a sample, in amplitudes, given the channel without it.
    fn noise(&self, _m: f64, _channel: usize, _k: usize, _u: f64) -> f64 {
        0.0
    }

    /// What the ADC adds to the voltage of sample `k`, both in LSB from the middle, given the sample before.
    fn transfer(&self, _m: f64, _channel: usize, _k: usize, _x: f64, _before: [f64; 2]) -> f64 {
        0.0
    }

    /// What becomes of a code.
    fn code(&self, _m: f64, _channel: usize, code: i64) -> i64 {
        code
    }

    /// It is the code that changes: without rounding and noise there is nothing to see.
    fn works_on_codes(&self) -> bool {
        false
    }

    /// What happens to the samples on their way to the file.
    fn damage(&self, _m: f64, _rows: &mut Rows, _world: &World) {}

    /// For what is noise: SNR²/2 is the expected gain in log-likelihood.
    fn noise_snr(&self, _m: f64, _world: &World) -> Option<f64> {
        None
    }

    /// The reference column goes along with it, and tells nothing of it.
    fn takes_reference_along(&self) -> bool {
        self.is_motion()
    }

    /// Whether what follows comes a sample earlier or later.
    fn moves_time(&self) -> bool {
        false
    }

    /// Whether low passes make both channels late together: that is motion to anybody who does not know it.
    fn delays_both(&self) -> bool {
        false
    }

    /// Other names of the catalogue that are true of it: low passes of both channels, not the same, are a mismatch and one in common.
    fn brings(&self) -> &'static [&'static str] {
        &[]
    }

    /// The low pass of a delay, or the delay of a low pass. `motion_known`: a reference shows which of the channels is late, not only
    /// that one is later than the other.
    fn twins(&self, _motion_known: bool) -> Option<Twins> {
        None
    }

    /// Whether it is real motion of the axis.
    fn is_motion(&self) -> bool {
        false
    }
}

/// A delay and the low pass that does nearly the same, or the other way round.
pub(crate) struct Twins {
    /// The hidden cause by its own magnitude. Where the motion is not known, late in the channel in which the other one is late: both
    /// channels may come earlier then, which the tangents of the SNR would take for a change of the radius.
    pub(crate) own: Box<dyn Effect>,
    /// The one of another name.
    pub(crate) other: Box<dyn Effect>,
    /// Magnitude of the other over that of the hidden one where both delay slow signals alike.
    pub(crate) alike: f64,
}

/// A hidden cause with its magnitude.
pub(crate) type Hidden<'a> = (&'a dyn Effect, f64);
