//! The chip against the paper: same ADC codes, same physical design, two programs that share no formula.
//!
//! The chip makes decisions that the paper does not know (γ shifts gear, each sector of travel counts once, the modes
//! are equalised). The reference is told them sample by sample; everything else it computes from the physical design.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod support;

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::{Input, Method, State};
use nonius_model::reference::gate::{Gate, GateState, Window};
use nonius_model::reference::gradient::Form;
use nonius_model::reference::interpolator::Search;
use nonius_model::reference::loops::Loop;
use nonius_model::reference::start::Start;
use nonius_model::reference::{Config, Parameters, Reference, Theta, from_spec};
use nonius_model::spec::{Coding, Spec};
use support::{Encoder, optical, wrapped};

/// What both readings of the chip show of their registers and decisions.
trait Reading {
    fn step(&mut self, codes: [i64; 2], middle: i64, bits: u32) -> (bool, [f64; 2]);
    fn position(&self) -> f64;
    fn registers(&self) -> State<f64>;
}

impl Reading for Chip<Bits> {
    fn step(&mut self, [cos, sin]: [i64; 2], middle: i64, _: u32) -> (bool, [f64; 2]) {
        let p = self.step_codes(cos + middle, sin + middle, false, true);
        (p.fresh, [p.e.to_f64(), p.rho.to_f64()])
    }
    fn position(&self) -> f64 {
        Self::position(self)
    }
    fn registers(&self) -> State<f64> {
        let s = &self.state;
        State::build(
            |name| s.value(name).unwrap().to_f64(),
            |name| s.flag(name).unwrap(),
        )
    }
}

