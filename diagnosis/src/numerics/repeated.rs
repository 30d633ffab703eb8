//! What values repeat with the period of an angle.

use std::f64::consts::TAU;

/// Sum of the squares of their means in so many parts of the period, each as often as it has values; `weight` says which count.
pub(crate) fn repeated(angle: &[f64], values: &[f64], weight: &[f64], parts: usize) -> f64 {
    let mut means = vec![[0.0; 2]; parts];
    for ((angle, value), weight) in angle.iter().zip(values).zip(weight) {
        let part = (angle / TAU).rem_euclid(1.0) * parts as f64;
        let [sum, count] = &mut means[(part as usize).min(parts - 1)];
        *sum += weight * value;
        *count += weight;
    }
    let filled = means.iter().filter(|[_, count]| *count > 0.0);
    filled.map(|[sum, count]| sum * sum / count).sum()
}
