//! What a diagnosis makes of the measured recordings: a table of findings and plots for each.
//!
//! They are kept in docs/diagnosed-recordings.md and the folder of that name; NONIUS_BLESS=1 writes them anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use nonius_diagnosis::{Cause, Diagnosis, Finding, diagnose, plots};
use nonius_recording::{Overrides, Recording};

const PAGE: &str = "diagnosed-recordings";
const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius diagnosed_recordings::";

/// Name, scale periods per revolution, what it is.
const RECORDINGS: [(&str, Option<u32>, &str); 9] = [
    (
        "rm44_center",
        Some(1),
        "RM44 magnetic encoder, well mounted, one turn, optical reference",
    ),
    (
        "rm44_static_x500um",
        Some(1),
        "the same, sensor shifted sideways by 0.5 mm",
    ),
    ("rm44_gap_z500um", Some(1), "the same, air gap 0.5 mm wider"),
    (
        "rm44_jumps",
        Some(1),
        "the same on another day, near full scale; the angle has steps of 1 to 1.5° that nobody has explained",
    ),
    (
        "homodyne_settle",
        None,
        "homodyne laser interferometer, 8-bit oscilloscope: a stop from 30 kHz fringe rate to rest",
    ),
    (
        "homodyne_stop",
        None,
        "the same from 131 kHz, with ringing and reversals",
    ),
    (
        "interf3x3_fs",
        None,
        "interferometer with three photodiodes, cos and sin by Clarke transform",
    ),
    ("interf3x3_mmi", None, "the same kind, strongly distorted"),
    (
        "wheel_magnetometer",
        None,
        "magnetometer on a car wheel; the reference is an integrated gyro whose scale is about 0.9 % off",
    ),
];

/// Plots of findings that are shown.
const SHOWN: usize = 2;

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

