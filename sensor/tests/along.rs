//! A motion that is given: followed exactly between its rows, and refused where it is none.

use std::f64::consts::TAU;

use nonius_sensor::{Motion, Sensor};

const PLAIN: &str = include_str!("support/plain.toml");

const HEAD: &str = "time_s,position_periods,speed_periods_per_s\n";

fn sensor() -> Sensor {
    Sensor::from_toml(PLAIN, "sensor.toml").expect("a sensor")
}

/// Position and speed of a cubic on either side of a knot, with the same value, slope and curvature there.
fn spline(t: f64) -> (f64, f64) {
    let bend = if t < 5.3 { 0.5 } else { -2.0 };
    let x = t - 5.3;
    let position = 40.0 - 3.0 * x + 6.0 * x * x + bend * x * x * x;
    (position, -3.0 + 12.0 * x + 3.0 * bend * x * x)
}

fn rows(times: &[f64]) -> String {
    let row = |t: &f64| {
        let (position, speed) = spline(*t);
        format!("{t},{position},{speed}\n")
    };
    times
        .iter()
        .map(row)
        .fold(HEAD.to_owned(), |all, row| all + &row)
}

#[test]
fn a_cubic_spline_is_followed_exactly_between_its_knots() {
    let text = rows(&[5.0, 5.07123, 5.3, 5.300_01, 5.5]);
    let motion = Motion::along(&sensor(), &text, "motion.csv").expect("a motion");
    // At 10 kHz, the first and the last included, and a sensor made of it has as many.
    assert_eq!(motion.alpha.len(), 5001);
    for (t, alpha) in motion.time_s.iter().zip(&motion.alpha) {
        let expected = TAU * spline(*t).0;
        assert!((alpha - expected).abs() < 1e-10, "{t}: {alpha} {expected}");
    }
    let ends = [motion.time_s[0], motion.time_s[5000]];
    assert!((ends[0] - 5.0).abs() < 1e-12 && (ends[1] - 5.5).abs() < 1e-12);
    let seen = sensor().simulate(&motion, 1);
    assert_eq!((seen.cos.len(), &seen.time_s), (5001, &motion.time_s));
}

#[test]
fn spaces_and_other_line_ends_are_read() {
    let text = rows(&[0.0, 0.01]).replace('\n', "\r\n").replace(',', " , ");
    let motion = Motion::along(&sensor(), &text, "motion.csv").expect("a motion");
    assert_eq!(motion.alpha.len(), 101);
}

#[test]
fn a_motion_that_is_none_is_refused_with_its_place() {
    let refused = |text: &str, words: &[&str]| {
        let error = Motion::along(&sensor(), text, "m.csv").expect_err("no motion");
        let said = error.to_string();
        for word in words {
            assert!(said.contains(word), "{word} is not in: {said}");
        }
    };
    let below = |rows: &str, words: &[&str]| refused(&format!("{HEAD}{rows}"), words);
    refused("", &["m.csv:1:", "the header is ``", HEAD.trim()]);
    refused(
        "time_s,cos,sin\n0,1,0\n",
        &["m.csv:1:", "`time_s,cos,sin`", HEAD.trim()],
    );
    below("0,0,0\n1,2\n", &["m.csv:3:", "2 cells", "three numbers"]);
    below("0,0,0\n1,2,3,4\n", &["m.csv:3:", "4 cells"]);
    below(
        "0,0,0\n1,far,0\n",
        &["m.csv:3:", "'far'", "'position_periods'"],
    );
    below(
        "0,0,nan\n1,2,0\n",
        &["m.csv:2:", "'nan'", "'speed_periods_per_s'", "finite"],
    );
    below("0,0,0\ninf,2,0\n", &["m.csv:3:", "'inf'", "'time_s'"]);
    below(
        "0,1e300,0\n1,2,0\n",
        &["m.csv:2:", "'1e300'", "at most 1e12"],
    );
    below(
        "0,0,0\n2,0,0\n2,1,0\n",
        &["m.csv:4:", "from 2 to 2", "later"],
    );
    below(
        "0,0,0\n2,0,0\n1,1,0\n",
        &["m.csv:4:", "from 2 to 1", "sort"],
    );
    below("", &["m.csv:", "0 rows", "at least two"]);
    below("0,0,0\n", &["m.csv:", "1 row ", "at least two"]);
    below(
        "0,0,0\n1e9,1,0\n",
        &["m.csv:", "1.000e13 samples", "at most 1e7"],
    );
}
