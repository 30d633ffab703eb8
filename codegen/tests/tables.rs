//! Every table file holds the table.

use crate::shipped;
use nonius_codegen::generate;

fn hex(text: &str) -> u128 {
    u128::from_str_radix(text.trim(), 16).unwrap_or_else(|_| panic!("{text:?} is not hexadecimal"))
}

#[test]
fn every_format_reads_back_as_the_table() {
    let design = shipped::design("optical");
    let files = generate(&design, "0123", &[])
        .expect("templates render")
        .files;
    let file = |ending: &str| {
        let name = format!("coefficients/sine_table.{ending}");
        let found = files.iter().find(|f| f.0 == name);
        found.unwrap_or_else(|| panic!("no {name}")).1.clone()
    };
    let rom = &design.structure.sine;
    let table: Vec<u128> = (0..rom.rows()).map(|row| rom.word(row)).collect();

    for ending in ["mem", "hex"] {
        let rows: Vec<u128> = file(ending).lines().map(hex).collect();
        assert_eq!(rows, table, "{ending}");
    }

    let coe = file("coe");
    assert!(coe.contains("memory_initialization_radix=16;"));
    let vector = coe
        .split("memory_initialization_vector=")
        .nth(1)
        .expect("a vector");
    let vector = vector
        .trim()
        .strip_suffix(';')
        .expect("the vector ends with ;");
    assert_eq!(vector.split(',').map(hex).collect::<Vec<_>>(), table);

    let mif = file("mif");
    assert!(mif.contains(&format!(
        "WIDTH={};\nDEPTH={};",
        rom.row_width(),
        rom.rows()
    )));
    let content = mif.split("CONTENT BEGIN").nth(1).expect("content");
    let content = content.split("END;").next().expect("an end");
    let rows: Vec<(u128, u128)> = content
        .split(';')
        .filter_map(|row| row.split_once(':'))
        .map(|(address, word)| (hex(address), hex(word)))
        .collect();
    assert_eq!(rows.len(), table.len());
    for (address, word) in rows {
        assert_eq!(word, table[address as usize]);
    }

    let vh = file("vh");
    let rows: Vec<u128> = vh
        .lines()
        .filter_map(|line| line.split_once("'h"))
        .map(|(_, word)| hex(word.trim_end_matches(';')))
        .collect();
    assert_eq!(rows, table);

    let json: serde_json::Value = serde_json::from_str(&file("json")).expect("JSON");
    let words: Vec<u128> = json["words"]
        .as_array()
        .expect("words")
        .iter()
        .map(|w| hex(w.as_str().expect("a word")))
        .collect();
    assert_eq!(words, table);
    for (column, expected) in json["columns"]
        .as_array()
        .expect("columns")
        .iter()
        .zip(&rom.columns)
    {
        let raw: Vec<i64> = serde_json::from_value(column["raw"].clone()).expect("integers");
        assert_eq!(raw, expected.raw);
    }
}

#[test]
fn coefficients_are_those_of_the_design() {
    let design = shipped::design("optical");
    let files = generate(&design, "0123", &[])
        .expect("templates render")
        .files;
    let json = files
        .iter()
        .find(|f| f.0 == "coefficients/coefficients.json");
    let json: serde_json::Value = serde_json::from_str(&json.expect("a file").1).expect("JSON");
    let list = json["coefficients"].as_array().expect("a list");
    let value = |name: &str| {
        let found = list.iter().find(|c| c["name"] == name);
        found.unwrap_or_else(|| panic!("no {name}"))["value"].as_f64()
    };
    assert_eq!(value("loop_a"), Some(design.constants.loop_a.value()));
    assert_eq!(value("loop_ab"), Some(design.constants.loop_ab.value()));
    assert_eq!(
        value("theta_1_nominal"),
        Some(design.constants.theta_1_nominal.value())
    );
    let vh = files
        .iter()
        .find(|f| f.0 == "coefficients/coefficients.vh")
        .expect("a file");
    for name in list
        .iter()
        .map(|c| c["name"].as_str().expect("a name").to_uppercase())
    {
        assert!(vh.1.contains(&format!(" {name} = ")), "{name}");
    }
}

/// The coefficients as words of a memory, in every form, and the table of harmonics where there is one.
#[test]
fn memories_hold_the_coefficients_and_every_table() {
    let variant = shipped::variants::harmonics().swap_remove(0);
    let design = variant.design();
    let files = generate(&design, "0123", &[])
        .expect("templates render")
        .files;
    let file = |name: &str| {
        let path = format!("coefficients/{name}");
        let found = files.iter().find(|f| f.0 == path);
        &found.unwrap_or_else(|| panic!("no {path}")).1
    };
    for rom in &design.graph.roms {
        for ending in ["json", "vh", "mem", "hex", "coe", "mif"] {
            assert!(!file(&format!("{}.{ending}", rom.name)).is_empty());
        }
    }
    assert_eq!(design.graph.roms.len(), 2);

    let json: serde_json::Value = serde_json::from_str(file("coefficients.json")).expect("JSON");
    let list = json["coefficients"].as_array().expect("a list");
    let number = |c: &serde_json::Value, key: &str| c[key].as_i64().expect("an integer");
    let bits = list.iter().map(|c| number(c, "bits")).max().expect("some");
    let words: Vec<u128> = list
        .iter()
        .map(|c| number(c, "raw") as u128 & ((1 << bits) - 1))
        .collect();
    for (row, c) in list.iter().enumerate() {
        assert_eq!(number(c, "row"), row as i64);
    }
    for ending in ["mem", "hex"] {
        let rows: Vec<u128> = file(&format!("coefficients.{ending}"))
            .lines()
            .map(hex)
            .collect();
        assert_eq!(rows, words, "{ending}");
    }
    let (_, vector) = file("coefficients.coe")
        .split_once("memory_initialization_vector=")
        .expect("a vector");
    let vector = vector.trim().trim_end_matches(';').split(',').map(hex);
    assert_eq!(vector.collect::<Vec<_>>(), words);
    let mif = file("coefficients.mif");
    assert!(mif.contains(&format!("WIDTH={bits};\nDEPTH={};", words.len())));
    let (_, content) = mif.split_once("CONTENT BEGIN").expect("content");
    let rows = content.split(';').filter_map(|row| row.split_once(':'));
    let rows: Vec<u128> = rows.map(|(_, word)| hex(word)).collect();
    assert_eq!(rows, words);
}
