//! The Cramér–Rao bound of the parameter sets of sections 5.2 to 5.4, whatever their number of parameters.
//!
//! A small error δΘ and a small change δα of the angle move the corrected pair by M δΘ and by t δα, t = (−sin α, cos α),
//! and the noise of the signals by C = J Σ Jᵀ, J the slope of the correction. Where nothing is known of the motion, each
//! sample has an angle of its own to be found, and what it tells of Θ lies along the normal n = (cos α, sin α):
//! F = Σ Mᵀn nᵀM / (nᵀCn). The sets with a cubic have a direction v, [`BLIND`], in which nᵀMv is 0 everywhere where β is 0 and the
//! channels are straight, and small else: v is held, as the searches hold it, and no error is stated for it. Where the motion is known to be uniform, its phase and speed alone are to be found, and the
//! angle tells of v too: F = Σ [M t tk]ᵀ C⁻¹ [M t tk], without those two.
//!
//! [`BLIND`]: crate::set::BLIND

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix2, Matrix2xX, Vector2};
use nonius_recording::Ellipse;

use crate::gradient::{FAINT, Minimum, invert, physical_covariance};
use crate::set::Set;

/// What is known of the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Nothing: the angle of every sample is to be found.
    Unknown,
    /// Its speed does not change: the samples' order is that of their angles.
    Uniform,
}

/// Bounds for given angles and noise.
#[derive(Clone, Debug, PartialEq)]
pub struct SetBound {
    /// Covariance of Θ for the signals in their own unit.
    pub theta: DMatrix<f64>,
    /// Covariance of the nearest a_c, b_c, a_s, b_s, β; zero for a β that is held.
    pub physical: Option<DMatrix<f64>>,
    /// Error of the corrected angle from the uncertain Θ alone, its mean over the period taken out, rms, radians.
    pub angle_by_parameters: f64,
    /// Error of the angle of one sample from its own noise, rms over the period, radians.
    pub angle_by_noise: f64,
}

/// The bound at a minimum that was found, for its own samples; noise rms of cosine and sine in the unit of the signals.
/// `None` where the samples do not determine it.
#[must_use]
pub fn of_minimum(
    set: Set,
    minimum: &Minimum,
    (cos, sin): (&[f64], &[f64]),
    noise: [f64; 2],
) -> Option<SetBound> {
    if minimum.faint > 0 || !minimum.converged {
        return None;
    }
    let angle = |(c, s): (&f64, &f64)| {
        let (c, s) = set.correct(&minimum.theta, *c, *s);
        s.atan2(c)
    };
    let at = At {
        set,
        theta: &minimum.normal,
        frame: &minimum.frame,
        noise,
    };
    at.bound(cos.iter().zip(sin).map(angle), Motion::Unknown)
}

/// The bound for samples at the angles `alpha` (radians) of a sensor without bends. The sets without phase take β as 0.
#[must_use]
pub fn of_ellipse(
    set: Set,
    ellipse: &Ellipse,
    alpha: impl Iterator<Item = f64>,
    noise: [f64; 2],
    motion: Motion,
) -> Option<SetBound> {
    let frame = set.frame(ellipse);
    let at = At {
        set,
        theta: &set.start(&frame),
        frame: &frame,
        noise,
    };
    at.bound(alpha, motion)
}

/// Where the bound is taken: Θ of signals normalised by `frame`.
struct At<'a> {
    set: Set,
    theta: &'a DVector<f64>,
    frame: &'a Ellipse,
    /// Of the signals in their own unit.
    noise: [f64; 2],
}

/// What a place on the circle tells.
struct Place {
    /// M.
    m: Matrix2xX<f64>,
    /// C, of the corrected pair.
    noise: Matrix2<f64>,
    normal: Vector2<f64>,
    tangent: Vector2<f64>,
}