impl Reading for Chip<f64> {
    fn step(&mut self, codes: [i64; 2], middle: i64, bits: u32) -> (bool, [f64; 2]) {
        let [adc_cos, adc_sin] = codes.map(|code| (code + middle) as f64 / 2f64.powi(bits as i32));
        let p = Self::step(
            self,
            &Input {
                adc_cos,
                adc_sin,
                preset: false,
                calibrate: true,
            },
        );
        (p.fresh, [p.e, p.rho])
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
    theta
}

/// The reference in the state that the chip is in.
fn reference(design: &Design, registers: &State<f64>, position: f64) -> Reference {
    let spec = &design.spec;
    let tracking = from_spec::tracking(spec).unwrap();
    let rate = match design.structure.method {
        Method::One => wrapped(registers.alpha_hat - registers.alpha_hat_previous),
        Method::Two | Method::Three => registers.rate,
    };
    let parameters = match spec.calibration.parameters {
        4 => Parameters::Four,
        _ => Parameters::Five,
    };
    Reference::new(Config {
        theta: theta(design, registers),
        search: match spec.calibration.parameters {
            0 => Search::None,
            _ => Search::Residual(Form::Final),
        },
        start: Start::At {
            alpha_hat: position * TAU,
            speed: rate * TAU / tracking.ts,
            e_1: registers.error_previous,
        },
        ..Config::paper(parameters, tracking, 0.0)
    })
    .unwrap()
}

/// Largest differences between chip and reference; in turns for the angle.
#[derive(Debug, Default)]
struct Difference {
    alpha_hat: f64,
    alpha_hat_rms: f64,
    speed: f64,
    theta: f64,
    e: f64,
    rho: f64,
    updates: u32,
    gears: u32,
    moved: f64,
}

/// Samples of a comparison.
const SAMPLES: u32 = 60_000;

/// Gains by 2, offsets by 1, phase by 4: what the chip equalises the modes with.
const EQUALISER: [f64; 5] = [2.0, 1.0, 2.0, 1.0, 4.0];

/// Runs both over `motion` (turns at sample k). The comparison begins where the chip has locked in its
/// last gear: there the reference is put in the chip's state, once.
fn compare(
    design: &Design,
    chip: &mut impl Reading,
    motion: impl Fn(f64) -> f64,
    equaliser: [f64; 5],
) -> Difference {
    let spec = &design.spec;
    let encoder = Encoder::miscalibrated(spec);
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
    let last_gear = f64::from(design.structure.loop_gears);
    let mut paper: Option<Reference> = None;
    let mut found = Difference::default();
    let mut start = Theta::zeros();
    let mut compared = 0u32;
    for k in 0..SAMPLES {
        let codes = encoder.codes(motion(f64::from(k)));
        let before = chip.registers();
        let (fresh, [e, rho]) = chip.step(codes, middle, spec.adc.bits);
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
        let mut gamma = Theta::zeros();
        for (i, equaliser) in equaliser.into_iter().enumerate() {
            gamma[i] = equaliser * first.exp2();
        }
        let y = codes.map(|code| code as f64 / half * unit);
        let fresh = fresh && spec.calibration.parameters > 0;
        let seen = paper.step_with(y[0], y[1], fresh.then_some(&gamma));

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

/// Each structure of the chip that differs in an equation.
fn structures() -> Vec<(String, Spec)> {
    let mut list = Vec::new();
    for (method, filter_type, pole) in [
        (1, 2, None),
        (1, 1, None),
        (1, 1, Some(0.9)),
        (2, 1, None),
        (3, 2, None),
        (3, 1, None),
        (3, 1, Some(0.97)),
    ] {
        for parameters in [0, 4, 5] {
            let mut spec = optical();
            spec.tracking.method = method;
            spec.tracking.filter_type = filter_type;
            spec.tracking.pole = pole;
            spec.calibration.parameters = parameters;
            if filter_type == 1 {
                // What lags at speed cannot be fast.
                spec.sensor.speed_max_periods_per_s = 1.5e3;
            }
            let pole = pole.map_or(String::new(), |p| format!(" pole {p}"));
            let name = format!("method {method} type {filter_type}{pole}, {parameters} parameters");
            list.push((name, spec));
        }
    }
    let mut binary = optical();
    binary.adc.coding = Coding::OffsetBinary;
    binary.adc.bits = 14;
    binary.sensor.amplitude = 0.3;
    list.push(("offset binary, 14 bits, amplitude 0.3".into(), binary));
    list
}

/// A sweep with reversals up to the top speed.
fn sweep(spec: &Spec) -> impl Fn(f64) -> f64 {
    let top = 0.8 * spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    let slow = TAU / 30_000.0;
    move |k| top / slow * (slow * k).sin() + 0.1
}

/// What the arithmetic of the chip can add to one sample at most, worked out from the word lengths alone.
struct WorstCase {
    /// To e, radians.
    e: f64,
    /// To ρ.
    rho: f64,
    /// To α̂, turns: the loop's largest amplification of what goes into e, with what coefficients and increments add.
    alpha_hat: f64,
    /// To Θ.
    theta: f64,
}

/// Radius of the corrected pair before it is calibrated, with the tests' encoder.
const RADIUS: f64 = 1.3;
/// Largest |e| with that encoder and these motions, radians.
const ERROR: f64 = 0.4;

impl WorstCase {
    /// `rounding`: the bit-true chip; otherwise the unrounded one, which has the same table and coefficients.
    fn of(design: &Design, rounding: bool) -> Self {
        let (words, f) = (&design.words, &design.structure.formats);
        let half_bit = |fraction: u32| {
            if rounding {
                0.5f64.powi(fraction as i32 + 1)
            } else {
                0.0
            }
        };
        let half_lsb = half_bit(words.signal_fraction);
        // The table is linear in segments expanded about their centre; the value is lowered by half the error at the
        // ends (x²/2), which leaves x²/4.
        let x = TAU * 0.5f64.powi(words.sine_rows_log2 as i32 + 3);
        let table = x * x / 4.0;
        // Rounded twice: a table entry with two more bits, and the result; the slope adds 1/32.
        let sine =
            table + TAU * half_bit(words.sine_phase_bits) + half_lsb * (1.0 + 0.25 + 1.0 / 16.0);
        let y = 1.1;
        let [first, _, fifth] = f.theta.map(|q| half_bit(q.format.fraction) * y);
        let corrected = half_lsb + (first * first + (first + fifth).powi(2)).sqrt();
        // A sum of cos² and sin² shares: no more than √2 of either.
        let rho = half_lsb + 2f64.sqrt() * (RADIUS * sine + corrected);
        // Coefficients of `width` bits; they are multiplied by e, and a and a + b each contribute.
        let width = words.signal_fraction as i32 + 2;
        let coefficients = 2.0 * ERROR * 0.5f64.powi(width - 1);
        // Three roundings of the increment a sample (kick, drift, leak), as the e that would make them.
        let increments = 3.0 * half_bit(words.phase_bits) / design.tracking.ab;
        let into_loop = rho + coefficients + increments;
        Self {
            e: rho + into_loop * (1.0 + amplification(design)),
            rho: rho + RADIUS * into_loop * amplification(design) * ERROR,
            alpha_hat: into_loop * amplification(design) / TAU,
            // In its equilibrium Θ makes the mean of n ρ vanish over the period: 2⟨cos · δρ⟩ ≤ 4/π of the largest δρ,
            // per amplitude (½ at least) for the gains.
            theta: 2.0 * 4.0 / std::f64::consts::PI * rho,
        }
    }
}

/// Σ |h| of the closed loop from e to α̂: the most that a bounded disturbance of e can do.
fn amplification(design: &Design) -> f64 {
    let mut tracking = Loop::new(from_spec::tracking(&design.spec).unwrap());
    (0..(60.0 / design.tracking.omega) as u32)
        .map(|k| {
            let disturbance = if k == 0 { 1.0 } else { 0.0 };
            tracking.advance(disturbance - tracking.alpha_hat());
            tracking.alpha_hat().abs()
        })
        .sum()
}

fn check(name: &str, found: &Difference, worst: &WorstCase) {
    println!(
        "{name}: alpha_hat {:.1e} (rms {:.1e}, bound {:.1e}) turns, e {:.1e} ({:.1e}), rho {:.1e} ({:.1e}), theta {:.1e} ({:.1e})",
        found.alpha_hat,
        found.alpha_hat_rms,
        worst.alpha_hat,
        found.e,
        worst.e,
        found.rho,
        worst.rho,
        found.theta,
        worst.theta,
    );
    assert!(found.alpha_hat <= worst.alpha_hat, "{name}: {found:?}");
    assert!(found.e <= worst.e, "{name}: {found:?}");
    assert!(found.rho <= worst.rho, "{name}: {found:?}");
    assert!(found.theta <= worst.theta, "{name}: {found:?}");
}

/// The comparison is one of a calibration that happens: hundreds of updates, every gear of γ, parameters that moved.
fn calibrated(spec: &Spec, found: &Difference) {
    if spec.calibration.parameters == 0 {
        assert_eq!((found.updates, found.moved), (0, 0.0));
    } else {
        assert!(found.updates > 600 && found.moved > 0.05, "{found:?}");
        assert_eq!(
            found.gears,
            spec.calibration.gamma_last - spec.calibration.gamma_first
        );
    }
}

/// The chip's equations are the paper's: with the finest sine table and coefficients the unrounded chip and the
/// reference differ by the table's interpolation error and the coefficients' last bit, a few 10⁻¹⁰ of a period, in
/// every method, type and parameter set, through reversals and all of the convergence.
#[test]
fn the_equations_agree() {
    for (name, mut spec) in structures() {
        spec.formats.signal_fraction = Some(24);
        spec.formats.sine_rows_log2 = Some(13);
        let design = Design::new(&spec).unwrap();
        let found = compare(
            &design,
            &mut Chip::unrounded(&design),
            sweep(&spec),
            EQUALISER,
        );
        check(&name, &found, &WorstCase::of(&design, false));
        calibrated(&spec, &found);
    }
}

/// The bit-true chip with the word lengths that its budget chose differs from the paper by no more than these word
/// lengths can do in the worst case.
#[test]
fn the_bits_agree_to_the_rounding() {
    for (name, spec) in structures() {
        let design = Design::new(&spec).unwrap();
        let found = compare(
            &design,
            &mut Chip::bit_true(&design),
            sweep(&spec),
            EQUALISER,
        );
        check(&name, &found, &WorstCase::of(&design, true));
        calibrated(&spec, &found);
        // And on the average by less than the budget allows.
        assert!(
            found.alpha_hat_rms <= design.budget.allowed,
            "{name}: {found:?}"
        );
    }
}

/// The comparison is sharp: a reference whose loop is 1 % wider, or whose γ is 1 % larger, misses the bounds by more than
/// a hundredfold.
#[test]
fn a_small_difference_in_the_design_is_seen() {
    let mut spec = optical();
    spec.formats.signal_fraction = Some(24);
    spec.formats.sine_rows_log2 = Some(13);
    let design = Design::new(&spec).unwrap();
    let worst = WorstCase::of(&design, false);
    let mut wider = design.clone();
    wider.spec.tracking.bandwidth_hz *= 1.01;
    let found = compare(
        &wider,
        &mut Chip::unrounded(&design),
        sweep(&spec),
        EQUALISER,
    );
    assert!(found.alpha_hat > 100.0 * worst.alpha_hat, "{found:?}");
    assert!(found.e > 100.0 * worst.e, "{found:?}");
    let larger = EQUALISER.map(|x| 1.01 * x);
    let found = compare(&design, &mut Chip::unrounded(&design), sweep(&spec), larger);
    assert!(found.theta > 100.0 * worst.theta, "{found:?}");
    assert!(found.rho > 100.0 * worst.rho, "{found:?}");
}

/// The chip's gate by travelled angle keeps an interval of sectors, the reference's a map of all 64. Where no sector is
/// jumped over they are the same thing: equal decisions at every sample, through reversals on large and small arcs.
#[test]
fn the_travel_gates_decide_alike() {
    let spec = optical();
    let design = Design::new(&spec).unwrap();
    let encoder = Encoder::ideal(&spec);
    let mut chip = Chip::bit_true(&design);
    let always = Window {
        e: f64::INFINITY,
        rho: f64::INFINITY,
        samples: 0,
    };
    let mut gate = GateState::new(Gate::Travelled(always));
    let (mut counted, mut fresh) = (0, 0);
    for k in 0..80_000 {
        let t = f64::from(k);
        let turns = 3.0 * (t / 3000.0).sin() + 0.9 * (t / 411.0).sin() + 0.2 * (t / 67.0).sin();
        let [cos, sin] = encoder.codes(turns);
        let (was_locked, position) = (chip.state.locked, chip.position());
        let probes = chip.step_codes(cos, sin, false, true);
        if !was_locked {
            // The chip's map begins where it was last not counting.
            gate = GateState::new(Gate::Travelled(always));
        }
        let expected = gate.step(0.0, 0.0, position * TAU);
        if was_locked {
            assert_eq!(probes.fresh, expected, "sample {k}");
            counted += 1;
            fresh += u32::from(expected);
        }
    }
    println!("{fresh} of {counted} samples were in a fresh sector");
    assert!(counted > 75_000 && fresh > 1000);
}
