//! What is compared: each takes samples and says its angle and its Θ.

use nonius_model::design::Design;
use nonius_model::reference::baseline::{Baseline, OpenLoop};
use nonius_model::reference::completed::CompletedConfig;
use nonius_model::reference::extremes::PeriodExtremes;
use nonius_model::reference::gate::{Gate, Window};
use nonius_model::reference::gradient::Form;
use nonius_model::reference::interpolator::{Gamma, Search};
use nonius_model::reference::loops::{FilterType, LoopConfig, Method as LoopMethod};
use nonius_model::reference::poles::Poles;
use nonius_model::reference::recursive::StartConfig;
use nonius_model::reference::start::Start;
use nonius_model::reference::sum_of_squares::Smoothing;
use nonius_model::reference::{Config, Parameters, Reference, Sensor, Steps, Theta};

use super::on_chip::{self, OnChip};
use super::scenario::{IN_PHASE, SENSOR, SPEED};

/// Sample time, seconds.
const TS: f64 = 1e-6;

/// One row of the table.
pub(crate) enum Method {
    OpenLoop(OpenLoop),
    Paper(Parameters, Box<Reference>),
    Chip(Box<OnChip>),
}

/// What a method says of a sample: α̂ in radians and Θ before it, for signals of amplitude 1.
pub(crate) struct Said {
    pub(crate) alpha_hat: f64,
    /// What Θ means.
    pub(crate) set: Parameters,
    pub(crate) theta: Theta,
}

impl Method {
    /// Every method, with its name. The loop's ω0 is twice the signal frequency, so that the completion has something
    /// to see; γ starts at 0.04 and halves three times.
    pub(crate) fn all(design: &Design) -> Vec<(String, Self)> {
        let four = Parameters::Four;
        let nominal = Baseline::Fixed(four, four.nominal(1.0));
        let extremes = Baseline::Extremes(PeriodExtremes::new(1.0));
        let mut list = vec![
            (
                "arctangent".to_owned(),
                Self::OpenLoop(OpenLoop::new(nominal, TS)),
            ),
            (
                "extremes".to_owned(),
                Self::OpenLoop(OpenLoop::new(extremes, TS)),
            ),
        ];
        let mut add = |name: &str, set: Parameters, (search, completion), gate| {
            let name = format!("{name} {}", set_name(set));
            let settings = Config {
                completion,
                ..config(set, search, gate)
            };
            if let Ok(reference) = Reference::new(settings) {
                list.push((name, Self::Paper(set, Box::new(reference))));
            }
        };
        let travelled = Gate::Travelled(WINDOW);
        let squares = Search::SumOfSquares(Smoothing::Forgetting { lambda: 0.9 });
        let batch = Search::SumOfSquares(Smoothing::Batch { samples: 64 });
        for set in Parameters::ALL {
            for completion in [None, Some(COMPLETION)] {
                let with = completion.map_or("", |_| " completed,");
                let name = |search: &str| format!("sum of squares, {search},{with}");
                let add = &mut add;
                add(&name("lambda 0.9"), set, (squares, completion), travelled);
                add(&name("batch 64"), set, (batch, completion), travelled);
            }
        }
        let five = Parameters::Five;
        add(
            "residual, as printed,",
            five,
            (Search::Residual(Form::Final), None),
            Gate::EverySample,
        );
        for set in Parameters::ALL {
            let radius = Search::Residual(Form::Final);
            let exact = Search::Residual(Form::Exact);
            add("residual, final form,", set, (radius, None), travelled);
            add("residual, exact,", set, (exact, None), travelled);
            add("completed,", set, (radius, Some(COMPLETION)), travelled);
        }
        for (name, search, gamma) in [
            (
                "residual, equalised, five",
                Search::Residual(Form::Final),
                0.03,
            ),
            ("least-squares start, five", Search::Started(STARTED), 0.01),
        ] {
            let mut config = config(five, search, travelled);
            config.gamma = Gamma {
                first: equalised(gamma),
                halvings: 3,
                periods: 20.0,
                settled: None,
                waits: None,
            };
            if let Ok(reference) = Reference::new(config) {
                list.push((name.into(), Self::Paper(five, Box::new(reference))));
            }
        }
        let chips = on_chip::all(&design.spec);
        list.extend(chips.map(|(name, chip)| (name, Self::Chip(Box::new(chip)))));
        list
    }

