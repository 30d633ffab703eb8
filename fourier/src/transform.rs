//! Plans and transforms.

use std::cell::RefCell;

use rustfft::FftPlanner;
pub use rustfft::num_complex::Complex;

/// Of plans of more values only those of the last length are kept: they take room in proportion.
const KEPT: usize = 1 << 16;

thread_local! {
    static PLANS: RefCell<FftPlanner<f64>> = RefCell::new(FftPlanner::new());
    static LARGE: RefCell<(usize, FftPlanner<f64>)> = RefCell::new((0, FftPlanner::new()));
}

/// X(k) = Σ x(n) exp(−2πi kn/N).
pub fn forward(values: &mut [Complex<f64>]) {
    transform(values, FftPlanner::plan_fft_forward);
}

/// x(n) = Σ X(k) exp(2πi kn/N): after [`forward`] N times what it began with.
pub fn inverse(values: &mut [Complex<f64>]) {
    transform(values, FftPlanner::plan_fft_inverse);
}

type Plan = fn(&mut FftPlanner<f64>, usize) -> std::sync::Arc<dyn rustfft::Fft<f64>>;

fn transform(values: &mut [Complex<f64>], plan: Plan) {
    let n = values.len();
    if n == 0 {
        return;
    }
    let plan = if n > KEPT {
        LARGE.with_borrow_mut(|(last, planner)| {
            if *last != n {
                (*last, *planner) = (n, FftPlanner::new());
            }
            plan(planner, n)
        })
    } else {
        PLANS.with_borrow_mut(|planner| plan(planner, n))
    };
    plan.process(values);
}
