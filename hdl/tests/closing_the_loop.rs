//! Recording, diagnosis, emitted design, chip: the angle error that the diagnosis takes away, on the chip; and that chip, with
//! the recording among its vectors, equal to the model in both simulators.
//!
//! The tables are kept in docs/closing-the-loop.md; NONIUS_BLESS=1 writes it anew.

use std::f64::consts::TAU;
use std::ffi::OsString;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use nonius_hdl::progress::silent;
use nonius_hdl::verify::{Options, verify};
use nonius_model::spec::Spec;
use nonius_recording::{Overrides, Recording};
use nonius_sensor::{Motion, Sensor};

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/closing-the-loop.md");
const ROWS: u32 = 60_000;
/// Rows of the recording that become vectors.
const PLAYED: usize = 1_000;

const HEAD: &str = "# sample_rate_hz: 50000\n# adc_bits: 14\n# full_scale: 1\n# periods_per_revolution: 64\ntime_s,cos,sin,reference_rad\n";

/// The command, successfully.
fn done(arguments: &[&dyn AsRef<Path>]) {
    let named = arguments.iter().map(|a| a.as_ref().as_os_str().to_owned());
    let code = nonius::run(std::iter::once(OsString::from("nonius")).chain(named));
    assert_eq!(code, 0);
}

/// A recording of a bent encoder of 64 periods per revolution, with its true angle.
fn bent_encoder(bends: [f64; 2]) -> String {
    let mut text = String::from(HEAD);
    let mut state = 7u64;
    let mut noise = || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            sum += (state >> 40) as f64 / f64::from(1 << 24);
        }
        sum * 1e-3
    };
    for k in 0..ROWS {
        let t = f64::from(k) / 50e3;
        // From 250 to 550 periods a second and back.
        let alpha = TAU * (400.0 * t - 150.0 / TAU / 0.8 * (TAU * 0.8 * t).sin());
        let bent = |u: f64, k: f64| u + k * u * u * u;
        let cos = 0.7 * bent(alpha.cos() + noise(), bends[0]) + 0.03;
        let sin = 0.66 * bent((alpha - 0.05).sin() + noise(), bends[1]) - 0.02;
        let code = |v: f64| (v * 8192.0).round() / 8192.0;
        let _ = writeln!(
            text,
            "{t:.6},{},{},{:.6}",
            code(cos),
            code(sin),
            alpha.rem_euclid(TAU)
        );
    }
    text
}

/// A sine that is sampled so many seconds later.
fn skew(delay_s: f64) -> String {
    format!("[[cause]]\nname = \"channel_skew\"\ndelay_s = {delay_s:e}\n")
}

/// An order of the scale period with amplitude and phase in each channel.
fn harmonic((order, cos, sin): (u32, (f64, f64), (f64, f64))) -> String {
    format!(
        "[[cause]]\nname = \"spatial_harmonic\"\norder = {order}\namplitude_cos = {}\nphase_cos = {:?}\n\
         amplitude_sin = {}\nphase_sin = {:?}\n",
        cos.0, cos.1, sin.0, sin.1
    )
}

/// A recording of a sensor with a cause as `sensor.toml` has it, up to 550 periods a second in both directions, with its true
/// angle: that at which the cosine is sampled.
fn simulated_encoder(cause: &str) -> String {
    let sensor = format!(
        "[signals]\na_c = 0.7\nb_c = 0.03\na_s = 0.66\nb_s = -0.02\nbeta = 0.05\nnoise_rms = 0.001\n\
         [adc]\nbits = 14\nlsb = {}\ncentre = 0.0\nsample_rate_hz = 50000.0\n\
         [motion]\nperiods_travelled = 420.0\nspeed_max_periods_per_s = 550.0\nperiods_per_revolution = 64\n\
         {cause}",
        1.0 / 8192.0
    );
    let sensor = Sensor::from_toml(&sensor, "sensor.toml").expect("a sensor");
    // Three times to and fro.
    let swing = 550.0 / (TAU * 2.5);
    let (time_s, alpha) = (0..ROWS)
        .map(|k| {
            let t = f64::from(k) / 50e3;
            (t, TAU * swing * (1.0 - (TAU * 2.5 * t).cos()))
        })
        .unzip();
    let motion = Motion { time_s, alpha };
    let seen = sensor.simulate(&motion, 5);
    let mut text = String::from(HEAD);
    for (k, alpha) in motion.alpha.iter().enumerate() {
        let (t, cos, sin) = (seen.time_s[k], seen.cos[k], seen.sin[k]);
        let _ = writeln!(text, "{t:.6},{cos},{sin},{:.6}", alpha.rem_euclid(TAU));
    }
    text
}

