//! What a recording looks like after the five parameters: corrected pair, angle, speed, residuals.

use std::f64::consts::TAU;

use nalgebra::{Matrix5, Vector5};
use nonius_calibration::Ellipse;
use nonius_recording::{AdcPair, Recording};

use crate::checks::first;
use crate::clipped::Clipped;
use crate::model::known::Known;
use crate::motion::in_step;
use crate::motion::knots::{self, Told};
use crate::motion::spline::Spline;
use crate::numerics::continuous::{continuous, nearest};
use crate::numerics::slopes::{around, fine_gradient, gradient};
use crate::numerics::solve::dot;
use crate::numerics::spread::standardised;
use crate::shapes::trig::Trig;

/// Fewest samples by which causes are looked for: of fewer, motion, five parameters and noise leave too little to tell one by.
pub(crate) const FEWEST: usize = 150;

/// Least gain that is taken off as one: of less, hardly anything of the signals is left.
const LEAST_GAIN: f64 = 0.1;

/// The recording, corrected, with everything that shapes are made of. One value per sample.
#[derive(Clone, Debug)]
pub struct Context {
    /// Time in seconds from the first sample.
    pub time: Vec<f64>,
    /// Samples per second.
    pub rate: f64,
    /// The ellipse of the raw signals.
    pub ellipse: Ellipse,
    /// Raw signals.
    pub raw: [Vec<f64>; 2],
    /// Corrected pair, of radius about one.
    pub c: Vec<f64>,
    /// See `c`.
    pub s: Vec<f64>,
    /// cos and sin of the smooth angle. Shapes are made of these: made of the measured angle they would hold its noise,
    /// and find it in the data.
    pub cos: Vec<f64>,
    /// See `cos`.
    pub sin: Vec<f64>,
    /// Smooth angle in radians, continuous.
    pub alpha: Vec<f64>,
    /// Angle of the pair in radians, continuous.
    pub measured: Vec<f64>,
    /// Smooth speed in radians per second, signed.
    pub speed: Vec<f64>,
    /// Its change, radians per second squared.
    pub acceleration: Vec<f64>,
    /// Real motion that is faster than the spline and known, radians.
    pub fast: Vec<f64>,
    /// What else of it only a reference shows, radians; empty where there is none.
    shaking: Vec<f64>,
    /// Angle of the revolution in radians, where periods per revolution are known.
    pub phi: Option<Vec<f64>>,
    /// Temperature, centred and of unit spread.
    pub temperature: Option<Vec<f64>>,
    /// Angle less reference in radians, constant and sense removed.
    pub against_reference: Option<Vec<f64>>,
    /// 1 where a sample counts, 0 where it is left out.
    pub weight: Vec<f64>,
    /// Samples that are left out where a channel is clipped.
    pub(crate) clipped: Vec<Clipped>,
    /// ADC codes.
    pub codes: [Vec<i64>; 2],
    /// Bits of the ADC.
    pub bits: u32,
    /// Codes and what they stand for.
    pub adc: AdcPair,
    /// Scale periods per revolution.
    pub periods_per_revolution: Option<u32>,
    /// The motion that is taken off the angle; none with a reference.
    pub spline: Option<Spline>,
    /// The motion that the angle is followed by, where that is finer.
    pub(crate) finer: Option<Spline>,
    /// Corners of the motion hardly count, and the motion's knots are those that do beside them.
    pub(crate) calm: bool,
    /// What is known to be added to each channel, in its amplitudes, at each angle.
    pub(crate) periodic: [Trig; 2],
    periods_travelled: f64,
    top_speed: f64,
}

/// Why there is nothing to diagnose.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContextError {
    /// No ellipse can be fitted.
    #[error(transparent)]
    NoEllipse(#[from] nonius_calibration::Error),
}

/// Continuous angles in radians.
pub(crate) fn unwrapped(mut angle: Vec<f64>) -> Vec<f64> {
    for k in 1..angle.len() {
        angle[k] = nearest(angle[k], angle[k - 1]);
    }
    angle
}

/// An angle less its reference, radians: that may count the other way, and whole periods apart are the same angle.
pub(crate) fn against(angle: &[f64], reference: &[f64]) -> Vec<f64> {
    let from = |values: &[f64]| values.first().copied().unwrap_or_default();
    let (a0, r0) = (from(angle), from(reference));
    let pairs = || angle.iter().zip(reference);
    let alike: f64 = pairs().map(|(a, r)| (a - a0) * (r - r0)).sum();
    let sense = if alike < 0.0 { -1.0 } else { 1.0 };
    let first = a0 - sense * r0;
    let apart = pairs().map(|(a, r)| a - sense * r);
    apart.map(|d| nearest(d, first)).collect()
}

