//! The first and last samples of a recording, which have neighbours on one side only: a logger that shows zeros before its ADC
//! has begun, or after it has ended.

use nonius_recording::Recording;

use crate::checks::glitches::{far_among, floors};
use crate::checks::ninth;

/// Samples at either end that are looked at.
const LOOKED: usize = 8;
/// The curve of order five through the next six samples, continued to the one before them.
const ONWARD: [f64; 6] = [6.0, -15.0, 20.0, -15.0, 6.0, -1.0];
/// Samples next to an end that tell how large the noise is there.
const AROUND: usize = 100;

/// Both channels, with what is far off at either end as the samples inside it say.
pub(crate) struct Edges {
    pub(crate) channels: [Vec<f64>; 2],
    /// Samples that are far off, and how far.
    pub(crate) far: Vec<(usize, f64)>,
}

/// How far a sample is off the curve through the next ones inwards; `inwards` tells which they are.
fn off(values: &[f64], k: usize, inwards: impl Fn(usize) -> usize) -> f64 {
    let next = (1..).zip(ONWARD);
    values[k] - next.map(|(j, c)| c * values[inwards(j)]).sum::<f64>()
}

/// Samples at the ends that are far off what the ones next to them inwards say, from inside outwards: one that is wrong says
/// nothing about the one before it, and what stands in its place has so much more noise that only a sample which is far off by as much
/// more is wrong beside it, or one that says the same again.
pub(crate) fn edges(recording: &Recording) -> Edges {
    let n = recording.samples();
    let mut edges = Edges {
        channels: [recording.cos.clone(), recording.sin.clone()],
        far: vec![],
    };
    if n < 4 * LOOKED {
        return edges;
    }
    let inside = LOOKED..n - LOOKED - ONWARD.len();
    let louder = ONWARD.iter().fold(1.0, |sum, c| sum + c * c).sqrt();
    let sizes = edges.channels.each_ref().map(|values| -> Vec<f64> {
        let off = inside.clone().map(|k| off(values, k, |j| k + j).abs());
        off.collect()
    });
    let (floors, limit) = (floors(recording), far_among(n));
    for end in [0, n - 1] {
        let limits = [0, 1].map(|which: usize| {
            let sizes = &sizes[which];
            let near = if end == 0 {
                &sizes[..AROUND.min(sizes.len())]
            } else {
                &sizes[sizes.len().saturating_sub(AROUND)..]
            };
            (limit * ninth(sizes).max(ninth(near))).max(floors[which])
        });
        // How much the noise of what stands in the place of wrong samples has grown, and how far off the last of them was.
        let (mut grown, mut last) = (1.0, None);
        for i in (0..LOOKED).rev() {
            let k = end.abs_diff(i);
            let inwards = |j: usize| if end == 0 { k + j } else { k - j };
            let sizes = [0, 1].map(|c| off(&edges.channels[c], k, inwards));
            let far = |c: usize| sizes[c].abs() > limits[c] * grown;
            let before = inwards(1);
            let again = last.filter(|_| {
                let same = |values: &[f64]| values[k] == values[before];
                same(&recording.cos) && same(&recording.sin)
            });
            let size = match again {
                Some(size) => size,
                None if far(0) || far(1) => sizes[0].abs().max(sizes[1].abs()),
                None => {
                    last = None;
                    continue;
                }
            };
            edges.far.push((k, size));
            (grown, last) = (grown * louder, Some(size));
            for (values, size) in edges.channels.iter_mut().zip(sizes) {
                values[k] -= size;
            }
        }
    }
    edges
}
