//! What is said of a number in `design.toml` that is too large to be read.

use std::ops::Range;

use super::place::field_at;

/// Of a number at `span` that is beyond what its key can be: key, value and limit; `None` where something else is wrong, which
/// the reader's `message` says.
pub(super) fn too_large(text: &str, span: Range<usize>, message: &str) -> Option<String> {
    let value = text.get(span.clone())?;
    let says = |words: &str| message.contains(words);
    let limit = if says("floating-point number overflowed") {
        "out of range (limit: -1.797e308 … 1.797e308)"
    } else if !is_large(value) {
        return None;
    } else if says("expected u32") {
        "out of range (limit: 0 … 4294967295)"
    } else if says("expected i32") {
        "out of range (limit: -2147483648 … 2147483647)"
    } else if says("expected f64") {
        "so many digits are written with a point or an exponent (limit without: 9223372036854775807)"
    } else if says("expected any valid TOML value") || says("\"all\"") {
        "out of range (limit: 1 … 4294967295, or \"all\")"
    } else if says("integer number overflowed") {
        // Of more digits than the reader takes for any key.
        "out of range (limit: 4294967295 where it is a whole number; others are written with a point or an exponent)"
    } else {
        return None;
    };
    let key = field_at(text, span.start).map_or_else(String::new, |field| format!("{field} = "));
    Some(format!("{key}{}: {limit}", shortened(value)))
}

/// Whether it is a whole number that not every key for whole numbers can be.
fn is_large(value: &str) -> bool {
    let digits = value.trim_start_matches(['+', '-']).replace('_', "");
    let (digits, radix) = match digits.get(..2) {
        Some("0x") => (&digits[2..], 16),
        Some("0o") => (&digits[2..], 8),
        Some("0b") => (&digits[2..], 2),
        _ => (&digits[..], 10),
    };
    let is_whole = !digits.is_empty() && digits.chars().all(|c| c.is_digit(radix));
    is_whole && i32::from_str_radix(digits, radix).is_err()
}

/// Cut where it would fill the screen.
fn shortened(value: &str) -> String {
    const LONGEST: usize = 40;
    match value.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &value[..end]),
        None => value.into(),
    }
}
