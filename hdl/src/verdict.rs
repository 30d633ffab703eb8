//! Reads the testbench's output, strictly.
//!
//! A pass is: exit code 0; the last line is exactly `PASS`; every stimulus that has a vector
//! file was reported once, and no other; no line says `FAIL` and no simulator message says
//! error. Everything else is a failure.

use crate::process::Output;
use crate::run::StimulusResult;

pub(crate) struct Verdict {
    pub(crate) stimuli: Vec<StimulusResult>,
    pub(crate) warnings: Vec<String>,
    pub(crate) failure: Option<String>,
}

/// Judges a simulation that should have reported the `expected` stimuli.
pub(crate) fn judge(output: &Output, expected: &[String]) -> Verdict {
    let said: Vec<&str> = output.stdout.lines().map(str::trim_end).collect();
    let said: Vec<&str> = said
        .into_iter()
        .filter(|line| !line.is_empty() && !is_simulator_note(line))
        .collect();
    let stimuli = reported(&said);
    let failure = reason(output, &said, &stimuli, expected)
        .map(|reason| format!("{reason}\n{}", output.tail()).trim_end().to_owned());
    Verdict {
        warnings: said
            .iter()
            .copied()
            .chain(output.stderr.lines())
            .filter(|line| is_message(line, "warning"))
            .map(str::to_owned)
            .collect(),
        stimuli,
        failure,
    }
}

fn reason(
    output: &Output,
    said: &[&str],
    stimuli: &[StimulusResult],
    expected: &[String],
) -> Option<String> {
    if let Some(trouble) = output.trouble() {
        return Some(format!("the simulation {trouble}"));
    }
    if let Some(failed) = stimuli.iter().find(|it| !it.passed) {
        let detail = match failed.detail.as_str() {
            "" => "the testbench does not say why",
            detail => detail,
        };
        return Some(format!("stimulus {} failed: {detail}", failed.name));
    }
    let error = said
        .iter()
        .copied()
        .chain(output.stderr.lines())
        .find(|line| is_message(line, "error"));
    if let Some(error) = error {
        return Some(format!("the simulator reported an error: {error}"));
    }
    match said.split_last() {
        None => return Some("the testbench said nothing".to_owned()),
        Some((&"PASS", before)) if before.iter().all(|it| !is_bare(it)) => (),
        Some((&"PASS", _)) => {
            return Some("the testbench gave more than one verdict".to_owned());
        }
        Some((last, _)) => {
            return Some(format!("the last line should be `PASS` and is `{last}`"));
        }
    }
    for name in expected {
        match stimuli.iter().filter(|it| it.name == *name).count() {
            1 => (),
            0 => {
                return Some(format!(
                    "vectors/{name}.vec is there, but the testbench did not report it"
                ));
            }
            n => return Some(format!("stimulus {name} was reported {n} times")),
        }
    }
    for it in stimuli {
        if !expected.contains(&it.name) {
            return Some(format!(
                "stimulus {} was reported, but vectors/{}.vec is missing",
                it.name, it.name
            ));
        }
        if it.samples == Some(0) {
            return Some(format!("stimulus {} compared no sample", it.name));
        }
    }
    stimuli
        .is_empty()
        .then(|| "no stimulus was reported".to_owned())
}

/// Every stimulus, a failed one with what was said right before its verdict: the first difference.
fn reported(said: &[&str]) -> Vec<StimulusResult> {
    let mut stimuli = vec![];
    let mut before = "";
    for line in said {
        if let Some(mut one) = stimulus(line) {
            if !one.passed && one.detail.is_empty() && before.starts_with("signal ") {
                one.detail = before.to_owned();
            }
            stimuli.push(one);
        }
        before = line;
    }
    stimuli
}

/// `PASS name: detail` or `FAIL name: detail`.
fn stimulus(line: &str) -> Option<StimulusResult> {
    let (verdict, rest) = line.split_once(char::is_whitespace)?;
    let passed = match verdict {
        "PASS" => true,
        "FAIL" => false,
        _ => return None,
    };
    let rest = rest.trim_start();
    let (name, detail) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    let detail = detail.trim();
    Some(StimulusResult {
        name: name.trim_end_matches([':', ',']).to_owned(),
        passed,
        samples: if passed { samples_in(detail) } else { None },
        detail: detail.to_owned(),
    })
}

