//! `report.html`: the data sheet.

use askama::Template;
use nonius_model::design::Design;
use nonius_model::physical::{metres, radians_of_revolution};
use nonius_model::spec::Spec;
use nonius_plot::{Axis, Look, Mark, Plot, Series};

use crate::curves;
use crate::design_json::DesignJson;
use crate::diagram::Diagram;
use crate::simulation::Simulation;
use crate::slow_lock::SlowLock;
use nonius_quantity::{engineering, periods_per_second};

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    j: &'a DesignJson,
    facts: Vec<Fact>,
    diagram: Diagram,
    bode: String,
    simulated: [String; 2],
    style: &'static str,
    script: String,
    bars: Vec<Bar>,
    /// The waves that were written, without the ending.
    waves: &'a str,
    files: Vec<(String, String)>,
}

struct Fact {
    name: &'static str,
    value: String,
    note: String,
    /// It is worse than what was asked for.
    missed: bool,
}

impl Fact {
    fn new(name: &'static str, value: String, note: String) -> Self {
        Self {
            name,
            value,
            note,
            missed: false,
        }
    }

    fn missed_where(self, missed: bool) -> Self {
        Self { missed, ..self }
    }
}

struct Bar {
    source: String,
    value: String,
    /// Share of the widest bar, per cent.
    width: String,
    class: &'static str,
}

fn facts(design: &Design, j: &DesignJson) -> Vec<Fact> {
    let (spec, t) = (&design.spec, &j.tracking);
    let per_period = |periods: f64| {
        let metres = metres(spec, periods).map(|x| engineering(x, "m"));
        let radians = radians_of_revolution(spec, periods).map(|x| engineering(x, "rad"));
        let units = [Some(format!("{periods:.2e} periods")), metres, radians];
        units.into_iter().flatten().collect::<Vec<_>>().join(", ")
    };
    let phase = &design.structure.formats.alpha.format;
    let skew = j.channel_skew.as_ref().map(|skew| {
        Fact::new(
            "Channel skew corrected",
            format!("sine later by {}", engineering(skew.delay_s, "s")),
            format!(
                "at top speed {:.2e} periods rms are left of {:.2e}",
                skew.left_at_top_speed_periods, skew.uncorrected_at_top_speed_periods
            ),
        )
    });
    let harmonics = j.harmonics.as_ref().map(|h| {
        let orders: Vec<String> = h.orders.iter().map(ToString::to_string).collect();
        Fact::new(
            "Harmonics corrected",
            format!("orders {}", orders.join(", ")),
            format!(
                "{:.2e} periods rms are left of {:.2e}",
                h.left_periods, h.uncorrected_periods
            ),
        )
    });
    let mut list = vec![
        Fact::new(
            "Accuracy predicted",
            per_period(j.budget.total),
            format!(
                "rms, slow{}; asked {:.2e}",
                if spec.calibration.is_on() {
                    ", calibrated"
                } else {
                    ", errors of the sensor at their worst"
                },
                j.budget.asked
            ),
        )
        .missed_where(j.budget.total > j.budget.asked),
        Fact::new(
            "Accuracy simulated",
            per_period(j.simulated.rms_periods),
            format!(
                "bit-true, rms, with half of the promised errors; largest {:.2e}; with the weakest signals {:.2e} rms; asked {:.2e}{}",
                j.simulated.largest_periods,
                j.simulated_weakest.rms_periods,
                j.budget.asked,
                if j.simulated.locked {
                    ""
                } else {
                    "; the loop did not lock"
                }
            ),
        )
        .missed_where(j.misses() || j.misses_with_the_weakest()),
        pull_in(j),
        Fact::new(
            "Resolution",
            format!("2^-{} of a period", phase.fraction),
            per_period(phase.lsb()),
        ),
        Fact::new(
            "Sample rate",
            engineering(spec.adc.sample_rate_hz, "Hz"),
            format!(
                "{} clocks per sample: clock of {} or more",
                j.clocks_per_sample,
                engineering(j.latency.clock_hz_min, "Hz")
            ),
        ),
        Fact::new(
            "Latency",
            format!("{} clocks", j.latency.clocks),
            format!(
                "{} at a clock of {}; the position is the estimate for the next sample",
                engineering(j.latency.seconds_at_that_clock, "s"),
                engineering(j.latency.clock_hz, "Hz")
            ),
        ),
        Fact::new(
            "Bandwidth, −3 dB",
            match t.bandwidth_3db_hz {
                hz if hz < 0.499 * spec.adc.sample_rate_hz => engineering(hz, "Hz"),
                _ => "none below half the sample rate".into(),
            },
            format!(
                "noise bandwidth {}, peak {:.2}",
                engineering(t.noise_bandwidth_hz, "Hz"),
                t.peak
            ),
        ),
        Fact::new(
            "Largest speed",
            periods_per_second(t.speed_max_periods_per_s),
            if t.lag_at_top_speed_periods == 0.0 {
                "no lag there".into()
            } else {
                format!("lag there {:.2e} periods", t.lag_at_top_speed_periods)
            },
        ),
        Fact::new(
            "Acceleration error",
            format!("{:.2e} periods per period/s²", t.acceleration_error_s2),
            match spec.tracking.filter_type {
                2 => "constant acceleration, type 2".into(),
                _ => "type 1".into(),
            },
        ),
        Fact::new(
            "Multipliers",
            format!("{} for {} products", j.multipliers, j.products),
            format!(
                "sine table {} bits, largest error {:.2e} turns",
                j.sine_table.bits, j.sine_table.error.largest_angle_turns
            ),
        ),
        Fact::new(
            "Calibration",
            match spec.calibration.parameters {
                0 => "off".into(),
                n => format!("{n} parameters on line"),
            },
            corrected(spec),
        ),
    ];
    list.extend(j.slow_lock.as_ref().and_then(slow_lock));
    list.extend(skew);
    list.extend(harmonics);
    list
}

