//! The command `nonius`.
fn main() {}
