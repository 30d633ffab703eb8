//! `sensor.toml`: the extended simulation, as a file to be read and run.

use std::fmt::Write;

use nonius_recording::{AdcPair, Recording};

use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding, OTHER_ORDER, Parameter, Place};

/// Name of the file beside it that the sensor is moved along: what [`crate::motion_csv`] says.
pub const MOTION: &str = "motion.csv";

/// The sensor that the recording shows.
#[must_use]
pub fn sensor_toml(found: &Diagnosis, recording: &Recording) -> String {
    let e = found.context.ellipse;
    let noise = found
        .simulation
        .causes
        .iter()
        .find(|c| c.cause == Cause::WhiteNoise);
    let white = noise
        .and_then(|c| c.parameters.first())
        .map_or(0.0, |p| p.value);
    // Along the radius, noise in proportion to the channels has ¾ of its square.
    let with_signal = found
        .findings
        .iter()
        .filter(|f| f.cause == Cause::AmplitudeNoise);
    let with_signal: f64 = with_signal
        .filter_map(|f| f.parameter("rms"))
        .map(|rms| 0.75 * rms * rms)
        .sum();
    let noise = (white * white - with_signal).max(0.0).sqrt();
    let AdcPair { cos: adc, sin } = recording.metadata.adc;
    let mut out = String::from(
        "# The sensor that a recording shows: equation (4), its noise, its ADC, and the causes that were found.\n\n[signals]\n",
    );
    let offset = |b: f64, channel: usize| b + taken_off(found, recording, channel);
    for (name, value, note) in [
        ("a_c", e.a_c, "amplitude of cos, in the unit of the columns"),
        ("b_c", offset(e.b_c, 0), "offset of cos"),
        ("a_s", e.a_s, "amplitude of sin"),
        ("b_s", offset(e.b_s, 1), "offset of sin"),
        ("beta", e.beta, "phase error, rad"),
        ("noise_rms", noise, "white, of the amplitude"),
    ] {
        let _ = writeln!(out, "{:<34} # {note}", format!("{name} = {value:?}"));
    }
    let _ = writeln!(
        out,
        "\n[adc]\nbits = {}\nlsb = {:?}\ncentre = {:?}\nsample_rate_hz = {:?}",
        adc.bits, adc.lsb, adc.centre, recording.metadata.sample_rate_hz
    );
    if !recording.metadata.adc.is_one() {
        let _ = writeln!(
            out,
            "\n[adc.sin] # the codes of sin are others\nlsb = {:?}\ncentre = {:?}",
            sin.lsb, sin.centre
        );
    }
    let file = format!("file = {MOTION:?}");
    let _ = writeln!(
        out,
        "\n[motion]\n{file:<34} # that of the recording; without this line to and fro, as far and as fast\nperiods_travelled = {:?}\nspeed_max_periods_per_s = {:?}",
        found.periods_travelled,
        found.context.top_speed() / std::f64::consts::TAU
    );
    if let Some(n) = recording.metadata.periods_per_revolution {
        let _ = writeln!(out, "periods_per_revolution = {n}");
    }
    for finding in &found.findings {
        // Single codes that never come are a table, which the simulation has none of; nor does it know a charge at the beginning, which
        // offsets that drift do as well.
        let drifts = finding.confounded_with.iter().any(|c| c.is_drift());
        let charge = finding.cause == Cause::AcCoupling && drifts;
        if charge || matches!(finding.place, Some(Place::Missing { .. })) {
            let _ = writeln!(out, "\n# not simulated: {}", finding.evidence);
            continue;
        }
        let _ = writeln!(out, "\n[[cause]]\nname = \"{}\"", finding.cause);
        for p in parameters(finding, recording) {
            let key = p
                .name
                .replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "_");
            let value = format!("{key} = {:?}", p.value);
            let _ = match (p.std_error, p.unit.as_str()) {
                // A count or an order has no error.
                (0.0, "1") => writeln!(out, "{value}"),
                (0.0, unit) => writeln!(out, "{value:<34} # {unit}"),
                (error, unit) => writeln!(out, "{value:<34} # +/- {error:.3e} {unit}"),
            };
        }
        if let Some(Place::Code { channel, .. }) = finding.place {
            let _ = writeln!(out, "channel = {:?}", ["cos", "sin"][channel]);
        }
    }
    out
}

/// What the codes of a channel that err are less than those that do not, on the average, in the unit of the columns. The fit has it in the offset,
/// and the simulated converter takes it off again.
fn taken_off(found: &Diagnosis, recording: &Recording, channel: usize) -> f64 {
    let adc = recording.metadata.adc;
    let lsb = [adc.cos.lsb, adc.sin.lsb][channel];
    let here =
        |f: &&Finding| matches!(f.place, Some(Place::Code { channel: at, .. }) if at == channel);
    let codes = found.findings.iter().filter(here).map(|finding| {
        let all = parameters(finding, recording);
        let value = |name: &str| all.iter().find(|p| p.name == name).map_or(0.0, |p| p.value);
        match finding.cause {
            // Half of the codes have it.
            Cause::StuckBit => (0.5 - value("level")) * value("bit").exp2(),
            Cause::CoarseQuantisation => (value("step_lsb") - 1.0) / 2.0,
            _ => 0.0,
        }
    });
    lsb * codes.sum::<f64>()
}

/// What the simulation needs to know of a finding: its parameters, and what follows from the recording.
fn parameters(finding: &Finding, recording: &Recording) -> Vec<Parameter> {
    let mut all = finding.parameters.clone();
    let samples = recording.samples() as f64;
    match (finding.cause, finding.place) {
        // As a share: a simulated recording is longer or shorter.
        (Cause::DroppedSamples, _) => {
            let lost = finding.parameter("count").unwrap_or(0.0);
            all = vec![Parameter::exact("share", lost / (samples + lost), "1")];
        }
        (Cause::RepeatedSamples, _) => {
            let doubled = finding.parameter("count").unwrap_or(0.0);
            all = vec![Parameter::exact("share", doubled / samples, "1")];
        }
        // One sensor is simulated, not both that it may be.
        (Cause::SpatialHarmonic, _) => all.retain(|p| p.name != OTHER_ORDER),
        (name, Some(Place::Code { channel, .. })) => {
            let adc = recording.metadata.adc;
            let bits = [adc.cos.bits, adc.sin.bits][channel];
            let codes = recording.codes().map(|(c, s)| [c, s][channel]);
            // From the lowest code on.
            let first = codes.map(|c| c + (1i64 << (bits - 1))).next().unwrap_or(0);
            if name == Cause::StuckBit {
                let bit = finding.parameter("bit").unwrap_or(0.0) as u32;
                all = vec![
                    Parameter::exact("bit", f64::from(bit), "1"),
                    Parameter::exact("level", (first >> bit & 1) as f64, "1"),
                ];
            } else {
                let step = finding.parameter("step_lsb").unwrap_or(1.0).max(1.0);
                let remainder = first.rem_euclid(step as i64) as f64;
                all.push(Parameter::exact("remainder_lsb", remainder, "LSB"));
            }
        }
        _ => {}
    }
    all
}
