//! Every method on signals whose parameters are known.

use nonius_calibration::conic::closed_form;
use nonius_calibration::{Curve, Ellipse, Error, Method, Options, calibrate, undetermined};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const ALL: [Method; 7] = Method::ALL;

fn signals(ellipse: &Ellipse, turns: f64, samples: usize) -> (Vec<f64>, Vec<f64>) {
    let step = turns * std::f64::consts::TAU / samples as f64;
    let points = (0..samples).map(|k| ellipse.point(0.1 + step * k as f64));
    points.map(|p| (p.x, p.y)).unzip()
}

fn crooked(beta: f64) -> Ellipse {
    Ellipse {
        a_c: 1.2,
        b_c: 0.15,
        a_s: 0.9,
        b_s: -0.1,
        beta,
    }
}

#[test]
fn every_method_finds_what_it_can_see() {
    for method in ALL {
        let sees_phase = matches!(
            method,
            Method::Unbiased | Method::Heydemann | Method::Sumsq5 | Method::Poly9
        );
        let truth = crooked(if sees_phase { 0.08 } else { 0.0 });
        let (cos, sin) = signals(&truth, 3.0, 3000);
        let found = calibrate(&cos, &sin, method, &Options::default()).expect("a calibration");
        let tolerance = if method == Method::Extremes {
            1e-5
        } else {
            1e-8
        };
        for (parameter, value) in found.parameters.iter().zip(truth.parameters().iter()) {
            let miss = (parameter.value - value).abs();
            assert!(
                miss < tolerance,
                "{method:?} {}: {} {value}",
                parameter.name,
                parameter.value
            );
        }
        assert!(
            found.residual_rms < tolerance,
            "{method:?}: {}",
            found.residual_rms
        );
        for p in &found.parameters {
            assert!(p.value.is_finite(), "{method:?} {}", p.name);
        }
    }
}

/// Equations (5), for any ellipse: offsets so large that the origin lies outside, and one on the curve itself.
#[test]
fn closed_form_solves_equations_5() {
    for (b_c, b_s, beta) in [
        (0.1, -0.2, 0.1),
        (3.0, -2.0, -0.4),
        (1.2, 0.0, 0.0),
        (0.0, 0.0, 1.2),
    ] {
        let e = Ellipse {
            a_c: 1.2,
            b_c,
            a_s: 0.7,
            b_s,
            beta,
        };
        let (g_c, g_s, sin) = (1.0 / e.a_c, 1.0 / e.a_s, beta.sin());
        let theta = [
            g_c * g_c,
            g_s * g_s,
            2.0 * g_c * g_s * sin,
            -2.0 * g_c * (g_c * b_c + g_s * b_s * sin),
            -2.0 * g_s * (g_s * b_s + g_c * b_c * sin),
            g_c * g_c * b_c * b_c + g_s * g_s * b_s * b_s + 2.0 * g_c * b_c * g_s * b_s * sin
                - beta.cos().powi(2),
        ];
        for sign in [1.0, -1.0] {
            let found = closed_form(theta.map(|t| t * sign)).expect("there is one");
            let miss = (found.parameters() - e.parameters()).amax();
            assert!(miss < 1e-12, "{found:?} {e:?}");
        }
    }
}

#[test]
fn theta_and_physical_parameters_are_each_other() {
    let e = crooked(0.3);
    let back = Ellipse::of_theta(&e.theta());
    assert!((back.parameters() - e.parameters()).amax() < 1e-14);
}

#[test]
fn short_arcs_are_named() {
    let (cos, sin) = signals(&crooked(0.1), 0.4, 2000);
    for method in [Method::Unbiased, Method::Heydemann] {
        let found = calibrate(&cos, &sin, method, &Options::default()).expect("a calibration");
        assert!(
            found
                .cannot_tell
                .iter()
                .any(|s| s.starts_with("0.60 of the scale period holds no sample")),
            "{:?}",
            found.cannot_tell
        );
    }
}

