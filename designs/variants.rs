//! The optical design with everything that a chip may be built with: one list for tests, campaigns and comparisons.

use nonius_model::design::Design;
use nonius_model::spec::{All, CalibrationMethod, CalibrationStart, Coding, Multipliers, Spec};

use super::words::key;
use super::{NAMES, optical, spec};
use CalibrationMethod::{Batch, Exact, Final, SumOfSquares};
use CalibrationStart::{Gears, LeastSquares};

mod corrections;

pub(crate) use corrections::{harmonics, skewed, third_and_fifth};

/// A design and what is special about it.
#[derive(Clone)]
pub(crate) struct Variant {
    pub(crate) what: String,
    pub(crate) spec: Spec,
}

impl Variant {
    fn of(what: impl Into<String>, change: impl Fn(&mut Spec)) -> Self {
        let (what, mut spec) = (what.into(), optical());
        change(&mut spec);
        Self { what, spec }
    }

    /// The larger of the parameter sets that its search has.
    pub(crate) fn is_largest(&self) -> bool {
        self.spec.calibration.has_phase()
    }

    /// Quantised.
    pub(crate) fn design(&self) -> Design {
        Design::new(&self.spec).unwrap_or_else(|refused| panic!("{}: {refused}", self.what))
    }
}

pub(crate) const ALL: Multipliers = Multipliers::All(All::All);

/// Type 1 lags at speed: asked to follow less.
pub(crate) fn type_1(spec: &mut Spec) {
    spec.tracking.filter_type = 1;
    spec.sensor.speed_max_periods_per_s = 1e3;
}

/// The designs that are shipped, the magnetic one with its offset binary codes.
pub(crate) fn shipped() -> Vec<Variant> {
    let variant = |name: &str| Variant {
        what: name.into(),
        spec: spec(name),
    };
    NAMES.map(variant).into()
}

/// Search, start, completion and parameter sets.
const SEARCHES: [(&str, CalibrationMethod, CalibrationStart, bool, &[u32]); 11] = [
    ("final form", Final, Gears, false, &[4, 5]),
    ("radius alone", Final, Gears, false, &[8, 9]),
    ("completed", Final, Gears, true, &[8, 9]),
    ("exact", Exact, Gears, false, &[4, 5]),
    ("sum of squares", SumOfSquares, Gears, false, &[4, 5]),
    (
        "sum of squares, completed",
        SumOfSquares,
        Gears,
        true,
        &[8, 9],
    ),
    ("batch", Batch, Gears, false, &[4, 5]),
    ("batch, completed", Batch, Gears, true, &[8, 9]),
    ("started", Final, LeastSquares, false, &[4, 5]),
    ("completed, started", Final, LeastSquares, true, &[8, 9]),
    ("exact, started", Exact, LeastSquares, false, &[4, 5]),
];

/// Every search with every parameter set that it is built for.
pub(crate) fn searches() -> Vec<Variant> {
    searches_of(&optical())
}

/// The same of another design.
pub(crate) fn searches_of(base: &Spec) -> Vec<Variant> {
    let mut list = vec![];
    for (what, method, start, completion, sets) in SEARCHES {
        for &parameters in sets {
            let mut spec = base.clone();
            spec.calibration.method = method;
            spec.calibration.start = start;
            spec.calibration.completion = completion;
            spec.calibration.parameters = parameters;
            let what = what.to_owned();
            list.push(Variant { what, spec });
        }
    }
    list
}

/// Without calibration.
pub(crate) fn fixed() -> Variant {
    Variant::of("fixed", |spec| spec.calibration.parameters = 0)
}

/// One of each kind: the shipped designs, no calibration, every search with its largest parameter set, and without recall.
pub(crate) fn kinds() -> Vec<Variant> {
    let mut kinds = shipped();
    kinds.push(fixed());
    kinds.extend(searches().into_iter().filter(Variant::is_largest));
    kinds.extend(forgetful().pop());
    kinds
}

/// These, a loop of type 1, and chips with known corrections: every word of `[formats]` is in one of them.
pub(crate) fn with_every_word() -> Vec<Variant> {
    let more = [poles(), skewed(), harmonics()];
    let firsts = more.into_iter().flat_map(|list| list.into_iter().take(1));
    kinds().into_iter().chain(firsts).collect()
}

/// The searches that only a design without completion has, which is rarely wanted.
pub(crate) fn radius_alone() -> Vec<Variant> {
    radius_alone_of(&optical())
}

