//! The causes of the catalogue, as physics has them, each as the textbook draws it and as the world does.

mod circuits;
mod converter;
mod data;
mod law;
mod lines;
mod motions;
mod noises;
mod slow;
mod statics;
mod turning;

use rand::rngs::StdRng;

pub(crate) use law::Law;
pub(crate) use statics::shares;

use crate::effect::Effect;
use crate::world::World;

/// How a name of the catalogue is drawn.
pub(crate) struct Entry {
    /// Its name in `docs/diagnosis.md`.
    pub(crate) name: &'static str,
    /// It needs a reference column.
    pub(crate) reference: bool,
    /// It needs to know the revolution.
    pub(crate) revolution: bool,
    /// It has a waveform that is not the textbook's.
    pub(crate) wild: bool,
    /// It is electrical and changes what position is shown: removing it can be measured.
    pub(crate) electrical: bool,
    /// Draws one.
    pub(crate) draw: fn(&mut Draw) -> Box<dyn Effect>,
}

/// What drawing needs.
pub(crate) struct Draw<'a> {
    /// Source of everything random.
    pub(crate) random: &'a mut StdRng,
    /// The experiment.
    pub(crate) world: &'a World,
    /// As the world draws it, not the textbook.
    pub(crate) wild: bool,
    /// SNR that it will be scaled to.
    pub(crate) snr: f64,
}

const fn entry(name: &'static str, draw: fn(&mut Draw) -> Box<dyn Effect>) -> Entry {
    Entry {
        name,
        reference: false,
        revolution: false,
        wild: true,
        electrical: false,
        draw,
    }
}

impl Entry {
    const fn electrical(mut self) -> Self {
        self.electrical = true;
        self
    }
    const fn textbook_only(mut self) -> Self {
        self.wild = false;
        self
    }
    const fn of_revolution(mut self) -> Self {
        self.revolution = true;
        self
    }
    const fn of_reference(mut self) -> Self {
        self.reference = true;
        self
    }
}

/// Every name that can be hidden. Offset, gain and phase error are in every recording.
pub(crate) const CATALOGUE: [Entry; 29] = [
    entry("even_nonlinearity", statics::even).electrical(),
    entry("odd_nonlinearity", statics::odd).electrical(),
    entry("spatial_harmonic", statics::harmonic).electrical(),
    entry("saturation", statics::saturation).electrical(),
    entry("adc_nonlinearity", converter::nonlinearity).electrical(),
    entry("stuck_bit", converter::stuck_bit).textbook_only(),
    entry("coarse_quantisation", converter::coarse),
    entry("channel_skew", circuits::skew)
        .electrical()
        .textbook_only(),
    entry("bandwidth_mismatch", circuits::mismatch).electrical(),
    entry("common_bandwidth", circuits::common).electrical(),
    entry("latency", circuits::latency)
        .of_reference()
        .textbook_only(),
    entry("ac_coupling", circuits::ac_coupling)
        .electrical()
        .textbook_only(),
    entry("interference", lines::interference).electrical(),
    entry("amplitude_ripple", lines::ripple),
    entry("offset_drift", slow::offset).electrical(),
    entry("gain_drift", slow::gain).electrical(),
    entry("runout", turning::runout).of_revolution(),
    entry("graduation_error", turning::graduation)
        .of_revolution()
        .of_reference(),
    entry("contamination", turning::contamination).of_revolution(),
    entry("glitches", data::glitches),
    entry("dropped_samples", data::dropped).textbook_only(),
    entry("repeated_samples", data::repeated),
    entry("clock_jitter", noises::jitter).textbook_only(),
    entry("flicker_noise", noises::flicker),
    entry("amplitude_noise", noises::amplitude),
    entry("hysteresis", slow::hysteresis).electrical(),
    entry("delayed_crosstalk", circuits::crosstalk)
        .electrical()
        .textbook_only(),
    entry("vibration", motions::vibration),
    entry("cogging", motions::cogging).of_revolution(),
];