    /// No loop and no search: the arctangent of the signals, or of what their extremes make of them.
    pub(crate) fn is_baseline(&self) -> bool {
        matches!(self, Self::OpenLoop(_))
    }

    /// The sensor that it meets: one that it can express.
    pub(crate) fn sensor(&self) -> Sensor {
        let in_phase = match self {
            Self::OpenLoop(_) => false,
            Self::Paper(set, _) => set.count() % 2 == 0,
            Self::Chip(chip) => !chip.design.structure.calibration.has_phase(),
        };
        if in_phase { IN_PHASE } else { SENSOR }
    }

    /// The design, where it is a chip.
    pub(crate) fn design(&self) -> Option<&Design> {
        match self {
            Self::Chip(chip) => Some(&chip.design),
            _ => None,
        }
    }

    /// Takes one sample; the amplitude of y is 1.
    pub(crate) fn step(&mut self, y: [f64; 2]) -> Said {
        match self {
            Self::OpenLoop(open_loop) => {
                let seen = open_loop.step(y[0], y[1]);
                Said {
                    alpha_hat: seen.alpha_hat,
                    set: Parameters::Four,
                    theta: seen.theta,
                }
            }
            Self::Paper(parameters, reference) => {
                let seen = reference.step(y[0], y[1]);
                Said {
                    alpha_hat: seen.alpha_hat,
                    set: *parameters,
                    theta: seen.theta,
                }
            }
            Self::Chip(on_chip) => on_chip.step(y),
        }
    }
}

const WINDOW: Window = Window {
    e: 0.5,
    rho: 0.6,
    samples: 100,
};

pub(crate) const COMPLETION: CompletedConfig = CompletedConfig {
    gamma_v: 0.02,
    slowest: 0.02,
};

const STARTED: StartConfig = StartConfig {
    periods: 2.0,
    lambda: 0.95,
    spread: 1.0,
};

/// Gains by [3 −1; −1 3], offsets by 2, phase by 8: the modes of the gradient at one speed.
fn equalised(gamma: f64) -> Steps {
    let mut steps = Steps::zeros();
    for (row, column, factor) in [
        (0, 0, 3.0),
        (2, 2, 3.0),
        (0, 2, -1.0),
        (2, 0, -1.0),
        (1, 1, 2.0),
        (3, 3, 2.0),
        (4, 4, 8.0),
    ] {
        steps[(row, column)] = factor * gamma;
    }
    steps
}

/// The paper's system in a loop of twice the signal frequency.
pub(crate) fn config(set: Parameters, search: Search, gate: Gate) -> Config {
    let poles = Poles::new(2.0 * SPEED / TS, std::f64::consts::FRAC_1_SQRT_2, TS)
        .expect("poles inside the unit circle");
    let tracking = LoopConfig::new(LoopMethod::Three(FilterType::Two), &poles, TS)
        .expect("the paper builds it");
    // 4 MᵀMΘ ε is eight times Mᵀ n ρ for small ρ, and a forgetting factor of 0.9 multiplies by ten. Bends that move at once where half a
    // period ends overshoot.
    let scale = match search {
        Search::SumOfSquares(Smoothing::Forgetting { .. }) => 1.0 / 80.0,
        Search::SumOfSquares(Smoothing::Batch { .. }) if set.count() > 5 => 1.0 / 32.0,
        Search::SumOfSquares(Smoothing::Batch { .. }) => 1.0 / 8.0,
        _ => 1.0,
    };
    Config {
        search,
        gate,
        gamma: Gamma {
            first: Steps::identity() * (0.04 * scale),
            halvings: 3,
            periods: 20.0,
            settled: None,
            waits: None,
        },
        start: Start::Arctangent { samples: 32 },
        ..Config::paper(set, tracking, 0.0)
    }
}

pub(crate) fn set_name(set: Parameters) -> &'static str {
    match set {
        Parameters::Four => "four",
        Parameters::Five => "five",
        Parameters::Eight => "eight",
        Parameters::Nine => "nine",
        Parameters::ChebyshevEight => "eight (Chebyshev)",
        Parameters::ChebyshevNine => "nine (Chebyshev)",
        Parameters::SplitEight => "eight (split)",
        Parameters::SplitNine => "nine (split)",
    }
}
