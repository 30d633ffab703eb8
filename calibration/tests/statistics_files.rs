//! docs/offline-statistics.json and .md: fresh, and holding what the README promises of them.

use crate::support::table;
use serde_json::Value;

fn numbers() -> Value {
    serde_json::from_str(&std::fs::read_to_string(table::NUMBERS).expect("a kept file"))
        .expect("there is one")
}

fn list(row: &Value, name: &str) -> Vec<f64> {
    let all = row[name].as_array().expect("there is one");
    all.iter()
        .map(|v| v.as_f64().expect("there is one"))
        .collect()
}

#[test]
fn the_page_is_made_from_the_numbers() {
    let page = std::fs::read_to_string(table::PAGE).expect("a kept file");
    assert_eq!(
        page,
        table::page(&numbers()),
        "stale; run `{}`",
        table::COMMAND
    );
}

/// The first seeds of every case give what the file holds of them, to rounding of the machine's functions.
#[test]
fn the_numbers_are_those_of_this_program() {
    let numbers = numbers();
    let rows = numbers["rows"].as_array().expect("there is one");
    let cases = table::cases();
    let stale = format!("stale; run `{}`", table::COMMAND);
    assert_eq!(rows.len(), cases.len(), "{stale}");
    for ((case, _), kept) in cases.iter().zip(rows) {
        let probe = case.run(0..table::PROBE, &|| ());
        let now = table::row(case, &probe, &probe);
        for name in ["method", "sensor", "noise", "periods"] {
            assert_eq!(now[name], kept[name], "{stale}");
        }
        for name in ["bias", "spread", "stated"] {
            let pairs = list(&now["probe"], name)
                .into_iter()
                .zip(list(&kept["probe"], name));
            for (now, kept) in pairs {
                let near = (now - kept).abs() < 1e-6 * (1.0 + kept.abs());
                assert!(near, "{case:?} {name}: {now}, kept {kept}; {stale}");
            }
        }
    }
}

/// 0.1 % to 5 % of noise over whole periods, and 1.7 : 1 between the channels.
#[test]
fn what_is_promised_is_in_the_file() {
    let numbers = numbers();
    let promised: Vec<&Value> = numbers["rows"]
        .as_array()
        .expect("there is one")
        .iter()
        .filter(|row| row["method"] == "unbiased" && row["periods"] == 7.0)
        .collect();
    assert_eq!(promised.len(), 7 + 9);
    for row in promised {
        assert_eq!((&row["seeds"], &row["refused"]), (&2000.into(), &0.into()));
        for bias in list(row, "bias") {
            assert!(bias.abs() < 0.1, "{row}");
        }
        for spread in list(row, "spread") {
            assert!((spread - 1.0).abs() < 0.05, "{row}");
        }
        for coverage in list(row, "coverage") {
            assert!((0.93..=0.97).contains(&coverage), "{row}");
        }
    }
}
