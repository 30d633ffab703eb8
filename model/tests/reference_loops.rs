//! Section 4: what the paper says of its three loops.

use std::f64::consts::TAU;

use crate::reference_support::TS;
use nalgebra::{Complex, Matrix2, Vector2};
use nonius_model::reference::ReferenceError;
use nonius_model::reference::loops::{
    Filter, FilterType, Loop, LoopConfig, Method, phase_detector,
};
use nonius_model::reference::poles::Poles;
use proptest::prelude::*;

const METHODS: [Method; 5] = [
    Method::One(FilterType::One { pole: 0.6 }),
    Method::One(FilterType::Two),
    Method::Two,
    Method::Three(FilterType::One { pole: 0.6 }),
    Method::Three(FilterType::Two),
];

fn is_type_2(method: Method) -> bool {
    matches!(
        method,
        Method::One(FilterType::Two) | Method::Three(FilterType::Two)
    )
}

/// Drives the loop with the angle `alpha(k)` through the phase detector; the last α − α̂ and the speed estimate.
fn follow(config: LoopConfig, samples: u32, alpha: impl Fn(f64) -> f64) -> (f64, f64) {
    let mut tracking = Loop::new(config);
    for k in 0..samples {
        let (sin, cos) = alpha(k.into()).sin_cos();
        tracking.advance(phase_detector([cos, sin], tracking.alpha_hat()));
    }
    (
        alpha(samples.into()) - tracking.alpha_hat(),
        tracking.speed(),
    )
}

