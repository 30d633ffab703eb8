//! The measured recordings beside the workspace, and what each method makes of them.

use std::fmt::Write;
use std::path::Path;

use nonius_calibration::{Method, Options, calibrate};
use nonius_recording::{Overrides, Recording};

/// The page that holds the tables, between the lines [`BEGIN`] and [`END`].
pub(crate) const PAGE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../docs/offline-calibration.md"
);
pub(crate) const BEGIN: &str = "<!-- begin: written by `cargo run -p nonius-calibration --example recordings`; do not edit -->\n";
pub(crate) const END: &str = "<!-- end -->\n";

/// A recording with the name that the table gives it.
struct Named {
    name: &'static str,
    recordings: Vec<Recording>,
}

fn read(path: &Path) -> Recording {
    Recording::read(path, &Overrides::default()).expect("a recording")
}

/// Recordings with a reference; the sixteen encoders of one file as one group.
fn with_reference(folder: &Path) -> Vec<Named> {
    let names = [
        "rm44_center",
        "rm44_static_x500um",
        "rm44_gap_z500um",
        "rm44_jumps",
    ];
    let mut all: Vec<Named> = names
        .map(|name| Named {
            name,
            recordings: vec![read(&folder.join(format!("{name}.csv")))],
        })
        .into();
    all.push(Named {
        name: "optical_servo_tables",
        recordings: units(&folder.join("optical_servo_tables.csv")),
    });
    all
}

/// One recording for each value of the last column.
fn units(path: &Path) -> Vec<Recording> {
    let text = std::fs::read_to_string(path).expect("a kept file");
    let one = |text: String| {
        Recording::read_from(text.as_bytes(), "unit", &Overrides::default()).expect("a recording")
    };
    nonius_kept::units(&text).into_iter().map(one).collect()
}

/// Rms of an angle against the reference in degrees; the best constant and the sense of the reference removed.
pub(crate) fn angle_error(recording: &Recording, correct: &dyn Fn(f64, f64) -> (f64, f64)) -> f64 {
    let reference = recording.reference_rad.as_ref().expect("there is one");
    let pairs = recording.cos.iter().zip(&recording.sin);
    let angles: Vec<f64> = pairs
        .map(|(y_c, y_s)| {
            let (c, s) = correct(*y_c, *y_s);
            s.atan2(c)
        })
        .collect();
    let against = |sense: f64| {
        let differences = || angles.iter().zip(reference).map(|(a, r)| a - sense * r);
        let (sin, cos) = differences()
            .map(f64::sin_cos)
            .fold((0.0, 0.0), |t, d| (t.0 + d.0, t.1 + d.1));
        let constant = sin.atan2(cos);
        let turn = std::f64::consts::TAU;
        let near = |d: f64| d - constant - turn * ((d - constant) / turn).round();
        let square: f64 = differences().map(|d| near(d).powi(2)).sum();
        (square / angles.len() as f64).sqrt().to_degrees()
    };
    against(1.0).min(against(-1.0))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (values[(n - 1) / 2] + values[n / 2]) / 2.0
}

/// The tables.
pub(crate) fn tables(folder: &Path) -> String {
    let names: Vec<&str> = Method::ALL.iter().map(|m| m.name()).collect();
    let head = |first: &str, columns: &[&str]| {
        format!(
            "| {first} | {} |\n|---{}|\n",
            columns.join(" | "),
            "|---".repeat(columns.len())
        )
    };
    let options = Options::default();
    let mut out = String::from(
        "Error of the corrected angle against the reference, degrees rms; the best constant and the sense of the reference\n\
         are removed and nothing else. The last row is the median of sixteen encoders, each calibrated alone.\n\n",
    );
    out += &head("recording", &[&["uncorrected"], &names[..]].concat());
    for named in with_reference(folder) {
        let plain = |r: &Recording| angle_error(r, &|c, s| (c, s));
        let _ = write!(
            out,
            "| {} | {:.3} ",
            named.name,
            median(named.recordings.iter().map(plain).collect())
        );
        for method in Method::ALL {
            let error = |r: &Recording| {
                let found = calibrate(&r.cos, &r.sin, method, &options).expect("a calibration");
                angle_error(r, &|c, s| found.correct(c, s))
            };
            let _ = write!(
                out,
                "| {:.3} ",
                median(named.recordings.iter().map(error).collect())
            );
        }
        out += "|\n";
    }
    out += "\nResidual: the corrected radius less one, per cent rms.\n\n";
    out += &head("recording", &names);
    let others = [
        "homodyne_settle",
        "homodyne_stop",
        "interf3x3_fs",
        "interf3x3_mmi",
        "wheel_magnetometer",
    ];
    let mut all = with_reference(folder);
    all.extend(others.map(|name| Named {
        name,
        recordings: vec![read(&folder.join(format!("{name}.csv")))],
    }));
    for named in &all {
        let _ = write!(out, "| {} ", named.name);
        for method in Method::ALL {
            let residual = |r: &Recording| {
                100.0
                    * calibrate(&r.cos, &r.sin, method, &options)
                        .expect("there is one")
                        .residual_rms
            };
            let _ = write!(
                out,
                "| {:.3} ",
                median(named.recordings.iter().map(residual).collect())
            );
        }
        out += "|\n";
    }
    out += "\nWhat `unbiased` says of each. *Scatter* is how much further consecutive parts of the recording differ than the\n\
            error bars say.\n\n";
    out += &head(
        "recording",
        &[
            "a_c / a_s",
            "b_c / a_c",
            "b_s / a_s",
            "β, degrees",
            "noise ratio sin : cos",
            "distortion, % rms (order)",
            "scatter",
            "left out",
        ],
    );
    for named in &all {
        let [recording] = &named.recordings[..] else {
            continue;
        };
        let found = calibrate(&recording.cos, &recording.sin, Method::Unbiased, &options)
            .expect("a calibration");
        let e = found.ellipse;
        let noise = found.noise.expect("there is one");
        let error = found
            .noise_ratio_error
            .map_or_else(String::new, |e| format!(" ± {e:.2}"));
        let shape = found.shape.map_or_else(
            || "–".into(),
            |s| format!("{:.2} ({})", 100.0 * s.rms, s.order),
        );
        let _ = writeln!(
            out,
            "| {} | {:.4} | {:.4} | {:.4} | {:.3} | {:.2}{error} | {shape} | {} | {} |",
            named.name,
            e.a_c / e.a_s,
            e.b_c / e.a_c,
            e.b_s / e.a_s,
            e.beta.to_degrees(),
            noise[1] / noise[0],
            found
                .scatter
                .map_or_else(|| "–".into(), |s| format!("{s:.1}")),
            found.outliers,
        );
    }
    out
}

/// The page with other tables in it.
pub(crate) fn with_tables(page: &str, tables: &str) -> String {
    let (before, rest) = page
        .split_once(BEGIN)
        .expect("the page has the line that begins the tables");
    let (_, after) = rest
        .split_once(END)
        .expect("the page has the line that ends the tables");
    format!("{before}{BEGIN}\n{tables}\n{END}{after}")
}
