//! Multipliers and tables in Verilog: what goes into them, step by step.

use nonius_model::graph::{NodeId, Op};

use crate::layout::{COMMENT, wrap};
use crate::netlist::width;
use crate::writer::{Source, Term, Writer, literal};

/// A multiplier.
pub(crate) struct Multiplier {
    pub(crate) index: usize,
    /// Bits of the operands.
    pub(crate) a: u32,
    pub(crate) b: u32,
    /// One operand register per port.
    pub(crate) ports: Vec<Port>,
}

/// An operand register.
pub(crate) struct Port {
    pub(crate) letter: char,
    pub(crate) bits: u32,
    /// Steps and source.
    pub(crate) loads: Vec<(String, Load)>,
    pub(crate) idle: Load,
}

/// What an operand register takes, and the comment beside it: the name of a coefficient.
#[derive(PartialEq)]
pub(crate) struct Load {
    pub(crate) source: String,
    pub(crate) comment: String,
}

struct Product {
    step: usize,
    operands: [(NodeId, Term); 2],
}

/// All multipliers. Operands may change places: each port gets as few different sources as possible.
pub(crate) fn multipliers(w: &Writer) -> Vec<Multiplier> {
    (0..w.schedule.multipliers)
        .map(|index| {
            let mut products: Vec<Product> = w
                .graph
                .ids()
                .filter_map(
                    |id| match (w.graph.node(id).op, w.schedule.issue[id.index()]) {
                        (Op::Mul(a, b), Some((m, cycle))) if m == index => {
                            let step = cycle - 1;
                            Some(Product {
                                step,
                                operands: [(a, w.at(a, step)), (b, w.at(b, step))],
                            })
                        }
                        _ => None,
                    },
                )
                .collect();
            products.sort_by_key(|p| p.step);
            arrange(w, &mut products);
            let ports: Vec<Port> = [('a', 0), ('b', 1)]
                .map(|(letter, side)| port(w, &products, letter, side))
                .into_iter()
                .collect();
            Multiplier {
                index,
                a: ports[0].bits,
                b: ports[1].bits,
                ports,
            }
        })
        .collect()
}

/// What stands at the source: two values on the same wires count as one.
fn key(term: &Term) -> String {
    format!("{:?}", term.source)
}

/// Turns products round, one at a time, while that makes the sources of both ports fewer.
fn arrange(w: &Writer, products: &mut [Product]) {
    let cost = |products: &[Product]| -> u32 {
        (0..2)
            .map(|side| {
                let mut seen: Vec<(String, u32)> = products
                    .iter()
                    .map(|p| {
                        let (id, term) = &p.operands[side];
                        (key(term), width(w.graph, *id))
                    })
                    .collect();
                seen.sort();
                seen.dedup();
                seen.iter().map(|s| s.1).sum::<u32>()
            })
            .sum()
    };
    let mut best = cost(products);
    loop {
        let before = best;
        for i in 0..products.len() {
            products[i].operands.swap(0, 1);
            let now = cost(products);
            if now < best {
                best = now;
                continue;
            }
            // Two at once helps where one source is in two products.
            let mut improved = false;
            for j in i + 1..products.len() {
                products[j].operands.swap(0, 1);
                let now = cost(products);
                if now < best {
                    best = now;
                    improved = true;
                    break;
                }
                products[j].operands.swap(0, 1);
            }
            if !improved {
                products[i].operands.swap(0, 1);
            }
        }
        if best == before {
            return;
        }
    }
}

fn port(w: &Writer, products: &[Product], letter: char, side: usize) -> Port {
    let bits = products
        .iter()
        .map(|p| p.operands[side].1.width)
        .max()
        .unwrap_or(1);
    // The same source in several steps is one line.
    let mut loads: Vec<(Vec<usize>, Load)> = vec![];
    for product in products {
        let (id, term) = &product.operands[side];
        let load = Load {
            source: w.fit(term, term.fraction, bits, None),
            comment: match term.source {
                Source::Constant(_) => format!(" // {}", w.shown(*id)),
                _ => String::new(),
            },
        };
        match loads.iter_mut().find(|l| l.1 == load) {
            Some(same) => same.0.push(product.step),
            None => loads.push((vec![product.step], load)),
        }
    }
    let nothing = Load {
        source: literal(0, bits),
        comment: String::new(),
    };
    let idle = loads.pop().map_or(nothing, |l| l.1);
    let step_bits = step_bits(w);
    let label = |step: &usize| format!("{step_bits}'d{step}");
    let labels = |steps: Vec<usize>| steps.iter().map(label).collect::<Vec<_>>().join(", ");
    Port {
        letter,
        bits,
        loads: loads.into_iter().map(|l| (labels(l.0), l.1)).collect(),
        idle,
    }
}

