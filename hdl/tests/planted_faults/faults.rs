//! Single faults in the Verilog, each of one place.

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
fn holds(line: &str, word: &str) -> bool {
    let other = match word.strip_suffix("_now =") {
        Some(name) => format!("{name} ="),
        None => word.replace(" =", "_now ="),
    };
    line.contains(word) || (word.ends_with(" =") && line.contains(&other))
}

/// The one line that holds all of `words`.
fn line_with<'a>(verilog: &'a str, words: &[&str]) -> &'a str {
    let mut lines = verilog
        .lines()
        .filter(|line| words.iter().all(|word| holds(line, word)));
    let found = lines.next();
    assert!(lines.next().is_none(), "{words:?} stand in two lines");
    found.unwrap_or_else(|| panic!("no line holds {words:?}"))
}

fn replaced(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    assert!(line.contains(from), "{from} is not in {line}");
    verilog.replacen(line, &line.replacen(from, to, 1), 1)
}

/// The text between `from` and `to` in the one line that holds all of `words`.
fn between(verilog: &str, words: &[&str], from: &str, to: &str) -> String {
    let line = line_with(verilog, words);
    let rest = line.split_once(from).map(|parts| parts.1);
    let inner = rest.and_then(|rest| rest.split_once(to));
    inner.unwrap_or_else(|| panic!("{line}")).0.to_owned()
}

/// The chip that commits some steps late or early.
fn another_last_step(verilog: &str, by: i32) -> String {
    let step = between(verilog, &["wire last ="], "5'd", ";");
    let other = step.parse::<i32>().expect("a number") + by;
    replaced(verilog, &["wire last ="], &step, &other.to_string())
}

/// The chip with another number in place of the hexadecimal one in the one line that holds all of `words`.
fn another_literal(verilog: &str, words: &[&str], change: fn(u64) -> u64) -> String {
    let line = line_with(verilog, words);
    let (_, rest) = line.split_once("'sh").expect("a hexadecimal number");
    let end = rest.find(|c: char| !c.is_ascii_hexdigit());
    let digits = &rest[..end.unwrap_or(rest.len())];
    let number = u64::from_str_radix(digits, 16).expect("a number");
    let other = format!("'sh{:x}", change(number));
    verilog.replacen(line, &line.replacen(&format!("'sh{digits}"), &other, 1), 1)
}

/// The bit by which `name` is rounded, and the one below it.
fn guard(verilog: &str, name: &str) -> (String, String) {
    let words = ["wire", &format!(" {name}_rounded =")];
    let guard = between(verilog, &words, "'b0, ", "};");
    let (signal, bit) = guard.trim_end_matches(']').split_once('[').expect("a bit");
    let below = bit.parse::<u32>().expect("a number") - 1;
    let below = format!("{signal}[{below}]");
    (guard, below)
}

/// The chip that rounds `name` to the nearest, but exact halves down in place of up.
fn half_down(verilog: &str, name: &str) -> String {
    let (guard, below) = guard(verilog, name);
    let down = format!("{guard} & (|{}:0])", below.trim_end_matches(']'));
    let words = ["wire", &format!(" {name}_rounded =")];
    let [from, to] = [guard, down].map(|bit| format!("{bit}}};"));
    replaced(verilog, &words, &from, &to)
}

/// The chip that fills the first operand up with zeros in place of its sign.
fn zero_extended(verilog: &str, words: &[&str]) -> String {
    let copies = between(verilog, words, "{{", "{");
    let sign = between(verilog, words, &format!("{{{{{copies}{{"), "}}");
    let signed = format!("{{{{{copies}{{{sign}}}}}");
    replaced(verilog, words, &signed, &format!("{{{copies}'b0"))
}

