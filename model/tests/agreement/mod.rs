//! Runs the chip and the reference side by side.

mod worst_case;

pub(crate) use worst_case::WorstCase;

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::{Input, Method, State};
use nonius_model::reference::completed::CompletedConfig;
use nonius_model::reference::gradient::Form;
use nonius_model::reference::interpolator::Search;
use nonius_model::reference::start::Start;
use nonius_model::reference::sum_of_squares::Smoothing;
use nonius_model::reference::{Config, Parameters, Reference, Steps, Theta, from_spec};
use nonius_model::spec::{Calibration, CalibrationMethod, Coding, Spec};

use crate::support::shipped::variants::third_and_fifth;
use crate::support::{Encoder, wrapped};

/// What a sample shows: it teaches, a period of travel ends, e and ρ.
pub(crate) struct Shown {
    fresh: bool,
    whole_period: bool,
    e: f64,
    rho: f64,
}

/// What both readings of the chip show of their registers and decisions.
pub(crate) trait Reading {
    fn step(&mut self, codes: [i64; 2], middle: i64, bits: u32, calibrate: bool) -> Shown;
    fn position(&self) -> f64;
    fn registers(&self) -> State<f64>;
}

impl Reading for Chip<Bits> {
    fn step(&mut self, [cos, sin]: [i64; 2], middle: i64, _: u32, calibrate: bool) -> Shown {
        let p = self.step_codes(cos + middle, sin + middle, false, calibrate);
        Shown {
            fresh: p.fresh,
            whole_period: p.whole_period,
            e: p.e.to_f64(),
            rho: p.rho.to_f64(),
        }
    }
    fn position(&self) -> f64 {
        Self::position(self)
    }
    fn registers(&self) -> State<f64> {
        let s = &self.state;
        State::build(
            |name| s.value(name).expect("there is one").to_f64(),
            |name| s.flag(name).expect("there is one"),
        )
    }
}

impl Reading for Chip<f64> {
    fn step(&mut self, codes: [i64; 2], middle: i64, bits: u32, calibrate: bool) -> Shown {
        let [adc_cos, adc_sin] = codes.map(|code| (code + middle) as f64 / 2f64.powi(bits as i32));
        let p = Self::step(
            self,
            &Input {
                adc_cos,
                adc_sin,
                preset: false,
                calibrate,
            },
        );
        Shown {
            fresh: p.fresh,
            whole_period: p.whole_period,
            e: p.e,
            rho: p.rho,
        }
    }
    fn position(&self) -> f64 {
        Self::position(self)
    }
    fn registers(&self) -> State<f64> {
        self.state
    }
}

/// The parameters that the chip applies.
fn theta(design: &Design, registers: &State<f64>) -> Theta {
    let mut theta = Theta::zeros();
    theta[0] = design.constants.theta_1_nominal.ideal + registers.theta_1_deviation;
    theta[1] = registers.theta_2_deviation;
    theta[2] = design.constants.theta_3_nominal.ideal + registers.theta_3_deviation;
    theta[3] = registers.theta_4_deviation;
    theta[4] = registers.theta_5_deviation;
    theta[5] = registers.theta_6_deviation;
    theta[6] = registers.theta_7_deviation;
    theta[7] = registers.theta_8_deviation;
    theta[8] = registers.theta_9_deviation;
    theta
}

/// The reference in the state that the chip is in.
fn reference(design: &Design, registers: &State<f64>, position: f64) -> Reference {
    let spec = &design.spec;
    let tracking = from_spec::tracking(spec).expect("a design that the paper knows");
    let rate = match design.structure.method {
        Method::One => wrapped(registers.alpha_hat - registers.alpha_hat_previous),
        Method::Two | Method::Three => registers.rate,
    };
    let parameters = match spec.calibration.parameters {
        4 => Parameters::Four,
        8 => Parameters::SplitEight,
        9 => Parameters::SplitNine,
        _ => Parameters::Five,
    };
    Reference::new(Config {
        theta: theta(design, registers),
        // They stand at their nominal values where the comparison begins, and may go as far as their words.
        bound: Theta::from_fn(|i, _| design.structure.formats.deviation[i].format.max()),
        skew: spec.correction.channel_skew_s,
        harmonics: from_spec::harmonics(spec),
        search: match (spec.calibration.parameters, spec.calibration.method) {
            (0, _) => Search::None,
            (_, CalibrationMethod::Exact) => Search::Residual(Form::Exact),
            (_, CalibrationMethod::Batch) => Search::SumOfSquares(Smoothing::Batch { samples: 64 }),
            (_, CalibrationMethod::SumOfSquares) => {
                let kept = 0.5f64.powi(spec.calibration.forgetting as i32);
                Search::SumOfSquares(Smoothing::Forgetting { lambda: 1.0 - kept })
            }
            _ => Search::Residual(Form::Final),
        },
        completion: spec.calibration.completed().map(|gamma| CompletedConfig {
            gamma_v: 4.0 * 0.5f64.powi(gamma as i32),
            // It is told when.
            slowest: 0.0,
        }),
        bend_rate: TAU * Calibration::BEND_RATE,
        sparse: from_spec::sparse(spec),
        // Of the final form only what stands along the radius; the other searches are compared without.
        allows_for_lag: spec.calibration.allows_for_lag(),
        start: Start::At {
            alpha_hat: position * TAU,
            speed: rate * TAU / tracking.ts,
            e_1: registers.error_previous,
        },
        ..Config::paper(parameters, tracking, 0.0)
    })
    .expect("there is one")
}

