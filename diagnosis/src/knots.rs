//! How close the knots of the motion's spline stand: as close as the likelihood asks for, and then a little closer.

use std::ops::Range;

use crate::spline::Spline;

/// Finest knot spacing, in samples.
const FINEST: f64 = 6.0;
/// Knots stand at least so much closer than the likelihood asks for: what the motion leaves behind must be far below the
/// noise, not just not worth another knot.
const CLOSER: f64 = 2.0;
/// Records longer than this are judged by stretches.
const WHOLE: usize = 32_768;
/// So many of them, spread over the record.
const STRETCHES: usize = 4;
/// So many halvings in a row that are worse end the search.
const PATIENCE: usize = 3;

/// The knot spacing, in samples, whose spline explains an angle (radians) best for its number of coefficients, with what
/// repeats with the period taken off first, and the strongest line in time and in the revolution: real vibration and
/// cogging are no reason for more knots.
pub(crate) fn spacing(angle: &[f64], weight: &[f64], periods_per_revolution: Option<u32>) -> f64 {
    let n = angle.len();
    let stretches: Vec<Stretch> = stretches(n)
        .into_iter()
        .map(|range| {
            Stretch::new(
                &angle[range.clone()],
                &weight[range],
                periods_per_revolution,
            )
        })
        .collect();
    let counting: f64 = stretches.iter().map(|s| s.weight.iter().sum::<f64>()).sum();
    let longest = stretches.iter().map(|s| s.angle.len()).max().unwrap_or(1);
    let mut spacing = (longest as f64 / 2.0).max(FINEST);
    let score = |spacing: f64| {
        let (mut power, mut count) = (0.0, 0.0);
        for stretch in &stretches {
            let spline = Spline::new(stretch.angle.len(), spacing, stretch.weight);
            power += stretch.left(&spline);
            count += spline.count() as f64;
        }
        counting * (power / counting).max(1e-300).ln() + count * counting.ln()
    };
    let mut best = (f64::MAX, spacing);
    let mut worse = 0;
    while spacing >= FINEST && worse <= PATIENCE {
        let now = score(spacing);
        worse += 1;
        if now < best.0 {
            best = (now, spacing);
            worse = 0;
        }
        spacing /= 2.0;
    }
    let coarse = best.1;
    for share in [1.0 / 2f64.sqrt(), 2f64.sqrt()] {
        let spacing = (coarse * share).max(FINEST);
        let now = score(spacing);
        if now < best.0 {
            best = (now, spacing);
        }
    }
    (best.1 / closer(n as f64, best.1)).max(FINEST)
}

/// How much closer than the likelihood asks for. There, what the spline leaves of the motion raises the log-likelihood by
/// about n ln n/(8 h) for a spacing of h samples; it falls with the eighth power of the spacing, and has to be below one.
fn closer(n: f64, spacing: f64) -> f64 {
    const MARGIN: f64 = 1.25;
    (MARGIN * (n * n.ln() / 8.0 / spacing).powf(0.125)).max(CLOSER)
}

fn stretches(n: usize) -> Vec<Range<usize>> {
    if n <= WHOLE {
        return std::iter::once(0..n).collect();
    }
    let length = WHOLE / STRETCHES;
    let gap = (n - length) / (STRETCHES - 1);
    (0..STRETCHES).map(|i| i * gap..i * gap + length).collect()
}

/// A part of the record, and what repeats with the period in it.
struct Stretch<'a> {
    angle: &'a [f64],
    weight: &'a [f64],
    /// cos and sin of orders 1 to 4.
    cyclic: Vec<Vec<f64>>,
    /// Periods per revolution, and the angle of the revolution.
    revolution: Option<(u32, Vec<f64>)>,
}

impl<'a> Stretch<'a> {
    fn new(angle: &'a [f64], weight: &'a [f64], per: Option<u32>) -> Self {
        let wave = |order: u32, f: fn(f64) -> f64| -> Vec<f64> {
            angle.iter().map(|a| f(f64::from(order) * a)).collect()
        };
        Self {
            angle,
            weight,
            cyclic: (1..=4)
                .flat_map(|order| [wave(order, f64::cos), wave(order, f64::sin)])
                .collect(),
            revolution: per.map(|n| (n, angle.iter().map(|a| a / f64::from(n)).collect())),
        }
    }

    /// Square of what a spline leaves of the angle.
    fn left(&self, spline: &Spline) -> f64 {
        let mut columns = vec![self.angle];
        columns.extend(self.cyclic.iter().map(Vec::as_slice));
        let mut residuals = spline.residuals(&columns, self.weight);
        let shapes = residuals.split_off(1);
        let left = crate::solve::without(&residuals[0], &shapes);
        let left = self.without_lines(&left, spline);
        left.iter().map(|r| r * r).sum()
    }

    fn without_lines(&self, values: &[f64], spline: &Spline) -> Vec<f64> {
        let left = crate::lines::without_strongest(values);
        let Some((per, phi)) = &self.revolution else {
            return left;
        };
        let sums = crate::causes::revolution_orders(phi, &left);
        let power = |order: &usize| sums[*order][0].powi(2) + sums[*order][1].powi(2);
        let best = (1..sums.len())
            .filter(|o| o % *per as usize != 0)
            .max_by(|a, b| power(a).total_cmp(&power(b)));
        let Some(order) = best else { return left };
        let wave =
            |f: fn(f64) -> f64| -> Vec<f64> { phi.iter().map(|p| f(order as f64 * p)).collect() };
        let waves = [wave(f64::cos), wave(f64::sin)];
        let columns: Vec<&[f64]> = waves.iter().map(Vec::as_slice).collect();
        crate::solve::without(&left, &spline.residuals(&columns, self.weight))
    }
}
