//! The tests of the model in one program: one for each file would each be built and linked with all that
//! they share.

mod accuracy;
mod agreement;
mod arithmetic;
mod chip;
mod chip_against_reference;
mod chip_bends;
mod chip_support;
mod flags;
mod graph_support;
mod harmonics;
mod harmonics_refused;
mod on_line_commensurate;
mod on_line_drift;
mod on_line_figures;
mod on_line_held;
mod on_line_interrupted;
mod on_line_loss;
mod on_line_moves;
mod on_line_promised;
mod on_line_rest;
mod on_line_speeds;
mod on_line_start;
mod on_line_stops;
mod on_line_stuck;
mod reading;
mod reference_baselines;
mod reference_completed;
mod reference_gradient;
mod reference_interpolator;
mod reference_loops;
mod reference_loss;
mod reference_null_direction;
mod reference_of_designs;
mod reference_sensor;
mod reference_speed_of_convergence;
mod reference_support;
mod refusals;
mod shortest_words;
mod skew;
mod support;
mod word_lengths;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(
        env!("CARGO_MANIFEST_DIR"),
        include_str!("all.rs"),
        &["study_is_fresh"],
    );
}
