//! What a sample shows the search: the residual that its gradient is made of, and where that points.
//!
//! The radius of the estimate shows it, in the final form and in the exact one; for sums of squares the square of the pair's own radius.
//! The start by least squares sees the pair in polar coordinates, and where samples are few the phase error takes the place of
//! the radius.

use super::counted::Way;
use super::measured::Measured;
use super::sparse::Sparse;
use super::start::{self, Polar};
use super::{Coefficients, State, Structure, detector, sum_of_squares};
use crate::signal::{Formula, Signal, Wide};

static DIRECTION: Formula = Formula {
    title: "Gradient along the radius",
    equation: "rho_c = cos(alpha_hat) rho,  rho_s = sin(alpha_hat) rho",
    source: "paper section 5.5.1: r + (sin, -cos) e = n (n^T r)",
};

static ALONG: Formula = Formula {
    title: "Gradient along the squared radius",
    equation: "rho_c = c epsilon,  rho_s = s epsilon",
    source: "paper sections 5.2 and 5.3",
};

/// What a sample shows.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S: Signal> {
    /// Normalised pair.
    pub y: (S, S),
    /// (cos α̂, sin α̂), for the sum of squares the corrected pair.
    pub frame: (S, S),
    /// Phase error, radians.
    pub e: S,
    /// Radial residual as it moves the parameters, for the sum of squares half that of the squared radius; or what stands in its place.
    pub rho: S,
    /// n ρ, or n⊥ e.
    pub along: (S, S),
    /// θ1 … θ5 as they were applied.
    pub theta: [S; 5],
    /// Where the design has a start by least squares: what that sees.
    pub start: Option<Polar<S>>,
    /// Where speeds are promised at which the radius does not show all: what this sample teaches instead.
    pub sparse: Option<Sparse<S>>,
}

/// Of one sample. `bends_shown`: where bends are calibrated, this speed shows them.
#[inline(always)]
pub fn seen<S: Signal, const PLAIN: bool>(
    measured: &Measured<S>,
    way: &Way<S>,
    bends_shown: Option<S::Bool>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Seen<S> {
    let which = (way.starting, bends_shown);
    let sparse = if PLAIN {
        None
    } else {
        Sparse::of(measured.e, &way.travel, which, state, k, structure)
    };
    let (frame, rho, along, start) = if !PLAIN && structure.calibration.squares() {
        let (rho, along) = squared(measured.pair, sparse, k, structure);
        (measured.pair, rho, along, None)
    } else {
        let (rho, along, start) = radial(measured, way, sparse, k, structure);
        (measured.estimate, rho, along, start)
    };
    Seen {
        y: measured.y,
        frame,
        e: measured.e,
        rho,
        along,
        theta: measured.theta,
        start,
        sparse,
    }
}

/// Sums of squares: half the error of the pair's squared radius, paper section 5.2, and that along the pair.
#[inline(always)]
fn squared<S: Signal>(
    pair: (S, S),
    sparse: Option<Sparse<S>>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (S, (S, S)) {
    let epsilon = sum_of_squares::half_square(pair.0, pair.1, k.half, structure);
    let limited = limited(epsilon, None, structure);
    let (residual, direction) = residual_and_direction(sparse, limited, pair, k);
    (residual, along(residual, direction, structure))
}

/// The radius against the estimate: the residual, that along the estimate, and what the start by least squares sees.
#[inline(always)]
fn radial<S: Signal>(
    measured: &Measured<S>,
    way: &Way<S>,
    sparse: Option<Sparse<S>>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (S, (S, S), Option<Polar<S>>) {
    let (e, rho, estimate) = (measured.e, measured.rho, measured.estimate);
    let lags = structure.calibration.allows_for_lag().then_some(e);
    let limited = limited(rho, lags, structure);
    let start = way
        .starting
        .map(|running| start::polar((rho, limited, e), estimate, running, &way.travel, structure));
    let (rho, direction) = match &start {
        Some(polar) => (polar.residual, polar.direction),
        None => (limited, estimate),
    };
    let (rho, direction) = residual_and_direction(sparse, rho, direction, k);
    let along = along(rho, direction, structure);
    let residual = match (sparse, way.starting) {
        (None, _) => limited,
        (Some(_), None) => rho,
        // The start's own is weighed.
        (Some(_), Some(running)) => S::select(running, limited, rho).named("residual_not_weighed"),
    };
    (residual, along, start)
}

/// Residual and direction of n ρ; where samples are few, what takes their place.
#[inline(always)]
fn residual_and_direction<S: Signal>(
    sparse: Option<Sparse<S>>,
    residual: S,
    direction: (S, S),
    k: &Coefficients<S>,
) -> (S, (S, S)) {
    sparse.map_or((residual, direction), |of| of.along(residual, direction, k))
}

/// ρ as it moves the parameters; where the design allows for what the loop lags, the radius less 1. More than a quarter of the radius is
/// no measurement: the word holds it there, and every step after it is short.
#[inline(always)]
fn limited<S: Signal>(rho: S, e: Option<S>, structure: &Structure) -> S {
    let residual = e.map_or_else(|| rho.widen(), |e| detector::radius(rho, e));
    rho.begin(if structure.calibration.squares() {
        &ALONG
    } else {
        &DIRECTION
    });
    residual
        .quantise(&structure.formats.residual)
        .named("rho_limited")
}

/// n ρ, or for the sum of squares (c, s) ε.
#[inline(always)]
fn along<S: Signal>(rho: S, (cos, sin): (S, S), structure: &Structure) -> (S, S) {
    let to = &structure.formats.along;
    ((cos * rho).quantise(to), (sin * rho).quantise(to))
}

impl<S: Signal> Seen<S> {
    /// Gains and phase are taught along the circle.
    pub(super) fn ellipse_by_e(&self) -> Option<S::Bool> {
        self.sparse?.ellipse
    }

    /// n ρ as it moves the offsets: what is seen along the circle does not.
    pub(super) fn by_offset(&self, k: &Coefficients<S>) -> (S, S) {
        let (rho_c, rho_s) = self.along;
        self.ellipse_by_e().map_or((rho_c, rho_s), |by_e| {
            (
                S::select(by_e, k.zero, rho_c).named("offset_residual_c"),
                S::select(by_e, k.zero, rho_s).named("offset_residual_s"),
            )
        })
    }
}
