//! What flicker noise gains on data that it was not fitted to.

use super::spectrum::{Line, bands};
use super::{corner, likelihood, white_beside};

/// Lines of the spectrum that are left together.
const BLOCK: usize = 2;

/// Log-likelihood of every second pair of the spectrum's lines by the level and corner of those between them, less that by
/// white noise alone: the lines of a spectrum are independent of each other, but for neighbours.
pub(super) fn gain(lines: &[Line]) -> f64 {
    let half = |half: usize| -> Vec<Line> {
        let blocks = lines.chunks(BLOCK).skip(half).step_by(2);
        blocks.flatten().copied().collect()
    };
    let halves = [half(0), half(1)];
    if halves.iter().any(Vec::is_empty) {
        return 0.0;
    }
    let one = |fitted: &[Line], judged: &[Line]| {
        let (fitted_bands, judged) = (bands(fitted), bands(judged));
        let of = |corner: f64| {
            let (white, _) = white_beside(&fitted_bands, corner);
            likelihood(&judged, |b| white * (2.0 + corner * b.flicker))
        };
        of(corner(fitted, &fitted_bands).0) - of(0.0)
    };
    one(&halves[0], &halves[1]) + one(&halves[1], &halves[0])
}