/// What the parameters correct, as far as the design promises.
fn corrected(spec: &Spec) -> String {
    let (c, s) = (&spec.calibration, &spec.sensor);
    if !c.is_on() {
        return "nominal gains; what the sensor promises stays".into();
    }
    let mut parts = vec![
        format!("amplitudes ±{:.0} %", s.amplitude_tolerance * 100.0),
        format!("offsets {:.0} %", s.offset_max * 100.0),
    ];
    if c.has_phase() {
        parts.push(format!("phase {:.1}°", s.phase_error_max_deg));
    }
    if c.has_bend() {
        parts.push(format!("bends {:.1} %", s.bend_max * 100.0));
    }
    format!("corrects {}", parts.join(", "))
}

/// From power-up into full speed.
fn pull_in(j: &DesignJson) -> Fact {
    let p = &j.pull_in;
    let starts = format!(
        "into full speed from power-up, both ways; {} sensors with every promised error at an end of its range, {} starts each",
        p.sensors, p.starts_each
    );
    let (value, note) = match &p.worst {
        None => (
            format!("locked within {}", engineering(p.longest_s, "s")),
            starts,
        ),
        Some(worst) => (
            format!(
                "{} of {} sensors do not lock, or not for good",
                p.not_locked, p.sensors
            ),
            format!("{starts}; worst: {worst}; {}", p.advice()),
        ),
    };
    Fact::new("Pull-in", value, note).missed_where(!p.holds())
}

/// Sensors that are never learned in slow motion, where there are any.
fn slow_lock(slow: &SlowLock) -> Option<Fact> {
    let value = format!(
        "{} of {} sensors never learned",
        slow.not_learned, slow.sensors
    );
    let fact = |why| Fact::new("Slow motion", value, why).missed_where(true);
    slow.missed().map(fact)
}

/// The closed loop's magnitude in dB over frequency.
fn bode(design: &Design) -> Plot {
    /// Lowest magnitude that is shown, dB.
    const LOWEST: f64 = -42.0;
    let rate = design.spec.adc.sample_rate_hz;
    let (low, high) = (design.tracking.omega / 60.0, 0.5f64);
    let points: Vec<[f64; 2]> = (0..=240)
        .map(|i| {
            let f = low * (high / low).powf(f64::from(i) / 240.0);
            let db = 20.0 * curves::magnitude(&design.tracking, f).log10();
            [f * rate, db.max(LOWEST)]
        })
        .collect();
    let hertz = curves::bandwidth(&design.tracking) * rate;
    Plot {
        title: "Magnitude of the closed loop, from the angle to its estimate".into(),
        x: Axis::logarithmic("frequency, Hz", points.iter().map(|p| p[0])),
        y: Axis::fitted("magnitude, dB", points.iter().map(|p| p[1]).chain([6.0])),
        series: vec![Series::new("closed loop", Look::Model, points)],
        marks: vec![Mark {
            x: hertz,
            text: format!("−3 dB: {}", engineering(hertz, "Hz")),
        }],
        round: false,
    }
}

