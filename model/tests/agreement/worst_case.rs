//! What the word lengths of a chip can do at worst.

use std::f64::consts::TAU;

use nonius_model::design::Design;
use nonius_model::reference::from_spec;
use nonius_model::reference::loops::Loop;

/// What the arithmetic of the chip can add to one sample at most, worked out from the word lengths alone.
pub(crate) struct WorstCase {
    /// To e, radians.
    pub(crate) e: f64,
    /// To ρ.
    pub(crate) rho: f64,
    /// To α̂, turns: the loop's largest amplification of what goes into e, with what coefficients and increments add.
    pub(crate) alpha_hat: f64,
    /// To Θ.
    pub(crate) theta: f64,
}

/// Radius of the corrected pair before it is calibrated, with the tests' encoder.
const RADIUS: f64 = 1.3;
/// Largest |e| with that encoder and these motions, radians.
const ERROR: f64 = 0.4;

impl WorstCase {
    /// `rounding`: the bit-true chip; otherwise the unrounded one, which has the same table and coefficients.
    pub(crate) fn of(design: &Design, rounding: bool) -> Self {
        let (words, f) = (&design.words, &design.structure.formats);
        let half_bit = |fraction: u32| {
            if rounding {
                0.5f64.powi(fraction as i32 + 1)
            } else {
                0.0
            }
        };
        let half_lsb = half_bit(words.signal_fraction);
        // The table is linear in segments expanded about their centre; the value is lowered by half the error at the
        // ends (x²/2), which leaves x²/4.
        let x = TAU * 0.5f64.powi(words.sine_rows_log2 as i32 + 3);
        let table = x * x / 4.0;
        // Rounded twice: a table entry with two more bits, and the result; the slope adds 1/32.
        let sine =
            table + TAU * half_bit(words.sine_phase_bits) + half_lsb * (1.0 + 0.25 + 1.0 / 16.0);
        let y = 1.1;
        let [first, _, fifth] = f.theta.map(|q| half_bit(q.format.fraction) * y);
        let corrected = half_lsb + (first * first + (first + fifth).powi(2)).sqrt();
        // A sum of cos² and sin² shares: no more than √2 of either.
        // What the series that takes channel skew off leaves, and its roundings: of the late sine, of the gain, of κ.
        let skew = design.skew.map_or(0.0, |skew| {
            skew.sine_error_max + 2.0 * half_lsb + half_bit(f.skew.format.fraction)
        });
        // What table and series of the harmonics leave; each channel rounded twice, and the sine twice more behind the phase.
        let harmonics = design.harmonics.map_or(0.0, |harmonics| {
            let list = &design.spec.correction.harmonics;
            let steepest = list
                .iter()
                .map(|h| f64::from(h.order) * h.amplitude_cos.max(h.amplitude_sin));
            let phase = steepest.sum::<f64>() * TAU * half_bit(words.sine_phase_bits);
            harmonics.pair_error_max + harmonics.interpolation_max + phase + 3.5 * half_lsb
        });
        let rho = half_lsb + 2f64.sqrt() * (RADIUS * sine + corrected + harmonics) + skew;
        // Coefficients of `width` bits; they are multiplied by e, and a and a + b each contribute.
        let width = words.signal_fraction as i32 + 2;
        let coefficients = 2.0 * ERROR * 0.5f64.powi(width - 1);
        // Three roundings of the increment a sample (kick, drift, leak), as the e that would make them.
        let increments = 3.0 * half_bit(words.phase_bits) / design.tracking.ab;
        let into_loop = rho + coefficients + increments;
        Self {
            e: rho + into_loop * (1.0 + amplification(design)),
            rho: rho + RADIUS * into_loop * amplification(design) * ERROR,
            alpha_hat: into_loop * amplification(design) / TAU,
            // In its equilibrium Θ makes the mean of n ρ vanish over the period: 2⟨cos · δρ⟩ ≤ 4/π of the largest δρ,
            // per amplitude (½ at least) for the gains.
            theta: 2.0 * 4.0 / std::f64::consts::PI * rho,
        }
    }
}

/// Σ |h| of the closed loop from e to α̂: the most that a bounded disturbance of e can do.
fn amplification(design: &Design) -> f64 {
    let mut tracking =
        Loop::new(from_spec::tracking(&design.spec).expect("a design that the paper knows"));
    (0..(60.0 / design.tracking.omega) as u32)
        .map(|k| {
            let disturbance = if k == 0 { 1.0 } else { 0.0 };
            tracking.advance(disturbance - tracking.alpha_hat());
            tracking.alpha_hat().abs()
        })
        .sum()
}