impl Context {
    /// Looks at a recording; `weight` is 0 for samples that are known to be bad, those too of which one channel is `clipped`.
    ///
    /// # Errors
    /// Where no ellipse can be fitted.
    pub(crate) fn new(
        recording: &Recording,
        weight: Vec<f64>,
        clipped: Vec<Clipped>,
    ) -> Result<Self, ContextError> {
        let ellipse = first::ellipse(recording, &weight)?;
        let first = recording.time_s.first().copied().unwrap_or_default();
        let codes: (Vec<i64>, Vec<i64>) = recording.codes().unzip();
        let temperature = recording
            .temperature_c
            .as_ref()
            .and_then(|t| standardised(t));
        let mut this = Self {
            time: recording.time_s.iter().map(|t| t - first).collect(),
            rate: recording.metadata.sample_rate_hz,
            ellipse,
            raw: [recording.cos.clone(), recording.sin.clone()],
            c: vec![],
            s: vec![],
            cos: vec![],
            sin: vec![],
            alpha: vec![],
            measured: vec![],
            speed: vec![],
            acceleration: vec![],
            fast: vec![0.0; recording.samples()],
            shaking: vec![],
            phi: None,
            temperature,
            against_reference: None,
            weight,
            clipped,
            codes: [codes.0, codes.1],
            bits: recording.metadata.adc.cos.bits,
            adc: recording.metadata.adc,
            periods_per_revolution: recording.metadata.periods_per_revolution,
            spline: None,
            finer: None,
            calm: false,
            periodic: [(); 2].map(|()| Trig::constant(0.0)),
            periods_travelled: 0.0,
            top_speed: f64::MIN_POSITIVE,
        };
        let pairs = recording.cos.iter().zip(&recording.sin);
        let pairs = pairs.map(|(c, s)| this.ellipse.corrected(*c, *s));
        let (mut c, mut s): (Vec<f64>, Vec<f64>) = pairs.unzip();
        this.complete(&mut c, &mut s, &[]);
        this.set_pair(c, s, recording.reference_rad.as_deref());
        Ok(this)
    }

