//! The extended simulation, moved as the recording was, is the recording but for the noise of both.

mod support;

use std::f64::consts::TAU;

use nonius_diagnosis::{diagnose, motion_csv, sensor_toml};
use nonius_fourier::{Complex, forward};
use nonius_recording::{Overrides, Recording};
use nonius_sensor::{Motion, Samples, Sensor};
use support::{PLAIN, recording};

const RATE: f64 = 10_000.0;
const SAMPLES: usize = 20_000;
/// Of a sample of the plain sensor, radians.
const NOISE: f64 = 1e-3;

/// How an axis is moved: from rest to one speed, back at another, and left alone; three times, a bit slower each. The speed goes
/// from one to the next by a law of 0 … 1.
fn driven_by(law: fn(f64) -> f64) -> Motion {
    const SPEEDS: [(f64, f64); 7] = [
        (0.0, 0.0),
        (0.08, 0.0),
        (0.2, 1.0),
        (0.3, 1.0),
        (0.45, -0.7),
        (0.58, 0.0),
        (2.0 / 3.0, 0.0),
    ];
    /// Periods per second.
    const TOP: f64 = 700.0;
    let speed = |t: f64| {
        let (round, t) = ((t * 1.5).floor(), t % (2.0 / 3.0));
        let pair = SPEEDS.windows(2).find(|w| t < w[1].0);
        let pair = pair.unwrap_or(&SPEEDS[5..]);
        let x = (t - pair[0].0) / (pair[1].0 - pair[0].0);
        (TOP - 120.0 * round) * (pair[0].1 + (pair[1].1 - pair[0].1) * law(x))
    };
    let mut angle = 0.3;
    let (time_s, alpha) = (0..SAMPLES)
        .map(|k| {
            let t = k as f64 / RATE;
            let now = angle;
            angle += TAU * speed(t + 0.5 / RATE) / RATE;
            (t, now)
        })
        .unzip();
    Motion { time_s, alpha }
}

/// By a drive that is controlled, without jerks.
fn driven() -> Motion {
    driven_by(|x| x * x * x * (10.0 - 15.0 * x + 6.0 * x * x))
}

fn with(causes: &[&str]) -> Sensor {
    let text = causes.iter().fold(PLAIN.to_owned(), |all, one| {
        format!("{all}[[cause]]\n{one}\n")
    });
    Sensor::from_toml(&text, "sensor.toml").expect("a sensor")
}

/// What a diagnosis says of a recording, simulated along the motion that it found, with other noise, and to and fro; and its noise.
fn replayed(recording: &Recording, causes: &[&str]) -> ([Samples; 2], f64) {
    let found = diagnose(recording).expect("an ellipse");
    let names: Vec<String> = found.findings.iter().map(|f| f.cause.to_string()).collect();
    assert_eq!(names.len(), causes.len(), "{names:?}");
    for name in names {
        assert!(causes.iter().any(|c| c.contains(&name)), "{name}");
    }
    let emitted = sensor_toml(&found, recording);
    let sensor = Sensor::from_toml(&emitted, "sensor.toml").expect("what was emitted");
    let text = motion_csv(&found, recording);
    let motion = Motion::along(&sensor, &text, "motion.csv").expect("what was emitted");
    let motions = [motion, Motion::to_and_fro(&sensor)];
    let samples = motions.map(|motion| sensor.simulate(&motion, 12));
    (samples, sensor.signals.noise_rms)
}

/// Rms of the difference of two recordings over that of the noise of both, cos and sin.
fn apart(sensor: &Sensor, recording: &Recording, simulated: &Samples) -> [f64; 2] {
    let channels = [
        (&recording.cos, &simulated.cos, sensor.signals.a_c),
        (&recording.sin, &simulated.sin, sensor.signals.a_s),
    ];
    channels.map(|(measured, simulated, amplitude)| {
        let pairs = measured.iter().zip(simulated);
        let power: f64 = pairs.map(|(m, s)| (m - s).powi(2)).sum();
        let rms = (power / measured.len() as f64).sqrt();
        // Two noises, and two ADCs round.
        let noise = sensor.signals.noise_rms * amplitude;
        rms / (noise * 2f64.sqrt()).hypot(sensor.adc.lsb / 6f64.sqrt())
    })
}

/// What of a recording its simulation does not reproduce, along the radius: there motion, which is only as smooth as its knots, has
/// no part, and what is left is the noise of both, which is white.
fn along_the_radius(sensor: &Sensor, recording: &Recording, simulated: &Samples) -> Vec<f64> {
    let of = &sensor.signals;
    let one = |k: usize| {
        let (c, s) = (recording.cos[k], recording.sin[k]);
        let (cos, sin) = ((c - of.b_c) / of.a_c, (s - of.b_s) / of.a_s);
        let left = (
            (c - simulated.cos[k]) / of.a_c,
            (s - simulated.sin[k]) / of.a_s,
        );
        (left.0 * cos + left.1 * sin) / cos.hypot(sin)
    };
    (0..recording.samples()).map(one).collect()
}