/// The section of a recording, and its plots.
fn section(
    name: &str,
    what: &str,
    found: &Diagnosis,
    recording: &Recording,
) -> (String, Vec<String>) {
    let mut text = format!("## {name}\n\n{}.\n\n", capital(what));
    let (before, after) = (&found.simulation, &found.extended);
    let change = match (before.position_error_rms_rad, after.position_error_rms_rad) {
        (Some(a), Some(b)) => format!(
            "Angle error {:.3}° rms with five parameters, {:.3}° with what was found, on data that was not fitted",
            a.to_degrees(),
            b.to_degrees()
        ),
        _ => format!(
            "Residual {:.3} % of the amplitude with five parameters, {:.3} % with what was found, on data that was not fitted",
            100.0 * before.held_out_residual_rms,
            100.0 * after.held_out_residual_rms
        ),
    };
    writeln!(text, "{change}.\n").expect("text");
    for finding in &found.findings {
        let named = finding.named_evidence();
        let (names, sentence) = named.split_once(": ").expect("names and a sentence");
        let names = names.replace(" or ", "` or `");
        writeln!(text, "- `{names}`: {sentence}").expect("text");
    }
    if found.findings.is_empty() {
        writeln!(text, "No cause has a name.").expect("text");
    }
    text += "\nLeft:\n\n";
    if found.unexplained.parts.is_empty() {
        writeln!(text, "- {}", found.unexplained.signature).expect("text");
    }
    for part in &found.unexplained.parts {
        writeln!(text, "- {part}").expect("text");
    }
    text.push('\n');
    let all = plots(found, recording);
    let first_of = |i: usize| all.iter().find(move |p| p.0.starts_with(&format!("{i}-")));
    let findings = (1..=found.findings.len()).filter_map(first_of).take(SHOWN);
    let whole = ["residual-3", "left-1"];
    let spectrum = all.iter().filter(|p| whole.contains(&p.0.as_str()));
    let mut drawn = vec![];
    for (_, plot) in findings.chain(spectrum) {
        drawn.push(plot.svg());
        writeln!(text, "![{}]({PAGE}/{name}-{}.svg)", plot.title, drawn.len()).expect("text");
    }
    text.push('\n');
    (text, drawn)
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

#[test]
fn measured_recordings_are_diagnosed() {
    let mut page = format!(
        "# Measured recordings, diagnosed\n\n\
         Written by `{HOW}`; do not edit.\n\n\
         Where they come from stands in `../shared/data/README.md`; they are no part of the project. Of the RM44 one turn is\n\
         one scale period and one revolution: orders of the period and of the revolution are one and the same there, and time\n\
         and angle as well.\n\n",
    );
    let mut files: Vec<(String, String)> = vec![];
    let mut of_rm44 = vec![];
    for (name, periods_per_revolution, what) in RECORDINGS {
        let Some(path) = nonius_kept::recording("diagnosed_recordings", &format!("{name}.csv"))
        else {
            return;
        };
        let overrides = Overrides {
            periods_per_revolution,
            ..Overrides::default()
        };
        let recording = Recording::read(&path, &overrides).expect("a recording");
        let found = diagnose(&recording).expect("an ellipse");
        let (text, drawn) = section(name, what, &found, &recording);
        page += &text;
        let numbered = drawn.into_iter().enumerate();
        files.extend(numbered.map(|(i, svg)| (format!("{name}-{}.svg", i + 1), svg)));
        if ["rm44_center", "rm44_static_x500um", "rm44_gap_z500um"].contains(&name) {
            of_rm44.push((name, found));
        }
    }
    let Some(tables) = tables() else {
        return;
    };
    page += &tables;
    let folder = docs().join(PAGE);
    if nonius_kept::blessed() {
        let _ = std::fs::remove_dir_all(&folder);
    }
    // Another machine's sine moves an estimate by a part of its error.
    nonius_kept::near(
        &docs().join(format!("{PAGE}.md")),
        &page,
        |x| 0.01 * x.abs().max(0.01),
        HOW,
    );
    for (name, svg) in &files {
        nonius_kept::near(&folder.join(name), svg, |_| 2.0, HOW);
    }
    for (name, found) in &of_rm44 {
        known(name, found);
    }
}

/// A row for each of the sixteen encoders of the tables: names with their SNR, and the angle error.
fn tables() -> Option<String> {
    let path = nonius_kept::recording("diagnosed_recordings", "optical_servo_tables.csv")?;
    let text = std::fs::read_to_string(&path).expect("a text");
    let mut page = String::from(
        "## optical_servo_tables\n\n\
         Sixteen home-made reflective encoders: an averaged period of 512 points each, far from an ellipse. The points are averages over\n\
         the angle, so nothing in them goes with time, and none of the names may (a test looks). Angle error against the index, rms.\n\n\
         | unit | five parameters | with what was found | found (SNR) |\n|---|---|---|---|\n",
    );
    for (unit, one) in nonius_kept::units(&text).iter().enumerate() {
        let recording = Recording::read_from(one.as_bytes(), "unit", &Overrides::default());
        let recording = recording.expect("a period");
        let found = diagnose(&recording).expect("an ellipse");
        let name = |f: &Finding| {
            let order = f
                .parameter("order")
                .map(|n| format!(" {n}"))
                .unwrap_or_default();
            let timeless = [
                Cause::EvenNonlinearity,
                Cause::OddNonlinearity,
                Cause::SpatialHarmonic,
                Cause::Saturation,
                Cause::AdcNonlinearity,
                Cause::Glitches,
                Cause::StuckBit,
            ];
            assert!(timeless.contains(&f.cause), "{unit}: {}", f.cause);
            let snr = f.gain.detection_snr.map(|snr| format!(" ({snr:.0})"));
            format!("`{}`{order}{}", f.cause, snr.unwrap_or_default())
        };
        let names: Vec<String> = found.findings.iter().map(name).collect();
        let errors = [
            found.simulation.position_error_rms_rad,
            found.extended.position_error_rms_rad,
        ];
        let [before, after] = errors.map(|e| e.expect("a reference").to_degrees());
        assert!(after <= before, "{unit}: {before} {after}");
        let names = if names.is_empty() {
            "nothing that has a name".into()
        } else {
            names.join(", ")
        };
        writeln!(page, "| {unit} | {before:.2}° | {after:.2}° | {names} |").expect("text");
    }
    Some(page + "\n")
}

/// The line that is known to be there is named, or said to be at a fixed frequency; and a gain that is worth the name.
fn known(name: &str, found: &Diagnosis) {
    let hum = found.findings.iter().any(|f| {
        let hertz = f.parameter("frequency_hz").unwrap_or(0.0);
        [Cause::Interference, Cause::AmplitudeRipple].contains(&f.cause)
            && (hertz - 256.0).abs() < 3.0
    });
    let told = found.unexplained.signature.contains("a fixed frequency");
    assert!(hum || told, "{name}: the line near 256 Hz");
    let error = |value: Option<f64>| value.expect("a reference");
    let before = error(found.simulation.position_error_rms_rad);
    let after = error(found.extended.position_error_rms_rad);
    assert!(after < 0.7 * before, "{name}: {before} {after}");
}