/// The number in `… 2000 samples …`.
fn samples_in(detail: &str) -> Option<u64> {
    let words: Vec<&str> = detail
        .split(|c: char| c.is_whitespace() || matches!(c, '(' | ')' | ','))
        .collect();
    words
        .windows(2)
        .find(|pair| pair[1] == "samples" || pair[1] == "sample")
        .and_then(|pair| pair[0].parse().ok())
}

fn is_bare(line: &str) -> bool {
    line == "PASS" || line == "FAIL"
}

/// Verilator's remarks such as `- tb/chip_tb.v:90: Verilog $finish`.
fn is_simulator_note(line: &str) -> bool {
    line.starts_with("- ")
}

/// `WARNING: file:line: …` of vvp, `%Warning: file:line: …` of Verilator.
fn is_message(line: &str, kind: &str) -> bool {
    let line = line.strip_prefix('%').unwrap_or(line);
    line.get(..kind.len())
        .is_some_and(|start| start.eq_ignore_ascii_case(kind))
        && line[kind.len()..].starts_with([':', '-'])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::End;
    use std::process::ExitStatus;

    fn judged(stdout: &str) -> Verdict {
        let output = Output {
            stdout: stdout.to_owned(),
            stderr: String::new(),
            end: End::Exit(ExitStatus::default()),
            seconds: 0.0,
        };
        judge(&output, &["ramp".to_owned(), "step".to_owned()])
    }

    #[test]
    fn a_clean_report_passes_with_its_samples() {
        let verdict = judged(
            "PASS ramp: 20 samples\nPASS step (7 samples)\nPASS\n- x.v:1: Verilog $finish\n",
        );
        assert_eq!(verdict.failure, None);
        assert_eq!(verdict.stimuli[0].samples, Some(20));
        assert_eq!(verdict.stimuli[1].samples, Some(7));
    }

    #[test]
    fn everything_else_fails() {
        for (said, why) in [
            ("", "said nothing"),
            ("PASS\n", "did not report it"),
            ("PASS ramp\nPASS\n", "vectors/step.vec is there"),
            ("PASS ramp\nPASS step\n", "the last line should be `PASS`"),
            ("PASS ramp\nPASS step\nPASS \nmore\n", "is `more`"),
            ("PASS ramp\nPASS step\nPASSED\n", "is `PASSED`"),
            (
                "PASS ramp\nPASS step\nPASS\nPASS\n",
                "more than one verdict",
            ),
            (
                "PASS ramp\nPASS step\nFAIL\nPASS\n",
                "more than one verdict",
            ),
            (
                "PASS ramp\nFAIL step: signal x\nPASS\n",
                "stimulus step failed: signal x",
            ),
            (
                "PASS ramp\nsignal e sample 3 expected 1 actual 0\nFAIL step\nFAIL\n",
                "stimulus step failed: signal e sample 3 expected 1 actual 0",
            ),
            (
                "signal e sample 3 expected 1 actual 0\nPASS ramp\nFAIL step\nFAIL\n",
                "stimulus step failed: the testbench does not say why",
            ),
            (
                "PASS ramp\nPASS ramp\nPASS step\nPASS\n",
                "reported 2 times",
            ),
            (
                "PASS ramp\nPASS step\nPASS other\nPASS\n",
                "other.vec is missing",
            ),
            ("PASS ramp: 0 samples\nPASS step\nPASS\n", "no sample"),
            (
                "ERROR: x.v:1: $readmemh: Unable to open rom.hex\nPASS ramp\nPASS step\nPASS\n",
                "reported an error",
            ),
        ] {
            let failure = judged(said).failure.expect("a failure");
            assert!(failure.contains(why), "{said:?} gave {failure:?}");
        }
    }

    #[test]
    fn a_simulators_warning_is_kept() {
        let verdict =
            judged("WARNING: x.v:1: $readmemh: Not enough words\nPASS ramp\nPASS step\nPASS\n");
        assert_eq!(verdict.warnings.len(), 1);
        assert_eq!(verdict.failure, None);
    }
}