/// How far a spectrum is from a white one: by Kolmogorov and Smirnov, its running sum from a straight line, 1.95 by chance once in a
/// thousand; and its highest line over the mean, 16.8 by chance once in a thousand for 20 000 samples.
fn colour(values: &[f64]) -> [f64; 2] {
    let mut spectrum: Vec<Complex<f64>> = values.iter().map(|x| Complex::from(*x)).collect();
    forward(&mut spectrum);
    let power: Vec<f64> = (1..spectrum.len() / 2)
        .map(|j| spectrum[j].norm_sqr())
        .collect();
    let (sum, count) = (power.iter().sum::<f64>(), power.len() as f64);
    let highest = power.iter().copied().fold(0.0, f64::max) / (sum / count);
    let mut up_to = 0.0;
    let off = power.iter().enumerate().map(|(j, p)| {
        up_to += p / sum;
        (up_to - (j as f64 + 1.0) / count).abs()
    });
    [off.fold(0.0, f64::max) * count.sqrt(), highest]
}

fn is_white([off, highest]: [f64; 2]) -> bool {
    off < 1.95 && highest < 16.8
}

/// The measure sees a line of a tenth of the noise, and noise that a low pass of a tenth of a sample has been through.
#[test]
fn colour_shows() {
    let sensor = with(&[]);
    let motion = driven();
    let [one, other] = [11, 12].map(|seed| sensor.simulate(&motion, seed));
    let noise = along_the_radius(&sensor, &recording(&sensor, one), &other);
    let rms = (noise.iter().map(|x| x * x).sum::<f64>() / noise.len() as f64).sqrt();
    let of = |f: &dyn Fn(usize) -> f64| colour(&(1..noise.len()).map(f).collect::<Vec<f64>>());
    let white = of(&|k| noise[k]);
    let line = of(&|k| noise[k] + 0.1 * rms * (0.7 * k as f64).cos());
    let slow = of(&|k| noise[k] + 0.1 * noise[k - 1]);
    println!("{white:.2?} {line:.2?} {slow:.2?}");
    assert!(is_white(white) && !is_white(line) && !is_white(slow));
}

fn reproduced(causes: &[&str]) {
    let sensor = with(causes);
    for (motion, is_driven) in [(driven(), true), (Motion::to_and_fro(&sensor), false)] {
        let recording = recording(&sensor, sensor.simulate(&motion, 11));
        let ([along, to_and_fro], noise) = replayed(&recording, causes);
        assert_eq!(along.time_s, recording.time_s);
        let own = apart(&sensor, &recording, &along);
        let other = apart(&sensor, &recording, &to_and_fro);
        println!("{causes:?}: {own:.4?} {other:.1?}");
        // When a scale that stood goes back, or begins to move at all, is known to some samples, and the offsets jump there.
        let jumps = is_driven && causes.iter().any(|c| c.starts_with(HYSTERESIS));
        let least = if jumps { 0.25 } else { 0.04 };
        let same = own.iter().all(|a| (a - 1.0).abs() < least);
        assert!(same, "{causes:?}: {own:?} times the noise");
        assert!((noise / NOISE - 1.0).abs() < least, "noise {noise}");
        let colour = colour(&along_the_radius(&sensor, &recording, &along));
        println!("{causes:?}: {colour:.2?}");
        // The side of a hysteresis that jumps there is in the radius, too.
        assert!(jumps || is_white(colour), "{causes:?}: {colour:?}");
        assert!(!is_driven || other.iter().all(|a| *a > 100.0), "{other:?}");
    }
}

const HARMONIC: &str = "name = \"spatial_harmonic\"\norder = 3.0\namplitude_cos = 0.02\nphase_cos = 0.7\namplitude_sin = 0.015\nphase_sin = -2.0";
const SKEW: &str = "name = \"channel_skew\"\ndelay_s = 3e-6";
const HUM: &str = "name = \"interference\"\nfrequency_hz = 311.3\namplitude_cos = 0.01\nphase_cos = 0.4\namplitude_sin = 0.008\nphase_sin = 1.9";
const RAIL: &str =
    "name = \"saturation\"\nthreshold = 0.8\ncompression = 0.1\ncompression_upper = 0.0";
const CROSSTALK: &str =
    "name = \"delayed_crosstalk\"\nproduct_into_cos_s = 3e-6\nproduct_into_sin_s = -2e-6";
