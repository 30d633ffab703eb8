//! Noise whose size depends on something: on the signal, on the speed.

use crate::context::Context;
use crate::finding::{Chip, Finding, Gain, Parameter};
use crate::model::Residual;
use crate::solve::Normal;
use crate::statistics::{after_trials, log_tail};

const SHOWN: f64 = 1e-3;

/// Rows: squares of the two residuals over their mean, less one; nearly independent with variance 2.
fn squares(residual: &[f64], weight: &[f64]) -> (Vec<f64>, f64) {
    let total: f64 = weight.iter().sum();
    let power = residual.iter().map(|r| r * r).sum::<f64>() / total.max(1.0);
    let scaled = residual.iter().zip(weight).map(|(r, w)| {
        // A single sample far out is a glitch, no noise that depends on something.
        let square = (r * r / power.max(1e-300)).min(25.0);
        (square - 1.0) * w / 2f64.sqrt()
    });
    (scaled.collect(), power)
}

pub(crate) fn findings(context: &Context, residual: &Residual) -> Vec<Finding> {
    let n = context.samples();
    let (radial, power_r) = squares(&residual.radial, &context.weight);
    let (tangential, power_t) = squares(&residual.tangential, &context.weight);
    let mut values = radial;
    values.extend(tangential);
    let rows = |f: &dyn Fn(usize) -> (f64, f64)| -> Vec<f64> {
        let mut all = vec![0.0; 2 * n];
        for k in 0..n {
            let (r, t) = f(k);
            all[k] = r * context.weight[k] / power_r.max(1e-300) / 2f64.sqrt();
            all[n + k] = t * context.weight[k] / power_t.max(1e-300) / 2f64.sqrt();
        }
        all
    };
    // Equal noise in each block; unequal noise of the channels.
    let base = vec![
        rows(&|_| (1.0, 0.0)),
        rows(&|_| (0.0, 1.0)),
        rows(&|k| {
            let d = context.cos[k].powi(2) - context.sin[k].powi(2);
            (d, -d)
        }),
    ];
    let top = context
        .speed
        .iter()
        .fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let shapes: [(&str, Vec<f64>); 2] = [
        (
            "amplitude_noise",
            rows(&|k| {
                let (c, s) = (context.cos[k].powi(2), context.sin[k].powi(2));
                (c * c + s * s, 2.0 * c * s)
            }),
        ),
        (
            "clock_jitter",
            rows(&|k| (0.0, (context.speed[k] / top).powi(2))),
        ),
    ];
    let before = Normal::of_columns(&values, &base).solve();
    let mut list = vec![];
    for (name, shape) in shapes {
        let mut columns = base.clone();
        columns.push(shape);
        let solution = Normal::of_columns(&values, &columns).solve();
        let gain = 0.5 * (solution.explained - before.explained);
        let freedom = solution.rank.saturating_sub(before.rank);
        let (x, error) = (solution.x[3], solution.covariance[(3, 3)].sqrt());
        if freedom == 0 || x <= 0.0 {
            continue;
        }
        let log_p = after_trials(log_tail(2.0 * gain, 1), 30.0);
        if log_p > SHOWN.ln() {
            continue;
        }
        let value = x.sqrt();
        let (value, spread, parameter, unit, sentence) = if name == "clock_jitter" {
            let scale = 1.0 / top;
            (
                value * scale,
                error / (2.0 * value) * scale,
                "rms_s",
                "s",
                format!(
                    "the angle is noisier the faster the scale moves, as if the sampling time were random by {:.3e} s rms",
                    value * scale
                ),
            )
        } else {
            (
                value,
                error / (2.0 * value),
                "rms",
                "1",
                format!(
                    "the noise of each channel grows with its signal: {:.3} % of it, rms",
                    value * 100.0
                ),
            )
        };
        list.push(Finding {
            cause: name.into(),
            confounded_with: vec![],
            p_value: log_p.exp(),
            parameters: vec![Parameter::measured(parameter, value, spread, unit)],
            gain: Gain::default(),
            evidence: format!("{sentence}; it raises the log-likelihood by {gain:.1}"),
            chip: Chip::CannotCorrect,
            weight: gain,
            effect: None,
            place: None,
        });
    }
    list
}
