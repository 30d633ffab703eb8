//! Measures how long a diagnosis takes, and writes `diagnosis-speed.md`.
//!
//! `cargo run --release -p nonius-diagnosis --example diagnosis_speed -- docs`

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use nonius_diagnosis::diagnose;
use nonius_recording::{Overrides, Recording};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

/// What is hidden in a recording.
#[derive(Clone, Copy, PartialEq)]
enum Hidden {
    Nothing,
    /// A third harmonic and a line.
    Two,
}

/// A reversing motion at 50 kHz, noise of 0.1 %, 14 bits.
fn recording(samples: usize, hidden: Hidden) -> Recording {
    const RATE: f64 = 50e3;
    const NOISE: f64 = 0.001;
    let mut random = StdRng::seed_from_u64(samples as u64);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let lsb = 2.0 / f64::from(1 << 14);
    let code = |v: f64| (v / lsb).round() * lsb;
    let [mut time, mut cos, mut sin] = [vec![], vec![], vec![]];
    let some = if hidden == Hidden::Two { 1.0 } else { 0.0 };
    for k in 0..samples {
        let t = k as f64 / RATE;
        let alpha = 15.0 * TAU * (TAU * 5.0 * t + 0.3).sin() + 12.0 * TAU * t;
        let hum = 0.001 * some * (TAU * 150.0 * t).cos();
        let bend = 0.002 * some * (3.0 * alpha).cos();
        let c = alpha.cos() + bend + hum + NOISE * normal();
        let s = (alpha - 0.03).sin() - bend + 0.5 * hum + NOISE * normal();
        time.push(t);
        cos.push(code(0.8 * c + 0.02));
        sin.push(code(0.75 * s - 0.01));
    }
    let described = Overrides {
        adc_bits: Some(14),
        full_scale: Some(1.0),
        periods_per_revolution: Some(32),
        ..Overrides::default()
    };
    Recording::from_samples(time, cos, sin, &described).expect("a usable recording")
}

/// Seconds that this process had a processor, where the system tells: what it takes on a core of its own.
fn processor_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// The most memory this process ever held, in megabytes, where the system tells.
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// So often each recording is diagnosed; the fastest counts.
const RUNS: usize = 3;

/// What is found, and the seconds that it took by the clock and on the processor.
struct Run {
    names: Vec<String>,
    seconds: f64,
    own: Option<f64>,
}

fn run(recording: &Recording) -> Run {
    let (start, before) = (Instant::now(), processor_seconds());
    let found = diagnose(recording).expect("an ellipse");
    let seconds = start.elapsed().as_secs_f64();
    let spent = processor_seconds().zip(before);
    let mut names: Vec<String> = found.findings.iter().map(|f| f.cause.to_string()).collect();
    if found.unexplained.significant {
        names.push("unexplained".into());
    }
    if names.is_empty() {
        names.push("nothing".into());
    }
    Run {
        names,
        seconds,
        own: spent.map(|(after, before)| after - before),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "docs".into());
    if !Path::new(&folder).is_dir() {
        return Err(
            format!("{folder}: no folder; usage: diagnosis_speed [DOCS [SAMPLES…]]").into(),
        );
    }
    let sizes = arguments.map(|a| a.parse::<usize>().map_err(|e| format!("{a}: {e}")));
    let sizes: Vec<usize> = sizes.collect::<Result<_, _>>()?;
    let sizes = if sizes.is_empty() {
        vec![100_000, 1_000_000]
    } else {
        sizes
    };
    let mut text = String::from(
        "# Speed of the diagnosis\n\n\
         Written by `cargo run --release -p nonius-diagnosis --example diagnosis_speed -- docs`; do not edit. One core; reversing motion,\n\
         14 bits, noise of 0.1 %, without reference, 32 periods per revolution. Time from the recording in memory to findings\n\
         and positions, by the clock and on the processor, the fastest of three runs: other work on the machine makes the first longer,\n\
         and the second too where it shares the cache. Memory is the most that the process ever held, recording included.\n\n\
         Memory is bounded by a number of bytes a sample, the last column: each sample has its place in the recording, in the\n\
         repaired recording, in what shapes are made of (angle, speed, corrected pair …) and in the data of the model, and a\n\
         spectrum is made of all. Functions are made block by block and only their products are kept. Each finding keeps 12\n\
         bytes a sample at most for its pictures; while an angle is followed anew, what shapes are made of stands there twice.\n\
         In recordings of 50000 samples and more, what is large is found in one block of several first; its numbers, and all\n\
         that is said to be there or not, come from all samples.\n\n\
         | samples | hidden | found | seconds by the clock | on the processor | megabytes | bytes a sample |\n|---|---|---|---|---|---|---|\n",
    );
    for samples in sizes {
        for (hidden, what) in [
            (Hidden::Nothing, "nothing"),
            (Hidden::Two, "third harmonic and line"),
        ] {
            let recording = recording(samples, hidden);
            let mut runs: Vec<Run> = (0..RUNS).map(|_| run(&recording)).collect();
            runs.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
            let Run {
                names,
                seconds,
                own,
            } = runs.swap_remove(0);
            let own = own.map_or("unknown".into(), |s| format!("{s:.2}"));
            let memory = peak_megabytes().map_or("unknown | unknown".into(), |m| {
                format!("{m:.0} | {:.0}", m * 1024.0 * 1024.0 / samples as f64)
            });
            let row = format!(
                "| {samples} | {what} | {} | {seconds:.2} | {own} | {memory} |",
                names.join(", ")
            );
            println!("{row}");
            let _ = writeln!(text, "{row}");
        }
    }
    let target = Path::new(&folder).join("diagnosis-speed.md");
    let fresh = Path::new(&folder).join(".diagnosis-speed.md.new");
    std::fs::write(&fresh, text)?;
    std::fs::rename(&fresh, &target)?;
    Ok(())
}