const VIBRATION: &str =
    "name = \"vibration\"\nfrequency_hz = 1210.0\namplitude = 0.01\nphase = 0.3";
const COGGING: &str = "name = \"cogging\"\norder = 48.0\namplitude = 0.03\nphase = 0.3";
const LATE: &str = "name = \"channel_skew\"\ndelay_s = 2e-5";
const LARGE_HARMONIC: &str = "name = \"spatial_harmonic\"\norder = 3.0\namplitude_cos = 0.03\nphase_cos = 0.7\namplitude_sin = 0.03\nphase_sin = -2.0";
const BENT: &str = "name = \"odd_nonlinearity\"\nk_cos = 0.04\nk_sin = -0.03";
const LARGE_CROSSTALK: &str =
    "name = \"delayed_crosstalk\"\nproduct_into_cos_s = 2e-5\nproduct_into_sin_s = -1e-5";
const ONE_LOW_PASS: &str = "name = \"bandwidth_mismatch\"\ntau_cos_s = 0.0\ntau_sin_s = 3e-5";
const STUCK: &str = "name = \"stuck_bit\"\nbit = 0.0\nchannel = \"cos\"\nlevel = 1.0";
const LOW_PASS: &str = "name = \"common_bandwidth\"\ntau_s = 2e-5";
const HYSTERESIS: &str = "name = \"hysteresis\"\noffset_cos = 0.008\noffset_sin = -0.006";
const CAME_BACK: &str =
    "name = \"hysteresis\"\noffset_cos = 0.008\noffset_sin = -0.006\nstart_side = -1.0";
const RUNOUT: &str = "name = \"runout\"\norder = 2.0\ndepth = 0.01\nphase = -0.9";
const EVEN: &str = "name = \"even_nonlinearity\"\nk_cos = 0.02\nk_sin = -0.015";
const ODD: &str = "name = \"odd_nonlinearity\"\nk_cos = 0.02\nk_sin = 0.015";
const RIPPLE: &str = "name = \"amplitude_ripple\"\nfrequency_hz = 100.2\ndepth = 0.01\nphase = 1.1";
const WEIGHT: &str = "name = \"adc_nonlinearity\"\nbit = 12.0\nstep_cos = 0.008\nstep_sin = -0.006";
const GAIN: &str = "name = \"gain_drift\"\nchange_cos = 0.02\nchange_sin = -0.012";
const DRIFT: &str = "name = \"offset_drift\"\nchange_cos = 0.02\nchange_sin = -0.012";

#[test]
fn one_cause() {
    for one in [
        HARMONIC, SKEW, HUM, RAIL, CROSSTALK, VIBRATION, COGGING, STUCK, HYSTERESIS, CAME_BACK,
        RUNOUT, DRIFT, LOW_PASS, EVEN, ODD, RIPPLE, WEIGHT, GAIN,
    ] {
        reproduced(&[one]);
    }
}

#[test]
fn two_causes() {
    reproduced(&[HARMONIC, HUM]);
    reproduced(&[HYSTERESIS, RUNOUT]);
    // What a delay does to a harmonic of three per cent or to a bend is a tenth of what it does.
    reproduced(&[LATE, LARGE_HARMONIC]);
    reproduced(&[LATE, BENT]);
    reproduced(&[ONE_LOW_PASS, BENT]);
    reproduced(&[LARGE_CROSSTALK, BENT]);
}

/// Knots that corners need follow a vibration, too: it is named from the stretches between them, and is in the motion once.
#[test]
fn a_vibration_between_corners() {
    let vibration = "name = \"vibration\"\nfrequency_hz = 300.3\namplitude = 0.01\nphase = 0.7";
    let sensor = with(&[vibration]);
    let recording = recording(&sensor, sensor.simulate(&driven_by(|x| x), 11));
    let ([along, _], _) = replayed(&recording, &[vibration]);
    let own = apart(&sensor, &recording, &along);
    println!("{own:.4?}");
    assert!(own.iter().all(|a| (a - 1.0).abs() < 0.04), "{own:?}");
}

/// Against a reference the lag of a low pass is seen, and off the positions: the motion is not ahead of it by as much again.
#[test]
fn a_low_pass_beside_a_reference() {
    let low_pass = "name = \"common_bandwidth\"\ntau_s = 6e-5";
    let (sensor, motion) = (with(&[low_pass]), driven());
    let mut recording = recording(&sensor, sensor.simulate(&motion, 11));
    recording.reference_rad = Some(motion.alpha);
    let ([along, _], _) = replayed(&recording, &[low_pass]);
    let own = apart(&sensor, &recording, &along);
    println!("{own:.4?}");
    assert!(own.iter().all(|a| (a - 1.0).abs() < 0.04), "{own:?}");
}

