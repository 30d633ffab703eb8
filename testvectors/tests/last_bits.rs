//! The vectors see the last bit of every coefficient: a chip with one more or one less in any of them differs in a row.

use std::collections::BTreeSet;
use std::panic::{self, AssertUnwindSafe, catch_unwind};

use crate::shipped;
use nonius_codegen::generate;
use nonius_model::design::Design;
use nonius_model::graph::{Graph, Op};
use nonius_model::kernel::{Coefficients, Constant};
use nonius_testvectors::{stimulus, vectors};

/// Samples of each stimulus, as `nonius build` writes them.
const ROWS: usize = 2000;

/// What the chip reads.
fn coefficients(graph: &Graph) -> BTreeSet<String> {
    let read = graph.ids().filter(|id| graph.is_read(*id));
    let constants = read.filter(|id| matches!(graph.node(*id).op, Op::Constant(_)));
    let names = constants.filter_map(|id| graph.node(id).name.clone());
    // The negative of one follows it.
    names
        .filter(|name| Coefficients::<Constant>::meaning(name).is_some())
        .collect()
}

/// Coefficients of a chip, one more and one less, that no vector sees.
fn unseen(design: &Design) -> Vec<(String, i64)> {
    let files = generate(design, "test", &[]).expect("templates render");
    let stimuli = stimulus::named(design, ROWS);
    let rows = |design: &Design, k: usize| vectors::rows(design, &stimuli[k], &files.columns);
    let sound: Vec<String> = (0..stimuli.len()).map(|k| rows(design, k)).collect();
    let seen = |name: &str, by: i64| {
        let mut other = design.clone();
        other.constants = design.constants.map(|n, mut c| {
            c.raw += if n == name { by } else { 0 };
            c
        });
        // An address that leaves its table shows too.
        let differs = |k: usize| {
            catch_unwind(AssertUnwindSafe(|| rows(&other, k))).map_or(true, |rows| rows != sound[k])
        };
        (0..stimuli.len()).any(differs)
    };
    let all = coefficients(&design.graph).into_iter();
    all.flat_map(|name| [(name.clone(), -1), (name, 1)])
        .filter(|(name, by)| !seen(name, *by))
        .collect()
}

/// The dead band of the direction: only a speed of exactly its size would tell, to the last of 26 bits.
const NEVER_MET: [&str; 1] = ["direction_rate"];

#[test]
fn every_last_bit_is_seen() {
    // As many periods held as the rows have, or the search does not begin again.
    let mut spec = shipped::design("optical").spec;
    spec.calibration.hold_periods = Some(40);
    let design = Design::new(&spec).expect("a design that works");
    // A table that is left says so at length, which is no news here.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| ()));
    let unseen = unseen(&design);
    panic::set_hook(hook);
    let names: BTreeSet<&str> = unseen.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, BTreeSet::from(NEVER_MET), "{unseen:?}");
}
