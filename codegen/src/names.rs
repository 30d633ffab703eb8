//! A name for every value of the graph. Kernels name what matters; the rest is named after what it goes into.

use std::collections::HashSet;

use nonius_model::graph::{Graph, NodeId, Op};

/// Names of all nodes, by index.
pub(crate) fn names(graph: &Graph) -> Vec<String> {
    let mut names: Vec<Option<String>> = graph.nodes.iter().map(|n| n.name.clone()).collect();
    let mut taken: HashSet<String> = names.iter().flatten().cloned().collect();
    let mut give = |wish: String| {
        let mut unique = wish.clone();
        let mut count = 1;
        while !taken.insert(unique.clone()) {
            count += 1;
            unique = format!("{wish}_{count}");
        }
        unique
    };
    for (register, id) in &graph.next {
        if names[id.index()].is_none() {
            names[id.index()] = Some(give(format!("{register}_next")));
        }
    }
    for id in graph.ids() {
        if names[id.index()].is_none()
            && let Some(wish) = spoken(graph, id).or_else(|| decision(graph, &names, id))
        {
            names[id.index()] = Some(give(wish));
        }
    }
    // Last first, so that every consumer has its name before what goes into it.
    let mut consumer: Vec<Option<NodeId>> = vec![None; graph.nodes.len()];
    for id in graph.ids() {
        for operand in graph.node(id).op.operands() {
            consumer[operand.index()].get_or_insert(id);
        }
    }
    // What a nameless value is a part of: the nearest named value down the line.
    let mut root = names.clone();
    for id in graph.ids().collect::<Vec<_>>().into_iter().rev() {
        if names[id.index()].is_some() {
            continue;
        }
        let whole = consumer[id.index()].and_then(|c| root[c.index()].clone());
        let whole = whole.unwrap_or_else(|| "value".into());
        names[id.index()] = Some(give(format!("{whole}_{}", part(graph, id))));
        root[id.index()] = Some(whole);
    }
    names.into_iter().flatten().collect()
}

/// A product or comparison of values, or a window around 0, where they have names, as one would say it.
fn spoken(graph: &Graph, id: NodeId) -> Option<String> {
    let name = |id: NodeId| graph.node(id).name.clone();
    let signed = |id: NodeId| match graph.node(id).op {
        Op::Neg(positive) => Some(format!("minus_{}", name(positive)?)),
        _ => name(id),
    };
    match graph.node(id).op {
        Op::Mul(a, b) => Some(format!("{}_times_{}", name(a)?, name(b)?)),
        Op::LessThan(a, b) => Some(format!("{}_below_{}", name(a)?, signed(b)?)),
        Op::And(below, above) => {
            let Op::Not(above) = graph.node(above).op else {
                return None;
            };
            let (Op::LessThan(x, limit), Op::LessThan(same, minus)) =
                (graph.node(below).op, graph.node(above).op)
            else {
                return None;
            };
            let of_limit = name(minus)? == format!("minus_{}", name(limit)?);
            let within = format!("{}_within_{}", name(x)?, name(limit)?);
            (x == same && of_limit).then_some(within)
        }
        _ => None,
    }
}

/// The longest name that a decision gets of what it is made of.
const SPOKEN: usize = 40;

/// A decision of decisions that have names, as one would say it, while that is short.
fn decision(graph: &Graph, names: &[Option<String>], id: NodeId) -> Option<String> {
    let name = |id: NodeId| names[id.index()].clone();
    let wish = match graph.node(id).op {
        Op::Not(a) => format!("not_{}", name(a)?),
        Op::And(a, b) => format!("{}_and_{}", name(a)?, name(b)?),
        Op::Or(a, b) => format!("{}_or_{}", name(a)?, name(b)?),
        Op::Xor(a, b) => format!("either_{}_or_{}", name(a)?, name(b)?),
        _ => return None,
    };
    (wish.len() <= SPOKEN).then_some(wish)
}

/// What a nameless value is in the one it goes into.
fn part(graph: &Graph, id: NodeId) -> &'static str {
    match graph.node(id).op {
        Op::Input => "input",
        Op::Constant(_) => "constant",
        Op::Add(..) => "sum",
        Op::Sub(..) => "difference",
        Op::Neg(_) => "negated",
        Op::Mul(..) => "product",
        Op::Scale(..) => "scaled",
        Op::Quantise(..) => "bits",
        Op::QuantiseGeared { .. } => "geared",
        Op::Select(..) => "chosen",
        Op::Lookup { .. } => "entry",
        Op::LessThan(..) | Op::And(..) | Op::Or(..) | Op::Xor(..) | Op::Not(_) => "condition",
    }
}
