//! The Cramér–Rao bound of every parameter set, and how near its estimator comes.

use std::f64::consts::TAU;

use nonius_calibration::set::{BLIND, Set};
use nonius_calibration::set_bound::{Motion, of_ellipse};
use nonius_calibration::{Curve, Ellipse, Method, Options, calibrate, cramer_rao};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

const SAMPLES: usize = 2000;

/// Offsets 10 %, gain ratio 1.2, β = 5°.
const SENSOR: Ellipse = Ellipse {
    a_c: 1.1,
    b_c: 0.11,
    a_s: 0.9167,
    b_s: -0.0917,
    beta: 0.087_266,
};

fn angles() -> impl Iterator<Item = f64> + Clone {
    (0..SAMPLES).map(|k| 0.3 + TAU * 7.0 * k as f64 / SAMPLES as f64)
}

/// Two derivations of one thing: across the curve of the physical parameters, and along the radius of the corrected pair.
#[test]
fn of_five_parameters_it_is_the_bound_of_the_ellipse() {
    for noise in [[0.01, 0.01], [0.01, 0.017], [0.03, 0.002]] {
        let angles: Vec<f64> = angles().collect();
        let ellipse = cramer_rao::bound(&SENSOR, &angles, noise).expect("a bound");
        let of = |motion| {
            of_ellipse(Set::Five, &SENSOR, angles.iter().copied(), noise, motion).expect("a bound")
        };
        let set = of(Motion::Unknown);
        let physical = set.physical.expect("an ellipse");
        for i in 0..5 {
            for j in 0..5 {
                let near = |a: f64, b: f64, size: f64| (a - b).abs() < 1e-7 * size;
                let size = (ellipse.theta[(i, i)] * ellipse.theta[(j, j)]).sqrt();
                assert!(near(set.theta[(i, j)], ellipse.theta[(i, j)], size));
                let size = (ellipse.covariance[(i, i)] * ellipse.covariance[(j, j)]).sqrt();
                assert!(near(physical[(i, j)], ellipse.covariance[(i, j)], size));
            }
        }
        assert!((set.angle_by_noise / ellipse.angle_by_noise - 1.0).abs() < 1e-9);
        // Who knows that the speed does not change knows more.
        let uniform = of(Motion::Uniform);
        assert!(uniform.angle_by_parameters < set.angle_by_parameters);
        for i in 0..5 {
            assert!(uniform.theta[(i, i)] < set.theta[(i, i)]);
        }
    }
}

/// With a cubic nothing is said of the direction that changes no radius, until the motion is known to be uniform.
#[test]
fn uniform_motion_shows_the_blind_direction() {
    let circle = Ellipse {
        a_c: 1.0,
        b_c: 0.0,
        a_s: 1.0,
        b_s: 0.0,
        beta: 0.0,
    };
    for set in [Set::Eight, Set::Nine] {
        let of = |motion| of_ellipse(set, &circle, angles(), [0.01; 2], motion).expect("a bound");
        let along = |theta: &nalgebra::DMatrix<f64>| {
            let at = |i: usize| BLIND.get(i).copied().unwrap_or(0.0) / 2.0;
            let v = nalgebra::DVector::from_fn(set.parameters(), |i, _| at(i));
            (v.transpose() * theta * v).x
        };
        assert!(along(&of(Motion::Unknown).theta) < 1e-18);
        // It is held, not unseen, where β is not 0.
        let late = Ellipse {
            beta: 0.1,
            ..circle
        };
        let held = of_ellipse(set, &late, angles(), [0.01; 2], Motion::Unknown).expect("a bound");
        assert!(along(&held.theta) < 1e-18);
        let seen = along(&of(Motion::Uniform).theta);
        println!("{set:?}: {:.2e} of the blind direction", seen.sqrt());
        assert!(seen > 0.0 && seen < 1e-4);
    }
    // A set without phase on a sensor with one: as if there were none.
    let four = |beta: f64| {
        let sensor = Ellipse { beta, ..circle };
        of_ellipse(Set::Four, &sensor, angles(), [0.01; 2], Motion::Unknown)
    };
    assert_eq!(four(0.1), four(0.0));
    let none = |angles: Vec<f64>, noise| {
        of_ellipse(
            Set::Nine,
            &circle,
            angles.into_iter(),
            noise,
            Motion::Unknown,
        )
    };
    assert_eq!(none(vec![0.1; 50], [0.01; 2]), None);
    assert_eq!(none(angles().collect(), [0.0, 0.01]), None);
}

/// Every set's least squares repeats as well as its bound allows, on a sensor that it can express.
#[test]
fn the_searches_come_near_their_bounds() {
    const SEEDS: u64 = 150;
    for method in [Method::Sumsq4, Method::Sumsq5, Method::Poly8, Method::Poly9] {
        let sensor = Ellipse {
            beta: if method.finds_phase() {
                SENSOR.beta
            } else {
                0.0
            },
            ..SENSOR
        };
        // Even and cubic bends that the sets with a cubic can take out.
        let bend = f64::from(u8::from(method.set().cubic()));
        let signal = |alpha: f64| {
            let y = sensor.point(alpha);
            let bent = |y: f64, a: f64, b: f64| {
                let u = (y - b) / a;
                a * (u + bend * (0.01 * u * u + 0.02 * u * u * u)) + b
            };
            [
                bent(y.x, sensor.a_c, sensor.b_c),
                bent(y.y, sensor.a_s, sensor.b_s),
            ]
        };
        let n = method.set().parameters() + 5;
        let (mut sum, mut square) = (vec![0.0; n], vec![0.0; n]);
        let mut bounds = vec![];
        for seed in 0..SEEDS {
            let mut random = StdRng::seed_from_u64(seed);
            let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
            let (cos, sin): (Vec<f64>, Vec<f64>) = angles()
                .map(|alpha| {
                    let [c, s] = signal(alpha);
                    (c + 0.002 * draw(), s + 0.002 * draw())
                })
                .unzip();
            let found = calibrate(&cos, &sin, method, &Options::default()).expect("a calibration");
            for (i, p) in found.parameters.iter().enumerate() {
                sum[i] += p.value / SEEDS as f64;
                square[i] += p.value * p.value / SEEDS as f64;
            }
            bounds = found
                .parameters
                .iter()
                .map(|p| (p.name.clone(), p.bound))
                .collect();
        }
        let mut furthest = 0.0f64;
        for (i, (name, bound)) in bounds.iter().enumerate() {
            let spread = (square[i] - sum[i] * sum[i]).max(0.0).sqrt();
            let Some(bound) = bound else {
                assert!(name == "beta" && !method.finds_phase(), "{method:?} {name}");
                continue;
            };
            furthest = furthest.max(spread / bound);
            // Four standard errors of a spread of 150 below; the sums of squares weigh the channels alike, though in amplitudes their noise
            // is not.
            let most = if method.set().cubic() { 1.35 } else { 1.25 };
            assert!(
                (0.77..most).contains(&(spread / bound)),
                "{method:?} {name}: {spread} {bound}"
            );
        }
        nonius_kept::figure(
            &format!(
                "off line, {}: largest standard deviation of a parameter over its Cramér–Rao bound, 150 seeds",
                method.name()
            ),
            &format!("{furthest:.2}"),
            "calibration/tests/set_bound.rs",
        );
    }
}
