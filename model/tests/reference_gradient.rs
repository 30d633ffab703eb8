//! Section 5.5: the gradient of the residual, and what its approximations cost.

use std::f64::consts::TAU;

use crate::reference_support::{MISCALIBRATED, TS, type_2};
use nalgebra::RowSVector;
use nonius_model::reference::gradient::{Observation, Recursion};
use nonius_model::reference::loops::Loop;
use nonius_model::reference::sum_of_squares::{gradient, objective};
use nonius_model::reference::{Parameters, Sensor, Theta};
use proptest::prelude::*;

/// A Θ of this set, away from the calibrated one by `size`.
fn near(set: Parameters, theta: Theta, size: f64) -> Theta {
    let away = [0.6, -0.3, 0.2, 0.5, -0.7, 0.25, -0.2, -0.4, 0.3];
    Theta::from_fn(|i, _| {
        if i < set.count() {
            theta[i] + size * away[i]
        } else {
            0.0
        }
    })
}

/// Runs the loop with a fixed Θ; α̂ and corrected-less-estimate (the residual) at the last sample.
fn run(set: Parameters, theta: &Theta, sensor: &Sensor, samples: u32) -> [f64; 3] {
    let mut tracking = Loop::new(type_2(0.2));
    let mut last = [0.0; 3];
    for k in 0..samples {
        let y = sensor.signals(0.031 * f64::from(k));
        let seen = Observation::new(set, theta, y, tracking.alpha_hat());
        let r = seen.residual();
        last = [tracking.alpha_hat(), r.x, r.y];
        tracking.advance(seen.e);
    }
    last
}

/// Largest difference between recursion (11) and numerical differentiation of α̂, over the parameters, as a fraction of
/// the largest derivative; the same for the residual's gradient.
fn deviation(set: Parameters, theta: &Theta, sensor: &Sensor, samples: u32) -> [f64; 2] {
    let config = type_2(0.2);
    let mut tracking = Loop::new(config);
    let mut recursion = Recursion::<9>::new(config.filter);
    let (mut of_alpha, mut of_residual) = (RowSVector::<f64, 9>::zeros(), Default::default());
    for k in 0..samples {
        let y = sensor.signals(0.031 * f64::from(k));
        let seen = Observation::new(set, theta, y, tracking.alpha_hat());
        of_alpha = recursion.value();
        of_residual = seen.gradient_of_residual(&of_alpha);
        recursion.advance(seen.w());
        tracking.advance(seen.e);
    }
    let (mut differences, mut sizes) = ([0.0f64; 2], [0.0f64; 2]);
    for i in 0..set.count() {
        let h = 1e-5;
        let at = |h: f64| {
            let mut moved = *theta;
            moved[i] += h;
            run(set, &moved, sensor, samples)
        };
        let (more, less) = (at(h), at(-h));
        let slope = |j: usize| (more[j] - less[j]) / (2.0 * h);
        for (which, numerical, analytical) in [
            (0, slope(0), of_alpha[i]),
            (1, slope(1), of_residual[(0, i)]),
            (1, slope(2), of_residual[(1, i)]),
        ] {
            differences[which] = differences[which].max((numerical - analytical).abs());
            sizes[which] = sizes[which].max(numerical.abs());
        }
    }
    [0, 1].map(|i| differences[i] / sizes[i])
}

/// Recursion (11), with (10) as a difference, is the derivative of α̂ where the signals are calibrated; so is ∇r of the
/// residual. In each parameter set.
#[test]
fn recursion_11_is_the_derivative_of_the_estimate() {
    for set in Parameters::ALL {
        let sensor = if set.count() % 2 == 1 {
            MISCALIBRATED
        } else {
            Sensor {
                beta: 0.0,
                ..MISCALIBRATED
            }
        };
        let theta = set.from_five(sensor.theta());
        // After 700 samples the loop is in its steady state, e = 0 and ρ = 0.
        let [of_alpha, of_residual] = deviation(set, &theta, &sensor, 701);
        assert!(of_alpha < 1e-7, "{set:?}: {of_alpha:e}");
        assert!(of_residual < 1e-7, "{set:?}: {of_residual:e}");
    }
}

/// The paper's only approximation in (11), cos(α − α̂) = 1 in place of 1 + ρ, costs the first order of ρ: half the
/// miscalibration, half the deviation.
#[test]
fn recursion_11_deviates_in_the_first_order_of_the_residual() {
    for set in Parameters::ALL {
        let sensor = Sensor {
            beta: 0.0,
            ..MISCALIBRATED
        };
        let calibrated = set.from_five(sensor.theta());
        let [[whole, _], [half, _]] =
            [0.02, 0.01].map(|size| deviation(set, &near(set, calibrated, size), &sensor, 701));
        let ratio = whole / half;
        assert!(whole > 1e-3 && whole < 0.1, "{set:?}: {whole}");
        assert!((1.7..2.3).contains(&ratio), "{set:?}: {whole} {half}");
    }
}

