//! Recording, diagnosis, emitted design, chip: the angle error that the diagnosis takes away, on the chip; and that chip, with
//! the recording among its vectors, equal to the model in both simulators.
//!
//! The tables are kept in docs/closing-the-loop.md; NONIUS_BLESS=1 writes it anew.

mod chips;
mod encoders;

use std::fmt::Write;
use std::path::Path;

use chips::{Closed, closed};
use encoders::{bent_encoder, harmonic, power, simulated_encoder, skew};

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/closing-the-loop.md");

/// Bends y + k y³, of cosine and sine.
const ODD: [[f64; 2]; 2] = [[0.04, 0.02], [0.03, -0.03]];

/// Bends y + k y².
const EVEN: [[f64; 2]; 2] = [[0.03, -0.02], [0.0, 0.04]];

const DELAYS: [f64; 3] = [10e-6, -6e-6, 0.0];

/// Order, amplitude and phase in the cosine, in the sine.
type Harmonic = (u32, (f64, f64), (f64, f64));

const HARMONICS: [Harmonic; 3] = [
    (4, (0.015, 0.4), (0.015, -1.2)),
    (3, (0.012, 0.9), (0.008, -2.3)),
    (2, (0.010, 0.8), (0.014, 0.5)),
];

/// Two causes at once, as `sensor.toml` has them, and what they are called.
fn pairs() -> [(String, [&'static str; 2]); 3] {
    let fourth = harmonic(HARMONICS[0]);
    let odd = power("odd", [0.04, -0.02]);
    let [late, early] = [6e-6, -6e-6].map(skew);
    [
        (
            format!("{odd}{fourth}"),
            ["odd_nonlinearity", "spatial_harmonic"],
        ),
        (
            format!("{fourth}{late}"),
            ["channel_skew", "spatial_harmonic"],
        ),
        (
            format!("{odd}{early}"),
            ["channel_skew", "odd_nonlinearity"],
        ),
    ]
}

/// Everything closed, the first of each kind in the simulators too; simulators run side by side.
struct All {
    odd: Vec<Closed>,
    even: Vec<Closed>,
    skewed: Vec<Closed>,
    harmonics: Vec<Closed>,
    pairs: Vec<Closed>,
}

impl All {
    fn run() -> Self {
        let of = |causes: Vec<String>| -> Vec<String> {
            causes.iter().map(|c| simulated_encoder(c)).collect()
        };
        let recordings = [
            ODD.map(bent_encoder).into(),
            of(EVEN.map(|k| power("even", k)).into()),
            of(DELAYS.map(skew).into()),
            of(HARMONICS.map(harmonic).into()),
            of(pairs().map(|(causes, _)| causes).into()),
        ];
        let [odd, even, skewed, harmonics, pairs] = std::thread::scope(|scope| {
            let all = recordings.map(|kind: Vec<String>| {
                let kind = kind.into_iter().enumerate();
                kind.map(|(k, recording)| scope.spawn(move || closed(&recording, k == 0)))
                    .collect::<Vec<_>>()
            });
            all.map(|kind| {
                let kind = kind.into_iter().map(|it| it.join().expect("it closes"));
                kind.collect()
            })
        });
        Self {
            odd,
            even,
            skewed,
            harmonics,
            pairs,
        }
    }
}

/// The noise of the first encoders stands before the bend: it is louder where the channel is steep.
const NOISE_BEFORE_THE_BEND: &str = "amplitude_noise";

/// What the spline of the motion leaves of the drive, which the reference shows.
const LEFT_OF_THE_DRIVE: &str = "vibration";

const HEAD: &str = "# Closing the loop\n\n\
     Written by `NONIUS_BLESS=1 cargo test -p nonius-hdl closing_the_loop::`; do not edit. An encoder is simulated with its\n\
     true angle, diagnosed, and the chip of the emitted design run over the same recording. Angle error in mrad of a scale\n\
     period, rms over the last third. In the first row of each table the chip of the diagnosis is also built with the first\n\
     1000 samples of the recording as vectors, and its Verilog equals the model in every bit, in Icarus and in Verilator\n\
     (`nonius verify`). No other cause is named but two: the noise of the encoders with y³ stands before the bend, so it is louder where\n\
     the channel is steep (`amplitude_noise`), and a `vibration` of 45 µrad is what the spline of the motion leaves of the drive.\n";

#[test]
fn what_is_found_is_corrected_by_the_chip() {
    let all = All::run();
    // What the chips of the others should come to.
    let without = all.skewed[DELAYS.len() - 1].after;
    let page = [
        HEAD.to_owned(),
        bends(&all.odd, &all.even),
        skews(&all.skewed, without),
        harmonics(&all.harmonics, without),
        two(&all.pairs, without),
    ];
    nonius_kept::same(
        Path::new(KEPT),
        &page.join("\n"),
        "NONIUS_BLESS=1 cargo test -p nonius-hdl closing_the_loop::",
    );
}

/// The chip learns nine parameters on line.
fn bends(odd: &[Closed], even: &[Closed]) -> String {
    let mut table = String::from(
        "## Bent channels\n\n\
         | bends (cos, sin) | named | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|\n",
    );
    let of = |power, name, bends: [[f64; 2]; 2]| bends.map(|b| (power, name, b));
    let bends = [
        of("y³", "odd_nonlinearity", ODD),
        of("y²", "even_nonlinearity", EVEN),
    ]
    .concat();
    for ((power, name, [cos, sin]), closed) in bends.into_iter().zip(odd.iter().chain(even)) {
        println!("{power} {cos} {sin}: {}", closed.errors());
        closed.found(name);
        assert_eq!(closed.design.calibration.parameters, 9);
        let _ = writeln!(
            table,
            "| y + k {power}: {:.1} %, {:.1} % | {} | {:.2} | {:.2} |",
            100.0 * cos,
            100.0 * sin,
            closed.names(&[name, NOISE_BEFORE_THE_BEND]),
            closed.before,
            closed.after
        );
        assert!(closed.left() < 0.5, "{}", closed.errors());
    }
    table
}

fn skews(skewed: &[Closed], without: f64) -> String {
    let mut table = String::from(
        "## A sine that is sampled later than the cosine\n\n\
         Up to 550 periods a second in both directions, a sample each 20 µs. At constant speed the calibration on line would hide\n\
         the skew in its phase parameter; where the speed changes nothing does.\n\n\
         | delay | named | measured | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|---|\n",
    );
    for (delay, closed) in DELAYS.into_iter().zip(skewed) {
        println!("{delay:e}: {}", closed.errors());
        if delay == 0.0 {
            assert!(closed.findings.is_empty(), "{:#?}", closed.findings);
            let _ = writeln!(
                table,
                "| none | nothing | – | {:.2} | {:.2} |",
                closed.before, closed.after
            );
            continue;
        }
        assert!(closed.design.correction.channel_skew_s != 0.0);
        let found = closed.found("channel_skew");
        let parameter = &found["parameters"][0];
        let number = |key: &str| parameter[key].as_f64().expect("a number");
        let (value, std_error) = (number("value"), number("std_error"));
        let _ = writeln!(
            table,
            "| {:.2} µs | {} | {:.3} ± {:.3} µs | {:.2} | {:.2} |",
            1e6 * delay,
            closed.names(&["channel_skew", LEFT_OF_THE_DRIVE]),
            1e6 * value,
            1e6 * std_error,
            closed.before,
            closed.after
        );
        assert!(
            (value - delay).abs() < 5.0 * std_error,
            "{value} ± {std_error}"
        );
        // The calibration follows some of it as a phase; with the correction it is as if there were none.
        let mended = closed.left() < 0.2 && closed.after < 1.1 * without;
        assert!(mended, "{}", closed.errors());
    }
    table
}

/// The chip takes them from a table.
fn harmonics(closed: &[Closed], without: f64) -> String {
    let mut table = String::from(
        "## Harmonics of the scale period that are no bend\n\n\
         The same motion. What looks like a gain or a phase error along the radius also moves the calibration of the chip that does\n\
         not know.\n\n\
         | order, amplitude and phase (cos; sin) | measured | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|\n",
    );
    for (harmonic, closed) in HARMONICS.into_iter().zip(closed) {
        println!("{harmonic:?}: {}", closed.errors());
        assert!(!closed.design.correction.harmonics.is_empty());
        let found = closed.found("spatial_harmonic");
        let number = |i: usize| found["parameters"][i]["value"].as_f64().expect("a number");
        let (order, cos, sin) = harmonic;
        assert_eq!(number(0), f64::from(order));
        let _ = writeln!(
            table,
            "| {order}: {:.2} %, {:.2} rad; {:.2} %, {:.2} rad | {:.3} %, {:.3} rad; {:.3} %, {:.3} rad | {:.2} | {:.2} |",
            100.0 * cos.0,
            cos.1,
            100.0 * sin.0,
            sin.1,
            100.0 * number(1),
            number(2),
            100.0 * number(3),
            number(4),
            closed.before,
            closed.after
        );
        let mended = closed.left() < 0.15 && closed.after < 1.1 * without;
        assert!(mended, "{}", closed.errors());
    }
    table
}

/// Each has its own correction, and neither hides the other.
fn two(closed: &[Closed], without: f64) -> String {
    let mut table = String::from(
        "## Two causes at once\n\n\
         The same motion: bends of 4.0 % and −2.0 % (y + k y³), the fourth harmonic of above, a sine 6 µs late, or early.\n\n\
         | named | chip of `new --from` | chip of the diagnosis |\n|---|---|---|\n",
    );
    for ((_, names), closed) in pairs().into_iter().zip(closed) {
        println!("{names:?}: {}", closed.errors());
        for name in names {
            closed.found(name);
        }
        let _ = writeln!(
            table,
            "| {} | {:.2} | {:.2} |",
            closed.names(&names),
            closed.before,
            closed.after
        );
        let mended = closed.left() < 0.2 && closed.after < 2.0 * without;
        assert!(mended, "{}", closed.errors());
    }
    table
}
