//! Axes: from numbers to places, and the numbers that stand beside them.

/// How numbers are spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm; what is not positive is not shown.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How.
    pub scale: Scale,
    /// Its ends; [`Axis::fitted`] finds them.
    pub ends: [f64; 2],
}

/// Most intervals between the ticks of an axis.
pub(crate) const INTERVALS: f64 = 5.0;
/// Decades below which a logarithmic axis has the numbers of a linear one.
pub(crate) const LINEAR: f64 = 0.7;
/// Decades below which 2 and 5 have numbers too.
pub(crate) const FEW: f64 = 2.5;
/// From it on a number has a power of ten.
pub(crate) const LARGE: f64 = 1e5;
/// Step below which it has one, too.
pub(crate) const SMALL: f64 = 1e-4;

impl Axis {
    /// A linear axis between two ends.
    #[must_use]
    pub fn linear(label: &str, ends: [f64; 2]) -> Self {
        let scale = Scale::Linear;
        Self::new(label, scale, ends)
    }

    /// A linear axis that shows all of these numbers, with a little room.
    #[must_use]
    pub fn fitted(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let [low, high] = ends(values);
        let room = 0.06 * (high - low);
        Self::new(label, Scale::Linear, [low - room, high + room])
    }

    /// A logarithmic axis that shows all of these numbers that are positive.
    #[must_use]
    pub fn logarithmic(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        let [low, high] = ends(values.into_iter().filter(|v| *v > 0.0));
        let (low, high) = if low > 0.0 { (low, high) } else { (0.1, 10.0) };
        Self::new(label, Scale::Logarithmic, [low / 1.3, high * 1.3])
    }

    fn new(label: &str, scale: Scale, [low, high]: [f64; 2]) -> Self {
        // An axis without length shows nothing.
        let high = if high > low {
            high
        } else {
            low + low.abs().max(1.0)
        };
        Self {
            label: label.into(),
            scale,
            ends: [low, high],
        }
    }

    /// Where a number stands, 0 at the lower end and 1 at the upper; `None` where it has no place.
    #[must_use]
    pub fn place(&self, value: f64) -> Option<f64> {
        let [low, high] = self.ends;
        let place = match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Logarithmic => (value / low).ln() / (high / low).ln(),
        };
        place.is_finite().then_some(place)
    }

    /// Numbers that stand beside the axis, with their places.
    #[must_use]
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.ends;
        let decades = (high / low).log10();
        if self.scale == Scale::Logarithmic && decades >= LINEAR {
            // 1, 2 and 5 of each decade, or decades alone, some of them left out where they are many.
            let (factors, every, first) = if decades < FEW {
                (&[1.0, 2.0, 5.0][..], 1, low.log10().floor())
            } else {
                let every = (decades / INTERVALS).ceil() as usize;
                (&[1.0][..], every, low.log10().ceil())
            };
            let first = first as i32;
            let powers = (first..=high.log10().floor() as i32).step_by(every);
            let values = powers.flat_map(|p| factors.iter().map(move |f| f * 10f64.powi(p)));
            let values: Vec<f64> = values.filter(|v| (low..=high).contains(v)).collect();
            // All in one way of writing.
            let plain = values.iter().all(|v| (SMALL..LARGE).contains(v));
            let written = |value: f64| {
                if plain {
                    number(value, value)
                } else {
                    format!("{value:.0e}")
                }
            };
            return values
                .into_iter()
                .filter_map(|value| Some((self.place(value)?, written(value))))
                .collect();
        }
        let step = step(high - low);
        let first = (low / step).ceil();
        let count = ((high / step).floor() - first).max(0.0) as usize + 1;
        (0..count)
            .filter_map(|i| {
                // Not −0.
                let value = (first + i as f64) * step + 0.0;
                Some((self.place(value)?, number(value, step)))
            })
            .collect()
    }
}

/// The smallest and the largest; 0 and 1 where there are none.
fn ends(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let [low, high] = finite.fold([f64::MAX, f64::MIN], |[a, b], v| [a.min(v), b.max(v)]);
    if low > high { [0.0, 1.0] } else { [low, high] }
}

/// 1, 2 or 5 times a power of ten, of which about five make the length.
fn step(length: f64) -> f64 {
    let rough = length / INTERVALS;
    let power = 10f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0, 10.0];
    let fits = factor
        .into_iter()
        .find(|f| f * power >= rough * (1.0 - 1e-9));
    fits.unwrap_or(10.0) * power
}

/// A number with as many digits as the step asks for.
fn number(value: f64, step: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if value.abs() >= LARGE || step < SMALL {
        let digits = (value.abs().log10().floor() - step.log10().floor()).clamp(0.0, 6.0) as usize;
        return format!("{value:.digits$e}");
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|t| t.1).collect()
    }

    #[test]
    fn ticks_are_round_numbers_within_the_ends() {
        assert_eq!(
            words(&Axis::linear("", [-0.31, 0.62])),
            ["-0.2", "0", "0.2", "0.4", "0.6"]
        );
        assert_eq!(
            words(&Axis::linear("", [0.0, 1.0])),
            ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            words(&Axis::linear("", [0.0, 2e6])),
            ["0", "5e5", "1.0e6", "1.5e6", "2.0e6"]
        );
        assert_eq!(
            words(&Axis::linear("", [0.0, 3e-5])),
            ["0", "1e-5", "2e-5", "3e-5"]
        );
    }

    #[test]
    fn decades_of_a_logarithmic_axis() {
        let axis = Axis::logarithmic("", [1e-6, 0.0, 1e-2, -3.0]);
        assert_eq!(words(&axis), ["1e-6", "1e-5", "1e-4", "1e-3", "1e-2"]);
        assert_eq!(
            words(&Axis::logarithmic("", [800.0, 150_000.0])),
            ["1e3", "1e4", "1e5"]
        );
        assert_eq!(
            words(&Axis::logarithmic("", [3.0, 60.0])),
            ["5", "10", "20", "50"]
        );
        assert_eq!(axis.place(-1.0), None);
        assert_eq!(axis.place(axis.ends[1]), Some(1.0));
    }

    #[test]
    fn every_logarithmic_axis_has_two_numbers_and_not_too_many() {
        for low in 0..100 {
            for length in 1..400 {
                let low = 10f64.powf(f64::from(low) / 37.0 - 3.0);
                let high = low * 10f64.powf(f64::from(length) / 40.0);
                let ticks = Axis::logarithmic("", [low, high]).ticks().len();
                assert!((2..=8).contains(&ticks), "{low} to {high}: {ticks}");
            }
        }
    }

    #[test]
    fn an_axis_of_one_number_or_of_none_has_a_length() {
        for values in [vec![], vec![3.0], vec![f64::NAN]] {
            let axis = Axis::fitted("", values);
            assert!(axis.ends[1] > axis.ends[0], "{axis:?}");
        }
    }
}