/// The angle error from power-up on, and along a period in the end.
fn simulated(simulation: &Simulation, calibrated: bool) -> [Plot; 2] {
    let calibrated = if calibrated { "calibrated, " } else { "" };
    let course = &simulation.course;
    let raw = simulation.raw_rms_periods;
    let ends = [course.first(), course.last()];
    let raw_line = ends.into_iter().flatten().map(|p| [p[0], raw]).collect();
    let errors = course.iter().map(|p| p[1]);
    let along = &simulation.along;
    [
        Plot {
            title: "From power-up, rms over the last period of travel".into(),
            x: Axis::logarithmic("periods travelled", course.iter().map(|p| p[0])),
            y: Axis::logarithmic("angle error, periods", errors.chain([raw])),
            series: vec![
                Series::new(
                    "arctangent of the signals as they are",
                    Look::BeforeLine,
                    raw_line,
                ),
                Series::new("chip", Look::AfterLine, course.clone()),
            ],
            marks: vec![],
            round: false,
        },
        Plot {
            title: format!("Along a period, {calibrated}mean of many samples at each place"),
            x: Axis::linear("place in the period, periods", [0.0, 1.0]),
            y: Axis::fitted("angle error, periods", along.iter().map(|p| p[1])),
            series: vec![Series::new("chip", Look::Model, along.clone())],
            marks: vec![],
            round: false,
        },
    ]
}

fn bars(j: &DesignJson) -> Vec<Bar> {
    let mut list = vec![
        (
            "sensor noise through the loop".to_owned(),
            j.budget.noise,
            "given",
        ),
        ("ADC".to_owned(), j.budget.adc, "given"),
    ];
    if j.spec.calibration.is_on() {
        let what = "noise of the calibration at its last gamma".to_owned();
        list.push((what, j.budget.calibration, "search"));
    }
    if j.budget.uncorrected > 0.0 {
        let what = "errors of the sensor that are not calibrated, at worst".to_owned();
        list.push((what, j.budget.uncorrected, "given"));
    }
    list.extend(
        j.budget
            .terms
            .iter()
            .map(|t| (t.source.to_owned(), t.rms_periods, "own")),
    );
    let largest = list.iter().fold(f64::MIN_POSITIVE, |m, b| m.max(b.1));
    list.into_iter()
        .map(|(source, value, class)| Bar {
            source,
            value: format!("{value:.2e}"),
            width: format!("{:.2}", value / largest * 100.0),
            class,
        })
        .collect()
}

fn files(files: &[(String, Vec<u8>)]) -> Vec<(String, String)> {
    let what = |path: &str| match path.rsplit('.').next().unwrap_or_default() {
        "sdc" => "timing constraints",
        "v" if path.starts_with("rtl") => "the chip, Verilog-2005",
        "v" if path.starts_with("tb") => "self-checking testbench",
        "v" => "how to instantiate it",
        "vec" => "stimulus and every expected value, hexadecimal",
        "vcd" => "waves of the bit-true model",
        "gtkw" => "opens the waves in GTKWave",
        "mem" | "hex" | "coe" | "mif" if path.contains("/coefficients.") => {
            "coefficients as words of a memory, rows as in coefficients.json"
        }
        "mem" | "hex" => "table for $readmemh",
        "coe" => "table for Vivado's memory generator",
        "mif" => "table for Quartus",
        "vh" => "for `include",
        "json" if path == "design.json" => "every derived number",
        "json" => "for programs",
        _ => "",
    };
    files
        .iter()
        .map(|(path, _)| (path.clone(), what(path).to_owned()))
        .collect()
}

/// The page.
pub(crate) fn page(
    design: &Design,
    j: &DesignJson,
    simulation: &Simulation,
    written: &[(String, Vec<u8>)],
) -> Result<String, askama::Error> {
    Page {
        j,
        facts: facts(design, j),
        diagram: Diagram::of(&design.spec),
        bode: bode(design).html(),
        simulated: simulated(simulation, design.spec.calibration.is_on()).map(|plot| plot.html()),
        style: nonius_plot::STYLE,
        script: nonius_plot::script(),
        bars: bars(j),
        waves: written
            .iter()
            .find_map(|(path, _)| path.strip_suffix(".gtkw"))
            .unwrap_or_default(),
        files: files(written),
    }
    .render()
}