/// Response of the linear loop (e = α − α̂) to α = 1 at sample 0 only.
fn impulse_response(config: LoopConfig, samples: usize) -> Vec<f64> {
    let mut tracking = Loop::new(config);
    (0..samples)
        .map(|k| {
            let alpha = if k == 0 { 1.0 } else { 0.0 };
            tracking.advance(alpha - tracking.alpha_hat());
            tracking.alpha_hat()
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Closed-loop poles, identified from the response alone (h_{k+2} = Σp h_{k+1} − Πp h_k), are those designed;
    /// for each method, over- and underdamped.
    #[test]
    fn the_response_has_the_poles_designed(
        omega_ts in 0.02f64..1.0, xi in 0.3f64..3.0, which in 0usize..5,
    ) {
        let poles = Poles::new(omega_ts / TS, xi, TS).expect("poles inside the unit circle");
        let h = impulse_response(LoopConfig::new(METHODS[which], &poles, TS).expect("the paper builds it"), 5);
        // h has the numerator in its first two values; from then on it is the recursion alone.
        let past = Matrix2::new(h[2], -h[1], h[3], -h[2]);
        let found = past.lu().solve(&Vector2::new(h[3], h[4]));
        // Where the zero cancels a pole the response has one pole only, and nothing can be identified.
        prop_assume!(past.determinant().abs() > 1e-9 * h[1] * h[1]);
        let found = found.expect("there is one");
        prop_assert!((found[0] - poles.sum()).abs() < 1e-5, "{} {}", found[0], poles.sum());
        prop_assert!((found[1] - poles.product()).abs() < 1e-5, "{} {}", found[1], poles.product());
    }

    /// The poles are those of the continuous system: z = exp(s ts) with s² + 2ξω0 s + ω0² = 0.
    #[test]
    fn poles_are_those_of_a_second_order_system(omega_0 in 10.0f64..1e5, xi in 0.2f64..5.0) {
        let poles = Poles::new(omega_0, xi, TS).expect("poles inside the unit circle");
        for p in [poles.p1, poles.p2] {
            let s = p.ln() / TS;
            let value = s * s + s * (2.0 * xi * omega_0) + omega_0 * omega_0;
            prop_assert!(value.norm() < 1e-6 * omega_0 * omega_0 * (1.0 + xi * xi), "{value}");
        }
    }

    /// Zero steady-state error after a step, for each method and type.
    #[test]
    fn a_step_leaves_no_error(omega_ts in 0.05f64..0.5, xi in 0.5f64..1.5, step in -1.5f64..1.5) {
        let poles = Poles::new(omega_ts / TS, xi, TS).expect("poles inside the unit circle");
        for method in METHODS {
            let config = LoopConfig::new(method, &poles, TS).expect("the paper builds it");
            let (error, speed) = follow(config, (100.0 / omega_ts) as u32, |_| step);
            prop_assert!(error.abs() < 1e-12, "{method:?}: {error}");
            prop_assert!(speed.abs() * TS < 1e-12, "{method:?}: {speed}");
        }
    }

    /// A ramp is followed without error by type 2; type 1 lags by what the final value theorem says, sin e for the
    /// phase detector; the speed is right in either case.
    #[test]
    fn a_ramp_leaves_the_known_lag(omega_ts in 0.05f64..0.5, xi in 0.7f64..1.5, part in -0.5f64..0.5) {
        let poles = Poles::new(omega_ts / TS, xi, TS).expect("poles inside the unit circle");
        for method in METHODS {
            let config = LoopConfig::new(method, &poles, TS).expect("the paper builds it");
            // A speed that lags by at most half a radian, and from rest does not lose the lock.
            let speed = part * omega_ts / TS / 4.0;
            let lag = config.lag(speed);
            prop_assume!(lag.abs() < 0.5);
            let (error, seen) = follow(config, (300.0 / omega_ts) as u32, |k| speed * TS * k);
            prop_assert!((error - lag.asin()).abs() < 1e-9, "{method:?}: {error} {lag}");
            prop_assert!((seen - speed).abs() < 1e-9 * speed.abs() + 1e-9 / TS, "{method:?}");
            prop_assert_eq!(is_type_2(method), lag == 0.0);
        }
    }

    /// Method 2's lag in the poles alone: v ts (1 − p1p2)/(1 − p1 − p2 + p1p2).
    #[test]
    fn method_2_lags_by_its_poles(p1 in 0.1f64..0.95, p2 in 0.1f64..0.95) {
        let poles = Poles::real(p1, p2).expect("poles inside the unit circle");
        let config = LoopConfig::new(Method::Two, &poles, TS).expect("the paper builds it");
        let v = 0.05 * (1.0 - p1) * (1.0 - p2) / TS;
        let expected = v * TS * (1.0 - p1 * p2) / (1.0 - p1 - p2 + p1 * p2);
        let (error, _) = follow(config, 3000, |k| v * TS * k);
        prop_assert!((error.sin() - expected).abs() < 1e-10, "{error} {expected}");
    }

    /// Method 2 is Method 1 of type 1 with its second pole at p1p2.
    #[test]
    fn method_2_is_type_1_with_a_pole_that_is_not_free(p1 in 0.1f64..0.95, p2 in 0.1f64..0.95) {
        let poles = Poles::real(p1, p2).expect("poles inside the unit circle");
        let two = LoopConfig::new(Method::Two, &poles, TS).expect("the paper builds it").filter;
        let one = Filter::placing(&poles, FilterType::One { pole: p1 * p2 }).expect("the paper builds it");
        for (x, y) in [(two.a, one.a), (two.b, one.b), (two.c, one.c), (two.d, one.d)] {
            prop_assert!((x - y).abs() < 1e-14, "{two:?} {one:?}");
        }
        let (sum, product) = two.closed_loop_poles();
        prop_assert!((sum - poles.sum()).abs() < 1e-14 && (product - poles.product()).abs() < 1e-14);
    }

    /// (3): the response to a slow sine is that of G_cl, and 1 − G_cl = 1/(1 + G).
    #[test]
    fn the_closed_loop_is_equation_3(omega_ts in 0.05f64..0.5, ratio in 0.05f64..4.0, which in 0usize..5) {
        let poles = Poles::new(omega_ts / TS, 0.8, TS).expect("poles inside the unit circle");
        let config = LoopConfig::new(METHODS[which], &poles, TS).expect("the paper builds it");
        let w = (omega_ts * ratio).min(2.5);
        let z = Complex::from_polar(1.0, w);
        let expected = config.filter.closed_loop(z);
        prop_assert!((expected + config.filter.sensitivity(z) - 1.0).norm() < 1e-12);
        let mut tracking = Loop::new(config);
        let settle = (60.0 / omega_ts) as u32;
        for k in 0..settle + 50 {
            if k >= settle {
                let ideal = (expected * Complex::from_polar(0.1, w * f64::from(k))).re;
                prop_assert!((tracking.alpha_hat() - ideal).abs() < 1e-9);
            }
            tracking.advance(0.1 * (w * f64::from(k)).cos() - tracking.alpha_hat());
        }
    }
}

/// Method 3 gives Method 1's estimate, digit for digit: with coefficients and input that are short binary fractions f64
/// does not round, and what remains is algebra. Its speed is the difference that Method 1 must take.
#[test]
fn method_3_is_method_1_exactly() {
    let poles = Poles::real(0.5, 0.75).expect("poles inside the unit circle");
    for kind in [FilterType::Two, FilterType::One { pole: 0.25 }] {
        let ts = 0.5;
        let mut one =
            Loop::new(LoopConfig::new(Method::One(kind), &poles, ts).expect("the paper builds it"));
        let mut three = Loop::new(
            LoopConfig::new(Method::Three(kind), &poles, ts).expect("the paper builds it"),
        );
        for alpha in [0.5, 0.75, -0.25, 0.125, 1.0, -0.5, 0.625, 0.25, 0.0] {
            one.advance(alpha - one.alpha_hat());
            three.advance(alpha - three.alpha_hat());
            assert_eq!(one.alpha_hat(), three.alpha_hat(), "{kind:?}");
            assert_eq!(one.speed(), three.speed(), "{kind:?}");
        }
        assert_ne!(one.alpha_hat(), 0.0);
    }
}

/// The same over a long and fast way, to rounding: a period is divided into more than 10^12 parts.
#[test]
fn method_3_is_method_1_after_a_long_way() {
    let poles = Poles::new(0.1 / TS, 0.707, TS).expect("poles inside the unit circle");
    let [mut one, mut three] = [Method::One(FilterType::Two), Method::Three(FilterType::Two)]
        .map(|m| Loop::new(LoopConfig::new(m, &poles, TS).expect("the paper builds it")));
    let mut largest = 0.0f64;
    for k in 0..200_000 {
        let (sin, cos) = (0.3 * f64::from(k)).sin_cos();
        for tracking in [&mut one, &mut three] {
            tracking.advance(phase_detector([cos, sin], tracking.turns_and_phase().1));
        }
        largest = largest.max((one.turns_and_phase().1 - three.turns_and_phase().1).abs());
    }
    assert_eq!(one.turns_and_phase().0, three.turns_and_phase().0);
    assert!(one.turns_and_phase().0 > 9000);
    assert!(largest < 1e-12 * TAU, "{largest}");
}

#[test]
fn what_the_paper_calls_impossible_is_refused() {
    let poles = Poles::new(0.1 / TS, 1.0, TS).expect("poles inside the unit circle");
    let named = |method, kind, pole| LoopConfig::named(method, kind, pole, &poles, TS);
    for (method, kind, pole, word) in [
        (2, 2, None, "type 2"),
        (2, 1, Some(0.3), "cannot be freely chosen"),
        (1, 2, Some(0.3), "none is left"),
        (3, 2, Some(0.3), "none is left"),
        (4, 1, None, "Methods 1, 2 and 3"),
        (0, 1, None, "Methods 1, 2 and 3"),
        (1, 3, None, "type 1 or 2"),
    ] {
        let error = named(method, kind, pole).expect_err("impossible");
        assert!(error.to_string().contains(word), "{error}");
    }
    assert!(matches!(
        named(1, 1, Some(1.0)),
        Err(ReferenceError::Value { .. })
    ));
    for (method, kind, pole) in [
        (1, 1, Some(0.3)),
        (1, 1, None),
        (1, 2, None),
        (2, 1, None),
        (3, 1, Some(0.0)),
        (3, 2, None),
    ] {
        assert!(
            named(method, kind, pole).is_ok(),
            "{method} {kind} {pole:?}"
        );
    }
    for (omega_0, xi, ts) in [
        (0.0, 1.0, TS),
        (1.0, 0.0, TS),
        (1.0, 1.0, 0.0),
        (4.0 / TS, 1.0, TS),
        (f64::NAN, 1.0, TS),
    ] {
        assert!(Poles::new(omega_0, xi, ts).is_err(), "{omega_0} {xi} {ts}");
    }
    assert!(Poles::real(1.0, 0.5).is_err());
}