/// The same of another design.
pub(crate) fn radius_alone_of(base: &Spec) -> Vec<Variant> {
    let searches = searches_of(base).into_iter();
    let completed = searches.filter(|v| v.spec.calibration.completion && v.what != "completed");
    completed
        .map(|Variant { what, mut spec }| {
            spec.calibration.completion = false;
            let what = what.replace("completed", "radius alone");
            Variant { what, spec }
        })
        .collect()
}

/// Every method and type of the loop, with four and five parameters, on one multiplier and on as many as there are
/// products.
pub(crate) fn loops() -> Vec<Variant> {
    let mut list = vec![];
    for (method, filter_type) in [(1, 1), (1, 2), (2, 1), (3, 1), (3, 2)] {
        for (parameters, multipliers) in [
            (4, Multipliers::Count(1)),
            (4, ALL),
            (5, Multipliers::Count(1)),
            (5, ALL),
        ] {
            list.push(Variant::of("optical", |spec| {
                spec.tracking.method = method;
                if filter_type == 1 {
                    type_1(spec);
                }
                spec.calibration.parameters = parameters;
                spec.chip.multipliers = multipliers;
            }));
        }
    }
    list
}

/// The second pole of type 1 as a field, and loops that follow four samples a period, where the increments have a bit
/// more.
pub(crate) fn poles() -> Vec<Variant> {
    let fast = |spec: &mut Spec| spec.sensor.speed_max_periods_per_s = 250e3;
    vec![
        Variant::of("second pole 0.9", |spec| {
            type_1(spec);
            spec.tracking.pole = Some(0.9);
        }),
        Variant::of("four samples a period", |spec| {
            fast(spec);
            spec.tracking.method = 1;
        }),
        Variant::of("four samples a period, second pole 0.9995", |spec| {
            type_1(spec);
            fast(spec);
            spec.tracking.pole = Some(0.9995);
        }),
        Variant::of("exact, second pole 0.9", |spec| {
            type_1(spec);
            spec.tracking.pole = Some(0.9);
            spec.calibration.method = Exact;
            spec.chip.multipliers = Multipliers::Count(2);
        }),
    ]
}

/// Speeds at which the radius does not show all, and the phase error is learned from.
pub(crate) fn sparse() -> Vec<Variant> {
    let of = |(parameters, method, start, per_period): (u32, _, _, f64)| {
        Variant::of(format!("down to {per_period} samples a period"), |spec| {
            spec.sensor.speed_max_periods_per_s = spec.adc.sample_rate_hz / per_period;
            spec.calibration.parameters = parameters;
            spec.calibration.method = method;
            spec.calibration.start = start;
        })
    };
    [
        (4, Final, Gears, 4.0),
        (5, Final, LeastSquares, 4.0),
        (5, SumOfSquares, Gears, 4.0),
        (9, Final, Gears, 4.0),
        (9, Final, LeastSquares, 4.0),
        (8, Batch, Gears, 4.0),
        (9, SumOfSquares, Gears, 8.0),
    ]
    .map(of)
    .into()
}

/// Loops with six gears and more above the designed one.
pub(crate) fn narrow() -> Vec<Variant> {
    let of = |(method, bandwidth): (u32, f64)| {
        Variant::of(format!("{bandwidth} Hz"), |spec| {
            spec.tracking.method = method;
            spec.tracking.bandwidth_hz = bandwidth;
        })
    };
    [(3, 1e3), (1, 300.0)].map(of).into()
}

/// Every word said by the design, one bit more than the analysis takes and one less, where the others allow that.
pub(crate) fn words() -> Vec<Variant> {
    let of = |(what, by): (&str, i64)| {
        let mut variant = Variant::of(what, |spec| {
            spec.calibration.parameters = 9;
            spec.correction.channel_skew_s = 2e-7;
            spec.correction.harmonics = third_and_fifth();
        });
        for word in variant.design().word_lengths() {
            for value in [word.value + by, word.value] {
                let said = variant.spec.formats.set(key(&word), Some(value));
                if said && Design::new(&variant.spec).is_ok() {
                    break;
                }
            }
        }
        variant
    };
    [("longer words", 1), ("shorter words", -1)].map(of).into()
}

