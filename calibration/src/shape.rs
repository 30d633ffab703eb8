//! What repeats with the angle and is no ellipse.
//!
//! A distortion of the signals swings with the angle as the noise does, but as the residual itself, not as its square: it is taken out
//! of the residuals where it is there beyond doubt.

use nalgebra::{SMatrix, SVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use crate::noise::Residual;

/// Highest order of the radius that is looked for.
const ORDERS: usize = 8;
const COLUMNS: usize = 2 * ORDERS + 1;
/// Orders 0 to 2 hold five shapes that the ellipse itself has taken.
pub(crate) const OWN: usize = 5;
/// Probability below which a shape is not noise.
const SIGNIFICANT: f64 = 1e-3;
/// Samples per shape that are needed to look for shapes.
const SAMPLES: usize = 8 * COLUMNS;
/// What repeats with the angle and is no ellipse.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its rms, in fractions of the mean amplitude.
    pub rms: f64,
    /// The order of the radius that is largest, in cycles per scale period, 3 to 8.
    pub order: usize,
}

/// What orders 0 to [`ORDERS`] explain of the residuals.
struct Explained {
    /// Size of each shape.
    sizes: SVector<f64, COLUMNS>,
    /// Squares that they explain, and those that orders 0 to 2 explain alone.
    all: f64,
    own: f64,
    /// Squares that they leave.
    after: f64,
    free: f64,
}

impl Explained {
    fn of(residuals: &[Residual]) -> Option<Self> {
        let n = residuals.len();
        if n < SAMPLES {
            return None;
        }
        let mut gram = SMatrix::<f64, COLUMNS, COLUMNS>::zeros();
        let mut sum = SVector::<f64, COLUMNS>::zeros();
        let mut before = 0.0;
        for r in residuals {
            let row = row(r.alpha);
            gram.syger(1.0, &row, &row, 1.0);
            sum += row * r.white;
            before += r.white * r.white;
        }
        gram.fill_upper_triangle_with_lower_triangle();
        // Angles that leave an arc empty make the shapes depend on each other: then nothing is said.
        let eigen = gram.symmetric_eigenvalues();
        if eigen.min() < 1e-3 * eigen.max() {
            return None;
        }
        let low = sum.fixed_rows::<OWN>(0).into_owned();
        let own = gram
            .fixed_view::<OWN, OWN>(0, 0)
            .into_owned()
            .cholesky()?
            .solve(&low)
            .dot(&low);
        let sizes = gram.cholesky()?.solve(&sum);
        let all = sizes.dot(&sum);
        Some(Self {
            sizes,
            all,
            own,
            after: before - all,
            free: (n - COLUMNS) as f64,
        })
    }

    /// Whether noise explains `squares` by the orders above 2 less than once in a thousand times.
    fn significant(&self, squares: f64) -> bool {
        let shapes = (COLUMNS - OWN) as f64;
        let f = (squares / shapes) / (self.after / self.free);
        let p = FisherSnedecor::new(shapes, self.free).map_or(f64::NAN, |d| d.sf(f.max(0.0)));
        // Residuals of rounding alone are no shape.
        p < SIGNIFICANT && self.after > 0.0
    }
}

fn row(alpha: f64) -> SVector<f64, COLUMNS> {
    let mut row = SVector::<f64, COLUMNS>::zeros();
    row[0] = 1.0;
    for m in 1..=ORDERS {
        let (sin, cos) = (m as f64 * alpha).sin_cos();
        (row[2 * m - 1], row[2 * m]) = (cos, sin);
    }
    row
}

/// Of samples that stand at one place no more than a few times as many as pass elsewhere. There the angle is noise as
/// well, and where the ratio of the channels' noise is missed by its error, the residual follows it: thousands of
/// samples at one angle then look like a slope of the radius, and that like a shape.
fn thinned(residuals: &[Residual]) -> Vec<Residual> {
    /// Sectors of the period: two per cycle of the highest order and as many again.
    const SECTORS: usize = 4 * ORDERS;
    /// Samples of a sector, in those of the middle one.
    const MOST: usize = 4;
    let sector = |r: &Residual| {
        let turns = r.alpha / std::f64::consts::TAU;
        (((turns - turns.floor()) * SECTORS as f64) as usize).min(SECTORS - 1)
    };
    let mut counts = [0usize; SECTORS];
    for r in residuals {
        counts[sector(r)] += 1;
    }
    let mut filled: Vec<usize> = counts.into_iter().filter(|n| *n > 0).collect();
    filled.sort_unstable();
    let most = MOST * filled.get(filled.len() / 2).copied().unwrap_or(0);
    let mut seen = [0usize; SECTORS];
    let mut thinned = Vec::with_capacity(residuals.len());
    for r in residuals {
        let (of, at) = (counts[sector(r)], &mut seen[sector(r)]);
        // Evenly over the time that was spent there.
        if of <= most || (*at + 1) * most / of > *at * most / of {
            thinned.push(*r);
        }
        *at += 1;
    }
    thinned
}

/// What repeats with the angle: taken out of `residuals` where it is significant. Gives its rms in units of the cosine
/// channel's noise, and the order.
pub(crate) fn take_shape(residuals: &mut [Residual]) -> Option<(f64, usize)> {
    let n = residuals.len();
    let found = Explained::of(residuals)?;
    // The ellipse has taken the low orders of all samples.
    if !found.significant(found.all) {
        return None;
    }
    let thinned = thinned(residuals);
    if thinned.len() < n {
        let again = Explained::of(&thinned)?;
        if !again.significant(again.all - again.own) {
            return None;
        }
    }
    for r in residuals.iter_mut() {
        r.white -= row(r.alpha).dot(&found.sizes);
    }
    let size = |m: &usize| f64::hypot(found.sizes[2 * m - 1], found.sizes[2 * m]);
    let order = (3..=ORDERS).max_by(|a, b| size(a).total_cmp(&size(b)))?;
    // Noise explains a little too.
    let shapes = (COLUMNS - OWN) as f64;
    let own = (found.all - shapes * found.after / found.free).max(0.0);
    Some(((own / n as f64).sqrt(), order))
}
