//! The columns of a block of samples side by side, and their products.

use std::ops::Range;

use nalgebra::{DMatrix, DMatrixView, Dyn};

use crate::solve::dot;
use crate::whiten::ORDER;

/// Samples of a block: its functions fit the cache.
pub(crate) const CHUNK: usize = 1024;
/// Between the columns of a block: the past of each stands before it.
pub(crate) const STRIDE: usize = CHUNK + ORDER;
/// Columns that are multiplied together.
const PANEL: usize = 48;
/// Fewest columns, and samples, that are worth a matrix product.
const WORTH: usize = 6;

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

    /// Adds the products of columns `a` with columns `b` to a matrix of all by all.
    fn products(&self, white: bool, a: Range<usize>, b: Range<usize>, sums: &mut DMatrix<f64>) {
        // Fewer samples than that nalgebra would take through its vector product, which reads strided rows as columns.
        if a.len().min(b.len()).min(self.samples) < WORTH {
            for i in a {
                let left = self.column(white, i);
                for j in b.clone() {
                    sums[(i, j)] += dot(left, self.column(white, j));
                }
            }
            return;
        }
        let values = self.values(white);
        let n = Dyn(self.samples);
        let (left, right) = (
            &values[a.start * STRIDE + ORDER..],
            &values[b.start * STRIDE + ORDER..],
        );
        // Lying down: the transpose, without moving a number.
        let left: DMatrixView<f64, Dyn, Dyn> = DMatrixView::from_slice_with_strides_generic(
            left,
            Dyn(a.len()),
            n,
            Dyn(STRIDE),
            Dyn(1),
        );
        let right: DMatrixView<f64, Dyn, Dyn> = DMatrixView::from_slice_with_strides_generic(
            right,
            n,
            Dyn(b.len()),
            Dyn(1),
            Dyn(STRIDE),
        );
        sums.view_mut((a.start, b.start), (a.len(), b.len()))
            .gemm(1.0, &left, &right, 1.0);
    }

    /// Adds all products of columns from `fresh` on with all columns; only those above the diagonal of panels count.
    pub(crate) fn add_products(&self, white: bool, fresh: usize, sums: &mut DMatrix<f64>) {
        for b in (fresh..self.columns).step_by(PANEL) {
            let b = b..(b + PANEL).min(self.columns);
            for a in (0..b.end).step_by(PANEL) {
                self.products(white, a..(a + PANEL).min(b.end), b.clone(), sums);
            }
        }
    }
}