/// w − ∇α̂ (rms, gain θ1) and what the final form leaves out of the gradient (rms, all of it), at this speed.
fn left_out(speed: f64) -> [f64; 2] {
    let set = Parameters::Five;
    let config = type_2(0.2);
    let theta = near(set, set.from_five(MISCALIBRATED.theta()), 0.05);
    let mut tracking = Loop::moving(config, 0.0, speed / TS, 0.0);
    let mut recursion = Recursion::<9>::new(config.filter);
    let (settle, periods) = (400, 4);
    let samples = (TAU / speed * f64::from(periods)).round() as u32;
    let (mut sensitivity, mut gradient) = (0.0, 0.0);
    for k in 0..settle + samples {
        let y = MISCALIBRATED.signals(speed * f64::from(k));
        let seen = Observation::new(set, &theta, y, tracking.alpha_hat());
        let of_alpha = recursion.value();
        let exact = seen.gradient_of_residual(&of_alpha).transpose() * seen.residual();
        let difference = exact - seen.final_form();
        // The difference is (w − ∇α̂)ᵀ e and nothing else.
        let expected = (seen.w() - of_alpha).transpose() * seen.e;
        assert!((difference - expected).amax() < 1e-12);
        if k >= settle {
            sensitivity += (seen.w() - of_alpha)[0].powi(2);
            gradient += difference.norm_squared();
        }
        recursion.advance(seen.w());
        tracking.advance(seen.e);
    }
    [sensitivity, gradient].map(|sum: f64| (sum / f64::from(samples)).sqrt())
}

/// Section 5.5.1: "assuming that the dynamics of the measured system are slower than the dynamics of the interpolator":
/// a type 2 loop's w − ∇α̂ falls with the square of the speed, and because e does so too, what the final form leaves
/// out falls with its fourth power.
#[test]
fn the_final_form_is_exact_to_second_order_of_the_sensitivity() {
    let [fast, slow] = [left_out(TAU / 320.0), left_out(TAU / 640.0)];
    let order = [0, 1].map(|i| (fast[i] / slow[i]).log2());
    println!(
        "at half the speed: w - grad alpha down by 2^{:.3}, the gradient by 2^{:.3}",
        order[0], order[1]
    );
    assert!((order[0] - 2.0).abs() < 0.1, "{fast:?} {slow:?}");
    assert!((order[1] - 4.0).abs() < 0.2, "{fast:?} {slow:?}");
    assert!(slow[1] < 1e-4, "{slow:?}");
}

proptest! {
    /// r + (sin α̂, −cos α̂) e = n ρ, so that the final form is Mᵀ n ρ; and w is the derivative of e at fixed α̂.
    #[test]
    fn the_final_form_is_radial(
        alpha_hat in -7.0f64..7.0, y in prop::array::uniform2(-1.3f64..1.3), size in -0.2f64..0.2,
    ) {
        for set in Parameters::ALL {
            let theta = near(set, set.nominal(0.9), size);
            let seen = Observation::new(set, &theta, y, alpha_hat);
            let n = nalgebra::Vector2::new(alpha_hat.cos(), alpha_hat.sin());
            let radial = seen.m.transpose() * n * seen.rho;
            prop_assert!((seen.final_form() - radial).amax() < 1e-13);
            prop_assert!((seen.rho - seen.residual().dot(&n)).abs() < 1e-15);
            for i in 0..set.count() {
                let at = |h: f64| {
                    let mut moved = theta;
                    moved[i] += h;
                    Observation::new(set, &moved, y, alpha_hat).e
                };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                prop_assert!((seen.w()[i] - slope).abs() < 1e-8, "{set:?} {i}");
            }
        }
    }

    /// ∇J of section 5.2 against numerical differentiation of J = Σ ε², in each parameter set.
    #[test]
    fn the_sum_of_squares_has_this_gradient(y in prop::array::uniform2(-1.3f64..1.3), size in -0.2f64..0.2) {
        for set in Parameters::ALL {
            let theta = near(set, set.nominal(0.9), size);
            let found = gradient(set, &theta, y);
            for i in 0..9 {
                let at = |h: f64| {
                    let mut moved = theta;
                    moved[i] += h;
                    objective(set, &moved, &[y])
                };
                let slope = (at(1e-5) - at(-1e-5)) / 2e-5;
                let expected = if i < set.count() { slope } else { 0.0 };
                prop_assert!((found[i] - expected).abs() < 1e-6 * (1.0 + found.amax()), "{set:?} {i}");
            }
        }
    }
}