/// Rms over the last third of the chip's position against the truth, mrad of a scale period.
fn error(dir: &Path, design: &str) -> f64 {
    let out = dir.join("out.csv");
    done(&[
        &"simulate",
        &dir.join(design),
        &dir.join("r.csv"),
        &"-o",
        &out,
    ]);
    let said = fs::read_to_string(out).expect("what simulate wrote");
    let truth = fs::read_to_string(dir.join("r.csv")).expect("the recording");
    let positions = said.lines().skip(1).map(|l| {
        let cell = l.split(',').nth(1).and_then(|c| c.parse::<f64>().ok());
        cell.expect("a position") * TAU
    });
    let angles = truth.lines().skip(5).map(|l| {
        let cell = l.split(',').nth(3).and_then(|c| c.parse::<f64>().ok());
        cell.expect("an angle")
    });
    let errors: Vec<f64> = positions
        .zip(angles)
        .skip(2 * ROWS as usize / 3)
        .map(|(p, a)| p - a - TAU * ((p - a) / TAU).round())
        .collect();
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    1e3 * (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt()
}

struct Closed {
    /// The design that the diagnosis writes.
    design: Spec,
    /// What the diagnosis finds first.
    first: serde_json::Value,
    /// Angle error of the chip that knows nothing, and of that of the diagnosis.
    before: f64,
    after: f64,
}

impl Closed {
    /// Share of the angle error that the chip of the diagnosis leaves.
    fn left(&self) -> f64 {
        self.after / self.before
    }

    fn errors(&self) -> String {
        format!("{:.3} -> {:.3} mrad", self.before, self.after)
    }
}

/// From the recording to the chip, in the simulators too where that is asked for.
fn closed(recording: &str, simulated: bool) -> Closed {
    let dir = tempfile::tempdir().expect("scratch folder");
    let dir = dir.path();
    let (file, found) = (dir.join("r.csv"), dir.join("found"));
    fs::write(&file, recording).expect("a recording");
    let read = Recording::read(&file, &Overrides::default()).expect("a recording");
    let plain = nonius::new::fitted_text("plain", &file, &read).expect("a design can follow it");
    fs::write(dir.join("plain.toml"), plain).expect("a design");
    done(&[&"diagnose", &file, &"-o", &found]);
    let json = fs::read_to_string(dir.join("found/findings.json")).expect("findings");
    let design = "found/design.toml";
    if simulated {
        let rows = recording.split_inclusive('\n').take(5 + PLAYED);
        let head = dir.join("head.csv");
        fs::write(&head, rows.collect::<String>()).expect("its beginning");
        // The named stimuli have tests of their own.
        let (from, to) = (dir.join(design), dir.join("chip"));
        done(&[
            &"build", &from, &"-o", &to, &"--play", &head, &"--rows", &"20",
        ]);
        let report = verify(dir.join("chip"), &Options::PATIENT, &silent);
        let report = report.unwrap_or_else(|e| panic!("{e}"));
        assert!(report.passed && report.runs.len() == 2, "{report:#?}");
        let played = fs::read_to_string(dir.join("chip/vectors/recording.vec"));
        assert_eq!(
            played.expect("the recording's vectors").lines().count(),
            PLAYED
        );
    }
    let text = fs::read_to_string(dir.join(design)).expect("a design");
    let findings: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    Closed {
        design: Spec::from_toml(&text, design).expect("a design"),
        first: findings["findings"][0].clone(),
        before: error(dir, "plain.toml"),
        after: error(dir, design),
    }
}

const BENDS: [[f64; 2]; 2] = [[0.04, 0.02], [0.03, -0.03]];
const DELAYS: [f64; 3] = [10e-6, -6e-6, 0.0];

/// Order, amplitude and phase in the cosine, in the sine.
type Harmonic = (u32, (f64, f64), (f64, f64));

const HARMONICS: [Harmonic; 2] = [
    (4, (0.015, 0.4), (0.015, -1.2)),
    (3, (0.012, 0.9), (0.008, -2.3)),
];

#[test]
fn what_is_found_is_corrected_by_the_chip() {
    let mut table = String::from(
        "# Closing the loop\n\n\
         Written by `NONIUS_BLESS=1 cargo test -p nonius-hdl closing_the_loop::`; do not edit. An encoder is simulated with its\n\
         true angle, diagnosed, and the chip of the emitted design run over the same recording. Angle error in mrad of a scale\n\
         period, rms over the last third. In the first row of each table the chip of the diagnosis is also built with the first\n\
         1000 samples of the recording as vectors, and its Verilog equals the model in every bit, in Icarus and in Verilator\n\
         (`nonius verify`).\n\n\
         ## Bent channels\n\n\
         | bends y + k y³ (cos, sin) | named | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|\n",
    );
    // Simulators run side by side.
    let (bent, skewed, harmonics) = std::thread::scope(|scope| {
        let bent = BENDS.map(|b| scope.spawn(move || closed(&bent_encoder(b), b[0] == 0.04)));
        let skewed =
            DELAYS.map(|d| scope.spawn(move || closed(&simulated_encoder(&skew(d)), d == 10e-6)));
        let harmonics = HARMONICS
            .map(|h| scope.spawn(move || closed(&simulated_encoder(&harmonic(h)), h.0 == 4)));
        (
            bent.map(|it| it.join().expect("it closes")),
            skewed.map(|it| it.join().expect("it closes")),
            harmonics.map(|it| it.join().expect("it closes")),
        )
    });
    for (bends, closed) in BENDS.into_iter().zip(bent) {
        assert_eq!(
            closed.design.calibration.parameters, 9,
            "{:#}",
            closed.first
        );
        let name = closed.first["cause"].as_str().expect("a name");
        println!("{bends:?}: {name}, {}", closed.errors());
        let _ = writeln!(
            table,
            "| {:.1} %, {:.1} % | `{name}` | {:.2} | {:.2} |",
            100.0 * bends[0],
            100.0 * bends[1],
            closed.before,
            closed.after
        );
        assert!(closed.left() < 0.5, "{}", closed.errors());
    }
    table += "\n## A sine that is sampled later than the cosine\n\n\
         Up to 550 periods a second in both directions, a sample each 20 µs. At constant speed the calibration on line would hide\n\
         the skew in its phase parameter; where the speed changes nothing does.\n\n\
         | delay | named | measured | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|---|\n";
    // What the chips of the others should come to.
    let without = skewed[DELAYS.len() - 1].after;
    for (delay, closed) in DELAYS.into_iter().zip(skewed) {
        let found = &closed.first;
        println!("{delay:e}: {}, {found:#}", closed.errors());
        if delay == 0.0 {
            assert!(found.is_null(), "{found}");
            let _ = writeln!(
                table,
                "| none | nothing | – | {:.2} | {:.2} |",
                closed.before, closed.after
            );
            continue;
        }
        assert!(closed.design.correction.channel_skew_s != 0.0);
        assert_eq!(found["cause"], "channel_skew");
        assert_eq!(found["chip"], "corrects");
        let parameter = &found["parameters"][0];
        let number = |key: &str| parameter[key].as_f64().expect("a number");
        let (value, std_error) = (number("value"), number("std_error"));
        let _ = writeln!(
            table,
            "| {:.2} µs | `channel_skew` | {:.3} ± {:.3} µs | {:.2} | {:.2} |",
            1e6 * delay,
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
    table += "\n## Harmonics of the scale period that are no bend\n\n\
         The same motion. What looks like a gain or a phase error along the radius also moves the calibration of the chip that does\n\
         not know.\n\n\
         | order, amplitude and phase (cos; sin) | measured | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|\n";
    for (harmonic, closed) in HARMONICS.into_iter().zip(harmonics) {
        let found = &closed.first;
        println!("{harmonic:?}: {}, {found:#}", closed.errors());
        assert!(!closed.design.correction.harmonics.is_empty());
        assert_eq!(found["cause"], "spatial_harmonic");
        assert_eq!(found["chip"], "corrects");
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
        assert!(closed.left() < 0.15, "{}", closed.errors());
    }
    nonius_kept::same(
        Path::new(KEPT),
        &table,
        "NONIUS_BLESS=1 cargo test -p nonius-hdl closing_the_loop::",
    );
}
