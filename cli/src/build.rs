//! `nonius build`: the whole package of a design.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use nonius_model::spec::{Calibration, Multipliers, Spec};
use nonius_package::{
    DesignJson, Event, PackageError, PullIn, ROWS, SlowLock, may_write, package_followed, write,
};
use nonius_quantity::{counted, engineering, periods_per_second};
use nonius_testvectors::stimulus;

use crate::play;
use crate::recording_args::RecordingArgs;

/// What to build.
#[derive(Args)]
pub(crate) struct Build {
    /// The design.
    design: PathBuf,
    /// Folder to write; replaced if nonius wrote it before.
    #[arg(short)]
    output: PathBuf,
    /// A recording (CSV) to play into the Verilog too, besides the named stimuli; its waves are written.
    #[arg(long, value_name = "RECORDING")]
    play: Option<PathBuf>,
    /// A simulated sensor (sensor.toml of `nonius diagnose`) to play into the Verilog, likewise; it is moved as there.
    #[arg(long, value_name = "SENSOR", conflicts_with = "play")]
    sensor: Option<PathBuf>,
    /// Plays a recording of whole turns so many times.
    #[arg(long, value_name = "N", default_value_t = 1, requires = "play", value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,
    /// Rows of each named stimulus: fewer for a quick check, more for a long one.
    #[arg(long, value_name = "N", default_value_t = ROWS as u32, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    rows: u32,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

/// Whether the chip reaches the accuracy that was asked for and locks on every sensor that is promised.
pub(crate) fn run(args: &Build) -> Result<bool> {
    may_write(&args.output)?;
    let (design, text) = crate::design_file::read(&args.design)?;
    let spec = &design.spec;
    let mut stimuli = stimulus::named(&design, args.rows as usize);
    let shown = match (&args.play, &args.sensor) {
        (Some(_), _) => "recording",
        (None, Some(_)) => "sensor",
        (None, None) => "sweep",
    };
    if shown != "sweep" {
        let overrides = args.recording_args.overrides();
        let (recording, path) =
            play::source(args.play.as_deref(), args.sensor.as_deref(), &overrides)?;
        play::check(spec, &recording, &path, args.repeat)?;
        stimuli.push(play::stimulus(shown, spec, &recording, args.repeat));
    }
    let bar = Bar::new();
    let package = package_followed(&design, stimuli, shown, &|event| bar.follow(event));
    drop(bar);
    let package = match package {
        Err(PackageError::Design(error)) => {
            return Err(crate::design_file::placed(&args.design, &text, &error));
        }
        other => other?,
    };
    let needed = package.json.latency.clock_hz_min;
    if let Some(clock) = spec.chip.clock_hz.filter(|clock| *clock < needed) {
        bail!(
            "{}: chip.clock_hz = {clock}: {} clocks per sample at {} samples per second need at least {needed} Hz; {}",
            crate::design_file::place(&args.design, &text, "chip.clock_hz"),
            package.json.clocks_per_sample,
            spec.adc.sample_rate_hz,
            fewer_clocks(&package.json)
        );
    }
    write(&package.files, &args.output)?;
    summary(&package.json, &args.output, shown);
    Ok(package.json.holds())
}

/// What is being done, on a terminal only.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        Self(crate::progress::line())
    }

    fn follow(&self, event: Event) {
        let doing = match event {
            Event::Generating => "writes the Verilog",
            Event::Simulating => "simulates the chip",
            Event::Starting { starts } => {
                self.0.set_length(starts as u64);
                let bar = "{bar:40} {pos}/{len} {msg}, {eta} left";
                if let Ok(style) = ProgressStyle::with_template(bar) {
                    self.0.set_style(style);
                }
                "starts from power-up"
            }
            Event::Started => return self.0.inc(1),
            Event::Remedying | Event::Writing => {
                self.0.set_style(ProgressStyle::default_spinner());
                if event == Event::Writing {
                    "makes vectors, waves and report"
                } else {
                    "looks for a promise with which every sensor locks"
                }
            }
        };
        self.0.set_message(doing);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

fn summary(j: &DesignJson, output: &Path, shown: &str) {
    let rate = j.spec.adc.sample_rate_hz;
    say!("{} (design {})", j.name, j.hash);
    say!(
        "  accuracy    {:.2e} periods rms predicted, {:.2e} simulated with half of the promised errors, {:.2e} with the weakest signals, {:.2e} \
         asked",
        j.budget.total,
        j.simulated.rms_periods,
        j.simulated_weakest.rms_periods,
        j.budget.asked
    );
    for (unit, per_period) in [
        ("m", j.position.metres_per_period),
        ("rad of the revolution", j.position.radians_per_period),
    ] {
        if let Some(per_period) = per_period {
            let rms = j.simulated.rms_periods * per_period;
            say!("              {}, rms simulated", engineering(rms, unit));
        }
    }
    say!(
        "  speed       {} need a clock of {}: {} clocks per sample",
        engineering(rate, "S/s"),
        engineering(j.latency.clock_hz_min, "Hz"),
        j.clocks_per_sample
    );
    say!(
        "  hardware    {} for {} products, {} table bits",
        counted(j.multipliers, "multiplier"),
        j.products,
        j.sine_table.bits + j.harmonics.as_ref().map_or(0, |h| h.bits)
    );
    if let Multipliers::Count(asked) = j.spec.chip.multipliers
        && asked as usize > j.multipliers
    {
        say!(
            "  note        chip.multipliers = {asked}: more than {} would never have a product",
            j.multipliers
        );
    }
    say!(
        "  bandwidth   {} at -3 dB, to {}",
        engineering(j.tracking.bandwidth_3db_hz, "Hz"),
        periods_per_second(j.tracking.speed_max_periods_per_s)
    );
    say!("  position    {}", position(j));
    pulled_in(&j.pull_in);
    if let Some(missed) = j.slow_lock.as_ref().and_then(SlowLock::missed) {
        say!("  note        {missed}");
    }
    if let Some(peak) = clipped(&j.spec) {
        say!(
            "  note        the sensor that the design promises reaches {peak:.3} of the ADC's range at its worst: it clips"
        );
    }
    if j.budget.arithmetic > j.budget.arithmetic_allowed {
        say!(
            "  note        the words of [formats] add {:.2e} periods rms where the budget allows {:.2e}",
            j.budget.arithmetic,
            j.budget.arithmetic_allowed
        );
    }
    if j.spec.calibration.has_bend() && j.spec.sensor.bend_max > 0.0 {
        say!(
            "  note        what polynomials of third order leave of bends of {} goes with the square of the bend and is not in the \
             budget: simulate such a sensor (`nonius simulate --sensor`)",
            j.spec.sensor.bend_max
        );
    }
    if let Some(why) = unseen(&j.spec) {
        say!("  note        {why}");
    }
    if let Some(why) = uncorrected(j).or_else(|| missed(j)) {
        say!("  note        {why}");
    }
    let folder = output.display();
    say!("  written     {folder}: rtl, tb, vectors, waves, coefficients, design.json, report.html");
    say!("next: nonius verify {folder}");
    let waves = output.join("waves");
    let [vcd, gtkw] = ["vcd", "gtkw"].map(|kind| waves.join(format!("{shown}.{kind}")));
    say!("      gtkwave {} {}", vcd.display(), gtkw.display());
}

/// Why the accuracy is missed, or nearly.
fn missed(j: &DesignJson) -> Option<String> {
    if j.misses() {
        let why = if !j.simulated.locked {
            "the loop does not lock on the sensor that the design promises"
        } else if j.budget.arithmetic > j.budget.arithmetic_allowed {
            "longer words in [formats] would help"
        } else if j.simulated.rms_periods > 2.0 * j.budget.total {
            "worse than the budget: the calibration has not converged at this speed, the loop lags behind the \
             acceleration of the run (a wider one lags less), or the signals clip"
        } else {
            "noise of the calibration, noise of the loop and what it lags behind in this run add up; a smaller last gamma helps, \
             and where noise is most of it a narrower loop, where the lag is a wider one"
        };
        Some(format!(
            "the simulated accuracy misses what was asked for: {why}"
        ))
    } else if j.misses_with_the_weakest() {
        Some(format!(
            "the weakest signals that are promised (sensor.amplitude_tolerance = {}) miss the accuracy that was asked for: noise and \
             steps of the ADC are larger beside them",
            j.spec.sensor.amplitude_tolerance
        ))
    } else {
        (j.budget.total > j.budget.asked).then(|| {
            format!(
                "{:.2e} periods rms are predicted, on the safe side, of {:.2e} asked; both runs keep it",
                j.budget.total, j.budget.asked
            )
        })
    }
}

/// What the sensor that the design promises reaches at its worst, of the ADC's range, where that is beyond it by more than its rounding.
fn clipped(spec: &Spec) -> Option<f64> {
    let peak = spec.sensor.amplitude * spec.reach() / spec.adc.full_scale;
    let half_a_step = 0.5f64.powi(spec.adc.bits as i32);
    (peak > 1.0 + half_a_step).then_some(peak)
}

/// What the calibration cannot see at speeds that the design promises.
fn unseen(spec: &Spec) -> Option<String> {
    let per_period = spec.adc.sample_rate_hz / spec.sensor.speed_max_periods_per_s;
    let slowest = 1.0 / Calibration::BEND_RATE;
    (spec.calibration.has_bend() && per_period < slowest).then(|| {
        format!(
            "with fewer than {slowest:.1} samples a period, which is within the promised speed, the bends rest: an axis that is never \
             slower does not learn them"
        )
    })
}

/// Why the accuracy is missed, where that is for errors of the sensor that stay.
fn uncorrected(j: &DesignJson) -> Option<String> {
    let b = &j.budget;
    let most = b.uncorrected.powi(2) > b.total.powi(2) / 2.0;
    let verdict = if !most {
        return None;
    } else if j.misses() {
        "the accuracy is missed"
    } else if b.total > b.asked {
        "the accuracy is missed by the worst sensor that is promised"
    } else {
        return None;
    };
    let stays = match j.spec.calibration.parameters {
        0 => {
            "errors of offset, amplitude and phase, which stay without calibration: take calibration.parameters = 5".into()
        }
        n @ (4 | 8) => format!(
            "the phase error (sensor.phase_error_max_deg = {}), which {n} parameters do not correct: take \
             calibration.parameters = {}",
            j.spec.sensor.phase_error_max_deg,
            n + 1
        ),
        _ => "what the correction of harmonics leaves".into(),
    };
    Some(format!(
        "{verdict}: {:.2e} periods rms at worst, of {:.2e} asked, are {stays}",
        b.uncorrected, b.asked
    ))
}

/// How a sample takes fewer clocks.
fn fewer_clocks(j: &DesignJson) -> &'static str {
    match j.spec.chip.multipliers {
        Multipliers::Count(n) if (n as usize) < j.products => {
            "more multipliers need fewer clocks (chip.multipliers = \"all\" the fewest)"
        }
        _ => "no chip of this design takes fewer clocks: lower the sample rate or raise the clock",
    }
}

/// From power-up into full speed.
fn pulled_in(p: &PullIn) {
    let Some(missed) = p.missed() else {
        say!(
            "  lock        all of {} sensors at the ends of the promise from power-up into full speed both ways, {} starts \
             each, within {}",
            p.sensors,
            p.starts_each,
            engineering(p.longest_s, "s")
        );
        return;
    };
    say!("  note        {missed}");
    say!("              to change: {}", p.advice());
}

/// The position at the output in the units that the design has for it.
fn position(j: &DesignJson) -> String {
    let p = &j.position;
    let bits = format!(
        "{} bits of periods and {} of fraction",
        p.period_bits, p.fraction_bits
    );
    match (p.step_m, p.range_m, p.radians_per_period) {
        (Some(step), Some(range), _) => {
            let (step, range) = (engineering(step, "m"), engineering(range, "m"));
            format!("{bits}: steps of {step}, to {range} either way")
        }
        (_, _, Some(radians)) => format!(
            "{bits}: steps of {}",
            engineering(p.step_periods * radians, "rad of the revolution")
        ),
        _ => bits,
    }
}
