//! The transforms against their definition. Not in the library: it would be built twice.

use std::f64::consts::TAU;

use nonius_fourier::{Complex, forward, inverse};

fn values(n: usize) -> Vec<Complex<f64>> {
    let of = |k: usize| Complex::new((k as f64).sin(), (3.0 * k as f64).cos());
    (0..n).map(of).collect()
}

#[test]
fn forward_is_the_sum_that_defines_it() {
    for n in [0, 1, 2, 7, 60, 64] {
        let (before, mut after) = (values(n), values(n));
        forward(&mut after);
        for (k, after) in after.iter().enumerate() {
            let turn = |i: usize| Complex::from_polar(1.0, -TAU * (k * i) as f64 / n as f64);
            let terms = before.iter().enumerate().map(|(i, x)| x * turn(i));
            let sum: Complex<f64> = terms.sum();
            assert!((after - sum).norm() < 1e-11, "{n}, {k}");
        }
    }
}

/// Few values, and so many that their plan is not kept.
#[test]
fn forward_and_back_is_n_times_as_much() {
    for n in [7, 64, 70_000] {
        let (before, mut after) = (values(n), values(n));
        forward(&mut after);
        inverse(&mut after);
        for (k, (before, after)) in before.iter().zip(&after).enumerate() {
            assert!((after / n as f64 - before).norm() < 1e-9, "{n}, {k}");
        }
    }
}