/// Largest differences between chip and reference; in turns for the angle.
#[derive(Debug, Default)]
pub(crate) struct Difference {
    pub(crate) alpha_hat: f64,
    pub(crate) alpha_hat_rms: f64,
    pub(crate) speed: f64,
    pub(crate) theta: f64,
    pub(crate) e: f64,
    pub(crate) rho: f64,
    pub(crate) updates: u32,
    /// Periods after which the completion moved θ9.
    pub(crate) completions: u32,
    pub(crate) gears: u32,
    pub(crate) moved: f64,
}

/// Samples of a comparison.
pub(crate) const SAMPLES: u32 = 60_000;

/// What the chip equalises the modes of offsets, gains and phase with, gains and phase by a power of two near the inverse square of the
/// amplitude as well. Final form: 1, 2 and 16, and without phase half of each gain's gradient off the other's. The exact gradient: 1/2, 1
/// and 2. With bends the final form has 2 and 4 for gains and phase, 1 for the common third order. The sum of squares: 1, 1 and 4; its gradient is eight times that along the radius, and a sum of as many samples as are not
/// forgotten. The batch: 1/2, 3/4 less a third of it of the other gain's, and 2.
pub(crate) fn equaliser(spec: &Spec) -> Steps {
    let mut amplitude: f64 = spec.sensor.amplitude / spec.adc.full_scale;
    while amplitude < 0.5 {
        amplitude *= 2.0;
    }
    let octaves = -2.0 * amplitude.log2();
    let bends = spec.calibration.has_bend();
    let final_form = spec.calibration.method == CalibrationMethod::Final;
    let inverse = if final_form && !bends {
        octaves - 0.3
    } else {
        octaves
    }
    .round()
    .exp2();
    let [offset, gain, phase] = match spec.calibration.method {
        // The phase is made of the estimate, whose amplitude is 1.
        CalibrationMethod::Final if bends => [1.0, 2.0, 4.0 / inverse],
        CalibrationMethod::Final => [1.0, 2.0, 16.0],
        CalibrationMethod::Exact => [0.5, 1.0, 2.0],
        CalibrationMethod::SumOfSquares => [1.0, 1.0, 4.0]
            .map(|of_radius| of_radius * 0.5f64.powi(3 + spec.calibration.forgetting as i32)),
        CalibrationMethod::Batch => [0.5, 0.75, 2.0].map(|of_radius| of_radius / 8.0),
    };
    let (gain, phase) = (gain * inverse, phase * inverse);
    let mut steps = Steps::zeros();
    for (i, step) in [gain, offset, gain, offset, phase].into_iter().enumerate() {
        steps[(i, i)] = step;
    }
    let across = match spec.calibration.method {
        CalibrationMethod::Final if spec.calibration.parameters == 4 => -gain / 2.0,
        CalibrationMethod::Batch => -gain / 3.0,
        _ => 0.0,
    };
    (steps[(0, 2)], steps[(2, 0)]) = (across, across);
    if bends {
        // Offset and second order of a channel apart: the inverse of their normal equations.
        for (offset, second) in [(1, 5), (3, 6)] {
            (steps[(offset, offset)], steps[(second, second)]) = (2.0, 4.0);
            (steps[(offset, second)], steps[(second, offset)]) = (-2.0, -2.0);
        }
        steps[(7, 7)] = 1.0;
    }
    steps
}

/// Samples for which a search that remembers stands still when the comparison begins: what it remembers of before is gone then.
const REMEMBERED: u32 = 3000;

