//! The ellipse that two channels draw, fitted quickly and robustly.
//!
//! Good for choosing the numbers of a design. It is no calibration with error bars: noise and
//! distortion leave a small bias.

use serde::Serialize;

use crate::conic::Conic;

/// Equation (4): y_c = a_c cos α + b_c, y_s = a_s sin(α − β) + b_s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Ellipse {
    /// Amplitude of the cos channel in the unit of the column, above 0.
    pub a_c: f64,
    /// Offset of the cos channel in the unit of the column.
    pub b_c: f64,
    /// Amplitude of the sin channel in the unit of the column, above 0.
    pub a_s: f64,
    /// Offset of the sin channel in the unit of the column.
    pub b_s: f64,
    /// Phase error in radians, −π/2 … π/2.
    pub beta: f64,
}

/// How an ellipse was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FitMethod {
    /// Least-squares conic through the samples.
    Conic,
    /// Half the sum and half the difference of the extremes; β = 0.
    Extremes,
}

/// An ellipse with what is known about the fit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EllipseFit {
    /// The ellipse.
    pub ellipse: Ellipse,
    /// How it was found.
    pub method: FitMethod,
    /// Rms of the radial residual, outliers left out, in fractions of the amplitude.
    pub residual_rms: f64,
    /// Samples so far off that they were left out.
    pub outliers: usize,
    /// Why the extremes had to serve.
    pub notes: Vec<String>,
}

/// Smallest residual in fractions of the amplitude that makes a sample an outlier.
const OUTLIER_FLOOR: f64 = 1e-6;
/// Residual, in robust standard deviations, from which a sample is an outlier.
const OUTLIER: f64 = 4.0;
/// Largest residual of samples that lie on an ellipse.
const ROUND: f64 = 0.25;
/// Share of the samples at each end of a channel that are not of its bulk, and so many of its half ranges from which on a sample is a glitch.
const BULK: (f64, f64) = (0.02, 2.0);
/// The same where those that are left draw no clear ellipse.
const NARROW: (f64, f64) = (0.15, 1.3);
/// Radial standard deviation, in fractions of the amplitude, from which on they do not.
const ROUGH: f64 = 0.03;
/// Largest arc without samples, in turns.
const WIDEST_GAP: f64 = 0.5;

impl Ellipse {
    /// The corrected pair (cos α, sin α) of a raw pair.
    #[must_use]
    pub fn corrected(&self, y_c: f64, y_s: f64) -> (f64, f64) {
        let (sin_beta, cos_beta) = self.beta.sin_cos();
        let c = (y_c - self.b_c) / self.a_c;
        let s = ((y_s - self.b_s) / self.a_s + c * sin_beta) / cos_beta;
        (c, s)
    }

    /// The angle α of a raw pair in turns, −0.5 … 0.5.
    #[must_use]
    pub fn angle(&self, y_c: f64, y_s: f64) -> f64 {
        let (c, s) = self.corrected(y_c, y_s);
        s.atan2(c) / std::f64::consts::TAU
    }

    /// The radial residual ρ of a raw pair: its corrected radius less one.
    #[must_use]
    pub fn radial_residual(&self, y_c: f64, y_s: f64) -> f64 {
        let (c, s) = self.corrected(y_c, y_s);
        c.hypot(s) - 1.0
    }

    /// The mean amplitude of the two channels, in the unit of the columns.
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        (self.a_c + self.a_s) / 2.0
    }

    /// Fits an ellipse to samples. Where they do not show one (too short an arc, too much noise),
    /// the extremes serve, and the notes say so.
    #[must_use]
    pub fn fit(cos: &[f64], sin: &[f64]) -> EllipseFit {
        let extremes = Self::of_extremes(cos, sin);
        match robust(cos, sin, &extremes) {
            Ok(fit) => fit,
            Err(why) => {
                let residuals: Vec<f64> = residuals(&extremes, cos, sin);
                EllipseFit {
                    ellipse: extremes,
                    method: FitMethod::Extremes,
                    residual_rms: rms(residuals.iter().copied()),
                    outliers: 0,
                    notes: vec![format!(
                        "{why}: amplitudes and offsets are those of the extremes, and no phase error is known"
                    )],
                }
            }
        }
    }

    /// The least-squares conic (Taubin's) through all samples, on however short an arc and with its glitches; `None`
    /// where it is no ellipse.
    #[must_use]
    pub fn of_arc(cos: &[f64], sin: &[f64]) -> Option<Self> {
        conic(pairs(cos, sin), &Self::of_extremes(cos, sin))
    }

    /// Centre and half the range of each channel, one sample in a thousand left out at each end.
    fn of_extremes(cos: &[f64], sin: &[f64]) -> Self {
        let [(a_c, b_c), (a_s, b_s)] = [cos, sin].map(|values| {
            let (low, high) = ends(values, 0.001);
            let (low, high) = if high > low {
                (low, high)
            } else {
                ends(values, 0.0)
            };
            let half = high / 2.0 - low / 2.0;
            (if half > 0.0 { half } else { 1.0 }, low + half)
        });
        Self {
            a_c,
            b_c,
            a_s,
            b_s,
            beta: 0.0,
        }
    }

    pub(crate) fn is_finite(&self) -> bool {
        [self.a_c, self.b_c, self.a_s, self.b_s, self.beta]
            .iter()
            .all(|v| v.is_finite())
    }
}

