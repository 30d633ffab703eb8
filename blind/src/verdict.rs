//! The diagnosis, which sees the file and nothing else.

use nonius_diagnosis::{Chip, diagnose};
use nonius_recording::{Overrides, Recording};

/// A cause that was named.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its name.
    pub cause: String,
    /// What it cannot be told from.
    pub confounded_with: Vec<String>,
    /// Name, value, standard error.
    pub parameters: Vec<(String, f64, f64)>,
    /// It is said to be real motion.
    pub motion: bool,
}

impl Named {
    /// The name is among those given.
    #[must_use]
    pub fn holds(&self, name: &str) -> bool {
        self.cause == name || self.confounded_with.iter().any(|c| c == name)
    }
}

/// What the diagnosis says.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What it found, in its order.
    pub named: Vec<Named>,
    /// Something significant is left without a name.
    pub unexplained: bool,
    /// What it says of that.
    pub signature: String,
    /// Positions, periods.
    pub positions: Vec<f64>,
    /// Wall-clock time that it took, s.
    pub seconds: f64,
}

/// Asks the diagnosis about a recording.
///
/// # Errors
/// Where it refuses the recording, with its words.
pub fn verdict(csv: &str) -> Result<Verdict, String> {
    let recording = Recording::read_from(csv.as_bytes(), "blind", &Overrides::default())
        .map_err(|e| e.to_string())?;
    let started = std::time::Instant::now();
    let found = diagnose(&recording).map_err(|e| e.to_string())?;
    Ok(Verdict {
        named: found
            .findings
            .into_iter()
            .map(|f| Named {
                cause: f.cause.to_string(),
                confounded_with: f.confounded_with.iter().map(|c| c.to_string()).collect(),
                parameters: f
                    .parameters
                    .into_iter()
                    .map(|p| (p.name, p.value, p.std_error))
                    .collect(),
                motion: f.chip == Chip::NotASensorError,
            })
            .collect(),
        unexplained: found.unexplained.significant,
        signature: found.unexplained.signature,
        positions: found.positions,
        seconds: started.elapsed().as_secs_f64(),
    })
}
