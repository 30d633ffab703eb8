//! From a declaration and the values to a description of the ADC.

use crate::adc::{Adc, AdcPair, AdcSource};
use crate::cells::Digits;
use crate::declared::{Declared, Span};
use crate::grid::{self, Grid};

/// Widths that ADCs are sold in.
const USUAL_BITS: [u32; 8] = [8, 10, 12, 14, 16, 18, 20, 24];
/// Width assumed where the values show no steps.
const ASSUMED_BITS: u32 = 16;

/// A signal's values and how they are written.
pub(crate) struct Column<'a> {
    pub(crate) values: &'a [f64],
    pub(crate) digits: Digits,
}

/// The ADC of a recording, with notes on what was estimated.
pub(crate) fn describe(
    cos: &Column<'_>,
    sin: &Column<'_>,
    declared: &Declared,
    notes: &mut Vec<String>,
) -> AdcPair {
    let sorted = [grid::distinct(cos.values), grid::distinct(sin.values)];
    if let (Some(bits), Some(span)) = (declared.adc_bits, declared.span) {
        let pair = described(bits, span, &sorted, notes);
        note_clipping(cos.values, sin.values, &pair, notes);
        return pair;
    }
    let grids = [
        grid::find(&sorted[0], cos.digits),
        grid::find(&sorted[1], sin.digits),
    ];
    let extent = [extent(&sorted[0]), extent(&sorted[1])];
    let pair = estimated(agree(grids), extent, declared);
    notes.push(note(&pair, declared));
    note_clipping(cos.values, sin.values, &pair, notes);
    pair
}

/// The ADC that was described, with its codes where the values lie.
fn described(bits: u32, span: Span, sorted: &[Vec<f64>; 2], notes: &mut Vec<String>) -> AdcPair {
    let codes = 2f64.powi(bits as i32);
    let range = span.max - span.min;
    let middle = (span.min + span.max) / 2.0;
    let whole = |values: &Vec<f64>| values.iter().all(|v| v.fract() == 0.0);
    // A range from the first to the last code, in counts, is one or two codes short of the span.
    let counts = bits >= 6 && (0.0..=2.0).contains(&(codes - range)) && sorted.iter().all(whole);
    let (lsb, middle) = if counts {
        (1.0, middle.ceil())
    } else {
        (range / codes, middle)
    };
    let mut agreement = 1.0f64;
    let [cos, sin] = sorted.each_ref().map(|values| {
        let (phase, agrees) = grid::phase(values, lsb, middle);
        agreement = agreement.min(agrees);
        // Exactly half a step to either side is one and the same grid: take the upper one.
        let phase = if phase < -0.4 { phase + 1.0 } else { phase };
        let offset = if agrees > 0.8 { phase * lsb } else { 0.0 };
        let source = AdcSource::Described;
        Adc {
            bits,
            lsb,
            centre: middle + offset,
            source,
        }
    });
    if agreement < 0.5 {
        notes.push(format!(
            "the values do not lie on the codes of the ADC described ({bits} bits, one code = {}); \
             they are rounded to them",
            tidy(lsb)
        ));
    }
    AdcPair { cos, sin }
}

/// Both channels on one grid where their steps say so; a channel without one takes the other's.
fn agree(grids: [Option<Grid>; 2]) -> Option<[Grid; 2]> {
    let (a, b) = match grids {
        [Some(a), Some(b)] => (a, b),
        [Some(one), None] | [None, Some(one)] => return Some([one, one]),
        [None, None] => return None,
    };
    let codes = a.codes.max(b.codes);
    if ((a.step - b.step) / a.step * codes).abs() > 0.5 {
        // Where one channel shows only every n-th code, the finer step is the ADC's.
        let ratio = a.step / b.step;
        let (finer, whole) = if ratio > 1.0 {
            (b, ratio)
        } else {
            (a, 1.0 / ratio)
        };
        let multiple = whole.round();
        if multiple >= 2.0 && ((whole / multiple - 1.0) * codes).abs() < 0.5 {
            return Some([finer, finer]);
        }
        return Some([a, b]);
    }
    let step = (a.step * a.codes + b.step * b.codes) / (a.codes + b.codes);
    let apart = (a.origin - b.origin) / step;
    let same = (apart - apart.round()).abs() < 0.1;
    let origin = |own: f64| if same { a.origin } else { own };
    Some([a, b].map(|g| Grid {
        step,
        origin: origin(g.origin),
        ..g
    }))
}

fn extent(sorted: &[f64]) -> (f64, f64) {
    let at = |i: usize| sorted.get(i).copied().unwrap_or_default();
    (at(0), at(sorted.len().saturating_sub(1)))
}

