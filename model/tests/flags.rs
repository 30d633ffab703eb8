//! What the flags and the zero preset say to the machine.

use crate::support::{Encoder, optical};
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;

/// A locked chip behind an ideal sensor, and where the sensor is, in periods.
struct Machine {
    encoder: Encoder,
    chip: Chip<Bits>,
    at: f64,
}

impl Machine {
    fn locked() -> Self {
        let spec = optical();
        let design = Design::new(&spec).expect("a shipped design");
        let mut machine = Self {
            encoder: Encoder::ideal(&spec),
            chip: Chip::bit_true(&design),
            at: 0.2,
        };
        machine.moves(0.01, 3000);
        assert!(machine.chip.state.locked && !machine.chip.state.lock_lost);
        machine
    }

    fn step(&mut self, preset: bool) {
        let [cos, sin] = self.encoder.codes(self.at);
        self.chip.step_codes(cos, sin, preset, true);
    }

    fn moves(&mut self, speed: f64, samples: u32) {
        for _ in 0..samples {
            self.at += speed;
            self.step(false);
        }
    }
}

/// It changes with the sign of the speed, a few samples late, and stays where the scale stands.
#[test]
fn direction_is_that_of_the_scale() {
    let mut machine = Machine::locked();
    for (speed, backwards) in [
        (0.01, false),
        (0.0, false),
        (-0.01, true),
        (0.0, true),
        (-0.0001, true),
        (0.0001, false),
        (0.05, false),
        (-0.05, true),
    ] {
        machine.moves(speed, 2000);
        let direction = machine.chip.state.direction;
        assert_eq!(direction, backwards, "at {speed} periods a sample");
    }
}

/// The period that the scale stands in becomes number 0, the fraction stays; counting goes on from there, either way.
#[test]
fn a_preset_makes_this_period_the_first() {
    let mut machine = Machine::locked();
    machine.moves(0.01, 1000);
    assert!(machine.chip.position() > 35.0);
    machine.at = machine.at.floor() + 0.4;
    machine.moves(0.0, 2000);
    machine.step(true);
    assert!((machine.chip.position() - 0.4).abs() < 1e-3);
    machine.moves(-0.003, 500);
    machine.moves(0.0, 2000);
    let found = machine.chip.position();
    assert!((found - (0.4 - 1.5)).abs() < 1e-3, "{found}");
}

/// Both signals at nothing: said with the first sample, taken back with the first one that is there again.
#[test]
fn a_lost_signal_is_said_at_once() {
    let mut machine = Machine::locked();
    for lost in [true, false, true, false] {
        for _ in 0..5 {
            if lost {
                machine.chip.step_codes(0, 0, false, true);
            } else {
                machine.step(false);
            }
            assert_eq!(machine.chip.state.signal_lost, lost);
        }
    }
    // One channel alone is enough to go on: the sensor stands where the other one is strong.
    machine.at = machine.at.floor();
    let [cos, _] = machine.encoder.codes(machine.at);
    machine.chip.step_codes(cos, 0, false, true);
    assert!(!machine.chip.state.signal_lost);
}

/// Lost lock is remembered after the loop has locked again, until a preset says that the position is known.
#[test]
fn a_lost_lock_is_remembered_until_the_preset() {
    let mut machine = Machine::locked();
    for _ in 0..200 {
        machine.chip.step_codes(0, 0, false, true);
    }
    let state = machine.chip.state;
    assert!(!state.locked && state.lock_lost && state.signal_lost);
    machine.moves(0.0, 3000);
    let state = machine.chip.state;
    assert!(state.locked && state.lock_lost && !state.signal_lost);
    machine.step(true);
    assert!(machine.chip.state.locked && !machine.chip.state.lock_lost);
    machine.moves(0.003, 1000);
    assert!(!machine.chip.state.lock_lost);
}
