//! Recordings of encoders that err, with their true angle.

use std::f64::consts::TAU;
use std::fmt::Write;

use nonius_sensor::{Motion, Sensor};

pub(super) const ROWS: u32 = 60_000;

const HEAD: &str = "# sample_rate_hz: 50000\n# adc_bits: 14\n# full_scale: 1\n# periods_per_revolution: 64\ntime_s,cos,sin,reference_rad\n";

/// A recording of a bent encoder of 64 periods per revolution, with its true angle.
pub(super) fn bent_encoder(bends: [f64; 2]) -> String {
    let mut text = String::from(HEAD);
    let mut state = 7u64;
    let mut noise = || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            sum += (state >> 40) as f64 / f64::from(1 << 24);
        }
        sum * 1e-3
    };
    for k in 0..ROWS {
        let t = f64::from(k) / 50e3;
        // From 250 to 550 periods a second and back.
        let alpha = TAU * (400.0 * t - 150.0 / TAU / 0.8 * (TAU * 0.8 * t).sin());
        let bent = |u: f64, k: f64| u + k * u * u * u;
        let cos = 0.7 * bent(alpha.cos() + noise(), bends[0]) + 0.03;
        let sin = 0.66 * bent((alpha - 0.05).sin() + noise(), bends[1]) - 0.02;
        let code = |v: f64| (v * 8192.0).round() / 8192.0;
        let _ = writeln!(
            text,
            "{t:.6},{},{},{:.6}",
            code(cos),
            code(sin),
            alpha.rem_euclid(TAU)
        );
    }
    text
}

/// A sine that is sampled so many seconds later.
pub(super) fn skew(delay_s: f64) -> String {
    format!("[[cause]]\nname = \"channel_skew\"\ndelay_s = {delay_s:e}\n")
}

/// Channels that bend by an even or odd power.
pub(super) fn power(which: &str, [cos, sin]: [f64; 2]) -> String {
    format!("[[cause]]\nname = \"{which}_nonlinearity\"\nk_cos = {cos:?}\nk_sin = {sin:?}\n")
}

/// An order of the scale period with amplitude and phase in each channel.
pub(super) fn harmonic((order, cos, sin): (u32, (f64, f64), (f64, f64))) -> String {
    format!(
        "[[cause]]\nname = \"spatial_harmonic\"\norder = {order}\namplitude_cos = {}\nphase_cos = {:?}\n\
         amplitude_sin = {}\nphase_sin = {:?}\n",
        cos.0, cos.1, sin.0, sin.1
    )
}

/// A recording of a sensor with a cause as `sensor.toml` has it, up to 550 periods a second in both directions, with its true
/// angle: that at which the cosine is sampled.
pub(super) fn simulated_encoder(cause: &str) -> String {
    let sensor = format!(
        "[signals]\na_c = 0.7\nb_c = 0.03\na_s = 0.66\nb_s = -0.02\nbeta = 0.05\nnoise_rms = 0.001\n\
         [adc]\nbits = 14\nlsb = {}\ncentre = 0.0\nsample_rate_hz = 50000.0\n\
         [motion]\nperiods_travelled = 420.0\nspeed_max_periods_per_s = 550.0\nperiods_per_revolution = 64\n\
         {cause}",
        1.0 / 8192.0
    );
    let sensor = Sensor::from_toml(&sensor, "sensor.toml").expect("a sensor");
    // Three times to and fro.
    let swing = 550.0 / (TAU * 2.5);
    let (time_s, alpha) = (0..ROWS)
        .map(|k| {
            let t = f64::from(k) / 50e3;
            (t, TAU * swing * (1.0 - (TAU * 2.5 * t).cos()))
        })
        .unzip();
    let motion = Motion { time_s, alpha };
    let seen = sensor.simulate(&motion, 5);
    let mut text = String::from(HEAD);
    for (k, alpha) in motion.alpha.iter().enumerate() {
        let (t, cos, sin) = (seen.time_s[k], seen.cos[k], seen.sin[k]);
        let _ = writeln!(text, "{t:.6},{cos},{sin},{:.6}", alpha.rem_euclid(TAU));
    }
    text
}
