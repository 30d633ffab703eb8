//! The report as it is read.

use nonius_calibration::{Curve, Ellipse, Method, Options, calibrate, report, undetermined};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SENSOR: Ellipse = Ellipse {
    a_c: 0.8,
    b_c: 0.05,
    a_s: 0.7,
    b_s: -0.02,
    beta: 0.06,
};

fn signals(periods: f64, sigma: f64, cubic: f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = StdRng::seed_from_u64(3);
    let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
    let step = std::f64::consts::TAU * periods / 2000.0;
    let pair = |k: i32| {
        let y = SENSOR.point(0.5 + step * f64::from(k));
        (
            y.x + cubic * y.x.powi(3) + sigma * draw(),
            y.y + sigma * draw(),
        )
    };
    (0..2000).map(pair).unzip()
}

fn text(method: Method, (cos, sin): &(Vec<f64>, Vec<f64>)) -> String {
    let found = calibrate(cos, sin, method, &Options::default()).expect("a calibration");
    report(&found, Some([2.0 / 4096.0; 2]))
}

#[test]
fn the_default() {
    insta::assert_snapshot!(text(Method::Unbiased, &signals(5.0, 0.004, 0.0)));
}

#[test]
fn extremes() {
    insta::assert_snapshot!(text(Method::Extremes, &signals(5.0, 0.004, 0.0)));
}

#[test]
fn cubic_channels() {
    insta::assert_snapshot!(text(Method::Poly9, &signals(5.0, 0.004, 0.04)));
}

#[test]
fn a_bent_channel_beside_an_ellipse() {
    insta::assert_snapshot!(text(Method::Unbiased, &signals(5.0, 0.004, 0.04)));
}

#[test]
fn a_short_arc() {
    insta::assert_snapshot!(text(Method::Unbiased, &signals(0.3, 0.004, 0.0)));
}

/// Extremes and the algebraic fit of an arc: the word in place of an error bar.
#[test]
fn a_short_arc_by_its_extremes() {
    insta::assert_snapshot!(text(Method::Extremes, &signals(0.3, 0.02, 0.0)));
}

#[test]
fn a_short_arc_by_heydemann() {
    insta::assert_snapshot!(text(Method::Heydemann, &signals(0.25, 0.03, 0.0)));
}

/// Exactly three and four samples a period: the places are counted, and nothing is said of a scale that stands still.
#[test]
fn few_places_of_the_period() {
    for places in [3, 4] {
        let (cos, sin) = signals(2000.0 / f64::from(places), 0.004, 0.0);
        let why =
            calibrate(&cos, &sin, Method::Unbiased, &Options::default()).expect_err("a refusal");
        let text = report(&undetermined(Method::Unbiased, &cos, &sin, &why), None);
        let said = format!("stand at {places} places");
        let flowing = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            flowing.contains(&said) && !flowing.contains("cloud"),
            "{text}"
        );
    }
}

#[test]
fn a_standstill() {
    let (cos, sin) = signals(0.0, 0.004, 0.0);
    let why = calibrate(&cos, &sin, Method::Unbiased, &Options::default()).expect_err("a refusal");
    insta::assert_snapshot!(report(
        &undetermined(Method::Unbiased, &cos, &sin, &why),
        None
    ));
}