/// What it is, and how it comes into the Verilog.
pub(crate) type Fault = (&'static str, Box<dyn Fn(&str) -> String>);

fn fault(name: &'static str, change: fn(&str) -> String) -> Fault {
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

/// Faults in the Verilog, each of one place.
pub(crate) fn faults() -> Vec<Fault> {
    vec![
        swap(
            "periods that the parameters are held: one less",
            &["wire held_long_now ="],
            "7'sh27",
            "7'sh26",
        ),
        fault("rounding of the phase error: by the wrong bit", |v| {
            let (guard, below) = guard(v, "e_seen");
            replaced(v, &["wire", " e_seen_rounded ="], &guard, &below)
        }),
        fault("rounding of c: cut off", |v| {
            let (guard, _) = guard(v, "c");
            replaced(v, &["wire", " c_rounded ="], &guard, "1'b0")
        }),
        // Its nominal value carries half of a last bit, which is its lowest one.
        fault("rounding of theta_1: cut off", |v| {
            another_literal(v, &["wire", " theta_1_rounded ="], |n| n & (n - 1))
        }),
        fault("half of theta_1's last bit rounds down", |v| {
            another_literal(v, &["wire", " theta_1_rounded ="], |n| n - 1)
        }),
        fault("half of theta_5's last bit rounds down", |v| {
            half_down(v, "theta_5")
        }),
        fault("half of c's last bit rounds down", |v| half_down(v, "c")),
        fault("half of s's last bit rounds down", |v| half_down(v, "s")),
        fault("half of e_seen's last bit rounds down", |v| {
            half_down(v, "e_seen")
        }),
        fault("half of rho_c's last bit rounds down", |v| {
            half_down(v, "rho_c")
        }),
        fault("half of rho_s's last bit rounds down", |v| {
            half_down(v, "rho_s")
        }),
        fault("saturation of s: wraps", |v| {
            let kept = between(v, &["wire", " s_now = "], "? ", " :");
            let all = between(v, &["wire", " s_now = "], "= ", ";");
            replaced(v, &["wire", " s_now = "], &all, &kept)
        }),
        fault("saturation of theta_2: wraps", |v| {
            let words = ["wire", " running_2_next_bits = "];
            let kept = between(v, &words, "? ", " :");
            let all = between(v, &words, "= ", ";");
            replaced(v, &words, &all, &kept)
        }),
        swap(
            "saturation of theta_4: at the other end",
            &["wire", " running_4_next_bits = "],
            "{~",
            "{",
        ),
        fault("sign extension of a product", |v| {
            zero_extended(v, &["wire", " sin_magnitude_sum ="])
        }),
        fault("sign extension of the speed", |v| {
            zero_extended(v, &["wire", " alpha_hat_sum ="])
        }),
        swap(
            "logical shift in place of the arithmetic one",
            &["wire", " kick_shifted ="],
            ">>>",
            ">>",
        ),
        fault("latency: one clock more", |v| another_last_step(v, 1)),
        fault("latency: a register committed one step early", |v| {
            another_last_step(v, -1)
        }),
        swap(
            "a chip that does not wait for samples",
            &["wire start ="],
            " & sample_valid",
            "",
        ),
        swap(
            "a sample that an early strobe begins anew",
            &["wire start ="],
            "(step == 5'd0) & sample_valid",
            "sample_valid",
        ),
        swap(
            "valid longer than a clock",
            &["valid <= last"],
            "last",
            "last | (valid & (step == 5'd0) & ~sample_valid)",
        ),
        swap(
            "a step counter that runs by itself",
            &["else if (start |"],
            "else if (start | (step != 5'd0))",
            "else",
        ),
        fault("last bit of the coefficient a", |v| {
            another_literal(v, &["operand_a", "// loop_a"], |n| n ^ 1)
        }),
        fault("last bit of the coefficient a + b", |v| {
            another_literal(v, &["operand_b", "// loop_ab"], |n| n ^ 1)
        }),
        swap(
            "last bit of the lock limit",
            &["wire e_in_window ="],
            "6'sd7",
            "6'sd8",
        ),
        swap(
            "last bit of the limit that begins again",
            &["wire rho_high_now ="],
            "< 4'sd1)",
            "< 4'sd2)",
        ),
        swap(
            "last bit of the limit that holds",
            &["wire rho_not_small_now ="],
            "~rho_now[17:12]) < 6'sd1)",
            "~rho_now[17:12]) < 6'sd2)",
        ),
        swap(
            "direction forwards from twice the speed on",
            &["wire not_forwards_now ="],
            "'sd1;",
            "'sd2;",
        ),
        swap(
            "sectors counted again by turning back behind",
            &["wire used_behind_counts ="],
            "behind_used &",
            "1'b0 &",
        ),
        swap(
            "sectors counted again by turning back ahead",
            &["wire used_ahead_counts ="],
            "ahead_used &",
            "1'b0 &",
        ),
        swap(
            "turning back that is never forgotten",
            &["wire still_used_behind ="],
            "(whole_period_now | sector_behind)",
            "whole_period_now",
        ),
        swap(
            "what a part of a period has taught is applied",
            &["wire travel_ends"],
            "period_taught |",
            "fresh_now |",
        ),
        swap(
            "what a period has taught is never applied",
            &["wire travel_ends"],
            "period_taught |",
            "1'b0 |",
        ),
        fault("proven at a bound", |v| {
            let inside = " & gain_s_inside";
            let v = replaced(v, &["wire gains_steady ="], " & gain_c_inside", "");
            replaced(&v, &["wire gains_steady ="], inside, "")
        }),
        swap(
            "what is unknown is held as long as the known",
            &["wire held_long_now ="],
            " | held_unknown",
            "",
        ),
        swap(
            "quiet periods counted from before the loss",
            &["wire gear_periods_again ="],
            " | not_counting",
            "",
        ),
        swap(
            "proven while gains move",
            &["wire proves"],
            "gains_steady | ~known",
            "1'b1",
        ),
        swap(
            "what is broken off waits on",
            &["wire travel_ends"],
            " | period_breaks_off",
            "",
        ),
        swap(
            "recall where a gain has moved on",
            &["wire proven_better"],
            "not_apart | ",
            "1'b1 | ",
        ),
        swap(
            "never proven again",
            &["wire proves"],
            "gains_steady | ",
            "",
        ),
        fault(
            "parameters of the next sample at the ports too early",
            |v| {
                let idle = "if (start) begin\n            upper_half <=";
                assert_eq!(v.matches(idle).count(), 1);
                v.replace(idle, &idle.replace("start", "step == 5'd0"))
            },
        ),
        fault("a stale operand", |v| {
            let forwarded = |line: &&str| line.contains("operand_") && line.ends_with("_now;");
            let line = v.lines().find(forwarded).expect("a forwarded operand");
            v.replacen(line, &line.replace("_now;", ";"), 1)
        }),
        swap(
            "nothing is remembered in the first gear",
            &["(gear_passed | first_gear_period)"],
            " | first_gear_period",
            "",
        ),
        swap(
            "no hold in the first gear",
            &["wire search_begun_now ="],
            " | ~(gear_periods < 4'sd1)",
            "",
        ),
    ]
}

/// Faults in the correction of channel skew.
pub(crate) fn skew_faults() -> Vec<Fault> {
    vec![
        swap(
            "skew taken the other way round",
            &["wire", " s_difference_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "half of the skew's product left out of the second order",
            &["wire", " s_between_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "skew before lock",
            &["wire", " skew_chosen ="],
            "locked ?",
            "1'b1 ?",
        ),
        swap(
            "phase of the sensor with the wrong sign",
            &["wire", " skew_slope_difference_now ="],
            " - ",
            " + ",
        ),
    ]
}

/// Faults in the correction of stored harmonics.
pub(crate) fn harmonic_faults() -> Vec<Fault> {
    vec![
        swap(
            "harmonics of the cosine added",
            &["wire", " c_difference ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "harmonics of the sine added",
            &["wire", " s_difference_2_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "phase correction of the harmonics the other way round",
            &["wire", " s_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "second order of the phase correction with the wrong sign",
            &["wire", " harmonic_through ="],
            "} + {{",
            "} - {{",
        ),
        fault("expanded about the segment's beginning", |v| {
            let words = ["wire", " harmonic_inside_now ="];
            let half = between(v, &words, "'sh", ";");
            replaced(v, &words, &format!("'sh{half};"), "'sh0;")
        }),
    ]
}
