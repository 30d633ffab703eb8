//! Long statements and sentences on several lines.

/// Columns of a line, indentation included.
const COLUMNS: usize = 120;
/// Columns of a comment behind its `// `.
pub(crate) const COMMENT: usize = COLUMNS - 3;
/// What stands before a statement of the module.
const INDENT: usize = 4;

/// Statements as they stand in the module.
pub(crate) fn laid_out(statements: &[String]) -> Vec<String> {
    statements.iter().flat_map(|one| fitted(one)).collect()
}

/// Where it is too long for one line, its value is below its name, and a value that is
/// still too long is broken at its signs.
fn fitted(statement: &str) -> Vec<String> {
    let fits = |text: &str, deeper: usize| INDENT + deeper + text.len() <= COLUMNS;
    let (code, comment) = match statement.split_once(" // ") {
        Some((code, comment)) => (code, format!(" // {comment}")),
        None => (statement, String::new()),
    };
    let Some((head, value)) = code.split_once(" = ").filter(|_| !fits(statement, 0)) else {
        return vec![statement.to_owned()];
    };
    let mut lines = vec![format!("{head} ={comment}")];
    if fits(value, INDENT) {
        lines.push(format!("    {value}"));
        return lines;
    }
    let mut parts = broken(value).into_iter();
    lines.extend(parts.next().map(|first| format!("    {first}")));
    lines.extend(parts.map(|part| format!("        {part}")));
    lines
}

/// `condition ? yes : no` at both signs, else a sum or a decision before its first sign; signs in brackets are none.
fn broken(value: &str) -> Vec<&str> {
    let sign = |signs: &[&str], from: usize| {
        let places = signs.iter().filter_map(|sign| outside(value, sign, from));
        places.min()
    };
    let Some(first) = sign(&[" ? "], 0).or_else(|| sign(&[" + ", " - ", " & ", " | ", " ^ "], 0))
    else {
        return vec![value];
    };
    let (condition, rest) = (&value[..first], &value[first + 1..]);
    match sign(&[" : "], first) {
        Some(colon) => vec![condition, &value[first + 1..colon], &value[colon + 1..]],
        None => vec![condition, rest],
    }
}

/// Where `sign` stands in `text` in no bracket, from a place on.
fn outside(text: &str, sign: &str, from: usize) -> Option<usize> {
    let mut depth = 0;
    for (place, c) in text.char_indices() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            _ if depth == 0 && place >= from && text[place..].starts_with(sign) => {
                return Some(place);
            }
            _ => {}
        }
    }
    None
}

/// `words` behind `first`, broken at `columns`; further lines are indented as far.
pub(crate) fn wrap(first: &str, words: &str, columns: usize) -> Vec<String> {
    let blank = " ".repeat(first.len());
    let mut rows = vec![];
    let mut line = first.to_owned();
    let mut fresh = true;
    for word in words.split_whitespace() {
        if !fresh && line.len() + 1 + word.len() > columns {
            rows.push(line.trim_end().to_owned());
            line = blank.clone();
            fresh = true;
        }
        if !fresh {
            line.push(' ');
        }
        line.push_str(word);
        fresh = false;
    }
    rows.push(line.trim_end().to_owned());
    rows
}

/// Words by which tools take a comment that begins with one of them for an order.
const ORDERS: [&str; 16] = [
    "altera",
    "ambit",
    "cadence",
    "coverage",
    "exemplar",
    "intel",
    "lattice",
    "leda",
    "pragma",
    "spyglass",
    "synopsys",
    "synplify",
    "synthesis",
    "vcs",
    "verilator",
    "xilinx",
];

fn is_order(line: &str) -> bool {
    let small = line.to_ascii_lowercase();
    ORDERS.iter().any(|order| small.starts_with(order))
}

/// A line of a comment in the user's words, which no tool takes for an order to it.
pub(crate) fn no_order(line: &str) -> String {
    let guard = if is_order(line) { "- " } else { "" };
    format!("{guard}{line}")
}

/// Lines of a comment in the user's words.
pub(crate) fn users_comment(words: &str) -> Vec<String> {
    let lines = wrap("", words, COMMENT);
    if !lines.iter().any(|line| is_order(line)) {
        return lines;
    }
    // With room for what stands before an order.
    let lines = wrap("", words, COMMENT - 2);
    lines.iter().map(|line| no_order(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_comment_of_the_users_is_an_order() {
        for line in [
            "verilator waves of it",
            "Verilator_x: a chip",
            "synopsys translate_off",
        ] {
            assert_eq!(no_order(line), format!("- {line}"));
        }
        assert_eq!(no_order("optical: verilator"), "optical: verilator");
        let words = "a chip whose waves are looked at in the ".repeat(3) + "verilator";
        for width in 0..60 {
            let lines = users_comment(&format!("{}{words}", "x ".repeat(width)));
            assert!(lines.iter().all(|l| !is_order(l) && l.len() <= COMMENT));
        }
    }

    #[test]
    fn what_fits_stays() {
        assert_eq!(
            fitted("wire a = b ? c : d; // step 1"),
            ["wire a = b ? c : d; // step 1"]
        );
    }

    #[test]
    fn a_long_sum_stands_below_its_name() {
        let (name, sum) = ("n".repeat(60), "s".repeat(60));
        let lines = fitted(&format!("wire {name} = {sum}; // step 1"));
        assert_eq!(
            lines,
            [format!("wire {name} = // step 1"), format!("    {sum};")]
        );
    }

    #[test]
    fn a_longer_sum_stands_on_two_lines() {
        let (a, b) = (format!("{{{} - 1}}", "a".repeat(60)), "b".repeat(60));
        let lines = fitted(&format!("wire x = {a} + {b};"));
        assert_eq!(
            lines,
            [
                "wire x =".to_owned(),
                format!("    {a}"),
                format!("        + {b};")
            ]
        );
    }

    #[test]
    fn a_long_choice_stands_on_four_lines() {
        let (condition, yes) = ("c".repeat(60), "y".repeat(60));
        let lines = fitted(&format!(
            "wire x = ({condition} ? 1 : 0) ? {yes} : {{y ? 1 : 0}}; // step 1 : 2"
        ));
        let expected = [
            "wire x = // step 1 : 2".to_owned(),
            format!("    ({condition} ? 1 : 0)"),
            format!("        ? {yes}"),
            "        : {y ? 1 : 0};".to_owned(),
        ];
        assert_eq!(lines, expected);
    }
}
