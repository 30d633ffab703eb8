//! A draft that is fitted to a recording.

use std::path::Path;

use anyhow::{Result, bail};
use nonius_calibration::no_ellipse;
use nonius_quantity::digits;
use nonius_recording::{AdcSource, Ellipse, Recording, Survey};

use super::FINEST;
use super::draft::{Draft, rounded_up, short};
use super::promise::Promise;

/// Largest errors of a sensor that a draft promises: of the amplitude, and degrees.
const MOST: f64 = 0.6;
const MOST_DEGREES: f64 = 45.0;
const SPARE: &str = "and some to spare";

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

/// Speed, periods per sample, beyond which no chip follows.
const FASTEST: f64 = 0.25;

/// Refuses what only seems to turn too fast: noise about a standstill has any angle in each sample.
pub(super) fn turns(file: &Path, recording: &Recording, survey: &Survey) -> Result<()> {
    if survey.motion.max_speed_periods_per_sample > FASTEST
        && let Some(why) = no_ellipse(&recording.cos, &recording.sin)
    {
        bail!("{}: {why}", file.display());
    }
    Ok(())
}

/// A draft that can follow what the recording shows.
pub(super) fn fitted(
    name: &str,
    file: &Path,
    recording: &Recording,
    survey: &Survey,
) -> Result<Draft> {
    let signals = Signals::of(recording, &survey.fit.ellipse);
    let codes = signals.described().unwrap_or_else(|| signals.held());
    let rate = recording.metadata.sample_rate_hz;
    let speed = speed(file, rate, survey)?;
    let (bandwidth, of_speed) = bandwidth(speed, rate);
    Ok(Draft {
        name: name.into(),
        description: format!("fitted to a recording of {} samples", recording.samples()),
        head: head(recording, survey),
        amplitude: (short(signals.amplitude), signals.measured_amplitudes()),
        amplitude_tolerance: signals.tolerance(),
        offset_max: signals.offset(codes.middle),
        phase_error_max_deg: signals.phase_error(),
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
        bits: (codes.bits, codes.whence.into()),
        full_scale: (codes.full_scale, codes.whence.into()),
        middle: codes.middle,
        sample_rate: (rate, "of the recording".into()),
        bandwidth: (short(bandwidth), of_speed.into()),
        accuracy: FINEST,
    })
}

/// What the draft is made of, in a sentence.
fn head(recording: &Recording, survey: &Survey) -> String {
    format!(
        "Fitted to a recording: {} samples, {:.2} scale periods travelled, residual {:.2e} of the amplitude.",
        recording.samples(),
        survey.motion.periods_travelled,
        survey.fit.residual_rms
    )
}

/// The largest speed, periods per second, with some to spare as far as a chip follows; refused where the recording turns too fast for
/// any chip.
fn speed(file: &Path, rate: f64, survey: &Survey) -> Result<f64> {
    let seen = survey.motion.max_speed_periods_per_sample;
    if seen > FASTEST {
        bail!(
            "{}: the signals turn by up to {seen:.3} periods per sample; a chip needs four samples per period. Sample \
             at {:.4e} Hz or more.",
            file.display(),
            // Where it is just too fast the rate that it has is no advice.
            1.01 * seen * rate * 4.0
        );
    }
    Ok((seen * 1.3).clamp(1e-4, FASTEST) * rate)
}

/// The ADC of a draft.
struct Codes {
    bits: u32,
    full_scale: f64,
    /// Value of the code 0.
    middle: f64,
    /// Where the numbers come from.
    whence: &'static str,
}

/// The two channels of a recording, as its ellipse has them.
struct Signals<'a> {
    recording: &'a Recording,
    ellipse: &'a Ellipse,
    /// Mean of both channels.
    amplitude: f64,
    /// What either is off that, of it.
    spread: f64,
}

impl<'a> Signals<'a> {
    fn of(recording: &'a Recording, ellipse: &'a Ellipse) -> Self {
        let amplitude = (ellipse.a_c + ellipse.a_s) / 2.0;
        Self {
            recording,
            ellipse,
            amplitude,
            spread: (ellipse.a_c - ellipse.a_s).abs() / (2.0 * amplitude),
        }
    }

    /// The comment beside the amplitude.
    fn measured_amplitudes(&self) -> String {
        let [cos, sin] = [self.ellipse.a_c, self.ellipse.a_s].map(|a| digits(a, 5));
        format!("measured: {cos} (cos), {sin} (sin)")
    }

    /// What is promised of the amplitudes.
    fn tolerance(&self) -> Promise {
        let spread = self.spread;
        Promise::of(spread, spread * 1.3 + 0.1, MOST, "and a tenth to spare")
    }

    /// What is promised of the offsets from this `middle`.
    fn offset(&self, middle: f64) -> Promise {
        let measured = self.offset_from(middle);
        Promise::of(measured, measured * 1.3 + 0.05, MOST, SPARE)
    }

    /// What is promised of the phase error.
    fn phase_error(&self) -> Promise {
        let beta = self.ellipse.beta.to_degrees();
        Promise::of(beta, beta.abs() * 1.3 + 2.0, MOST_DEGREES, SPARE)
    }

    /// The larger offset of both channels from this `middle`, of the amplitude.
    fn offset_from(&self, middle: f64) -> f64 {
        let [cos, sin] = [self.ellipse.b_c, self.ellipse.b_s].map(|b| (b - middle).abs());
        cos.max(sin) / self.amplitude
    }

    /// The ADC that the recording says it was made with, where it is one for both channels, such as a design may have, and the
    /// signals are neither beyond it nor lost in it.
    fn described(&self) -> Option<Codes> {
        let (own, sin) = (
            self.recording.metadata.adc.cos,
            self.recording.metadata.adc.sin,
        );
        let same = own.bits == sin.bits && own.lsb == sin.lsb && own.centre == sin.centre;
        let full_scale = own.full_scale();
        let fits = same
            && own.source == AdcSource::Described
            && (8..=18).contains(&own.bits)
            && self.offset_from(own.centre) < 0.4
            && self.amplitude * (1.0 + self.spread) <= full_scale
            && self.amplitude * 60.0 > full_scale;
        fits.then_some(Codes {
            bits: own.bits,
            full_scale,
            middle: own.centre,
            whence: "as the recording says",
        })
    }

    /// An ADC that holds every sample and what the design promises of the sensor, at least as fine as the recording's own steps.
    fn held(&self) -> Codes {
        let Recording {
            cos, sin, metadata, ..
        } = self.recording;
        let middle = short((self.ellipse.b_c + self.ellipse.b_s) / 2.0);
        let reach = |values: &[f64]| {
            let far = values.iter().map(|v| (v - middle).abs());
            far.fold(0.0, f64::max)
        };
        let reach = reach(cos).max(reach(sin));
        let amplitude = self.amplitude;
        let promised = amplitude * (1.0 + self.tolerance().value + self.offset(middle).value);
        let seen = reach.clamp(amplitude * 1.2, amplitude * 4.0) * 1.05;
        let full_scale = rounded_up(seen.max(promised));
        let finest = metadata.adc.cos.lsb.min(metadata.adc.sin.lsb);
        let bits = (2.0 * full_scale / finest).log2().ceil().clamp(8.0, 18.0);
        Codes {
            bits: bits as u32,
            full_scale,
            middle,
            whence: "fitted: holds every sample, as fine as its steps",
        }
    }
}