/// Other ADCs.
pub(crate) fn adcs() -> Vec<Variant> {
    let of = |bits: u32| {
        Variant::of("optical", |spec| {
            spec.adc.bits = bits;
            spec.sensor.noise_rms = 0.0;
            spec.accuracy.rms_periods = 60e-6 * 2f64.powi(12 - bits as i32);
        })
    };
    let mut list: Vec<_> = [8, 16, 18].map(of).into();
    list.push(Variant::of("offset binary", |spec| {
        spec.adc.coding = Coding::OffsetBinary;
    }));
    list
}

/// Every number of multipliers.
pub(crate) fn multipliers() -> Vec<Variant> {
    let of = |multipliers| Variant::of("optical", |spec| spec.chip.multipliers = multipliers);
    let few = [2, 3, 5].map(Multipliers::Count);
    let mut list: Vec<_> = few.into_iter().chain([ALL]).map(of).collect();
    for (parameters, method, multipliers) in [
        (9, Final, ALL),
        (9, Final, Multipliers::Count(3)),
        (8, SumOfSquares, Multipliers::Count(2)),
        (9, Batch, ALL),
    ] {
        list.push(Variant::of("completed", |spec| {
            spec.calibration.parameters = parameters;
            spec.calibration.method = method;
            spec.chip.multipliers = multipliers;
        }));
    }
    list
}

/// Chips that do not recall the parameters of before a fade.
pub(crate) fn forgetful() -> Vec<Variant> {
    let of = |parameters: u32| {
        Variant::of("final form, no recall", |spec| {
            spec.calibration.recall = Some(false);
            spec.calibration.parameters = parameters;
        })
    };
    [5, 9].map(of).into()
}

/// Chips whose residual is the paper's projection, which does not allow for what the loop lags.
pub(crate) fn lagging() -> Vec<Variant> {
    let of = |(what, method, parameters): (&str, CalibrationMethod, u32)| {
        Variant::of(what, |spec| {
            spec.calibration.lag = Some(false);
            spec.calibration.method = method;
            spec.calibration.parameters = parameters;
        })
    };
    [
        ("final form, no lag", Final, 4),
        ("final form, no lag", Final, 5),
        ("exact, no lag", Exact, 5),
    ]
    .map(of)
    .into()
}

/// Few periods between the gears and held, so that the last one, where there is recall, is soon reached, and again; with each parameter set.
pub(crate) fn recalls() -> Vec<Variant> {
    let one = Multipliers::Count(1);
    let of = |(parameters, method, multipliers): (u32, CalibrationMethod, Multipliers)| {
        Variant::of("recall", |spec| {
            spec.calibration.parameters = parameters;
            spec.calibration.gear_periods = Some(2);
            spec.calibration.hold_periods = Some(40);
            spec.calibration.method = method;
            spec.chip.multipliers = multipliers;
        })
    };
    [
        (4, Exact, ALL),
        (5, Final, one),
        (8, SumOfSquares, Multipliers::Count(2)),
        (9, Final, one),
    ]
    .map(of)
    .into()
}

/// From one gear of gamma, which is never shifted, to sixteen.
pub(crate) fn gears() -> Vec<Variant> {
    let one = Multipliers::Count(1);
    let of = |(parameters, method, (first, last), multipliers): (u32, _, (u32, u32), _)| {
        Variant::of(format!("gamma 2^-{first} to 2^-{last}"), |spec| {
            spec.calibration.parameters = parameters;
            spec.calibration.method = method;
            spec.calibration.gamma_first = first;
            spec.calibration.gamma_last = Some(last);
            spec.calibration.gear_periods = Some(1);
            spec.chip.multipliers = multipliers;
        })
    };
    [
        (5, Final, (8, 8), one),
        (9, Final, (8, 8), ALL),
        (4, SumOfSquares, (9, 9), one),
        (5, Exact, (8, 9), Multipliers::Count(2)),
        (5, Batch, (3, 18), one),
        (8, Batch, (4, 9), one),
    ]
    .map(of)
    .into()
}

/// What the page of costs has, in its order.
pub(crate) fn costed() -> Vec<Variant> {
    [
        vec![fixed()],
        searches(),
        radius_alone(),
        forgetful(),
        lagging(),
    ]
    .concat()
}

/// All of these.
pub(crate) fn everything() -> Vec<Variant> {
    let mut list = shipped();
    list.push(fixed());
    for part in [
        searches(),
        radius_alone(),
        loops(),
        poles(),
        sparse(),
        narrow(),
        adcs(),
        words(),
        multipliers(),
        skewed(),
        harmonics(),
        recalls(),
        forgetful(),
        lagging(),
        gears(),
    ] {
        list.extend(part);
    }
    list
}
