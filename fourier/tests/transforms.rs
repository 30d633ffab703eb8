//! The transforms against their definition. Not in the library: it would be built twice, which takes a minute.

use nonius_fourier::{Complex, forward, inverse};

#[test]
fn forward_and_back_is_n_times_as_much() {
    for n in [0, 1, 7, 64, 70_000] {
        let of = |k: usize| Complex::new((k as f64).sin(), (3.0 * k as f64).cos());
        let mut values: Vec<Complex<f64>> = (0..n).map(of).collect();
        forward(&mut values);
        let sum: Complex<f64> = (0..n).map(of).sum();
        assert!(n == 0 || (values[0] - sum).norm() < 1e-6);
        inverse(&mut values);
        for (k, value) in values.iter().enumerate() {
            assert!((value / n as f64 - of(k)).norm() < 1e-9, "{n}, {k}");
        }
    }
}
