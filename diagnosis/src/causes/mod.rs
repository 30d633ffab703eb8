//! The catalogue: one file per kind of cause.

mod angle;
mod code;
mod line;
mod revolution;
mod speed;
mod time;

use crate::cause::Candidate;
use crate::context::Context;
use crate::model::Residual;

/// Every cause with every choice of its discrete parameters.
pub(crate) fn all(context: &Context, residual: &Residual) -> Vec<Candidate> {
    let mut list = angle::candidates(context);
    list.extend(code::candidates(context));
    list.extend(speed::candidates(context));
    list.extend(time::candidates(context));
    list.extend(line::candidates(context, residual));
    list.extend(revolution::candidates(context, residual));
    list
}

pub(crate) use speed::varies as speed_varies;
pub(crate) use time::polynomials;
