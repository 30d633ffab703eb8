//! Numbers as engineers write them: digits that the error allows, one SI prefix for a value and its error, and nouns that
//! agree with their number. All text for people is made with these; files for programs have plain SI numbers.

mod counted;
mod plain;
mod prefix;
mod quantity;

pub use counted::{agree, counted, ordinal, times};
pub use plain::{digits, engineering, periods_per_second};
pub use quantity::{Quantity, Unit, before_after, prefixed};