#[test]
fn what_is_no_pair_is_refused() {
    let still = vec![0.5; 100];
    let wave: Vec<f64> = (0..100).map(|k| (f64::from(k) * 0.1).sin()).collect();
    let options = Options::default();
    assert!(matches!(
        calibrate(&still, &wave, Method::Unbiased, &options),
        Err(Error::Standstill(_))
    ));
    assert!(matches!(
        calibrate(&wave[..5], &wave[..5], Method::Unbiased, &options),
        Err(Error::TooFew(5))
    ));
    assert!(matches!(
        calibrate(&wave[..50], &wave, Method::Unbiased, &options),
        Err(Error::Lengths(50, 100))
    ));
    let mut holed = wave.clone();
    holed[7] = f64::NAN;
    assert!(matches!(
        calibrate(&holed, &wave, Method::Unbiased, &options),
        Err(Error::NotFinite(7))
    ));
    for ratio in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = Options {
            noise_ratio: Some(ratio),
        };
        let refused = calibrate(&wave, &wave, Method::Unbiased, &options);
        assert!(matches!(refused, Err(Error::Ratio(_))));
    }
}

fn noisy(angle: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = StdRng::seed_from_u64(1);
    let mut draw = || -> f64 { 0.001 * Distribution::<f64>::sample(&StandardNormal, &mut random) };
    let ellipse = crooked(0.08);
    let points = (0..4000).map(|k| ellipse.point(angle(f64::from(k))));
    points.map(|p| (p.x + draw(), p.y + draw())).unzip()
}

/// Short arcs with noise: a search that comes to no rest, or has a direction open, stands anywhere.
#[test]
fn a_search_that_found_nothing_has_no_error_bars() {
    let to_and_fro = noisy(|k| 0.63 * (k / 100.0).sin());
    let quarter = noisy(|k| k * std::f64::consts::FRAC_PI_2 / 4000.0);
    let mut seen = 0;
    for (cos, sin) in [to_and_fro, quarter] {
        for method in ALL {
            let found = calibrate(&cos, &sin, method, &Options::default()).expect("a calibration");
            let said = found.cannot_tell.join(" ");
            let nothing = [
                "did not come to rest",
                "of Theta cannot be told",
                "collapsed",
            ];
            if nothing.iter().any(|words| said.contains(words)) {
                seen += 1;
                assert!(found.parameters.iter().all(|p| p.std_error.is_none()));
                let of = found.correlations.iter().chain(&found.theta_correlations);
                assert!(of.flatten().flatten().all(Option::is_none));
            }
            let bias = found.remarks.iter().any(|r| r.starts_with("noise biases"));
            let biased = !matches!(method, Method::Unbiased | Method::Extremes);
            let bars = found.parameters.iter().any(|p| p.std_error.is_some());
            assert_eq!(bias, biased && bars, "{method:?}");
        }
    }
    assert!(seen > 1);
}

/// Five samples a period all round, but none at an end of the cosine.
#[test]
fn extremes_that_no_sample_reached_have_no_error_bar() {
    let (cos, sin) = noisy(|k| 0.6 + k * std::f64::consts::TAU / 5.0);
    let found =
        calibrate(&cos, &sin, Method::Extremes, &Options::default()).expect("a calibration");
    for p in &found.parameters[..4] {
        assert_eq!(p.std_error, None, "{}", p.name);
    }
    let said = found.cannot_tell.join(" ");
    for channel in ["cos", "sin"] {
        let words = format!("the samples do not reach both ends of {channel}");
        assert!(said.contains(&words), "{said}");
    }
    // Two hundred samples a period are at all ends within their noise.
    let (cos, sin) = noisy(|k| k * std::f64::consts::TAU / 200.0);
    let found =
        calibrate(&cos, &sin, Method::Extremes, &Options::default()).expect("a calibration");
    assert!(found.parameters[..4].iter().all(|p| p.std_error.is_some()));
}

