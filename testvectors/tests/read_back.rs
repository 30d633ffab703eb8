//! Vectors and waves are read back and replayed: model, recorded graph and scheduled graph agree with every value.

use std::collections::HashMap;

use crate::shipped;
use crate::shipped::variants::kinds;
use nonius_codegen::evaluate::evaluate;
use nonius_codegen::schedule::schedule;
use nonius_codegen::{Files, generate};
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::graph::{Evaluation, Kind};
use nonius_model::spec::Coding;
use nonius_testvectors::read_vectors::{Row, rows};
use nonius_testvectors::waves::{Waves, gtkw};
use nonius_testvectors::{stimulus, vectors};

const ROWS: usize = 120;

fn chip_files(design: &Design) -> Files {
    generate(design, "test", &[]).expect("templates render")
}

fn word(raw: i128, bits: u32) -> u64 {
    (raw as u128 & ((1u128 << bits) - 1)) as u64
}

/// A column as the graph wants it: an integer with its sign, if it has one.
fn integer(word: u64, bits: u32, unsigned: bool) -> i128 {
    let word = i128::from(word);
    if !unsigned && word >> (bits - 1) & 1 == 1 {
        word - (1i128 << bits)
    } else {
        word
    }
}

/// Every row of every stimulus: the graph, given the registers of the row before and the inputs of this one, and the
/// schedule on one and on three multipliers, give what the row says.
#[test]
fn vectors_replay_through_recorded_and_scheduled_graph() {
    for kind in kinds() {
        replays(&kind.what, &kind.design());
    }
}

fn replays(kind: &str, design: &Design) {
    let files = chip_files(design);
    let graph = &design.graph;
    let signed = design.spec.adc.coding == Coding::TwosComplement;
    let schedules = [1, 3].map(|m| schedule(graph, m));
    for stimulus in stimulus::named(design, ROWS) {
        let text = vectors::rows(design, &stimulus, &files.columns);
        let read: Vec<Row> =
            rows(&text, design.spec.adc.bits, signed, files.columns.len()).expect("rows");
        assert_eq!(read.len(), ROWS);
        let mut registers: HashMap<&str, i128> = HashMap::new();
        for (row, sample) in read.iter().zip(&stimulus.samples) {
            assert_eq!(row.input, *sample, "{}", stimulus.name);
            let input = |name: &str| match name {
                "adc_cos" => row.input.cos.into(),
                "adc_sin" => row.input.sin.into(),
                "preset" => row.input.preset.into(),
                "calibrate" => row.input.calibrate.into(),
                other => registers.get(other).copied().unwrap_or(0),
            };
            let recorded = Evaluation::new(graph, input);
            let timed: Vec<_> = schedules
                .iter()
                .map(|s| evaluate(graph, s, input))
                .collect();
            let mut after = HashMap::new();
            for ((name, id, bits), seen) in files.columns.iter().zip(&row.words) {
                let next = graph.next.iter().find(|n| n.0 == *name).map(|n| n.1);
                let node = next.unwrap_or(*id);
                let place = || format!("{kind}: {} sample {} {name}", stimulus.name, row.number);
                assert_eq!(word(recorded.raw(node), *bits), *seen, "{}", place());
                for timed in &timed {
                    let raw = timed[node.index()].unwrap_or_else(|| panic!("{} lost", place()));
                    assert_eq!(word(raw, *bits), *seen, "{}", place());
                }
                if next.is_some() {
                    let flag = graph.node(*id).kind == Kind::Flag;
                    after.insert(name.as_str(), integer(*seen, *bits, flag));
                }
            }
            registers = after;
        }
    }
}

#[test]
fn waves_read_back_as_the_chip() {
    for kind in kinds() {
        waves_read_back(&kind.what, &kind.design());
    }
}

