//! Which registers and probes a structure has, and the registers' formats. The tables are complete: a register that stands in
//! none of them stops the first design that is built.

use crate::bits::Bits;
use crate::format::Format;
use crate::kernel::{Method, Probes, State, Structure, travel};

/// Format of the register `name`; `None` where the structure does not have it.
///
/// # Panics
/// Where `name` is no number of [`State`].
#[must_use]
pub fn format(name: &str, structure: &Structure) -> Option<Format> {
    if let Some((memory, n)) = of_parameter(name) {
        return parameter(memory, n, structure);
    }
    let (f, c) = (&structure.formats, &structure.calibration);
    let (format, present) = match name {
        "alpha_hat" => (f.alpha.format, true),
        "count" => (f.count.format, true),
        "alpha_hat_previous" => (f.alpha.format, structure.method == Method::One),
        "rate" => (f.rate.format, structure.method != Method::One),
        "error_previous" => (f.signal.format, keeps_error(structure)),
        "lock_level" => (f.level.format, true),
        "loop_gear" => (f.loop_gear.format, structure.loop_gears > 0),
        "gamma_gear" => (f.gamma_gear.format, c.is_on()),
        "gear_periods" => (f.gear_periods.format, c.is_on()),
        "held_periods" => (f.held_periods.format, c.is_on()),
        "travel_origin" | "travel_low" | "travel_high" => (travel::SECTOR, c.is_on()),
        "unlocked_samples" => (f.unlocked_samples.format, c.may_stray()),
        "failed_periods" => (f.failed_periods.format, c.may_stray() && c.swings()),
        "start_periods" => (f.start_periods.format, c.starts()),
        "travel_samples" => (f.travel_samples.format, c.completed().is_some()),
        "null_gradient" | "null_gradient_rate" => {
            (f.alpha_gradient.format, c.completed().is_some())
        }
        "null_gradient_error" => (
            f.signal.format,
            c.completed().is_some() && keeps_error(structure),
        ),
        _ => unreachable!("no register {name}"),
    };
    present.then_some(format)
}

/// The filter has the error of one sample ago as well.
fn keeps_error(structure: &Structure) -> bool {
    structure.method != Method::Two
}

/// What a register has of which parameter: θ1 is number 0.
fn of_parameter(name: &str) -> Option<(&str, usize)> {
    let name = name.strip_suffix("_deviation").unwrap_or(name);
    let (memory, n) = name.rsplit_once('_')?;
    Some((memory, n.parse::<usize>().ok()? - 1))
}

/// Format of what `memory` has of parameter `n`.
fn parameter(memory: &str, n: usize, structure: &Structure) -> Option<Format> {
    let (f, c) = (&structure.formats, &structure.calibration);
    let calibrated = match n {
        0..4 => c.is_on(),
        4 => c.has_phase(),
        5..8 => c.has_bend(),
        _ => c.completed().is_some(),
    };
    let gathered = match n {
        0..5 => c.gathers(),
        5..8 => c.squares(),
        _ => true,
    };
    let (format, present) = match memory {
        "theta" => (f.deviation[n].format, true),
        "running" => (f.deviation[n].format, c.waits()),
        "recent" | "proven" => (f.remembered[n].format, c.recalls()),
        "alpha_gradient" | "alpha_gradient_rate" => (f.alpha_gradient.format, c.is_exact()),
        "alpha_gradient_error" => (f.signal.format, c.is_exact() && keeps_error(structure)),
        // That of θ9 is what it moves by, at the end of a period.
        "gathered" if n == 8 => (f.deviation[n].format, true),
        "gathered" => (f.gathered.format, gathered),
        _ => unreachable!("no register {memory}_{}", n + 1),
    };
    (calibrated && present).then_some(format)
}

/// Whether the structure has the flag `name`.
///
/// # Panics
/// Where `name` is no flag of [`State`].
#[must_use]
pub fn flag(name: &str, structure: &Structure) -> bool {
    let c = &structure.calibration;
    match name {
        "locked" | "lock_lost" | "signal_lost" | "direction" => true,
        "ahead_used" | "behind_used" => c.is_on() && !c.is_batch(),
        "disturbed" | "risen" | "held" => c.is_on(),
        "rough" | "calm" => c.is_on() && c.settles(),
        "astray" | "astray_before" | "astray_long" => structure.catches_up(),
        "moving" => c.completed().is_some(),
        "returning" | "fading" | "known" | "halfway" | "apart" => c.recalls(),
        _ => unreachable!("no flag {name}"),
    }
}

/// What has a port of its own beside the position and the parameters.
pub const STATUS: [&str; 5] = ["speed", "locked", "lock_lost", "signal_lost", "direction"];

/// Numbers and flags that this structure remembers.
#[must_use]
pub fn registers(structure: &Structure) -> (Vec<&'static str>, Vec<&'static str>) {
    let (values, flags) = (State::<Bits>::VALUES.iter(), State::<Bits>::FLAGS.iter());
    (
        values
            .copied()
            .filter(|name| format(name, structure).is_some())
            .collect(),
        flags
            .copied()
            .filter(|name| flag(name, structure))
            .collect(),
    )
}

/// Which probes this structure has.
#[must_use]
pub fn probes(structure: &Structure) -> (Vec<&'static str>, Vec<&'static str>) {
    let c = &structure.calibration;
    let used = |name: &str| match name {
        "theta_2" | "theta_4" | "rho_c" | "rho_s" | "fresh" | "whole_period" => c.is_on(),
        "theta_5" => c.has_phase(),
        "theta_6" | "theta_7" | "theta_8" => c.has_bend(),
        "theta_9" => c.completed().is_some(),
        "skew" => structure.skew.is_some(),
        "harmonic_cos" | "harmonic_sin" => structure.harmonics.is_some(),
        "y_c" | "y_s" | "theta_1" | "theta_3" | "c" | "s" | "cos_hat" | "sin_hat" | "e" | "rho"
        | "speed" | "in_window" => true,
        _ => unreachable!("no probe {name}"),
    };
    let keep = |names: &[&'static str]| names.iter().copied().filter(|n| used(n)).collect();
    (keep(Probes::<Bits>::VALUES), keep(Probes::<Bits>::FLAGS))
}