impl At<'_> {
    fn bound(&self, alpha: impl Iterator<Item = f64>, motion: Motion) -> Option<SetBound> {
        if !self.noise.iter().all(|n| *n > 0.0) {
            return None;
        }
        let inner = match motion {
            Motion::Unknown => self.of_radius(alpha)?,
            Motion::Uniform => self.of_pair(alpha)?,
        };
        let [angle_by_parameters, angle_by_noise] = self.of_angle(&inner)?;
        let to_raw = self.set.to_raw(self.frame);
        Some(SetBound {
            physical: physical_covariance(self.set, self.theta, self.frame, &inner),
            theta: &to_raw * inner * to_raw.transpose(),
            angle_by_parameters,
            angle_by_noise,
        })
    }

    /// The pair that Θ corrects to (cos α, sin α), and what it tells.
    fn place(&self, alpha: f64) -> Option<Place> {
        let (sin, cos) = alpha.sin_cos();
        let t = self.theta.as_slice();
        let tan = self.set.cross(t);
        // s = W + tan β · c, with c of the signal itself for five parameters and of the corrected cosine for nine.
        let (u_c, u_s) = match self.set {
            Set::Four | Set::Five => {
                let u_c = (cos - t[1]) / t[0];
                (u_c, (sin - t[3] - tan * u_c) / t[2])
            }
            Set::Eight | Set::Nine => (
                invert(&t[..4], cos, cos)?,
                invert(&t[4..8], sin - tan * cos, (sin - tan * cos) / t[4])?,
            ),
        };
        let slope = self.set.slope_by_signals(t, u_c, u_s);
        let white = Vector2::new(
            (self.noise[0] / self.frame.a_c).powi(2),
            (self.noise[1] / self.frame.a_s).powi(2),
        );
        Some(Place {
            m: self
                .set
                .jacobian(t, u_c, u_s)
                .columns(0, self.set.parameters())
                .into_owned(),
            noise: slope * Matrix2::from_diagonal(&white) * slope.transpose(),
            normal: Vector2::new(cos, sin),
            tangent: Vector2::new(-sin, cos),
        })
    }

    /// Covariance of Θ of normalised signals where every angle is to be found.
    fn of_radius(&self, alpha: impl Iterator<Item = f64>) -> Option<DMatrix<f64>> {
        let n = self.set.parameters();
        let mut information = DMatrix::zeros(n, n);
        for alpha in alpha {
            let place = self.place(alpha)?;
            let by = place.m.transpose() * place.normal;
            let variance = (place.normal.transpose() * place.noise * place.normal).x;
            information.syger(1.0 / variance, &by, &by, 1.0);
        }
        information.fill_upper_triangle_with_lower_triangle();
        let directions = self.set.directions();
        let seen = directions.transpose() * information * &directions;
        Some(&directions * inverse(seen)? * directions.transpose())
    }

    /// The same where phase and speed alone are.
    fn of_pair(&self, alpha: impl Iterator<Item = f64>) -> Option<DMatrix<f64>> {
        let n = self.set.parameters();
        let mut information = DMatrix::zeros(n + 2, n + 2);
        let alpha: Vec<f64> = alpha.collect();
        let middle = alpha.len() as f64 / 2.0;
        for (k, alpha) in alpha.iter().enumerate() {
            let place = self.place(*alpha)?;
            let mut by = place.m.clone().insert_columns(n, 2, 0.0);
            by.column_mut(n).copy_from(&place.tangent);
            // Within −1 … 1, for the numbers' sake.
            let late = (k as f64 - middle) / middle;
            by.column_mut(n + 1).copy_from(&(place.tangent * late));
            information += by.transpose() * place.noise.try_inverse()? * &by;
        }
        let covariance = inverse(information)?;
        Some(covariance.view((0, 0), (n, n)).into_owned())
    }

    /// Error of the corrected angle by Θ, less its mean over the period, and by noise.
    fn of_angle(&self, theta: &DMatrix<f64>) -> Option<[f64; 2]> {
        const POINTS: u32 = 360;
        let places = (0..POINTS).map(|k| self.place(TAU * f64::from(k) / f64::from(POINTS)));
        let places = places.collect::<Option<Vec<Place>>>()?;
        let by = |p: &Place| p.m.transpose() * p.tangent;
        let each = 1.0 / f64::from(POINTS);
        let mean = places
            .iter()
            .fold(DVector::zeros(self.set.parameters()), |sum, p| {
                sum + by(p) * each
            });
        let squares = places.iter().map(|p| {
            let by = by(p) - &mean;
            let of_noise = p.tangent.transpose() * p.noise * p.tangent;
            [(by.transpose() * theta * by).x, of_noise.x]
        });
        let sums = squares.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        Some(sums.map(|sum: f64| (sum * each).sqrt()))
    }
}

/// `None` where a direction is faint.
fn inverse(information: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let eigen = information.symmetric_eigen();
    let [least, most] = [eigen.eigenvalues.min(), eigen.eigenvalues.max()];
    // Nor of what is no number.
    if least.is_nan() || least <= FAINT * most {
        return None;
    }
    let inverse = DMatrix::from_diagonal(&eigen.eigenvalues.map(f64::recip));
    Some(&eigen.eigenvectors * inverse * eigen.eigenvectors.transpose())
}