    /// Number of samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.time.len()
    }

    /// Whether causes are looked for by too few samples to tell any.
    pub(crate) fn is_too_short(&self) -> bool {
        self.samples() < FEWEST
    }

    /// A code of the coarser channel, in amplitudes.
    pub(crate) fn code(&self) -> f64 {
        let (adc, e) = (self.adc, self.ellipse);
        (adc.cos.lsb / e.a_c.abs()).max(adc.sin.lsb / e.a_s.abs())
    }

    /// Scale periods travelled by the smooth motion, to and fro.
    #[must_use]
    pub fn periods_travelled(&self) -> f64 {
        self.periods_travelled
    }

    /// Largest size of the smooth speed, radians per second; above zero even at rest, so that speeds can be divided by it.
    #[must_use]
    pub fn top_speed(&self) -> f64 {
        self.top_speed
    }

    /// What is along the radius and along the circle, in the frame of the channels.
    pub(crate) fn in_frame(&self, radial: &[f64], tangential: &[f64]) -> [Vec<f64>; 2] {
        let frame = |k: usize| {
            let (r, t) = (radial[k], tangential[k]);
            let (c, s) = (self.cos[k], self.sin[k]);
            (r * c - t * s, r * s + t * c)
        };
        let (in_c, in_s) = (0..radial.len()).map(frame).unzip();
        [in_c, in_s]
    }

    /// The spline that the angle is followed by.
    pub(crate) fn followed(&self) -> Option<&Spline> {
        self.finer.as_ref().or(self.spline.as_ref())
    }

    /// Takes another corrected pair, and follows its angle.
    pub fn set_pair(&mut self, c: Vec<f64>, s: Vec<f64>, reference: Option<&[f64]>) {
        let n = c.len();
        let tells = self.tells();
        let angle = c.iter().zip(&s).map(|(c, s)| s.atan2(*c)).collect();
        self.measured = continuous(angle, &tells);
        (self.c, self.s) = (c, s);
        if self.spline.is_none() {
            let per = self.periods_per_revolution;
            let (angle, weight) = (&self.measured, &tells);
            let spacing = match reference {
                Some(_) => knots::spacing(angle, weight, per, Told::ByReference),
                None => in_step::spacing(angle, &self.radial(), weight, per),
            };
            let make = |spacing: f64| Spline::new(n, spacing, &self.weight);
            self.spline = Some(make(spacing.motion));
            let finer = spacing.followed < spacing.motion;
            self.finer = finer.then(|| make(spacing.followed));
        }
        self.against_reference = reference.map(|r| {
            let apart = against(&self.measured, r);
            let total: f64 = self.weight.iter().sum();
            let mean = dot(&apart, &self.weight) / total.max(1.0);
            apart.iter().map(|d| d - mean).collect()
        });
        self.shaking = self.shown_by_reference();
        if let Some(spline) = self.finer.as_ref().or(self.spline.as_ref()) {
            let (spline, fit) = self.fitted(spline, &self.slow());
            let rate = self.rate;
            let fast: Vec<f64> = self.fast_motion().collect();
            let smooth = spline.values(&fit).into_iter().zip(&fast);
            self.alpha = smooth.map(|(a, f)| a + f).collect();
            (self.sin, self.cos) = self.alpha.iter().map(|a| a.sin_cos()).unzip();
            let change = spline.derivative(&fit);
            let bends = gradient(&self.change_of_moves(&spline, &change));
            let bends = bends.into_iter().zip(around(&fast));
            self.acceleration = bends.map(|(a, f)| (a + f) * rate * rate).collect();
            let change = change.into_iter().zip(fine_gradient(&fast));
            self.speed = change.map(|(v, f)| (v + f) * rate).collect();
            let sizes = self.speed.iter().map(|v| v.abs());
            self.periods_travelled = sizes.clone().sum::<f64>() / rate / TAU;
            self.top_speed = sizes.fold(f64::MIN_POSITIVE, f64::max);
        }
        let per = self.periods_per_revolution.map(f64::from);
        self.phi = per.map(|n| self.alpha.iter().map(|a| a / n).collect());
    }

    /// Radial residual.
    #[must_use]
    pub fn radial(&self) -> Vec<f64> {
        let n = self.samples();
        (0..n)
            .map(|k| ((self.c[k].powi(2) + self.s[k].powi(2)).sqrt() - 1.0) * self.weight[k])
            .collect()
    }

    /// The same where the channels see these errors of the angle, radians: not followed anew.
    pub(crate) fn turned_by(&self, errors: &[f64]) -> Self {
        let mut turned = self.clone();
        let angles = turned.alpha.iter_mut().zip(errors);
        angles.for_each(|(alpha, error)| *alpha += error);
        (turned.sin, turned.cos) = turned.alpha.iter().map(|a| a.sin_cos()).unzip();
        turned
    }

    /// Change of the angle, radians rms.
    pub(crate) fn moved_since(&self, before: &[f64]) -> f64 {
        let pairs = self.measured.iter().zip(before).zip(&self.weight);
        let square: f64 = pairs.map(|((a, b), w)| w * (a - b).powi(2)).sum();
        (square / self.weight.iter().sum::<f64>()).sqrt()
    }

    /// Sum of the squares of the radial residual that no other ellipse takes away.
    pub(crate) fn power_off_the_ellipse(&self) -> f64 {
        let radial = self.radial();
        let (mut gram, mut right) = (Matrix5::<f64>::zeros(), Vector5::<f64>::zeros());
        for (k, left) in radial.iter().enumerate() {
            let (c, s) = (self.cos[k], self.sin[k]);
            let row = Vector5::new(1.0, c, s, c * c - s * s, 2.0 * c * s);
            gram += row * row.transpose() * self.weight[k];
            right += row * *left;
        }
        let whole = radial.iter().map(|r| r * r).sum::<f64>();
        let taken = gram.cholesky().map_or(0.0, |g| right.dot(&g.solve(&right)));
        whole - taken
    }

    /// Tangential residual in radians: against the reference where there is one, else above the motion.
    #[must_use]
    pub fn tangential(&self) -> Vec<f64> {
        match (&self.against_reference, &self.spline) {
            (Some(d), _) => d.iter().zip(&self.weight).map(|(d, w)| d * w).collect(),
            (None, Some(spline)) => spline.residual(&self.slow(), &self.weight),
            (None, None) => vec![0.0; self.samples()],
        }
    }

    /// The angle of the pair without known fast motion, radians.
    pub(crate) fn slow(&self) -> Vec<f64> {
        let pairs = self.measured.iter().zip(self.fast_motion());
        pairs.map(|(m, f)| m - f).collect()
    }

    /// Real motion that is faster than the spline, as far as it is known, radians.
    fn fast_motion(&self) -> impl Iterator<Item = f64> {
        let shaking = self.shaking.iter().copied().chain(std::iter::repeat(0.0));
        self.fast.iter().zip(shaking).map(|(f, s)| f + s)
    }

    /// Takes what is known off the raw signals, corrected by another ellipse.
    pub(crate) fn without(&mut self, ellipse: Ellipse, known: Known, reference: Option<&[f64]>) {
        self.ellipse = ellipse;
        let n = self.samples();
        let (mut c, mut s) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for k in 0..n {
            let (x, y) = ellipse.corrected(self.raw[0][k], self.raw[1][k]);
            // An error of the angle turns the pair, and the channels see the angle with it; a gain is one of all that is in them but
            // for what the electronics add.
            let (turn_s, turn_c) = known.angle[k].sin_cos();
            let (x, y) = (x * turn_c + y * turn_s, y * turn_c - x * turn_s);
            let (cos, sin) = (self.cos[k], self.sin[k]);
            let [r, t] = [0, 1].map(|row: usize| known.behind[row][k]);
            let (x, y) = (x - r * cos + t * sin, y - r * sin - t * cos);
            let gain = (1.0 + known.gain[k]).max(LEAST_GAIN);
            let (x, y) = (x / gain, y / gain);
            let (r, t) = (known.radial[k], known.tangential[k]);
            c.push(x - r * cos + t * sin);
            s.push(y - r * sin - t * cos);
        }
        self.fast = known.fast;
        self.complete(&mut c, &mut s, &known.angle);
        self.set_pair(c, s, reference);
    }
}
