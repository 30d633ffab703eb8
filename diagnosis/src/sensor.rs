//! `sensor.toml`: the extended simulation, as a file to be read and run.

use std::fmt::Write;

use nonius_recording::Recording;

use crate::diagnose::Diagnosis;

/// The sensor that the recording shows.
#[must_use]
pub fn sensor_toml(found: &Diagnosis, recording: &Recording) -> String {
    let e = found.context.ellipse;
    let noise = found
        .simulation
        .causes
        .iter()
        .find(|c| c.cause == "white_noise");
    let noise = noise
        .and_then(|c| c.parameters.first())
        .map_or(0.0, |p| p.value);
    let adc = recording.metadata.adc.cos;
    let mut out = String::from(
        "# The sensor that a recording shows: equation (4), its noise, its ADC, and the causes that were found.\n\n[signals]\n",
    );
    for (name, value, note) in [
        ("a_c", e.a_c, "amplitude of cos, in the unit of the columns"),
        ("b_c", e.b_c, "offset of cos"),
        ("a_s", e.a_s, "amplitude of sin"),
        ("b_s", e.b_s, "offset of sin"),
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
    let top = found
        .context
        .speed
        .iter()
        .fold(0.0f64, |m, v| m.max(v.abs()));
    let _ = writeln!(
        out,
        "\n[motion]\nperiods_travelled = {:?}\nspeed_max_periods_per_s = {:?}",
        found.periods_travelled,
        top / std::f64::consts::TAU
    );
    if let Some(n) = recording.metadata.periods_per_revolution {
        let _ = writeln!(out, "periods_per_revolution = {n}");
    }
    for finding in &found.findings {
        let _ = writeln!(out, "\n[[cause]]\nname = {:?}", finding.cause);
        for p in &finding.parameters {
            let key = p
                .name
                .replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "_");
            let _ = writeln!(
                out,
                "{:<34} # +/- {:.3e} {}",
                format!("{key} = {:?}", p.value),
                p.std_error,
                p.unit
            );
        }
    }
    out
}
