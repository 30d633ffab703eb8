//! What fixed-point arithmetic adds to the angle error, beside what the ADC does.
//!
//! The table is kept in docs/accuracy.md; NONIUS_BLESS=1 writes it anew.

use std::fmt::Write;
use std::path::Path;

use crate::support::{Encoder, shipped, wrapped};
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::kernel::{Input, State};
use nonius_model::signal::Signal;
use nonius_model::spec::{Coding, Spec};

const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-model accuracy";

/// After convergence, on a slow sweep with the same codes, the bit-true chip differs from the unrounded one by at
/// most a tenth of what quantising the input changes in the unrounded one.
#[test]
fn arithmetic_adds_at_most_a_tenth_of_the_adc() {
    let mut page = format!(
        "# What the arithmetic adds\n\n\
         Written by `{HOW}`; do not edit. A whole period, slowly, at constant\n\
         speed, after convergence of a miscalibrated encoder; the same codes and coefficients, and the same parameters at first,\n\
         which stand still or calibrate on; lock detection and gears decide the same, within ten samples of the sweep. ADC: the unrounded chip with and without quantised input. Arithmetic: the bit-true chip against the unrounded one. Periods.\n\n\
         | design | parameters | ADC, rms | arithmetic, rms | share | arithmetic, largest |\n|---|---|---|---|---|---|\n",
    );
    for (name, calibrating) in shipped::NAMES
        .into_iter()
        .flat_map(|name| [(name, false), (name, true)])
    {
        let Measured {
            arithmetic,
            largest,
            adc,
        } = measure(&shipped::spec(name), calibrating);
        let allowed = shipped::design(name).budget.allowed;
        assert!(
            arithmetic <= allowed,
            "{name}: {arithmetic:e} of {allowed:e}"
        );
        let share = arithmetic / adc;
        writeln!(
            page,
            "| {name} | {} | {adc:.1e} | {arithmetic:.1e} | {:.1} % | {largest:.1e} |",
            if calibrating {
                "calibrate"
            } else {
                "stand still"
            },
            share * 100.0
        )
        .expect("text");
        assert!(
            share <= 0.1,
            "{name}: arithmetic {arithmetic:e}, ADC {adc:e} periods rms"
        );
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/accuracy.md");
    nonius_kept::same(Path::new(file), &page, HOW);
}

/// Periods: rms of what arithmetic adds, the largest of it, rms of what the ADC does.
struct Measured {
    arithmetic: f64,
    largest: f64,
    adc: f64,
}

/// What lock detection and gears have decided after a sample.
fn decisions<S: Signal<Bool = bool>>(
    state: &State<S>,
    number: impl Fn(S) -> f64,
) -> ([f64; 4], [bool; 6]) {
    let values = [
        state.lock_level,
        state.loop_gear,
        state.gamma_gear,
        state.gear_periods,
    ];
    let flags = [
        state.locked,
        state.lock_lost,
        state.signal_lost,
        state.disturbed,
        state.risen,
        state.held,
    ];
    (values.map(number), flags)
}

/// Samples within which both readings pass the edge of a sector, by which decisions fall, in this slow motion: it takes them to
/// move by the largest difference.
const WITHIN: u32 = 10;

fn measure(spec: &Spec, calibrating: bool) -> Measured {
    let design = Design::new(spec).expect("a shipped design");
    let encoder = Encoder::miscalibrated(spec);
    let half = f64::from(1 << (spec.adc.bits - 1));
    let mut bits = Chip::bit_true(&design);
    let mut real = Chip::unrounded(&design);
    let mut analogue = Chip::unrounded(&design);
    // A whole period after the loop has come to rest in the slow motion.
    let (converge, settle, sweep) = (60_000, 5_000, 475_000);
    let slow = 1.0 / f64::from(sweep);
    let mut at: f64 = 0.1;
    let (mut arithmetic, mut adc, mut largest) = (0.0, 0.0, 0.0f64);
    let mut apart = 0;
    for k in 0..converge + settle + sweep {
        let measuring = k >= converge;
        let calibrate = !measuring || calibrating;
        at += if measuring { slow } else { 0.00713 };
        if measuring && k == converge {
            let theta = bits.state;
            for chip in [&mut real, &mut analogue] {
                chip.state.theta_1_deviation = theta.theta_1_deviation.to_f64();
                chip.state.theta_2_deviation = theta.theta_2_deviation.to_f64();
                chip.state.theta_3_deviation = theta.theta_3_deviation.to_f64();
                chip.state.theta_4_deviation = theta.theta_4_deviation.to_f64();
                chip.state.theta_5_deviation = theta.theta_5_deviation.to_f64();
                chip.state.running_1 = theta.running_1.to_f64();
                chip.state.running_2 = theta.running_2.to_f64();
                chip.state.running_3 = theta.running_3.to_f64();
                chip.state.running_4 = theta.running_4.to_f64();
                chip.state.running_5 = theta.running_5.to_f64();
            }
        }
        let [cos, sin] = encoder.codes(at);
        let input = |adc_cos: f64, adc_sin: f64| Input {
            adc_cos,
            adc_sin,
            preset: false,
            calibrate,
        };
        let middle = match spec.adc.coding {
            Coding::OffsetBinary => half,
            Coding::TwosComplement => 0.0,
        };
        let code = |c: i64| c + middle as i64;
        let part = |v: f64| (v + middle) / half / 2.0;
        bits.step_codes(code(cos), code(sin), false, calibrate);
        real.step(&input(part(cos as f64), part(sin as f64)));
        let [v_cos, v_sin] = encoder.volts(at);
        analogue.step(&input(part(v_cos * half), part(v_sin * half)));
        if k >= converge + settle {
            assert!(bits.state.locked, "{}, sample {k}", spec.name);
            let both = (
                decisions(&bits.state, Bits::to_f64),
                decisions(&real.state, |x| x),
            );
            apart = if both.0 == both.1 { 0 } else { apart + 1 };
            assert!(
                apart <= WITHIN,
                "{}, sample {k}: lock level, loop gear, gamma gear, its periods; locked, lost, no signal, disturbed, risen, held: {both:?}",
                spec.name
            );
            let difference = wrapped(bits.position() - real.position());
            arithmetic += difference * difference;
            largest = largest.max(difference.abs());
            adc += wrapped(real.position() - analogue.position()).powi(2);
        }
    }
    let n = f64::from(sweep);
    Measured {
        arithmetic: (arithmetic / n).sqrt(),
        largest,
        adc: (adc / n).sqrt(),
    }
}
