//! Reads vector files back.

use crate::stimulus::Sample;

/// One row: what went in, and the columns behind it, as the words that the Verilog compares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Sample number.
    pub number: u64,
    /// The inputs; codes with their sign.
    pub input: Sample,
    /// One word per column.
    pub words: Vec<u64>,
}

/// Why a vector file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {reason}")]
pub struct VectorError {
    /// Counted from 1.
    pub line: usize,
    /// What is wrong.
    pub reason: String,
}

/// All rows of a file for ADC codes of `adc_bits` bits, signed or not, with `columns` columns behind the inputs.
///
/// # Errors
/// The first line that is no such row.
pub fn rows(
    text: &str,
    adc_bits: u32,
    signed: bool,
    columns: usize,
) -> Result<Vec<Row>, VectorError> {
    let code = |word: u64| {
        let negative = signed && adc_bits < 64 && word >> (adc_bits - 1) & 1 == 1;
        let span = if negative { 1i64 << adc_bits } else { 0 };
        word as i64 - span
    };
    let mut all = vec![];
    for (index, line) in text.lines().enumerate() {
        let wrong = |reason: String| VectorError {
            line: index + 1,
            reason,
        };
        let words = line
            .split_whitespace()
            .map(|word| {
                // The standard library takes a sign too, `$readmemh` and the testbench do not.
                let digits = word.bytes().all(|byte| byte.is_ascii_hexdigit());
                let number = u64::from_str_radix(word, 16).ok().filter(|_| digits);
                number.ok_or_else(|| wrong(format!("{word:?} is no hexadecimal number")))
            })
            .collect::<Result<Vec<u64>, VectorError>>()?;
        if words.len() != columns + 5 {
            return Err(wrong(format!(
                "{} columns where {} are expected",
                words.len(),
                columns + 5
            )));
        }
        for word in &words[1..3] {
            if adc_bits < 64 && word >> adc_bits != 0 {
                return Err(wrong(format!("{word:x} is no code of {adc_bits} bits")));
            }
        }
        for (word, pin) in words[3..5].iter().zip(["preset", "calibrate"]) {
            if *word > 1 {
                return Err(wrong(format!("{word:x} is no level of {pin}: 0 or 1")));
            }
        }
        if words[0] != index as u64 {
            return Err(wrong(format!("sample {:x} out of order", words[0])));
        }
        all.push(Row {
            number: words[0],
            input: Sample {
                cos: code(words[1]),
                sin: code(words[2]),
                preset: words[3] != 0,
                calibrate: words[4] != 0,
            },
            words: words[5..].to_vec(),
        });
    }
    Ok(all)
}