/// Bits of the step counter.
pub(crate) fn step_bits(w: &Writer) -> u32 {
    usize::BITS - w.schedule.clocks.leading_zeros()
}

/// A table.
pub(crate) struct Table {
    pub(crate) name: String,
    pub(crate) width: u32,
    pub(crate) rows: usize,
    pub(crate) address: u32,
    pub(crate) reads: Vec<(usize, String)>,
    pub(crate) fallback: String,
}

/// All tables.
pub(crate) fn tables(w: &Writer) -> Vec<Table> {
    let table = |(index, rom): (usize, &nonius_model::rom::Rom)| {
        let mut reads: Vec<(usize, String)> = w
            .graph
            .ids()
            .filter_map(|id| match w.graph.node(id).op {
                Op::Lookup {
                    rom: r, address, ..
                } if r == index => {
                    let step = w.schedule.ready[id.index()] - 1;
                    let drop = w.graph.node(address).format.fraction - rom.index_fraction;
                    let text = w.slice(&w.at(address, step), drop + rom.address_bits - 1, drop);
                    Some((step, text))
                }
                _ => None,
            })
            .collect();
        // All columns of a row come together.
        reads.sort();
        reads.dedup();
        let fallback = reads.pop().map_or_else(|| "0".into(), |r| r.1);
        let row = format!("{}_row", rom.name);
        w.declare(&row, rom.row_width());
        Table {
            name: rom.name.into(),
            width: rom.row_width(),
            rows: rom.rows(),
            address: rom.address_bits,
            reads,
            fallback,
        }
    };
    w.graph.roms.iter().enumerate().map(table).collect()
}

/// The schedule as a table: step, products in the multipliers, what is computed.
pub(crate) fn timetable(w: &Writer) -> Vec<String> {
    let products: Vec<Vec<String>> = (0..w.schedule.clocks)
        .map(|step| products(w, step))
        .collect();
    let title = if w.schedule.multipliers == 1 {
        "in the multiplier"
    } else {
        "in the multipliers"
    };
    let longest = products.iter().flatten().map(String::len).max();
    let width = longest.unwrap_or(0).max(title.len());
    let mut rows = vec![
        format!("step | {title:<width$} | computed in this step"),
        format!(
            "-----+-{:-<width$}-+{:-<rest$}",
            "",
            "",
            rest = COMMENT - width - 9
        ),
    ];
    for (step, products) in products.iter().enumerate() {
        let named: Vec<&str> = w
            .graph
            .ids()
            .filter(|id| {
                let node = w.graph.node(*id);
                w.schedule.ready[id.index()] == step
                    && node.name.is_some()
                    && !matches!(node.op, Op::Input | Op::Constant(_))
            })
            .map(|id| w.name(id))
            .collect();
        let named = wrap("", &named.join(" "), COMMENT - width - 10);
        for line in 0..products.len().max(named.len()) {
            let step = if line == 0 {
                step.to_string()
            } else {
                String::new()
            };
            let product = products.get(line).map_or("", String::as_str);
            let named = named.get(line).map_or("", String::as_str);
            let row = format!("{step:>4} | {product:<width$} | {named}");
            rows.push(row.trim_end().to_owned());
        }
    }
    rows
}

/// The products that are computed in a step.
fn products(w: &Writer, step: usize) -> Vec<String> {
    let mut parts = vec![];
    for id in w.graph.ids() {
        let issued = w.schedule.issue[id.index()];
        if let (Op::Mul(a, b), Some((_, cycle))) = (w.graph.node(id).op, issued)
            && cycle == step
        {
            parts.push(format!("{} * {}", w.shown(a), w.shown(b)));
        }
    }
    if parts.is_empty() {
        parts.push("-".to_owned());
    }
    parts
}
