//! Whether the signals of a recording can be used at all.

use crate::MIN_SAMPLES;
use crate::error::ErrorKind;
use crate::estimate::tidy;
use crate::standstill;

/// A channel with less than this share of the other's range is dead, if the other one turns.
const DEAD_RANGE: f64 = 0.005;
/// Passages of the other channel through its middle that show that it turns.
const TURNS: usize = 3;

/// A signal with the names to use in a message.
pub(crate) struct Channel<'a> {
    pub(crate) values: &'a [f64],
    pub(crate) column: &'a str,
    pub(crate) option: &'static str,
}

/// Refuses recordings that are too short or have a dead channel; constant channels where both rest are a standstill, and no
/// dead wiring.
pub(crate) fn usable(cos: &Channel<'_>, sin: &Channel<'_>) -> Result<(), ErrorKind> {
    let found = cos.values.len();
    if found < MIN_SAMPLES {
        return Err(ErrorKind::TooFew { found });
    }
    // Zeros in both channels at the start are an ADC that had not begun yet.
    let start = standstill::start(cos.values, sin.values);
    let ranges = [cos, sin].map(|c| range(c.values.get(start..).unwrap_or_default()));
    let widths = ranges.map(|(low, high)| high - low);
    if widths.contains(&0.0) && standstill::at_rest(cos.values, sin.values) {
        let of = |i: usize| {
            let (low, high) = ranges[i];
            if low == high {
                format!("is constant at {}", tidy(low))
            } else {
                format!("flickers within {} … {}", tidy(low), tidy(high))
            }
        };
        let why = format!("'{}' {}, '{}' {}", cos.column, of(0), sin.column, of(1));
        return Err(ErrorKind::Standstill { why });
    }
    for (i, channel) in [cos, sin].into_iter().enumerate() {
        let other = [sin, cos][i];
        let (low, high) = ranges[i];
        let why = if widths[i].is_nan() || widths[i] < 1e-30 {
            format!("it is constant at {}", tidy(low))
        } else if widths[i] < DEAD_RANGE * widths[1 - i]
            && turns(&other.values[start..], ranges[1 - i])
        {
            let [low, high] = [low, high].map(tidy);
            format!(
                "it stays within {low} … {high} while '{}' turns",
                other.column
            )
        } else {
            continue;
        };
        let (column, option) = (channel.column.to_owned(), channel.option);
        return Err(ErrorKind::DeadChannel {
            column,
            why,
            option,
        });
    }
    Ok(())
}

fn range(values: &[f64]) -> (f64, f64) {
    let fold = |f: fn(f64, f64) -> f64| values.iter().copied().reduce(f).unwrap_or_default();
    (fold(f64::min), fold(f64::max))
}

/// True where the values pass the middle of their range a few times, for good each time.
fn turns(values: &[f64], (low, high): (f64, f64)) -> bool {
    let (quarter, middle) = ((high - low) / 4.0, (high + low) / 2.0);
    let mut side = 0.0;
    let mut passages = 0;
    for value in values {
        let now = (value - middle).signum();
        if (value - middle).abs() > quarter && now != side {
            passages += usize::from(side != 0.0);
            side = now;
        }
    }
    passages >= TURNS
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(
        cos: impl Fn(f64) -> f64,
        sin: impl Fn(f64) -> f64,
        n: u32,
    ) -> Result<(), ErrorKind> {
        let values = |f: &dyn Fn(f64) -> f64| (0..n).map(|k| f(f64::from(k))).collect::<Vec<_>>();
        let (cos, sin) = (values(&cos), values(&sin));
        usable(
            &Channel {
                values: &cos,
                column: "cos",
                option: "--cos",
            },
            &Channel {
                values: &sin,
                column: "sin",
                option: "--sin",
            },
        )
    }

    #[test]
    fn sixteen_samples_are_enough_and_fifteen_are_not() {
        verdict(f64::cos, f64::sin, 16).expect("accepted");
        let error = verdict(f64::cos, f64::sin, 15).expect_err("a refusal");
        assert!(
            error
                .to_string()
                .starts_with("15 samples are too few; at least 16"),
            "{error}"
        );
    }

    #[test]
    fn constant_channels_are_dead_and_named() {
        let error = verdict(f64::cos, |_| 2.5, 100).expect_err("a refusal");
        assert!(
            error
                .to_string()
                .starts_with("the column 'sin' is dead: it is constant at 2.5")
        );
        let after_zeros = |k: f64| if k < 2.0 { 0.0 } else { 2.5 };
        let cos = |k: f64| if k < 2.0 { 0.0 } else { k.cos() };
        assert!(verdict(cos, after_zeros, 100).is_err());
    }

    #[test]
    fn two_channels_that_rest_are_a_standstill_and_not_dead_wiring() {
        let toggles = |k: f64| f64::from(u8::from((k * 7.0).sin() > 0.3));
        type Signal = fn(f64) -> f64;
        let cases: [(Signal, Signal); 3] = [
            (|_| 0.0, |_| 0.0),
            (|_| 1200.0, |_| -500.0),
            (|_| 1200.0, toggles),
        ];
        for (cos, sin) in cases {
            let error = verdict(cos, sin, 1000).expect_err("a refusal");
            assert!(matches!(error, ErrorKind::Standstill { .. }), "{error}");
            assert!(
                error.to_string().starts_with("the scale stands still"),
                "{error}"
            );
        }
        // Beside one that moves it is dead.
        let error = verdict(|_| 1200.0, |k| (40.0 * (k / 9.0).cos()).round(), 1000);
        assert!(matches!(error, Err(ErrorKind::DeadChannel { .. })));
    }

    #[test]
    fn a_channel_that_only_flickers_is_dead_where_the_other_turns() {
        let flicker = |k: f64| (k * 7.0).sin().signum() * 0.001;
        let error = verdict(|k| (k / 9.0).cos(), flicker, 1000).expect_err("a refusal");
        assert!(error.to_string().contains("while 'cos' turns"), "{error}");
    }

    #[test]
    fn a_short_arc_and_a_standstill_are_data() {
        let arc = |k: f64| k * 1e-5;
        verdict(|k| arc(k).cos(), |k| arc(k).sin(), 1000).expect("accepted");
        let noise = |k: f64| (k * k * 1.7).sin() * 1e-3;
        verdict(noise, |k| noise(k + 0.5), 1000).expect("accepted");
    }
}
