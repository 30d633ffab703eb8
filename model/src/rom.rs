//! Read-only tables: rows of one or more columns, addressed by an angle.

use crate::bits::Bits;
use crate::format::Format;

/// One column of a [`Rom`].
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name in Verilog and files.
    pub name: &'static str,
    /// Format of the entries.
    pub format: Format,
    /// Entries in units of the format's last bit.
    pub raw: Vec<i64>,
    /// What the entries stand for, without rounding, for the `f64` reading.
    pub exact: Vec<f64>,
    /// The entries in the container, for the bit-true reading.
    pub(crate) bits: Vec<Bits>,
}

impl Column {
    /// Rounds `exact` + `carried` to `format` and checks that every entry fits. `carried` is what the entries hold on
    /// top for a later rounding; the `f64` reading does not see it.
    ///
    /// # Errors
    /// The index of the first entry that does not fit.
    pub fn new(
        name: &'static str,
        format: Format,
        exact: Vec<f64>,
        carried: f64,
    ) -> Result<Self, usize> {
        let raw: Vec<i64> = exact
            .iter()
            .map(|x| ((x + carried) / format.lsb()).round() as i64)
            .collect();
        if let Some(i) = raw
            .iter()
            .position(|&r| i128::from(r) < format.min_raw() || i128::from(r) > format.max_raw())
        {
            return Err(i);
        }
        let bits = raw
            .iter()
            .map(|&r| Bits::from_raw(r, format.fraction))
            .collect();
        Ok(Self {
            name,
            format,
            raw,
            exact,
            bits,
        })
    }
}

/// A table with 2^`address_bits` rows; the row of an address x is ⌊x · 2^`index_fraction`⌋.
#[derive(Clone, Debug, PartialEq)]
pub struct Rom {
    /// Name in Verilog and files.
    pub name: &'static str,
    /// Number of address bits.
    pub address_bits: u32,
    /// Rows per unit of the address are 2^`index_fraction`.
    pub index_fraction: u32,
    /// The columns, side by side in one memory word.
    pub columns: Vec<Column>,
}

impl Rom {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        1 << self.address_bits
    }

    /// Bits of one row.
    #[must_use]
    pub fn row_width(&self) -> u32 {
        self.columns.iter().map(|c| c.format.width).sum()
    }

    /// Bits of the whole table.
    #[must_use]
    pub fn bits(&self) -> u64 {
        u64::from(self.row_width()) << self.address_bits
    }

    /// One row as the memory holds it, the first column in the highest bits.
    #[must_use]
    pub fn word(&self, row: usize) -> u128 {
        self.columns.iter().fold(0, |word, c| {
            (word << c.format.width) | (c.raw[row] as u128 & ((1u128 << c.format.width) - 1))
        })
    }
}
