//! What several tests share.

pub(crate) mod campaign;
pub(crate) mod recordings;
pub(crate) mod table;
