//! The signals as somebody sees them who turns with the scale: near a sample they hardly move, however few samples a period has.

use nonius_calibration::Ellipse;
use nonius_fourier::Complex;

/// Where the steps that tell how fast the scale turns near a sample begin; none of them begins or ends at that sample.
const STEPS: [isize; 4] = [-3, -2, 1, 2];
/// Radians within a sample from which on a curve through neighbours does not follow the channels as they are: 25 samples a period.
const FAST: f64 = 0.25;

/// The pair corrected by an ellipse, and how far it turns from each sample to the next.
pub(crate) struct Turning {
    ellipse: Ellipse,
    pair: Vec<Complex<f64>>,
    steps: Vec<f64>,
}

impl Turning {
    pub(crate) fn new(channels: &[Vec<f64>; 2], ellipse: &Ellipse) -> Self {
        let pairs = channels[0].iter().zip(&channels[1]);
        let pair: Vec<Complex<f64>> = pairs
            .map(|(c, s)| {
                let (c, s) = ellipse.corrected(*c, *s);
                Complex::new(c, s)
            })
            .collect();
        let steps = pair.windows(2).map(|w| (w[1] * w[0].conj()).arg());
        Self {
            ellipse: *ellipse,
            steps: steps.collect(),
            pair,
        }
    }

    /// How far the scale turns within a sample near the sample `k`, radians: the middle of the steps near it, of which one that is
    /// wrong changes little.
    fn rate(&self, k: usize) -> f64 {
        let near = STEPS.map(|from| k.checked_add_signed(from).and_then(|j| self.steps.get(j)));
        let mut steps = near.map(|step| step.copied().unwrap_or(0.0));
        steps.sort_unstable_by(f64::total_cmp);
        (steps[1] + steps[2]) / 2.0
    }

    /// Whether the scale turns fast near a sample.
    pub(crate) fn is_fast(&self, k: usize) -> bool {
        self.rate(k).abs() > FAST
    }

    /// In the unit of the channels, offsets taken off.
    fn channels(&self, z: Complex<f64>) -> [f64; 2] {
        let e = &self.ellipse;
        let (sin, cos) = e.beta.sin_cos();
        [e.a_c * z.re, e.a_s * (z.im * cos - z.re * sin)]
    }

    /// Both channels at the sample `k` and `side` samples on either side of it, as they would be if the scale stood there all the time.
    /// There have to be so many.
    pub(crate) fn around(&self, k: usize, side: usize) -> [Vec<f64>; 2] {
        let rate = self.rate(k);
        let near = self.pair[k - side..=k + side].iter().zip(0..);
        let still = near.map(|(z, i): (_, i32)| {
            let away = f64::from(i) - side as f64;
            self.channels(z * Complex::from_polar(1.0, -rate * away))
        });
        still
            .map(|[c, s]| (c, s))
            .unzip::<_, _, Vec<f64>, Vec<f64>>()
            .into()
    }

    /// What both channels have too much at the sample `j`, as it would be at the sample `k`.
    pub(crate) fn seen_from(&self, k: usize, j: usize, there: [f64; 2]) -> [f64; 2] {
        let e = &self.ellipse;
        let (sin, cos) = e.beta.sin_cos();
        let [c, s] = [there[0] / e.a_c, there[1] / e.a_s];
        let z = Complex::new(c, (s + c * sin) / cos);
        self.channels(z * Complex::from_polar(1.0, self.rate(k) * (k as f64 - j as f64)))
    }
}
