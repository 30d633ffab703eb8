//! `nonius new`: a commented design, on its own or fitted to a recording.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::Spec;
use nonius_package::{digits, periods_per_second};
use nonius_recording::{AdcSource, Recording, Survey};

use crate::recording_args::RecordingArgs;
use crate::target::Target;

/// A new design.
#[derive(Args)]
pub(crate) struct New {
    /// Name of the design and of its Verilog module; ./NAME.toml is written.
    name: String,
    /// Fits ADC range, offset, rate and speed to a recording, so that the design can follow it.
    #[arg(long, value_name = "RECORDING.csv")]
    from: Option<PathBuf>,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

/// Numbers of a design, each with where it comes from.
struct Draft {
    name: String,
    description: String,
    head: String,
    amplitude: (f64, String),
    amplitude_tolerance: (f64, String),
    offset_max: (f64, String),
    phase_error_max_deg: (f64, String),
    noise_rms: (f64, String),
    speed_max: (f64, String),
    scale_period_m: Option<f64>,
    periods_per_revolution: Option<u32>,
    bits: (u32, String),
    full_scale: (f64, String),
    middle: f64,
    sample_rate: (f64, String),
    bandwidth: (f64, String),
    accuracy: f64,
}

/// Asked over found: calibration noise and loop noise add up.
const MARGIN: f64 = 1.1;
/// Accuracies that are tried, from the finest, until the sensor and its ADC allow one.
const FINEST: f64 = 1e-6;
const COARSEST: f64 = 0.1;

pub(crate) fn run(args: &New) -> Result<()> {
    let path = PathBuf::from(format!("{}.toml", args.name));
    if path.exists() {
        bail!(
            "{} exists and is left as it is; choose another name, or move it away",
            path.display()
        );
    }
    let mut draft = match &args.from {
        None => plain(&args.name),
        Some(file) => {
            let recording = Recording::read(file, &args.recording_args.overrides())?;
            let survey = Survey::of(&recording);
            for note in recording.notes.iter().chain(&survey.notes) {
                eprintln!("note: {note}");
            }
            fitted(&args.name, file, &recording, &survey)?
        }
    };
    let design = settle(&mut draft)?;
    let target = Target::new(&path)?;
    target
        .file()
        .write_all(draft.toml().as_bytes())
        .with_context(|| format!("cannot write {}", path.display()))?;
    target.keep_new()?;
    say!(
        "{}: accuracy {:.2e} periods rms predicted, speed to {}",
        path.display(),
        design.budget.total(),
        periods_per_second(draft.speed_max.0)
    );
    for (key, (_, note)) in [
        ("amplitude_tolerance", &draft.amplitude_tolerance),
        ("offset_max", &draft.offset_max),
        ("phase_error_max_deg", &draft.phase_error_max_deg),
    ] {
        if let Some(why) = note.strip_prefix(BEYOND) {
            eprintln!("note: sensor.{key} does not hold what the recording shows{why}");
        }
    }
    say!("next: nonius build {} -o out/{}", path.display(), args.name);
    Ok(())
}

/// The text of a design fitted to a recording.
///
/// # Errors
/// No design can follow the recording.
pub fn fitted_text(name: &str, file: &Path, recording: &Recording) -> Result<String> {
    let mut draft = fitted(name, file, recording, &Survey::of(recording))?;
    settle(&mut draft)?;
    Ok(draft.toml())
}

/// The finest accuracy that the rest of the draft allows and that the bit-true chip reaches, with a tenth to spare.
fn settle(draft: &mut Draft) -> Result<Design> {
    draft.accuracy = FINEST;
    loop {
        match designed(draft) {
            Ok(design) => {
                let reached = nonius_package::simulate(&design).accuracy.rms_periods;
                let spared = rounded_up(MARGIN * draft.accuracy.max(reached.min(COARSEST)));
                if spared <= MARGIN * MARGIN * draft.accuracy {
                    draft.accuracy = spared;
                    return designed(draft);
                }
                draft.accuracy = rounded_up(spared / MARGIN);
            }
            Err(_) if draft.accuracy < COARSEST => {
                draft.accuracy = rounded_up(draft.accuracy * 1.1);
            }
            // A name is no number, and says itself what is wrong.
            Err(error) if names_the_name(&error) => return Err(error),
            Err(error) => {
                return Err(error).context("no design can follow this; the number at fault is");
            }
        }
    }
}

fn names_the_name(error: &anyhow::Error) -> bool {
    let field = error.downcast_ref::<DesignError>();
    matches!(field, Some(DesignError::Field { field, .. }) if field == "name")
}

fn designed(draft: &Draft) -> Result<Design> {
    let spec = Spec::from_toml(&draft.toml(), &format!("{}.toml", draft.name))?;
    Ok(Design::new(&spec)?)
}

/// The next number of two digits.
fn rounded_up(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    short((value / unit - 1e-9).ceil() * unit)
}

/// Four digits.
fn short(value: f64) -> f64 {
    digits(value, 4)
}

/// Largest errors of a sensor that a draft promises: of the amplitude, and degrees.
const MOST: f64 = 0.6;
const MOST_DEGREES: f64 = 45.0;
const SPARE: &str = "and some to spare";
/// How a comment begins that takes a promise back.
const BEYOND: &str = "NOT ENOUGH";

/// A promise that holds what was measured, with something to spare, or says that it does not.
fn promised(measured: f64, wanted: f64, most: f64, spare: &str) -> (f64, String) {
    let seen = digits(measured, 4);
    let note = if measured.abs() > most {
        format!(
            "{BEYOND}: measured {seen}, and no chip is promised to hold more than {most}: adjust the sensor"
        )
    } else if wanted > most {
        format!("measured: {seen}; as much to spare as a chip may promise")
    } else {
        format!("measured: {seen}; {spare}")
    };
    (short(wanted.min(most)), note)
}

fn plain(name: &str) -> Draft {
    let note = String::from;
    Draft {
        name: name.into(),
        description: "a sin/cos encoder".into(),
        head: "A sin/cos encoder. Every number below is an example: replace it with your sensor's."
            .into(),
        amplitude: (0.8, note("nominal, in the unit of full_scale")),
        amplitude_tolerance: (0.15, note("of the amplitude, each channel")),
        offset_max: (0.1, note("of the amplitude, each channel")),
        phase_error_max_deg: (5.0, note("degrees of a scale period")),
        noise_rms: (0.001, note("of the amplitude, each channel")),
        speed_max: (20e3, note("")),
        scale_period_m: Some(20e-6),
        periods_per_revolution: None,
        bits: (12, note("8 to 18")),
        full_scale: (
            1.0,
            note("the ADC spans middle - full_scale ... middle + full_scale"),
        ),
        middle: 0.0,
        sample_rate: (500e3, note("both channels at the same instant")),
        bandwidth: (5e3, note("omega_0 / 2 pi of the closed loop")),
        accuracy: FINEST,
    }
}

/// A loop that follows what the speed makes of errors that are not yet corrected, within what the sample rate allows; and which
/// of the three it is.
fn bandwidth(speed: f64, rate: f64) -> (f64, &'static str) {
    let (wanted, least, most) = (8.0 * speed, 0.02 * rate, 0.06 * rate);
    if wanted < least {
        (least, "2 % of the sample rate, more than 8 times the speed")
    } else if wanted > most {
        (
            most,
            "6 % of the sample rate: 8 times the speed would be more",
        )
    } else {
        (wanted, "8 times the speed")
    }
}

/// A draft that can follow what the recording shows.
fn fitted(name: &str, file: &Path, recording: &Recording, survey: &Survey) -> Result<Draft> {
    let ellipse = survey.fit.ellipse;
    let rate = recording.metadata.sample_rate_hz;
    let amplitude = (ellipse.a_c + ellipse.a_s) / 2.0;
    let spread = (ellipse.a_c - ellipse.a_s).abs() / (2.0 * amplitude);
    let adc = recording.metadata.adc;
    let own = adc.cos;
    let same = own.bits == adc.sin.bits && own.lsb == adc.sin.lsb && own.centre == adc.sin.centre;
    let full = own.lsb * 2f64.powi(own.bits as i32 - 1);
    let offset_from = |middle: f64| {
        let far = (ellipse.b_c - middle)
            .abs()
            .max((ellipse.b_s - middle).abs());
        far / amplitude
    };
    let tolerance = promised(spread, spread * 1.3 + 0.1, MOST, "and a tenth to spare");
    let offset = |middle: f64| {
        let measured = offset_from(middle);
        promised(measured, measured * 1.3 + 0.05, MOST, SPARE)
    };
    let beta = ellipse.beta.to_degrees();
    let described = same
        && own.source == AdcSource::Described
        && (8..=18).contains(&own.bits)
        && offset_from(own.centre) < 0.4
        && amplitude * (1.0 + spread) <= full
        && amplitude * 60.0 > full;
    let (bits, full_scale, middle, whence) = if described {
        (own.bits, full, own.centre, "as the recording says")
    } else {
        let middle = short((ellipse.b_c + ellipse.b_s) / 2.0);
        let reach = |values: &[f64]| {
            let far = values.iter().map(|v| (v - middle).abs());
            far.fold(0.0, f64::max)
        };
        let reach = reach(&recording.cos).max(reach(&recording.sin));
        // And what the design promises of the sensor.
        let promised = amplitude * (1.0 + tolerance.0 + offset(middle).0);
        let seen = reach.clamp(amplitude * 1.2, amplitude * 4.0) * 1.05;
        let full_scale = rounded_up(seen.max(promised));
        // At least as fine as the recording's own steps.
        let finest = adc.cos.lsb.min(adc.sin.lsb);
        let bits = (2.0 * full_scale / finest).log2().ceil().clamp(8.0, 18.0);
        (
            bits as u32,
            full_scale,
            middle,
            "fitted: holds every sample, as fine as its steps",
        )
    };
    let seen = survey.motion.max_speed_periods_per_sample;
    if seen > 0.25 {
        bail!(
            "{}: the signals turn by up to {seen:.3} periods per sample; a chip needs four samples per period. Sample \
             at {:.4e} Hz or more.",
            file.display(),
            seen * rate * 4.0
        );
    }
    let speed = (seen * 1.3).clamp(1e-4, 0.25) * rate;
    let (bandwidth, of_speed) = bandwidth(speed, rate);
    Ok(Draft {
        name: name.into(),
        description: format!("fitted to a recording of {} samples", recording.samples()),
        head: format!(
            "Fitted to a recording: {} samples, {:.2} scale periods travelled, residual {:.2e} of the amplitude.",
            recording.samples(),
            survey.motion.periods_travelled,
            survey.fit.residual_rms
        ),
        amplitude: (
            short(amplitude),
            format!(
                "measured: {} (cos), {} (sin)",
                digits(ellipse.a_c, 5),
                digits(ellipse.a_s, 5)
            ),
        ),
        amplitude_tolerance: tolerance,
        offset_max: offset(middle),
        phase_error_max_deg: promised(beta, beta.abs() * 1.3 + 2.0, MOST_DEGREES, SPARE),
        noise_rms: (
            short(survey.noise_rms.clamp(0.0, 0.25)),
            "measured, of the amplitude".into(),
        ),
        speed_max: (
            short(speed),
            format!(
                "measured: {}",
                digits(survey.motion.max_speed_periods_per_s, 9)
            ),
        ),
        scale_period_m: recording.metadata.scale_period_m,
        periods_per_revolution: recording.metadata.periods_per_revolution,
        bits: (bits, whence.into()),
        full_scale: (full_scale, whence.into()),
        middle,
        sample_rate: (rate, "of the recording".into()),
        bandwidth: (short(bandwidth), of_speed.into()),
        accuracy: FINEST,
    })
}

impl Draft {
    fn toml(&self) -> String {
        let mut out = String::new();
        let line = |key: &str, value: String, note: &str| {
            let text = format!("{key} = {value}");
            if note.is_empty() {
                format!("{text}\n")
            } else {
                format!("{text:<40} # {note}\n")
            }
        };
        let number = |v: f64| {
            if v != 0.0 && !(1e-4..1e7).contains(&v.abs()) {
                format!("{v:e}")
            } else if v.fract() == 0.0 {
                format!("{v:.1}")
            } else {
                format!("{v}")
            }
        };
        let real = |key: &str, v: &(f64, String)| line(key, number(v.0), &v.1);
        let _ = writeln!(out, "# {}", self.head);
        let _ = writeln!(
            out,
            "name = {:?}\ndescription = {:?}\n",
            self.name, self.description
        );
        out += "[sensor]\n";
        out += &real("amplitude", &self.amplitude);
        out += &real("amplitude_tolerance", &self.amplitude_tolerance);
        out += &real("offset_max", &self.offset_max);
        out += &real("phase_error_max_deg", &self.phase_error_max_deg);
        out += &real("noise_rms", &self.noise_rms);
        out += &real("speed_max_periods_per_s", &self.speed_max);
        match self.scale_period_m {
            Some(length) => {
                out += &line("scale_period_m", number(length), "for positions in metres")
            }
            None => {
                out += "# scale_period_m = 20e-6                # linear scales: for positions in metres\n"
            }
        }
        match self.periods_per_revolution {
            Some(n) => out += &line("periods_per_revolution", format!("{n}.0"), ""),
            None => out += "# periods_per_revolution = 1024         # rotary scales\n",
        }
        out += "\n[adc]\n";
        out += &line("bits", self.bits.0.to_string(), &self.bits.1);
        out += &real("full_scale", &self.full_scale);
        out += &line("middle", number(self.middle), "middle of the ADC's range");
        out += &line(
            "coding",
            "\"twos_complement\"".into(),
            "or \"offset_binary\"",
        );
        out += &real("sample_rate_hz", &self.sample_rate);
        out += "\n[loop]\n";
        out += &line("method", "3".into(), "of the paper: 1, 2 or 3");
        out += &line("type", "2".into(), "no lag at constant speed");
        out += &real("bandwidth_hz", &self.bandwidth);
        out += "\n[calibration]\n";
        out += &line(
            "parameters",
            "5".into(),
            "0 (off), 4 (gains, offsets), 5 (and phase), 8, 9 (and bends)",
        );
        out += "# recall = true                         # a signal that fades and comes back leaves nothing in the parameters\n";
        out += "\n# [correction]\n";
        out += "# channel_skew_s = 1e-6                 # sin is sampled so much later than cos\n";
        out += "# [[correction.harmonics]]              # one for each order: amplitude * cos(order * angle + phase) more\n";
        out += "# order = 4\n# amplitude_cos = 0.01                  # of the amplitude\n# phase_cos = 0.5                       # rad\n";
        out += "# amplitude_sin = 0.01\n# phase_sin = -1.0\n";
        out += "\n[accuracy]\n";
        out += &line(
            "rms_periods",
            number(self.accuracy),
            "the finest that sensor, ADC and loop allow",
        );
        out += "\n[chip]\n";
        out += &line("multipliers", "1".into(), "1, 2, ... or \"all\"");
        out += "\n# [formats]                             # any word length in place of the chosen one: see\n";
        out += "# signal_fraction = 16                  # budget.words of design.json for keys, values and limits\n";
        out
    }
}