/// Runs both over `motion` (turns at sample k). The comparison begins where the chip has locked in its
/// last gear: there the reference is put in the chip's state, once.
pub(crate) fn compare(
    design: &Design,
    chip: &mut impl Reading,
    motion: impl Fn(f64) -> f64,
    equaliser: &Steps,
) -> Difference {
    let spec = &design.spec;
    let mut encoder = Encoder::miscalibrated(spec);
    if spec.calibration.has_bend() {
        encoder.harmonics.extend(third_and_fifth());
    }
    let (half, middle) = {
        let half = 1i64 << (spec.adc.bits - 1);
        let binary = spec.adc.coding == Coding::OffsetBinary;
        (half as f64, if binary { half } else { 0 })
    };
    // y has the nominal amplitude between ½ and 1.
    let mut unit = 1.0;
    while spec.sensor.amplitude / spec.adc.full_scale * unit < 0.5 {
        unit *= 2.0;
    }
    // The sensor that the design is for.
    let late = spec.correction.channel_skew_s * spec.adc.sample_rate_hz;
    let last_gear = f64::from(design.structure.loop_gears);
    let mut paper: Option<Reference> = None;
    let mut found = Difference::default();
    let mut start = Theta::zeros();
    let mut compared = 0u32;
    let final_form = spec.calibration.method == CalibrationMethod::Final;
    let forgets = final_form && spec.calibration.completed().is_none();
    let still = if forgets { 0 } else { REMEMBERED };
    for k in 0..SAMPLES {
        let k = f64::from(k);
        let codes = encoder.codes_of([motion(k), motion(k + late)]);
        let before = chip.registers();
        let Shown {
            fresh,
            whole_period,
            e,
            rho,
        } = chip.step(codes, middle, spec.adc.bits, compared >= still);
        let after = chip.registers();
        let Some(paper) = &mut paper else {
            if after.locked && after.loop_gear == last_gear {
                start = theta(design, &after);
                paper = Some(reference(design, &after, chip.position()));
            }
            continue;
        };
        assert!(after.locked, "lock lost at sample {k}");
        let first = -f64::from(spec.calibration.gamma_first as i32) - before.gamma_gear;
        let mut gamma = equaliser * first.exp2();
        if spec.calibration.phase_settles() && before.gamma_gear >= 4.0 {
            gamma[(4, 4)] /= 4.0;
        }
        // From the fifth gear on, where a period of travel ends; a mean acts with each sample, and a batch when it is full.
        let due = !spec.calibration.waits() || before.gamma_gear < 4.0 || whole_period && fresh;
        let y = codes.map(|code| code as f64 / half * unit);
        let fresh = fresh && spec.calibration.is_on();
        // Where a period ends in which the loop caught up it is dropped, its last sample, too.
        let caught_up = before.astray || before.gamma_gear >= 4.0 && e.abs() >= spec.small_error();
        let dropped = whole_period
            && caught_up
            && !before.astray_long
            && design.structure.catches_up()
            && spec.calibration.drops_periods();
        let teaches = fresh && !dropped;
        // The completion gathers in some sectors of a period, acts where the period ends, or is dropped.
        let gathers = after.gathered_9 != before.gathered_9;
        let acts = after.theta_9_deviation != before.theta_9_deviation;
        let seen = paper.step_with(
            y,
            (teaches.then_some(&gamma), due && !dropped),
            (acts || gathers && after.gathered_9 != 0.0, acts),
        );
        if gathers && !acts && after.gathered_9 == 0.0 {
            paper.drop_completion();
        }
        found.completions += u32::from(acts);
        if dropped {
            paper.drop_period();
        }

        let angle = wrapped(chip.position() - paper.tracking().alpha_hat() / TAU);
        let ts = paper.tracking().config.ts;
        let rate = match design.structure.method {
            Method::One => wrapped(after.alpha_hat - after.alpha_hat_previous),
            Method::Two | Method::Three => after.rate,
        };
        let largest = |x: &mut f64, y: f64| *x = x.max(y.abs());
        largest(&mut found.alpha_hat, angle);
        largest(&mut found.speed, rate - paper.tracking().speed() * ts / TAU);
        largest(
            &mut found.theta,
            (theta(design, &after) - paper.theta()).amax(),
        );
        largest(&mut found.e, e - seen.e);
        largest(&mut found.rho, rho - seen.rho);
        found.alpha_hat_rms += angle * angle;
        found.updates += u32::from(fresh);
        found.gears = found.gears.max(after.gamma_gear as u32);
        found.moved = (paper.theta() - start).amax();
        compared += 1;
    }
    assert!(compared > SAMPLES / 2, "compared only {compared} samples");
    found.alpha_hat_rms = (found.alpha_hat_rms / f64::from(compared)).sqrt();
    found
}