/// Largest difference of the motion that a diagnosis finds in some rows of a recording from the true one, radians; rows are
/// numbers of samples and the times that they are said to have. And how many samples there are along it.
fn off(rows: &[(usize, f64)]) -> (f64, usize) {
    let sensor = with(&[]);
    let true_motion = driven();
    let all = sensor.simulate(&true_motion, 11);
    let of = |values: &[f64]| rows.iter().map(|row| values[row.0]).collect();
    let samples = Samples {
        time_s: rows.iter().map(|row| row.1).collect(),
        cos: of(&all.cos),
        sin: of(&all.sin),
    };
    let start = rows[0];
    let recording = recording(&sensor, samples);
    let found = diagnose(&recording).expect("an ellipse");
    let motion = Motion::along(&sensor, &motion_csv(&found, &recording), "motion.csv");
    let motion = motion.expect("what was written");
    let pairs = motion.time_s.iter().zip(&motion.alpha);
    let largest = pairs.fold(0.0, |most, (t, alpha)| {
        let k = start.0 + ((t - start.1) * RATE).round() as usize;
        let off = alpha - true_motion.alpha[k];
        f64::max(most, (off - TAU * (off / TAU).round()).abs())
    });
    (largest, motion.alpha.len())
}

#[test]
fn a_motion_is_over_the_true_time() {
    let time = |k: usize| k as f64 / RATE;
    let lost = |k: &usize| ![1500, 2500, 2501, 9000].contains(k);
    let all = || 0..SAMPLES;
    let later: Vec<_> = all().map(|k| (k, 1_700_000_000.0 + time(k))).collect();
    let gaps: Vec<_> = all().filter(lost).map(|k| (k, time(k))).collect();
    // The clock counts what arrives.
    let hidden = all().filter(lost).enumerate();
    let hidden: Vec<_> = hidden.map(|(i, k)| (k, time(i))).collect();
    // Too long to be bridged, while the axis stands.
    let pause = (0..12_000).filter(|k| !(5830..7430).contains(k));
    let pause: Vec<_> = pause.map(|k| (k, time(k))).collect();
    for (rows, count) in [
        (later, SAMPLES),
        (gaps, SAMPLES),
        (hidden, SAMPLES),
        (pause, 12_000),
    ] {
        let (off, samples) = off(&rows);
        assert_eq!(samples, count);
        assert!(off < 3.0 * NOISE, "{off} rad");
    }
}

/// However coarse the numbers of a clock that counts from long ago are beside its samples.
#[test]
fn every_time_of_a_motion_is_later_than_the_one_before() {
    let sensor = with(&[]);
    let all = sensor.simulate(&driven(), 11);
    let kept = || (0..SAMPLES).filter(|k| k % 97 < 67);
    let of = |values: &[f64]| kept().map(|k| values[k]).collect();
    let samples = Samples {
        time_s: kept().map(|k| 1_700_000_000.0 + k as f64 / 2e6).collect(),
        cos: of(&all.cos),
        sin: of(&all.sin),
    };
    let recording = recording(&sensor, samples);
    let found = diagnose(&recording).expect("an ellipse");
    let motion = Motion::along(&sensor, &motion_csv(&found, &recording), "motion.csv");
    assert!(motion.is_ok(), "{motion:?}");
}

/// A channel that was scaled after the ADC has codes of its own size, and so has it simulated.
#[test]
fn either_channel_has_its_own_codes() {
    let coarse = PLAIN.replace("bits = 14", "bits = 12");
    let coarse = coarse.replace("lsb = 0.0001220703125", "lsb = 0.00048828125");
    let sensor = Sensor::from_toml(&coarse, "sensor.toml").expect("a sensor");
    let samples = sensor.simulate(&driven(), 11);
    let scaled = samples.sin.iter().map(|v| 0.73 * v + 0.05).collect();
    let recording =
        Recording::from_samples(samples.time_s, samples.cos, scaled, &Overrides::default());
    let recording = recording.expect("a recording");
    let adc = recording.metadata.adc;
    assert!((adc.sin.lsb / adc.cos.lsb - 0.73).abs() < 1e-6, "{adc:?}");
    let (simulated, _) = replayed(&recording, &[]);
    for samples in simulated {
        for (adc, values) in [(adc.cos, &samples.cos), (adc.sin, &samples.sin)] {
            let off = values.iter().map(|v| (adc.value(adc.code(*v)) - v).abs());
            let off = off.fold(0.0, f64::max) / adc.lsb;
            assert!(off < 1e-6, "{off} of a code: {adc:?}");
        }
    }
}
