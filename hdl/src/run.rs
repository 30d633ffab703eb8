//! What one simulator said about a chip.

use serde::Serialize;

use crate::process::Output;
use crate::tools::{Found, Tool};
use crate::verdict::Verdict;

/// One stimulus of the testbench.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct StimulusResult {
    /// Name of the stimulus and of its file in `vectors/`.
    pub name: String,
    /// Whether every probe held in every sample.
    pub passed: bool,
    /// Samples compared, where the testbench says so (`PASS ramp: 20 samples`).
    pub samples: Option<u64>,
    /// The rest of the line: on failure the first differing signal, its sample, the expected
    /// and the actual value.
    pub detail: String,
}

/// One run of the testbench in one simulator.
#[derive(Clone, Debug, Serialize)]
pub struct Run {
    /// The simulator.
    pub tool: Tool,
    /// Its version.
    pub version: String,
    /// Whether everything held. See [`failure`](Run::failure).
    pub passed: bool,
    /// What did not hold, with the end of the output.
    pub failure: Option<String>,
    /// Every warning of compiler and simulator.
    pub warnings: Vec<String>,
    /// Every stimulus in the order of the testbench.
    pub stimuli: Vec<StimulusResult>,
    /// Samples compared in all, if every stimulus says how many.
    pub samples: Option<u64>,
    /// Time to compile.
    pub build_seconds: f64,
    /// Time to simulate.
    pub seconds: f64,
}

impl Run {
    /// The compiler did not accept the Verilog.
    pub(crate) fn refused(
        found: &Found,
        trouble: &str,
        built: &Output,
        warnings: Vec<String>,
    ) -> Run {
        Run {
            tool: found.tool,
            version: found.version(),
            passed: false,
            failure: Some(format!("the compiler {trouble}\n{}", built.tail())),
            warnings,
            stimuli: Vec::new(),
            samples: None,
            build_seconds: built.seconds,
            seconds: 0.0,
        }
    }

    /// The testbench ran.
    pub(crate) fn judged(
        found: &Found,
        built: &Output,
        mut warnings: Vec<String>,
        simulated: &Output,
        verdict: Verdict,
    ) -> Run {
        warnings.extend(verdict.warnings);
        Run {
            tool: found.tool,
            version: found.version(),
            passed: verdict.failure.is_none(),
            failure: verdict.failure,
            warnings,
            samples: verdict.stimuli.iter().map(|it| it.samples).sum(),
            stimuli: verdict.stimuli,
            build_seconds: built.seconds,
            seconds: simulated.seconds,
        }
    }
}
