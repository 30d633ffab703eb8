//! What has no name: what is left, where it lives and what it looks like, and what a recording cannot show at all.

pub(crate) mod left;
pub(crate) mod unexplained;
pub(crate) mod unseen;
pub(crate) mod whereabouts;