fn waves_read_back(kind: &str, design: &Design) {
    let files = chip_files(design);
    let stimuli = stimulus::named(design, ROWS);
    let sweep = stimuli.iter().find(|s| s.name == "sweep").expect("sweep");
    let mut bytes = vec![];
    let mut chip = Chip::bit_true(design);
    let mut waves = Waves::new(&mut bytes, design, &files.columns, files.clocks).expect("memory");
    for s in &sweep.samples {
        let probes = chip.step_codes(s.cos, s.sin, s.preset, s.calibrate);
        waves.sample(s, &probes, &chip).expect("memory");
    }
    waves.finish().expect("memory");

    // Read as any viewer would: values by hierarchical name over time.
    let mut parser = vcd::Parser::new(&bytes[..]);
    let header = parser.parse_header().expect("a header");
    let path = |name: &str| {
        let found = header.find_var(&["chip_tb", "chip", name]);
        found.unwrap_or_else(|| panic!("no {name}")).code
    };
    let mut now: HashMap<vcd::IdCode, u128> = HashMap::new();
    let mut reals: HashMap<vcd::IdCode, f64> = HashMap::new();
    let strobes = ["clk", "rst_n", "sample_valid", "valid"].map(path);
    let mut time = 0;
    let (mut pins, mut results) = (vec![], vec![]);
    for command in parser {
        match command.expect("a command") {
            vcd::Command::Timestamp(t) => {
                let now_at = strobes.map(|id| now.get(&id) == Some(&1));
                // Results stand where `valid` rises.
                if now_at[3] && !pins.last().is_some_and(|last: &(u64, [bool; 4])| last.1[3]) {
                    results.push((time, now.clone(), reals.clone()));
                }
                pins.push((time, now_at));
                time = t;
            }
            vcd::Command::ChangeScalar(id, value) => {
                now.insert(id, u128::from(value == vcd::Value::V1));
            }
            vcd::Command::ChangeVector(id, values) => {
                let bits = values.iter().map(|v| u128::from(v == vcd::Value::V1));
                now.insert(id, bits.fold(0, |word, bit| word << 1 | bit));
            }
            vcd::Command::ChangeReal(id, value) => {
                reals.insert(id, value);
            }
            _ => {}
        }
    }
    // Half clocks: two clocks of reset, then sample after sample.
    let each = 2 * files.clocks;
    let drawn = (0..4 + each * ROWS).map(|i| {
        let (sample, half) = (i.saturating_sub(4) / each, i.saturating_sub(4) % each);
        let running = i >= 4;
        let valid = running && (half == each - 1 || half == 0 && sample > 0);
        let pins = [i % 2 == 1, running, running && half < 2, valid];
        (5 * i as u64, pins)
    });
    assert_eq!(pins, drawn.collect::<Vec<_>>(), "{kind}");
    assert_eq!(results.len(), ROWS, "{kind}");
    let mut replay = Chip::bit_true(design);
    let edge = |name: &str| header.find_var(&["chip_tb", name]).expect("a wave").code;
    for (k, (stamp, values, analogue)) in results.iter().enumerate() {
        let bits = design.spec.adc.bits;
        let unsigned = design.spec.adc.coding == Coding::OffsetBinary;
        let code = |name: &str| integer(values[&path(name)] as u64, bits, unsigned) as i64;
        let probes = replay.step_codes(
            code("adc_cos"),
            code("adc_sin"),
            values[&path("preset")] == 1,
            values[&path("calibrate")] == 1,
        );
        assert_eq!(
            *stamp as usize,
            (2 + k * files.clocks + files.clocks - 1) * 10 + 5
        );
        for (name, id, bits) in &files.columns {
            let node = design.graph.node(*id);
            let expected = if node.kind == Kind::Flag {
                let flag = probes.flag(name).or_else(|| replay.state.flag(name));
                i64::from(flag.expect("a flag"))
            } else {
                let value = probes.value(name).or_else(|| replay.state.value(name));
                value.expect("a value").raw(node.format.fraction)
            };
            assert_eq!(
                values[&path(name)],
                u128::from(word(expected.into(), *bits)),
                "{kind}: {name} at {k}"
            );
        }
        let real = |name: &str| analogue[&edge(name)];
        let value = |name: &str| {
            let value = probes.value(name).or_else(|| replay.state.value(name));
            value.expect("a value").to_f64()
        };
        assert_eq!(real("position_periods"), replay.position(), "{kind}: {k}");
        assert_eq!(real("alpha_hat_turns"), value("alpha_hat"), "{kind}: {k}");
        assert_eq!(
            real("speed_turns_per_sample"),
            value("speed"),
            "{kind}: {k}"
        );
        let f = &design.structure.formats;
        let all = (1u128 << (f.count.format.width + f.alpha.format.width)) - 1;
        let position = replay.position_raw() as u128 & all;
        assert_eq!(values[&path("position")], position, "{kind}: {k}");
    }
}

