//! Section 5.4 is singular: one direction of the eight cubic parameters changes no radius, but turns the angle.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use nonius_model::reference::gradient::Observation;
use nonius_model::reference::{Parameters, Sensor, Theta};
use proptest::prelude::*;

const CUBIC: [Parameters; 4] = [
    Parameters::Eight,
    Parameters::Nine,
    Parameters::ChebyshevEight,
    Parameters::ChebyshevNine,
];

/// Radial and tangential effect of v at the angle α, with a calibrated Θ and α̂ = α.
fn effect(set: Parameters, sensor: &Sensor, alpha: f64) -> (f64, f64) {
    let theta = set.from_five(sensor.theta());
    let v = set.null_direction(&theta).expect("a cubic set");
    let seen = Observation::new(set, &theta, sensor.signals(alpha), alpha);
    let moved = seen.m * v;
    let (sin, cos) = alpha.sin_cos();
    (moved.x * cos + moved.y * sin, (seen.w() * v).x)
}

/// Σ Mᵀn nᵀM over a period: how the radius sees each direction of Θ.
fn information(set: Parameters, sensor: &Sensor) -> DMatrix<f64> {
    let theta = set.from_five(sensor.theta());
    let n = set.count();
    let mut sum = DMatrix::zeros(n, n);
    for k in 0..360 {
        let alpha = TAU * f64::from(k) / 360.0;
        let seen = Observation::new(set, &theta, sensor.signals(alpha), alpha);
        let radial = DVector::from_fn(n, |i, _| {
            seen.m[(0, i)] * alpha.cos() + seen.m[(1, i)] * alpha.sin()
        });
        sum += &radial * radial.transpose() / 360.0;
    }
    sum
}

proptest! {
    /// For any amplitudes and offsets: no radial effect at any angle, ½ sin 2α tangentially. So no record, however long,
    /// shows v to a method that uses the radius alone.
    #[test]
    fn v_changes_no_radius_and_turns_the_angle(
        a_c in 0.3f64..2.0, a_s in 0.3f64..2.0, b_c in -0.5f64..0.5, b_s in -0.5f64..0.5, alpha in -7.0f64..7.0,
    ) {
        let sensor = Sensor { a_c, b_c, a_s, b_s, beta: 0.0 };
        for set in CUBIC {
            let (radial, tangential) = effect(set, &sensor, alpha);
            prop_assert!(radial.abs() < 1e-11, "{set:?}: {radial}");
            prop_assert!((tangential - (2.0 * alpha).sin() / 2.0).abs() < 1e-11, "{set:?}: {tangential}");
        }
    }

    /// How v scales with the amplitude a and the offset b: without offset −1/a and 1/a³ on the linear and the cubic
    /// term; an offset brings the square and the constant in.
    #[test]
    fn v_scales_with_amplitude_and_offset(a in 0.3f64..2.0, b in -0.5f64..0.5) {
        let sensor = Sensor { a_c: a, b_c: b, a_s: a, b_s: 0.0, beta: 0.0 };
        let set = Parameters::Eight;
        let v = set.null_direction(&set.from_five(sensor.theta())).expect("a cubic set");
        let expected = [
            -1.0 / a + 3.0 * b * b / a.powi(3), -3.0 * b / a.powi(3), 1.0 / a.powi(3), b / a - (b / a).powi(3),
            1.0 / a, 0.0, -1.0 / a.powi(3), 0.0,
        ];
        for (i, expected) in expected.into_iter().enumerate() {
            prop_assert!((v[i] - expected).abs() < 1e-10 * (1.0 + expected.abs()), "{i}: {} {expected}", v[i]);
        }
    }

    /// The angle itself: Θ moved along v by a little turns atan2 by ½ sin 2α of it, and the radius by its square only.
    #[test]
    fn moving_along_v_turns_the_corrected_pair(step in 1e-4f64..1e-3, alpha in -3.0f64..3.0) {
        for set in CUBIC {
            let theta: Theta = set.nominal(0.8);
            let moved = theta + set.null_direction(&theta).expect("a cubic set") * step;
            let [c, s] = set.corrected(&moved, [0.8 * alpha.cos(), 0.8 * alpha.sin()]);
            let turned = s.atan2(c) - alpha;
            prop_assert!((turned - step * (2.0 * alpha).sin() / 2.0).abs() < step * step, "{set:?}");
            prop_assert!((c.hypot(s) - 1.0).abs() < step * step, "{set:?}");
        }
    }
}

/// The radius alone leaves the eight parameters singular by exactly one direction, v; and four and five not at all.
#[test]
fn the_information_of_the_radius_lacks_one_direction() {
    for amplitude in [1.0, 0.6] {
        let sensor = Sensor {
            a_c: amplitude,
            a_s: amplitude,
            ..Sensor::IDEAL
        };
        for set in CUBIC {
            let eigen = information(set, &sensor).symmetric_eigen();
            let mut values: Vec<f64> = eigen.eigenvalues.iter().copied().collect();
            values.sort_by(f64::total_cmp);
            assert!(values[0].abs() < 1e-12, "{set:?}: {values:?}");
            assert!(values[1] > 1e-5, "{set:?}: {values:?}");
            let v = set
                .null_direction(&set.from_five(sensor.theta()))
                .expect("there is one")
                .normalize();
            let unseen = eigen.eigenvectors.column(eigen.eigenvalues.imin());
            let along: f64 = unseen.iter().zip(v.iter()).map(|(x, y)| x * y).sum();
            assert!((along.abs() - 1.0).abs() < 1e-9, "{set:?}: {along}");
            // How differently fast the other directions converge.
            let spread = values[values.len() - 1] / values[1];
            println!("{set:?}, amplitude {amplitude}: eigenvalue spread {spread:.1}");
            match set {
                Parameters::ChebyshevEight => assert!(spread < 10.0, "{spread}"),
                Parameters::Eight => assert!(spread > 50.0, "{spread}"),
                _ => {}
            }
        }
        for set in [Parameters::Four, Parameters::Five] {
            assert!(information(set, &sensor).symmetric_eigenvalues().min() > 0.04);
        }
    }
}

/// With a phase error v is nearly as invisible: at 5° its radial effect is less than a tenth of its tangential one.
#[test]
fn a_phase_error_hardly_shows_v() {
    let sensor = Sensor {
        beta: 5f64.to_radians(),
        ..Sensor::IDEAL
    };
    for set in [Parameters::Nine, Parameters::ChebyshevNine] {
        let (mut radial, mut tangential) = (0.0, 0.0);
        for k in 0..360 {
            let (r, t) = effect(set, &sensor, TAU * f64::from(k) / 360.0);
            radial += r * r;
            tangential += t * t;
        }
        let ratio = (radial / tangential).sqrt();
        println!(
            "{set:?}: radial / tangential effect of v at 5 degrees: {:.1} %",
            100.0 * ratio
        );
        assert!((0.03..0.10).contains(&ratio), "{set:?}: {ratio}");
    }
}
