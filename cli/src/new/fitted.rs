//! A draft that is fitted to a recording.

use std::path::Path;

use anyhow::{Result, bail};
use nonius_calibration::no_ellipse;
use nonius_quantity::digits;
use nonius_recording::{AdcSource, Recording, Survey};

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
    let tolerance = Promise::of(spread, spread * 1.3 + 0.1, MOST, "and a tenth to spare");
    let offset = |middle: f64| {
        let measured = offset_from(middle);
        Promise::of(measured, measured * 1.3 + 0.05, MOST, SPARE)
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
        let promised = amplitude * (1.0 + tolerance.value + offset(middle).value);
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
    if seen > FASTEST {
        bail!(
            "{}: the signals turn by up to {seen:.3} periods per sample; a chip needs four samples per period. Sample \
             at {:.4e} Hz or more.",
            file.display(),
            // Where it is just too fast the rate that it has is no advice.
            1.01 * seen * rate * 4.0
        );
    }
    let speed = (seen * 1.3).clamp(1e-4, FASTEST) * rate;
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
        phase_error_max_deg: Promise::of(beta, beta.abs() * 1.3 + 2.0, MOST_DEGREES, SPARE),
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