/// Fits, leaves out what lies far off, and fits again.
fn robust(cos: &[f64], sin: &[f64], extremes: &Ellipse) -> Result<EllipseFit, &'static str> {
    let first = Kept::of(cos, sin, extremes, BULK);
    // One glitch in twenty, all to one side, is part of that bulk.
    let sigma = first.as_ref().map_or(ROUND, |kept| kept.sigma);
    let narrow = || Kept::of(cos, sin, extremes, NARROW);
    let better = (sigma > ROUGH).then(narrow).flatten();
    let kept = better.filter(|kept| kept.sigma < sigma / 2.0).or(first);
    let Kept {
        ellipse, rho, keep, ..
    } = kept.ok_or("the samples lie on no ellipse")?;
    let kept = keep.iter().filter(|k| **k).count();
    let residual_rms = rms(rho.iter().zip(&keep).filter(|(_, k)| **k).map(|(r, _)| *r));
    if kept * 2 < keep.len() || residual_rms.is_nan() || residual_rms > ROUND {
        return Err("the samples lie on no ellipse (noise, or another shape)");
    }
    let angles = pairs(cos, sin).zip(&keep).filter(|(_, keep)| **keep);
    if widest_gap(angles.map(|((c, s), _)| ellipse.angle(c, s)).collect()) > WIDEST_GAP {
        return Err("the samples cover less than half a scale period");
    }
    let (method, outliers) = (FitMethod::Conic, keep.len() - kept);
    let notes = Vec::new();
    Ok(EllipseFit {
        ellipse,
        method,
        residual_rms,
        outliers,
        notes,
    })
}

/// An ellipse through the samples that are near it.
struct Kept {
    ellipse: Ellipse,
    /// Radial residuals of all samples.
    rho: Vec<f64>,
    keep: Vec<bool>,
    /// Robust standard deviation of the residuals.
    sigma: f64,
}

impl Kept {
    /// Begins with those that are not far outside the bulk, without such a share of them at each end; `None` where there is no ellipse.
    fn of(cos: &[f64], sin: &[f64], extremes: &Ellipse, (share, room): (f64, f64)) -> Option<Self> {
        // Glitches far outside the bulk of the samples would bend the first fit.
        let (frame, bulk) = bulk(cos, sin, extremes, share);
        let keep = pairs(cos, sin).map(|(c, s)| {
            let (x, y) = frame.corrected(c, s);
            x.abs() <= room * bulk.0 && y.abs() <= room * bulk.1
        });
        let mut this = Self {
            ellipse: frame,
            rho: vec![],
            keep: keep.collect(),
            sigma: 0.0,
        };
        for _ in 0..4 {
            let kept = pairs(cos, sin).zip(&this.keep).filter(|(_, keep)| **keep);
            this.ellipse = conic(kept.map(|(y, _)| y), &frame)?;
            this.rho = residuals(&this.ellipse, cos, sin);
            this.sigma = 1.4826 * median(this.rho.iter().map(|r| r.abs()).collect());
            let limit = f64::max(OUTLIER * this.sigma, OUTLIER_FLOOR);
            this.keep = this.rho.iter().map(|r| r.abs() <= limit).collect();
        }
        Some(this)
    }
}

/// The least-squares conic through points, in a frame in which they are of order one.
fn conic(points: impl Iterator<Item = (f64, f64)>, frame: &Ellipse) -> Option<Ellipse> {
    let mut conic = Conic::default();
    for (c, s) in points {
        let (x, y) = frame.corrected(c, s);
        conic.add(x, y);
    }
    let unit = conic.ellipse()?;
    Some(Ellipse {
        a_c: unit.a_c * frame.a_c,
        b_c: unit.b_c * frame.a_c + frame.b_c,
        a_s: unit.a_s * frame.a_s,
        b_s: unit.b_s * frame.a_s + frame.b_s,
        beta: unit.beta,
    })
}

/// A frame in which the samples are of order one, and the half ranges of their bulk in it.
fn bulk(cos: &[f64], sin: &[f64], extremes: &Ellipse, share: f64) -> (Ellipse, (f64, f64)) {
    let [c, s] = [cos, sin].map(|values| ends(values, share));
    if c.1 > c.0 && s.1 > s.0 {
        let half = |(low, high): (f64, f64)| high / 2.0 - low / 2.0;
        let (b_c, b_s) = (c.0 + half(c), s.0 + half(s));
        let frame = Ellipse {
            a_c: half(c),
            b_c,
            a_s: half(s),
            b_s,
            beta: 0.0,
        };
        return (frame, (1.0, 1.0));
    }
    (*extremes, (f64::MAX, f64::MAX))
}

fn pairs<'a>(cos: &'a [f64], sin: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    cos.iter().copied().zip(sin.iter().copied())
}

pub(crate) fn residuals(ellipse: &Ellipse, cos: &[f64], sin: &[f64]) -> Vec<f64> {
    pairs(cos, sin)
        .map(|(c, s)| ellipse.radial_residual(c, s))
        .collect()
}

/// The values below and above which a share of all lies.
fn ends(values: &[f64], share: f64) -> (f64, f64) {
    let mut values = values.to_vec();
    let cut = (values.len() as f64 * share) as usize;
    let Some(last) = values.len().checked_sub(1 + cut) else {
        return (0.0, 0.0);
    };
    let low = *values.select_nth_unstable_by(cut, f64::total_cmp).1;
    let high = *values.select_nth_unstable_by(last, f64::total_cmp).1;
    (low, high)
}

fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Root of the mean square; 0 for nothing.
pub(crate) fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

/// The widest arc between neighbouring angles, all in turns.
fn widest_gap(mut angles: Vec<f64>) -> f64 {
    angles.sort_unstable_by(f64::total_cmp);
    let across = match (angles.first(), angles.last()) {
        (Some(first), Some(last)) => first + 1.0 - last,
        _ => 1.0,
    };
    angles
        .windows(2)
        .map(|w| w[1] - w[0])
        .fold(across, f64::max)
}
