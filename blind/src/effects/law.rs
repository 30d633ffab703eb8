//! A cause without memory: a law between the channels before and after.

use crate::effect::{At, Effect};
use crate::world::World;

type Channels = Box<dyn Fn(f64, &At, [f64; 2]) -> [f64; 2] + Send + Sync>;
type Parameters = Box<dyn Fn(f64) -> Vec<(&'static str, f64, bool)> + Send + Sync>;

/// A law of the channels.
pub(crate) struct Law {
    name: &'static str,
    limit: f64,
    channels: Channels,
    parameters: Option<Parameters>,
}

impl Law {
    /// Of magnitudes up to `limit`: magnitude, state and pair, in amplitudes, to pair.
    pub(crate) fn new(
        name: &'static str,
        limit: f64,
        channels: impl Fn(f64, &At, [f64; 2]) -> [f64; 2] + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            limit,
            channels: Box::new(channels),
            parameters: None,
        }
    }

    /// With parameters that the textbook knows, if this is the textbook's form.
    pub(crate) fn with(
        mut self,
        textbook: bool,
        parameters: impl Fn(f64) -> Vec<(&'static str, f64, bool)> + Send + Sync + 'static,
    ) -> Self {
        if textbook {
            self.parameters = Some(Box::new(parameters));
        }
        self
    }

    pub(crate) fn boxed(self) -> Box<dyn Effect> {
        Box::new(self)
    }
}

impl Effect for Law {
    fn name(&self) -> &'static str {
        self.name
    }
    fn limit(&self) -> f64 {
        self.limit
    }
    fn channels(&self, m: f64, at: &At, pair: [f64; 2]) -> [f64; 2] {
        (self.channels)(m, at, pair)
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        self.parameters.as_ref().map_or(vec![], |p| p(m))
    }
}
