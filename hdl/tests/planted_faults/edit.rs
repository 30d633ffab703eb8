//! Changes of one place in the Verilog.

/// The same Verilog with each statement on one line, however long.
pub(crate) fn on_one_line(verilog: &str) -> String {
    let mut lines: Vec<String> = vec![];
    for line in verilog.lines() {
        let words = line.trim_start();
        match lines.last_mut() {
            Some(last) if last.ends_with(" =") => *last += &format!(" {words}"),
            // What stands behind the sign is a comment, which ends a line.
            Some(last) if last.contains(" = // ") => {
                let code = last.split_once(" // ").map_or("", |parts| parts.0);
                *last = format!("{code} {words}");
            }
            Some(last) if words.starts_with(['?', ':', '+', '-', '&', '|', '^']) => {
                *last += &format!(" {words}");
            }
            _ => lines.push(line.to_owned()),
        }
    }
    lines.join("\n") + "\n"
}

/// Whether a line holds a word; a wire that a register keeps has another name.
pub(crate) fn holds(line: &str, word: &str) -> bool {
    let other = match word.strip_suffix("_now =") {
        Some(name) => format!("{name} ="),
        None => word.replace(" =", "_now ="),
    };
    line.contains(word) || (word.ends_with(" =") && line.contains(&other))
}

/// The one line that holds all of `words`.
pub(crate) fn line_with<'a>(verilog: &'a str, words: &[&str]) -> &'a str {
    let mut lines = verilog
        .lines()
        .filter(|line| words.iter().all(|word| holds(line, word)));
    let found = lines.next();
    assert!(lines.next().is_none(), "{words:?} stand in two lines");
    found.unwrap_or_else(|| panic!("no line holds {words:?}"))
}

pub(crate) fn replaced(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    assert!(line.contains(from), "{from} is not in {line}");
    verilog.replacen(line, &line.replacen(from, to, 1), 1)
}

/// The text between `from` and `to` in the one line that holds all of `words`.
pub(crate) fn between(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    let rest = line.split_once(from).map(|parts| parts.1);
    let inner = rest.and_then(|rest| rest.split_once(to));
    inner.unwrap_or_else(|| panic!("{line}")).0.to_owned()
}

/// The chip that commits some steps late or early.
pub(crate) fn another_last_step(verilog: &str, by: i32) -> String {
    let step = between(verilog, &["wire last ="], "5'd", ";");
    let other = step.parse::<i32>().expect("a number") + by;
    replaced(verilog, &["wire last ="], &step, &other.to_string())
}

/// The chip with another number in place of the hexadecimal one in the one line that holds all of `words`.
pub(crate) fn another_literal(verilog: &str, words: &[&str], change: fn(u64) -> u64) -> String {
    let line = line_with(verilog, words);
    let (_, rest) = line.split_once("'sh").expect("a hexadecimal number");
    let end = rest.find(|c: char| !c.is_ascii_hexdigit());
    let digits = &rest[..end.unwrap_or(rest.len())];
    let number = u64::from_str_radix(digits, 16).expect("a number");
    let other = format!("'sh{:x}", change(number));
    verilog.replacen(line, &line.replacen(&format!("'sh{digits}"), &other, 1), 1)
}

/// What the line holds in which `name` is rounded: that of a wire before it saturates, or its own.
pub(crate) fn rounding(verilog: &str, name: &str) -> String {
    let before = format!(" {name}_rounded =");
    let own = format!(" {name} =");
    if verilog.contains(&before) {
        before
    } else {
        own
    }
}

/// The bit by which `name` is rounded, and the one below it.
pub(crate) fn guard(verilog: &str, name: &str) -> (String, String) {
    let words = ["wire", &rounding(verilog, name)];
    let guard = between(verilog, &words, "'b0, ", "};");
    let (signal, bit) = guard.trim_end_matches(']').split_once('[').expect("a bit");
    let below = bit.parse::<u32>().expect("a number") - 1;
    let below = format!("{signal}[{below}]");
    (guard, below)
}

/// The chip that rounds `name` to the nearest, but exact halves down in place of up.
pub(crate) fn half_down(verilog: &str, name: &str) -> String {
    let (guard, below) = guard(verilog, name);
    let down = format!("{guard} & (|{}:0])", below.trim_end_matches(']'));
    let words = ["wire", &rounding(verilog, name)];
    let [from, to] = [guard, down].map(|bit| format!("{bit}}};"));
    replaced(verilog, &words, &from, &to)
}

/// The chip that fills the first operand up with zeros in place of its sign.
pub(crate) fn zero_extended(verilog: &str, words: &[&str]) -> String {
    let copies = between(verilog, words, "{{", "{");
    let sign = between(verilog, words, &format!("{{{{{copies}{{"), "}}");
    let signed = format!("{{{{{copies}{{{sign}}}}}");
    replaced(verilog, words, &signed, &format!("{{{copies}'b0"))
}

/// What it is, and how it comes into the Verilog.
pub(crate) type Fault = (&'static str, Box<dyn Fn(&str) -> String>);

pub(crate) fn fault(name: &'static str, change: fn(&str) -> String) -> Fault {
    (name, Box::new(change))
}

/// Of the one line that holds all of `words`, `from` becomes `to`.
pub(crate) fn swap(
    name: &'static str,
    words: &'static [&'static str],
    from: &'static str,
    to: &'static str,
) -> Fault {
    (name, Box::new(move |v| replaced(v, words, from, to)))
}
