//! The verdict on a toy chip in real simulators: it passes whole, and nothing less passes.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::support::Toy;
use nonius_hdl::progress::{Event, silent};
use nonius_hdl::tools::Tool;
use nonius_hdl::{Options, Run, icarus, verify};

const SECONDS: Duration = Duration::from_secs(20);

/// Where a tool is missing the message names the install command.
fn in_icarus(toy: &Toy) -> Run {
    icarus::simulate(&toy.open(), SECONDS, &[], &silent).unwrap_or_else(|it| panic!("{it}"))
}

/// Icarus refuses the toy, and says so with these words.
#[track_caller]
fn refused(toy: &Toy, words: &str) {
    let run = in_icarus(toy);
    assert!(!run.passed);
    let failure = run.failure.expect("a failure");
    assert!(failure.contains(words), "{words:?} is not in {failure:?}");
}

#[test]
fn the_toy_passes_in_both_simulators() {
    let toy = Toy::new();
    let before = toy.contents();
    let events = Mutex::new(Vec::new());
    let report = verify(toy.path(), &Options::default(), &|event| {
        events.lock().expect("nobody panicked").push(event);
    })
    .unwrap_or_else(|it| panic!("{it}"));

    assert!(report.passed, "{report:#?}");
    assert_eq!(report.disagreements, Vec::<String>::new());
    assert_eq!(report.runs.len(), 2);
    for run in &report.runs {
        assert_eq!(run.warnings, Vec::<String>::new(), "{}", run.tool);
        assert_eq!(run.samples, Some(26), "{}", run.tool);
        assert!(run.version.starts_with(|c: char| c.is_ascii_digit()));
    }
    for tool in [Tool::Iverilog, Tool::Verilator] {
        let steps = [
            Event::Building(tool),
            Event::Simulating(tool),
            Event::Finished(tool),
        ];
        let mut heard = events.lock().expect("nobody panicked").clone();
        heard.retain(|it| steps.contains(it));
        assert_eq!(heard, steps);
    }
    assert_eq!(toy.contents(), before, "the chip's directory was touched");
}

#[test]
fn a_planted_fault_is_named_alike_by_both_simulators() {
    let toy = Toy::new().replace("rtl/adder_core.v", "total <= a + b", "total <= a - b");
    let report = verify(toy.path(), &Options::default(), &silent).expect("the tools run");
    assert!(!report.passed);
    assert_eq!(report.disagreements, Vec::<String>::new());
    for run in &report.runs {
        assert!(!run.passed);
        let ramp = run
            .stimuli
            .iter()
            .find(|it| it.name == "ramp")
            .expect("the stimulus");
        assert!(!ramp.passed);
        assert_eq!(
            ramp.detail,
            "signal total sample 0 expected -120 actual -80"
        );
        let failure = run.failure.as_ref().expect("a failure");
        assert!(failure.starts_with("stimulus ramp failed: signal total"));
    }
}

#[test]
fn a_hanging_testbench_is_stopped_at_its_limit() {
    let toy = Toy::new()
        .replace("tb/chip_tb.v", "#1000000;", "wait (0);")
        .replace(
            "tb/chip_tb.v",
            "replay(\"corners\", \"vectors/corners.vec\");",
            "wait (0);",
        );
    let start = Instant::now();
    let options = Options {
        time_limit: Some(Duration::from_secs(1)),
        ..Options::default()
    };
    let report = verify(toy.path(), &options, &silent).expect("the tools run");
    assert!(start.elapsed() < Duration::from_secs(60));
    assert!(!report.passed);
    for run in &report.runs {
        let failure = run.failure.as_ref().expect("a failure");
        assert!(
            failure.starts_with("the simulation was stopped at its time limit of 1 s"),
            "{failure}"
        );
    }
}

#[test]
fn a_testbench_that_leaves_a_stimulus_out_is_refused() {
    refused(
        &Toy::new().replace(
            "tb/chip_tb.v",
            "replay(\"corners\", \"vectors/corners.vec\");",
            "",
        ),
        "vectors/corners.vec is there, but the testbench did not report it",
    );
}

#[test]
fn a_testbench_that_stops_before_its_verdict_is_refused() {
    refused(
        &Toy::new().replace(
            "tb/chip_tb.v",
            "replay(\"corners\", \"vectors/corners.vec\");",
            "replay(\"corners\", \"vectors/corners.vec\"); $finish(0);",
        ),
        "the last line should be `PASS` and is `PASS corners: 6 samples`",
    );
}

#[test]
fn a_testbench_that_only_says_pass_is_refused() {
    refused(
        &Toy::new().write(
            "tb/chip_tb.v",
            "module chip_tb; initial begin $display(\"PASS\"); $finish(0); end endmodule\n",
        ),
        "the testbench did not report it",
    );
}

#[test]
fn a_testbench_that_stops_with_an_exit_code_is_refused() {
    refused(
        &Toy::new().replace(
            "tb/chip_tb.v",
            "else $display(\"FAIL\");\n        $finish(0);",
            "else $display(\"FAIL\");\n        $stop;",
        ),
        "the simulation ended with exit status: 1",
    );
}

#[test]
fn an_empty_vector_file_is_refused() {
    refused(
        &Toy::new().write("vectors/corners.vec", ""),
        "stimulus corners compared no sample",
    );
}

#[test]
fn an_endless_printer_is_stopped() {
    let toy = Toy::new().replace(
        "tb/chip_tb.v",
        "replay(\"corners\", \"vectors/corners.vec\");",
        "while (1) $display(\"a line of text that goes on and on and on and on and on\");",
    );
    refused(&toy, "the simulation was stopped");
}

#[test]
fn verilog_that_does_not_compile_is_a_failure_that_names_the_place() {
    refused(
        &Toy::new().replace("rtl/adder_core.v", "endmodule", ""),
        "rtl/adder_core.v",
    );
}

#[test]
fn a_compilers_warning_is_reported() {
    let toy = Toy::new().replace("tb/chip_tb.v", ".a(a)", ".a({1'b0, a})");
    let run = in_icarus(&toy);
    assert!(
        run.warnings
            .iter()
            .any(|it| it.starts_with("tb/chip_tb.v:") && it.contains("expects 8 bits")),
        "{:?}",
        run.warnings
    );
}

#[test]
fn a_directory_that_is_no_chip_is_refused_by_name() {
    let empty = tempfile::tempdir().expect("a scratch folder");
    let error = verify(empty.path(), &Options::default(), &silent)
        .expect_err("no chip")
        .to_string();
    assert!(error.contains("design.json"), "{error}");
    assert!(error.contains("nonius build"), "{error}");
}
