//! Each named stimulus shows what it is for, as `nonius build` plays it.

use crate::shipped;
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::State;
use nonius_testvectors::stimulus::{Stimulus, named};

/// Samples of each, as `nonius build` writes them.
const ROWS: usize = 2000;

/// The registers after each sample.
fn played(design: &Design, name: &str) -> Vec<State<Bits>> {
    let stimuli = named(design, ROWS);
    let found = stimuli.iter().find(|s| s.name == name);
    let Stimulus { samples, .. } = found.expect("a stimulus");
    let mut chip = Chip::bit_true(design);
    let step = |s: &nonius_testvectors::stimulus::Sample| {
        chip.step_codes(s.cos, s.sin, s.preset, s.calibrate);
        chip.state
    };
    samples.iter().map(step).collect()
}

/// The waves that a new user opens: locked before the reversal, and to the end.
#[test]
fn the_sweep_reverses_in_lock() {
    for name in shipped::NAMES {
        let design = shipped::design(name);
        let states = played(&design, "sweep");
        assert!(states[ROWS / 6..].iter().all(|s| s.locked), "{name}");
        let (first, last) = (&states[ROWS / 3], &states[ROWS - 1]);
        assert!(!first.direction && last.direction, "{name}");
    }
}

/// Lock is lost with the signal and remembered until the second preset.
#[test]
fn the_loss_is_remembered_until_the_preset() {
    for name in shipped::NAMES {
        let states = played(&shipped::design(name), "loss");
        let preset = ROWS - ROWS / 8;
        assert!(states[ROWS * 65 / 100].locked, "{name}: not locked first");
        assert!(states[ROWS * 71 / 100].signal_lost, "{name}");
        assert!(!states[ROWS * 71 / 100].locked, "{name}");
        assert!(states[preset - 1].lock_lost, "{name}: forgotten");
        assert!(states[preset - 1].locked, "{name}: not locked again");
        assert!(!states[preset].lock_lost, "{name}: not taken back");
    }
}

/// The parameters are held while the signal has faded, until that has lasted `hold_periods`, 40 here: then the search begins again. Where
/// the rows do not hold as many, this is seen in longer vectors.
#[test]
fn the_fade_is_held_and_then_followed() {
    let mut seen = vec![];
    for name in shipped::NAMES {
        let mut spec = shipped::design(name).spec;
        spec.calibration.hold_periods = Some(40);
        let design = Design::new(&spec).expect("a design that works");
        let (sensor, adc) = (&design.spec.sensor, &design.spec.adc);
        let travels = sensor.speed_max_periods_per_s / adc.sample_rate_hz * (ROWS * 2 / 3) as f64;
        if travels < 50.0 {
            continue;
        }
        let states = played(&design, "fade");
        let gear = |k: usize| states[k].gamma_gear.to_f64();
        let settled = design.constants.gamma_gear_settled.value();
        // Before that it is held for short, soon after lock.
        let fades = ROWS / 3;
        assert!(
            gear(fades) >= settled && !states[fades].held,
            "{name}: held before"
        );
        let begins = (fades..ROWS).find(|k| states[*k].held).expect("held");
        let again = (begins..ROWS).find(|k| gear(*k) == 0.0);
        let again = again.expect("the search begins again");
        assert!(states[again - 1].held, "{name}: not held until then");
        let periods = travels / (ROWS * 2 / 3) as f64 * (again - begins) as f64;
        assert!((39.0..44.0).contains(&periods), "{name}: {periods}");
        seen.push(name);
    }
    assert!(seen.contains(&"optical"), "{seen:?}");
}

/// Where the axis is jolted the loop catches up; after two periods with a jolt all samples count, until one has none.
#[test]
fn the_jolts_are_caught_up_with() {
    let design = shipped::design("optical");
    let states = played(&design, "jolts");
    let long = |s: &State<Bits>| s.astray_long;
    let first = states.iter().position(|s| s.astray).expect("a jolt");
    let given_up = states.iter().position(long).expect("several");
    assert!(first < given_up && states[first].gamma_gear.to_f64() >= 4.0);
    let again = given_up
        + states[given_up..]
            .iter()
            .position(|s| !s.astray_long)
            .expect("travel");
    let alone = states[again..].iter().position(|s| s.astray);
    let alone = again + alone.expect("one jolt alone");
    // Out of the lock window with a signal; then the estimate is across it, and points away from it. Where it is across a small one,
    // what is proven is recalled.
    let (jumps, small) = ([16, 17, 18].map(|k| k * ROWS / 20), 19 * ROWS / 20);
    assert!(states[first..jumps[1]].iter().all(|s| s.locked));
    assert!(!states[alone].astray_long && !states[ROWS - 1].astray_long);
    for jump in jumps {
        assert!(!states[jump].signal_lost && states[jump].lock_level < states[jump - 1].lock_level);
    }
    assert!(states[jumps[1]].locked && states[jumps[1]].known);
    assert!(states[first..=small].iter().all(|s| !s.returning) && states[small].locked);
    assert!(states[small + 1].returning && !states[small + 1].signal_lost);
    // And gone.
    let gone = small + 2..small + 4;
    assert!(states[gone].iter().all(|s| s.signal_lost));
}

/// The direction turns once, at speeds so small that its dead band counts.
#[test]
fn the_creep_turns_the_direction() {
    for name in shipped::NAMES {
        let states = played(&shipped::design(name), "creep");
        let backwards =
            |from: usize, to: usize| states[from..to].iter().filter(|s| s.direction).count();
        assert!(backwards(ROWS / 4, ROWS * 4 / 10) > ROWS / 10, "{name}");
        assert!(backwards(ROWS * 9 / 10, ROWS) < ROWS / 40, "{name}");
    }
}

type Register = fn(&State<Bits>) -> Bits;
const THETA: [Register; 4] = [
    |s| s.theta_1_deviation,
    |s| s.theta_2_deviation,
    |s| s.theta_3_deviation,
    |s| s.theta_4_deviation,
];

/// Offsets and gains of the optical chip, in which saturations are altered to see whether it shows, come to their bounds.
#[test]
fn the_bounds_are_met() {
    let design = shipped::design("optical");
    let states = played(&design, "bounds");
    for (i, of) in THETA.iter().enumerate() {
        let format = design.structure.formats.deviation[i].format;
        let ends = [format.min_raw(), format.max_raw()];
        let raw = |s| i128::from(of(s).raw(format.fraction));
        let met = states.iter().filter(|s| ends.contains(&raw(s))).count();
        println!("theta_{} at its bounds in {met} samples", i + 1);
        assert!(met > 0, "theta_{} meets no bound", i + 1);
    }
}