#[test]
fn the_save_file_names_signals_that_are_there() {
    let design = shipped::design("optical");
    let files = chip_files(&design);
    let mut bytes = vec![];
    Waves::new(&mut bytes, &design, &files.columns, files.clocks)
        .and_then(Waves::finish)
        .expect("memory");
    let mut parser = vcd::Parser::new(&bytes[..]);
    let header = parser.parse_header().expect("a header");
    let save = gtkw("sweep", &design, &files.columns, files.clocks);
    let named: Vec<&str> = save.lines().take(2).collect();
    assert_eq!(
        named,
        ["[dumpfile] \"sweep.vcd\"", "[savefile] \"sweep.gtkw\""]
    );
    let signals: Vec<&str> = save.lines().filter(|l| l.starts_with("chip_tb.")).collect();
    assert!(signals.len() > files.columns.len());
    for signal in signals {
        let name = signal.split('[').next().expect("a name");
        let parts: Vec<&str> = name.split('.').collect();
        let var = header
            .find_var(&parts)
            .unwrap_or_else(|| panic!("no {signal}"));
        let range = var.index.map(|i| i.to_string()).unwrap_or_default();
        assert_eq!(format!("{name}{range}"), signal);
    }
}

/// A chip without calibration has the loop's signals, and its parameters; what else another has is calibration.
#[test]
fn the_save_file_tells_loop_and_calibration_apart() {
    let groups = |parameters| {
        let mut spec = shipped::optical();
        spec.calibration.parameters = parameters;
        let design = Design::new(&spec).expect("a design");
        let files = chip_files(&design);
        let save = gtkw("sweep", &design, &files.columns, files.clocks);
        let (_, groups) = save.split_once("-loop\n").expect("a group");
        let (own, others) = groups.split_once("-calibration\n").expect("another");
        [own, others].map(|group| -> Vec<String> {
            let signals = group
                .lines()
                .filter_map(|l| l.strip_prefix("chip_tb.chip."));
            signals
                .map(|s| s.split('[').next().expect("a name").to_owned())
                .collect()
        })
    };
    let [own, parameters] = groups(0);
    assert!(
        parameters.iter().all(|n| n.starts_with("theta_")),
        "{parameters:?}"
    );
    let [same, calibration] = groups(5);
    assert_eq!(own, same);
    for name in ["theta_1_deviation", "held_periods", "running_1", "held"] {
        assert!(
            calibration.iter().any(|n| n == name),
            "{name}: {calibration:?}"
        );
    }
}

/// Every byte of two rows in every other value, of each fifth stimulus: what is read all the same is what stands there.
#[test]
fn damaged_vectors_are_refused_by_line() {
    let design = shipped::design("optical");
    let files = chip_files(&design);
    let stimuli = stimulus::named(&design, 2);
    let read = |text: &str| rows(text, design.spec.adc.bits, true, files.columns.len());
    let words = |text: &str| -> Vec<String> {
        let lower = |word: &str| word.to_lowercase().trim_start_matches('0').to_owned();
        text.split_whitespace().map(lower).collect()
    };
    let mut refused = 0;
    for stimulus in stimuli.iter().step_by(5) {
        let text = vectors::rows(&design, stimulus, &files.columns);
        let (sound, meant) = (read(&text).expect("rows"), words(&text));
        for at in 0..text.len() {
            for byte in 0..=u8::MAX {
                let mut bytes = text.clone().into_bytes();
                bytes[at] = byte;
                let damaged = String::from_utf8_lossy(&bytes);
                match read(&damaged) {
                    Ok(read) => assert_eq!(
                        sound == read,
                        words(&damaged) == meant,
                        "{}: byte {at} as {byte}",
                        stimulus.name
                    ),
                    Err(error) => {
                        assert!((1..=3).contains(&error.line), "{error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(refused > 0);
}
