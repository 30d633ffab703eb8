//! What the head of a chip says it is: no more than it has.

use nonius_model::spec::{CalibrationMethod, Spec};

use crate::layout::{COMMENT, wrap};

/// The kind of chip.
pub(crate) fn kind(spec: &Spec) -> &'static str {
    if spec.calibration.is_on() {
        "sin/cos interpolation chip that calibrates itself"
    } else {
        "sin/cos interpolation chip"
    }
}

/// How it works, in lines.
pub(crate) fn purpose(spec: &Spec) -> Vec<String> {
    const LOOP: &str = "A digital loop follows the angle alpha of a sin/cos sensor: the corrected pair is turned back \
                        by the estimate alpha_hat, what is left is the phase error e, and the loop filter turns e into \
                        the next step of the estimate.";
    let c = &spec.calibration;
    let search = match c.method {
        _ if !c.is_on() => {
            "Nothing is calibrated: the gains are nominal. The radial residual rho tells the lock detector whether the \
             estimate is that of the signal."
                .to_owned()
        }
        CalibrationMethod::Final => {
            "The radial residual rho shows what the correction still misses and moves its parameters".to_owned()
        }
        CalibrationMethod::Exact => "The radial residual rho and the phase error e show what the correction still \
                                     misses and move its parameters"
            .to_owned(),
        CalibrationMethod::SumOfSquares | CalibrationMethod::Batch => {
            "The squared radius of the pair shows what the correction still misses and moves its parameters".to_owned()
        }
    };
    // θ9 moves by the completed gradient alone: no radius shows it.
    let parameters = match (c.parameters, c.completed().is_some()) {
        (0, _) => "",
        (4, _) => " theta_1 to theta_4.",
        (5, _) => " theta_1 to theta_5.",
        (8, false) => " theta_1 to theta_4 and theta_6 to theta_8.",
        (8, true) => " theta_1 to theta_4 and theta_6 to theta_9.",
        (_, false) => " theta_1 to theta_8.",
        (_, true) => " theta_1 to theta_9.",
    };
    let gamma = match (c.is_on(), c.gears()) {
        (false, _) => String::new(),
        (true, 0) => format!(" gamma, how far, is 2^-{}.", c.gamma_first),
        (true, gears) => format!(
            " gamma, how far, is 2^-{} at first and 2^-{} after {gears} gear{}.",
            c.gamma_first,
            c.gamma_last(),
            if gears == 1 { "" } else { "s" }
        ),
    };
    wrap("", &format!("{LOOP} {search}{parameters}{gamma}"), COMMENT)
}

/// What the input `calibrate` does.
pub(crate) fn calibrate(spec: &Spec) -> &'static str {
    if spec.calibration.waits() {
        "this sample may teach the parameters; where it falls, what was learned so far is applied"
    } else if spec.calibration.is_on() {
        "this sample may move the parameters"
    } else {
        "does nothing: this chip has no calibration"
    }
}
