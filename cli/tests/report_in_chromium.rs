//! The reports in headless Chromium: no error, every plot drawn, zoomed and read off, no text clipped, nothing wider than
//! the window; and each of these checks sees a fault that is planted.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::browser::look;
use crate::support::done;
use nonius_sensor::{Motion, Sensor};

const WIDTHS: [u32; 2] = [1280, 390];

const PLAIN: &str = include_str!("../../sensor/tests/support/plain.toml");

/// A harmonic, hum and hysteresis.
const CAUSES: &str = r#"
[[cause]]
name = "spatial_harmonic"
order = 3
amplitude_cos = 0.004
phase_cos = 0.7
amplitude_sin = 0.003
phase_sin = -2.0
[[cause]]
name = "interference"
frequency_hz = 311.3
amplitude_cos = 0.003
phase_cos = 0.4
amplitude_sin = 0.004
phase_sin = 1.9
[[cause]]
name = "hysteresis"
offset_cos = 0.004
offset_sin = -0.003
"#;

/// Noise alone: its picture has logarithmic axes.
const NOISE: &str = r#"
[[cause]]
name = "flicker_noise"
density_at_1_hz = 4e-4
"#;

/// A recording of a sensor with these causes, two samples of which are missing in the middle.
fn recording(causes: &str, folder: &Path) {
    let text = format!("{PLAIN}{causes}");
    let sensor = Sensor::from_toml(&text, "sensor.toml").expect("a sensor");
    let samples = sensor.simulate(&Motion::to_and_fro(&sensor), 1);
    let mut csv = String::from(
        "# adc_bits: 14\n# full_scale: 1.0\n# periods_per_revolution: 16\ntime_s,cos,sin\n",
    );
    let rows = samples.time_s.iter().zip(&samples.cos).zip(&samples.sin);
    for (k, ((time, cos), sin)) in rows.enumerate() {
        if !(3000..3002).contains(&k) {
            writeln!(csv, "{time:.7},{cos:.9},{sin:.9}").expect("text");
        }
    }
    std::fs::write(folder.join("recording.csv"), csv).expect("a recording");
}

fn diagnosed(causes: &str, folder: &Path) -> String {
    recording(causes, folder);
    done(folder, &["diagnose", "recording.csv", "-o", "diagnosis"]);
    std::fs::read_to_string(folder.join("diagnosis/report.html")).expect("a report")
}

fn design() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs/optical.toml")
}

#[test]
fn the_report_of_a_diagnosis_is_whole() {
    let scratch = tempfile::tempdir().expect("scratch folder");
    let html = diagnosed(CAUSES, scratch.path());
    for title in [
        "Spatial harmonic, order 3",
        "Interference, 311.3",
        "Hysteresis",
        "Dropped samples",
        "4 findings together: residual on held-out data, rms",
        "2 samples put back into the time base",
        "Angle less the smooth motion, around the first gap",
    ] {
        assert!(html.contains(title), "{title}");
    }
    for width in WIDTHS {
        let verdict = look(&html, width, scratch.path());
        assert_eq!(verdict.width, width);
        assert_eq!(verdict.faults, [""; 0], "{width} px");
        // Two each for harmonic and hysteresis, three for hum, one for what is lost; seven for the whole.
        assert_eq!(verdict.plots, 2 + 3 + 2 + 1 + 7);
    }
}

#[test]
fn the_report_of_noise_is_whole() {
    let scratch = tempfile::tempdir().expect("scratch folder");
    let html = diagnosed(NOISE, scratch.path());
    assert!(html.contains("Flicker noise"));
    for width in WIDTHS {
        let verdict = look(&html, width, scratch.path());
        assert_eq!(verdict.faults, [""; 0], "{width} px");
        // What is left beside it may be shown too.
        assert!(verdict.plots > 1 + 7, "{}", verdict.plots);
    }
}

#[test]
fn the_report_of_a_design_is_whole() {
    let scratch = tempfile::tempdir().expect("scratch folder");
    let design = design();
    let design = design.to_string_lossy();
    done(scratch.path(), &["build", &design, "-o", "chip"]);
    let html = std::fs::read_to_string(scratch.path().join("chip/report.html")).expect("a report");
    for width in WIDTHS {
        let verdict = look(&html, width, scratch.path());
        assert_eq!(verdict.width, width);
        assert_eq!(verdict.faults, [""; 0], "{width} px");
        assert_eq!(verdict.plots, 3);
    }
}

#[test]
fn planted_faults_are_seen() {
    let scratch = tempfile::tempdir().expect("scratch folder");
    let html = diagnosed(CAUSES, scratch.path());
    let (path, script) = (
        r#"data-name="simulated with the cause" d="M"#,
        r#""use strict";"#,
    );
    let style = |css: &str| html.replacen("</style>", &format!("{css}</style>"), 1);
    let faults = [
        (
            "console",
            html.replacen("</body>", "<script>absent();</script></body>", 1),
        ),
        (
            "offline",
            html.replacen(
                "</body>",
                r#"<img src="https://localhost/a.png" alt=""></body>"#,
                1,
            ),
        ),
        (
            "overflow",
            html.replacen("<h1>", r#"<div style="width:1400px">.</div><h1>"#, 1),
        ),
        (
            "clipped",
            style(".plot figcaption { width: 60px; height: 12px; overflow: hidden; }"),
        ),
        ("clipped", style(".plot .ticks.x span { padding: 0 80px; }")),
        (
            "drawn",
            html.replacen(path, r#"data-name="none" d="MNaN "#, 1),
        ),
        ("drawn", style(".plot .area { height: 20px; }")),
        (
            "zoom",
            html.replacen(script, "\"use strict\";\nif (true) throw 1;", 1),
        ),
        (
            "read",
            html.replacen("toPrecision(5)", "toPrecision(1)", 1)
                .replacen("[m[1] / UNITS", "[m[1] / 2 / UNITS", 1),
        ),
    ];
    for (kind, page) in faults {
        assert_ne!(page, html, "{kind}: nothing was planted");
        let verdict = look(&page, WIDTHS[0], scratch.path());
        let seen = verdict.faults.iter().any(|f| f.starts_with(kind));
        assert!(seen, "{kind}: {:?}", verdict.faults);
    }
}
