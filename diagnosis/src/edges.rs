//! The first and last samples of a recording, which have neighbours on one side only: a logger that shows zeros before its ADC
//! has begun, or after it has ended.

use nonius_recording::Recording;

use crate::checks::ninth;
use crate::glitches::FAR;

/// Samples at either end that are looked at.
const LOOKED: usize = 8;
/// The curve of order five through the next six samples, continued to the one before them.
const ONWARD: [f64; 6] = [6.0, -15.0, 20.0, -15.0, 6.0, -1.0];

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
/// nothing about the one before it.
pub(crate) fn edges(recording: &Recording) -> Edges {
    let n = recording.samples();
    let mut edges = Edges {
        channels: [recording.cos.clone(), recording.sin.clone()],
        far: vec![],
    };
    if n < 4 * LOOKED {
        return edges;
    }
    let limits: Vec<f64> = edges
        .channels
        .iter()
        .map(|values| {
            let inside = LOOKED..n - LOOKED - ONWARD.len();
            let sizes: Vec<f64> = inside.map(|k| off(values, k, |j| k + j).abs()).collect();
            FAR * ninth(&sizes)
        })
        .collect();
    let floor = 6.0 * recording.metadata.adc.cos.lsb;
    for end in [0, n - 1] {
        for i in (0..LOOKED).rev() {
            let k = end.abs_diff(i);
            let inwards = |j: usize| if end == 0 { k + j } else { k - j };
            let sizes = [0, 1].map(|c| off(&edges.channels[c], k, inwards));
            let far = |c: usize| sizes[c].abs() > limits[c].max(floor);
            if !far(0) && !far(1) {
                continue;
            }
            edges.far.push((k, sizes[0].abs().max(sizes[1].abs())));
            for (values, size) in edges.channels.iter_mut().zip(sizes) {
                values[k] -= size;
            }
        }
    }
    edges
}