/// A straight line: both channels alike.
#[test]
fn a_line_is_no_ellipse() {
    let wave: Vec<f64> = (0..100).map(|k| (f64::from(k) * 0.1).sin()).collect();
    for method in ALL {
        let error = calibrate(&wave, &wave, method, &Options::default()).expect_err("a refusal");
        assert_eq!(error, Error::NoEllipse);
        let said = undetermined(method, &wave, &wave, &error);
        assert!(
            said.parameters
                .iter()
                .all(|p| p.std_error.is_none() && p.value.is_finite())
        );
        assert!(said.cannot_tell[0].contains("a_c, b_c, a_s, b_s, beta"));
    }
}

/// One signal on both channels, with noise: a line, however the noise in its middle is spread around the circle.
#[test]
fn a_noisy_line_is_no_places_of_the_period() {
    for seed in 0..20 {
        let mut random = StdRng::seed_from_u64(seed);
        let mut noisy = |k: i32| {
            let noise: f64 = StandardNormal.sample(&mut random);
            (f64::from(k) * 0.1).sin() + 0.003 * noise
        };
        let (cos, sin): (Vec<f64>, Vec<f64>) = (0..400).map(|k| (noisy(k), noisy(k))).unzip();
        let error = calibrate(&cos, &sin, Method::Unbiased, &Options::default());
        let said = undetermined(Method::Unbiased, &cos, &sin, &error.expect_err("a line"));
        assert!(
            said.cannot_tell[0].contains("both channels carry one signal"),
            "{}",
            said.cannot_tell[0]
        );
    }
}

/// A ratio of the channels' noise that the samples contradict is said.
#[test]
fn a_noise_ratio_that_is_not_theirs_is_said() {
    let mut random = StdRng::seed_from_u64(7);
    let mut noise = || {
        let noise: f64 = StandardNormal.sample(&mut random);
        0.01 * noise
    };
    let pairs = (0..4000).map(|k| {
        let alpha = 0.0123 * f64::from(k);
        (alpha.cos() + noise(), alpha.sin() + noise())
    });
    let (cos, sin): (Vec<f64>, Vec<f64>) = pairs.unzip();
    for (given, said) in [(None, false), (Some(1.0), false), (Some(3.0), true)] {
        let options = Options { noise_ratio: given };
        let found = calibrate(&cos, &sin, Method::Unbiased, &options).expect("an ellipse");
        let told = found.remarks.iter().any(|r| r.contains("the samples say"));
        assert_eq!(told, said, "{given:?}: {:?}", found.remarks);
    }
}

/// Sine noise of 3 to 50 times the cosine's: what is beyond the tested range is said, and has no error bar of the ratio.
#[test]
fn a_ratio_beyond_the_tested_range_is_said() {
    let at = |ratio: f64, given: Option<f64>, swapped: bool| {
        let mut random = StdRng::seed_from_u64(7);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let one = |k: i32| {
            let (s, c) = (0.3 + std::f64::consts::TAU * 7.0 * f64::from(k) / 4000.0).sin_cos();
            (c + 0.1 + 0.05 / ratio * draw(), s - 0.1 + 0.05 * draw())
        };
        let (cos, sin): (Vec<f64>, Vec<f64>) = (0..4000).map(one).unzip();
        let (cos, sin) = if swapped { (sin, cos) } else { (cos, sin) };
        let options = Options { noise_ratio: given };
        calibrate(&cos, &sin, Method::Unbiased, &options).expect("a calibration")
    };
    for swapped in [false, true] {
        let near = at(3.0, None, swapped);
        assert!(near.noise_ratio_error.is_some() && near.cannot_tell.is_empty());
        for ratio in [12.0, 25.0, 50.0] {
            let far = at(ratio, None, swapped);
            assert_eq!(far.noise_ratio_error, None, "{ratio}: {:?}", far.noise);
            let loud = if swapped {
                "cos has 8 or more"
            } else {
                "sin has 8 or more"
            };
            assert!(far.cannot_tell[0].contains(loud), "{:?}", far.cannot_tell);
            let text = nonius_calibration::report(&far, None);
            assert!(text.contains("too far from 1 to be measured"), "{text}");
            // Given, it is not contradicted; equal noise is.
            let truth = if swapped { 1.0 / ratio } else { ratio };
            let given = at(ratio, Some(truth), swapped);
            assert!(given.remarks.is_empty());
            // The quiet channel makes the curve's end narrow.
            let narrow = |s: &String| s.starts_with("where the curve bends most");
            assert!(
                given.cannot_tell.iter().all(narrow),
                "{:?}",
                given.cannot_tell
            );
            let wrong = at(ratio, Some(1.0), swapped).remarks.join(" ");
            assert!(wrong.contains("the samples say"), "{wrong}");
        }
    }
}