fn estimated(grids: Option<[Grid; 2]>, extent: [(f64, f64); 2], declared: &Declared) -> AdcPair {
    if let Some(grids) = grids
        && let Some(pair) = on_grid(grids, extent, declared)
    {
        return pair;
    }
    let low = extent[0].0.min(extent[1].0);
    let high = extent[0].1.max(extent[1].1);
    let bits = declared.adc_bits.unwrap_or(ASSUMED_BITS);
    let span = declared.span.unwrap_or_else(|| {
        let max = power_of_two(1.05 * low.abs().max(high.abs()));
        Span {
            min: if low >= 0.0 { 0.0 } else { -max },
            max,
        }
    });
    let lsb = (span.max - span.min) / 2f64.powi(bits as i32);
    let centre = (span.min + span.max) / 2.0;
    let adc = Adc {
        bits,
        lsb,
        centre,
        source: AdcSource::Assumed,
    };
    AdcPair { cos: adc, sin: adc }
}

/// The ADC whose codes are the grid's; `None` where no usual number of bits holds them.
fn on_grid(grids: [Grid; 2], extent: [(f64, f64); 2], declared: &Declared) -> Option<AdcPair> {
    let code = |i: usize, value: f64| ((value - grids[i].origin) / grids[i].step).round();
    let low = code(0, extent[0].0).min(code(1, extent[1].0));
    let high = code(0, extent[0].1).max(code(1, extent[1].1));
    let (bits, middle) = if let Some(span) = declared.span {
        let codes = (span.max - span.min) / grids[0].step;
        let middle = code(0, (span.min + span.max) / 2.0);
        ((codes.log2() - 0.01).ceil().clamp(2.0, 24.0) as u32, middle)
    } else {
        let whole = |g: &Grid| g.step.fract() == 0.0 && g.origin == 0.0;
        let counts = grids.iter().all(whole);
        place(low, high, counts, declared.adc_bits)?
    };
    let [cos, sin] = grids.map(|g| Adc {
        bits,
        lsb: g.step,
        centre: g.origin + middle * g.step,
        source: AdcSource::Estimated,
    });
    Some(AdcPair { cos, sin })
}

/// Number of bits and middle of an ADC that holds the codes `low` … `high` of a grid about 0.
fn place(low: f64, high: f64, counts: bool, bits: Option<u32>) -> Option<(u32, f64)> {
    let allowed = |b: &u32| bits.is_none_or(|given| given == *b);
    let width = |holds: &dyn Fn(f64) -> bool| {
        let mut usual = USUAL_BITS.into_iter().chain(bits);
        usual.find(|b| allowed(b) && holds(2f64.powi(*b as i32 - 1)))
    };
    let bipolar = width(&|half| low >= -half && high < half);
    let one_sided = width(&|half| low >= 0.0 && high < 2.0 * half);
    let middle = |b: u32| 2f64.powi(b as i32 - 1);
    let signal = (low + high) / 2.0;
    match (bipolar, one_sided) {
        (_, Some(b)) if counts => Some((b, middle(b))),
        // Both hold the values: the fewer bits, then the one with the signal nearer to its middle.
        (Some(b), Some(o)) if o < b || (o == b && (signal - middle(o)).abs() < signal.abs()) => {
            Some((o, middle(o)))
        }
        (Some(b), _) => Some((b, 0.0)),
        (None, Some(o)) => Some((o, middle(o))),
        (None, None) => width(&|half| high - low < 2.0 * half).map(|b| (b, signal.round())),
    }
}

/// The power of two at or above a value.
fn power_of_two(value: f64) -> f64 {
    2f64.powi(value.max(f64::MIN_POSITIVE).log2().ceil() as i32)
}

fn note(pair: &AdcPair, declared: &Declared) -> String {
    let Adc {
        bits, lsb, source, ..
    } = pair.cos;
    let partly = match (declared.adc_bits, declared.span) {
        (Some(_), None) => " (its range is not given)",
        (None, Some(_)) => " (its number of bits is not given)",
        _ => "",
    };
    let steps = match pair.sin.lsb {
        same if same == lsb => tidy(lsb),
        sin => format!("{} in cos and {} in sin", tidy(lsb), tidy(sin)),
    };
    let found = format!("{bits} bits over {}, one code = {steps}", range(&pair.cos));
    match source {
        AdcSource::Assumed => {
            format!("the values show no codes; the ADC was assumed{partly}: {found}")
        }
        _ => format!("the ADC was estimated from the codes{partly}: {found}"),
    }
}

fn note_clipping(cos: &[f64], sin: &[f64], pair: &AdcPair, notes: &mut Vec<String>) {
    let outside = |values: &[f64], adc: &Adc| values.iter().filter(|v| adc.clips(**v)).count();
    let clipped = outside(cos, &pair.cos) + outside(sin, &pair.sin);
    if clipped > 0 {
        let range = range(&pair.cos);
        notes.push(format!(
            "{clipped} values lie outside the range of the ADC ({range}), which reads its ends for them"
        ));
    }
}

fn range(adc: &Adc) -> String {
    let full_scale = adc.full_scale();
    format!(
        "{} … {}",
        tidy(adc.centre - full_scale),
        tidy(adc.centre + full_scale)
    )
}

/// A number with six significant digits.
pub(crate) fn tidy(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}
