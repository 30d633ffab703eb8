//! The columns of a block of samples side by side, and their products.

use nalgebra::DMatrix;

use crate::model::whiten::ORDER;
use crate::numerics::solve::dot;

/// Samples of a block: its functions fit the cache.
pub(crate) const CHUNK: usize = 1024;
/// Between the columns of a block: the past of each stands before it.
pub(crate) const STRIDE: usize = CHUNK + ORDER;
/// Samples whose products are summed at once: those of all columns fit the second cache.
const STRETCH: usize = 256;
/// Columns that are multiplied with [`RIGHT`] others at once: as many sums as there are registers.
const LEFT: usize = 4;
/// See [`LEFT`].
const RIGHT: usize = 3;

/// The columns of a row in a block: atoms in the order asked for, then the data.
#[derive(Default)]
pub(crate) struct Part {
    pub(crate) columns: usize,
    pub(crate) samples: usize,
    pub(crate) plain: Vec<f64>,
    pub(crate) white: Vec<f64>,
}

impl Part {
    /// Column `i` of plain or of white values.
    fn column(&self, white: bool, i: usize) -> &[f64] {
        let from = i * STRIDE + ORDER;
        &self.values(white)[from..from + self.samples]
    }

    fn values(&self, white: bool) -> &[f64] {
        if white && !self.white.is_empty() {
            &self.white
        } else {
            &self.plain
        }
    }

    /// Adds all products of columns from `fresh` on with all columns; only those above the diagonal count.
    pub(crate) fn add_products(&self, white: bool, fresh: usize, sums: &mut DMatrix<f64>) {
        for from in (0..self.samples).step_by(STRETCH) {
            let stretch = from..(from + STRETCH).min(self.samples);
            let column = |i: usize| &self.column(white, i.min(self.columns - 1))[stretch.clone()];
            for j in (fresh..self.columns).step_by(RIGHT) {
                let right = std::array::from_fn(|b| column(j + b));
                let last = (j + RIGHT).min(self.columns);
                for i in (0..last).step_by(LEFT) {
                    let tile = tile(std::array::from_fn(|a| column(i + a)), right);
                    // Past the last column it stands again.
                    for (row, i) in tile.iter().zip(i..last) {
                        for (product, j) in row.iter().zip(j..last) {
                            sums[(i, j)] += product;
                        }
                    }
                }
            }
        }
    }
}

/// Products of columns of the same samples. The columns are long and few: a matrix product for all shapes would spend most of
/// its time on arranging them anew.
fn tile(left: [&[f64]; LEFT], right: [&[f64]; RIGHT]) -> [[f64; RIGHT]; LEFT] {
    let count = right[0].len() / LANES;
    let sums = in_lanes(left, right, count);
    let mut sums = sums.map(|row| row.map(|lanes| lanes.iter().sum::<f64>()));
    for (row, left) in sums.iter_mut().zip(left) {
        for (sum, right) in row.iter_mut().zip(right) {
            *sum += dot(&left[count * LANES..], &right[count * LANES..]);
        }
    }
    sums
}

/// So many groups of samples, each of a group in a sum of its own. Every product is fused with its sum, by the processor or, on
/// an old one, slowly: all find the same sums. Those of a group are added elsewhere: where they are added here, the compiler
/// mixes lanes, and the loop is far slower.
#[multiversion::multiversion(targets("x86_64+avx2+fma"))]
fn in_lanes(
    left: [&[f64]; LEFT],
    right: [&[f64]; RIGHT],
    count: usize,
) -> [[[f64; LANES]; RIGHT]; LEFT] {
    let ([a0, a1, a2, a3], [b0, b1, b2]) = (
        left.map(|c| lanes(c, count)),
        right.map(|c| lanes(c, count)),
    );
    // Each has a register, which the compiler sees only where all are named.
    let [mut s00, mut s01, mut s02] = [[0.0; LANES]; RIGHT];
    let [mut s10, mut s11, mut s12] = [[0.0; LANES]; RIGHT];
    let [mut s20, mut s21, mut s22] = [[0.0; LANES]; RIGHT];
    let [mut s30, mut s31, mut s32] = [[0.0; LANES]; RIGHT];
    for ((((((x0, x1), x2), x3), y0), y1), y2) in
        a0.iter().zip(a1).zip(a2).zip(a3).zip(b0).zip(b1).zip(b2)
    {
        add(&mut s00, x0, y0);
        add(&mut s01, x0, y1);
        add(&mut s02, x0, y2);
        add(&mut s10, x1, y0);
        add(&mut s11, x1, y1);
        add(&mut s12, x1, y2);
        add(&mut s20, x2, y0);
        add(&mut s21, x2, y1);
        add(&mut s22, x2, y2);
        add(&mut s30, x3, y0);
        add(&mut s31, x3, y1);
        add(&mut s32, x3, y2);
    }
    [
        [s00, s01, s02],
        [s10, s11, s12],
        [s20, s21, s22],
        [s30, s31, s32],
    ]
}

/// Samples that are multiplied at once.
const LANES: usize = 4;

/// So many groups of samples.
#[inline(always)]
fn lanes(column: &[f64], count: usize) -> &[[f64; LANES]] {
    &column.as_chunks::<LANES>().0[..count]
}

/// Adds products.
#[inline(always)]
fn add(sums: &mut [f64; LANES], x: &[f64; LANES], y: &[f64; LANES]) {
    for lane in 0..LANES {
        sums[lane] = x[lane].mul_add(y[lane], sums[lane]);
    }
}