/// A search that maps an arc to one point leaves no residual, and is no calibration: a cubic on any arc, gains and offsets on a short one.
#[test]
fn a_search_that_collapsed_on_an_arc_gives_no_values() {
    let cubics = [Method::Poly8, Method::Poly9];
    for (arc, methods) in [
        (0.06, &[Method::Sumsq4][..]),
        (0.1, &cubics[..]),
        (0.25, &cubics[..]),
    ] {
        let (cos, sin) = noisy(|k| 0.7 + std::f64::consts::TAU * arc * k / 4000.0);
        for &method in methods {
            let found = calibrate(&cos, &sin, method, &Options::default()).expect("an answer");
            assert!(found.theta.is_empty() && found.parameters.len() == 5);
            assert!(found.parameters.iter().all(|p| p.std_error.is_none()));
            assert!(found.residual_rms > 5e-4, "{}", found.residual_rms);
            let said = found.cannot_tell.join(" ");
            assert!(
                said.contains("collapsed") && !said.contains("rough guess"),
                "{said}"
            );
        }
    }
}

/// Without noise the residual is the rounding of the numbers: nothing that is made of it is given, by any method, and no ratio estimated.
#[test]
fn the_rounding_of_the_numbers_is_no_noise() {
    for method in ALL {
        let (cos, sin) = signals(&crooked(0.0), 3.0, 3000);
        let found = calibrate(&cos, &sin, method, &Options::default()).expect("a calibration");
        assert!(
            found
                .parameters
                .iter()
                .all(|p| p.std_error.is_none() && p.bound.is_none())
        );
        assert_eq!((found.noise, found.noise_ratio_error), (None, None));
        assert!(found.bound.is_none() && found.shape.is_none() && found.scatter.is_none());
        let said = found.cannot_tell.join(" ");
        assert!(
            said.contains("the rounding of the numbers and no noise"),
            "{method:?}: {said}"
        );
        assert!(
            !nonius_calibration::report(&found, None).contains("ratio  "),
            "{method:?}"
        );
    }
}

/// A row of one pair, as where the ADC did not run, beside a sound ellipse.
#[test]
fn a_row_of_one_pair_is_named() {
    let (mut cos, mut sin) = noisy(|k| 0.7 + 40.3 * std::f64::consts::TAU * k / 4000.0);
    for k in 0..cos.len() / 2 {
        (cos[k], sin[k]) = (0.0, -0.0);
    }
    let why = calibrate(&cos, &sin, Method::Unbiased, &Options::default()).expect_err("no ellipse");
    let said = undetermined(Method::Unbiased, &cos, &sin, &why)
        .cannot_tell
        .join(" ");
    let named = "without the 2000 of 4000 that are 0, 0 to the last digit";
    assert!(
        said.contains(named) && !said.contains("stands still"),
        "{said}"
    );
}
