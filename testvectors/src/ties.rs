//! Codes that make rounding ties: values exactly half way between two of the format that they are rounded to.
//!
//! Whether a chip rounds half up, half down or to even shows in ties alone, and a product of which sixteen bits are
//! dropped is one in a sample of 65 536. So they are searched for: from the registers as they stand, codes about those
//! of a slow turn are tried, and the one is played that makes the rarest ties.

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::format::Rounding;
use nonius_model::graph::{Evaluation, Graph, NodeId, Op, compute};

use crate::stimulus::Sample;

/// Codes tried on either side of the slow turn's, in each channel.
const REACH: i64 = 8;
/// The farthest, as a fraction of the amplitude, across the radius: what is rare needs a phase error of some size.
const ACROSS: f64 = 0.1;
/// Most codes tried across the radius, spread evenly: of an ADC of many bits there would be too many for a build of seconds.
const TRIED: usize = 1536;

/// A value that is rounded to the nearest.
#[derive(Clone, Copy, Debug)]
struct Rounded {
    value: NodeId,
    gear: Option<(NodeId, u32)>,
    /// Bits dropped in gear 0.
    dropped: i64,
}

/// Finds the ties of a design's sample.
#[derive(Debug)]
pub struct Ties<'a> {
    graph: &'a Graph,
    rounded: Vec<(NodeId, Rounded)>,
    /// What has to be computed anew for other codes, operands first.
    cone: Vec<NodeId>,
    /// Roundings that no code of the same sample changes, but the registers that it leaves behind do.
    later: Vec<usize>,
    /// What these need, operands first.
    later_cone: Vec<NodeId>,
    /// The node that each register takes its next value from, under the register's node.
    next: Vec<Option<NodeId>>,
}

impl Rounded {
    /// Whether it is a tie, given the integer of every node.
    fn is_tie(&self, raw: &[i128]) -> bool {
        let more = self.gear.map_or(0, |(gear, stride)| {
            i64::from(stride) * raw[gear.index()] as i64
        });
        let dropped = self.dropped + more;
        dropped > 0 && raw[self.value.index()] & ((1 << dropped) - 1) == 1 << (dropped - 1)
    }
}

/// Steps from the slow turn's codes.
fn near() -> impl Iterator<Item = (i64, i64)> {
    (-REACH..=REACH).flat_map(|i| (-REACH..=REACH).map(move |j| (i, j)))
}

/// Which nodes depend on `from`.
fn followers(graph: &Graph, from: impl Iterator<Item = NodeId>) -> Vec<bool> {
    let mut follows = vec![false; graph.nodes.len()];
    from.for_each(|id| follows[id.index()] = true);
    for id in graph.ids() {
        let mut operands = graph.node(id).op.operands();
        follows[id.index()] |= operands.any(|o| follows[o.index()]);
    }
    follows
}

/// Which nodes `of` depend on.
fn ancestors(graph: &Graph, of: impl Iterator<Item = NodeId>) -> Vec<bool> {
    let mut needed = vec![false; graph.nodes.len()];
    of.for_each(|id| needed[id.index()] = true);
    for i in (0..graph.nodes.len()).rev() {
        if needed[i] {
            for operand in graph.nodes[i].op.operands() {
                needed[operand.index()] = true;
            }
        }
    }
    needed
}

impl<'a> Ties<'a> {
    /// Finds where the design rounds to the nearest.
    #[must_use]
    pub fn new(design: &'a Design) -> Self {
        let graph = &design.graph;
        let fraction = |id: NodeId| i64::from(graph.node(id).format.fraction);
        let nearest = |id: NodeId| {
            let (value, gear, to) = match graph.node(id).op {
                Op::Quantise(value, to) => (value, None, to),
                Op::QuantiseGeared {
                    value,
                    gear,
                    stride,
                    last,
                    to,
                } => (value, Some((gear, stride, last)), to),
                _ => return None,
            };
            let dropped = fraction(value) - i64::from(to.format.fraction);
            let most = dropped + gear.map_or(0, |(_, stride, last)| i64::from(stride * last));
            let gear = gear.map(|(gear, stride, _)| (gear, stride));
            let rounds = to.rounding == Rounding::Nearest && most > 0;
            rounds.then_some((
                id,
                Rounded {
                    value,
                    gear,
                    dropped,
                },
            ))
        };
        let rounded: Vec<_> = graph.ids().filter_map(nearest).collect();
        let mut next = vec![None; graph.nodes.len()];
        for (name, value) in &graph.next {
            for (_, register) in graph.inputs.iter().filter(|(n, _)| n == name) {
                next[register.index()] = Some(*value);
            }
        }
        let codes = graph.inputs.iter().filter(|(n, _)| n.starts_with("adc_"));
        let follows = followers(graph, codes.map(|(_, id)| *id));
        let values = |r: &Rounded| [Some(r.value), r.gear.map(|(gear, _)| gear)];
        let later: Vec<usize> = (0..rounded.len())
            .filter(|&i| !follows[rounded[i].0.index()])
            .collect();
        let later_values = later.iter().flat_map(|&i| values(&rounded[i].1)).flatten();
        let later_needs = ancestors(graph, later_values);
        let registers = graph.ids().filter(|id| later_needs[id.index()]);
        let left_behind = registers.filter_map(|id| next[id.index()]);
        let now = rounded.iter().flat_map(|(_, r)| values(r)).flatten();
        let needed = ancestors(graph, now.chain(left_behind));
        let both = |id: &NodeId| follows[id.index()] && needed[id.index()];
        Self {
            graph,
            cone: graph.ids().filter(both).collect(),
            later_cone: graph.ids().filter(|id| later_needs[id.index()]).collect(),
            rounded,
            later,
            next,
        }
    }

    /// The names of the values that are rounded to the nearest, where they have one.
    pub fn names(&self) -> impl Iterator<Item = Option<&str>> {
        let name = |(id, _): &(NodeId, Rounded)| self.graph.node(*id).name.as_deref();
        self.rounded.iter().map(name)
    }

    /// Which of [`Self::names`] are ties, given the integer of every node.
    fn tied<'b>(&'b self, raw: &'b [i128]) -> impl Iterator<Item = usize> + 'b {
        (0..self.rounded.len()).filter(move |&i| self.rounded[i].1.is_tie(raw))
    }

    /// How much it is worth that these are ties: the rarer they were, the more.
    fn worth(&self, raw: &[i128], next_raw: &mut [i128], counts: &[u32]) -> f64 {
        for &id in &self.later_cone {
            next_raw[id.index()] = match self.next[id.index()] {
                Some(value) => raw[value.index()],
                None if self.graph.node(id).op == Op::Input => raw[id.index()],
                None => compute(self.graph, id, |operand| next_raw[operand.index()]),
            };
        }
        let now = (0..self.rounded.len()).filter(|i| !self.later.contains(i));
        let now = now.filter(|&i| self.rounded[i].1.is_tie(raw));
        let later = self.later.iter().copied();
        let later = later.filter(|&i| self.rounded[i].1.is_tie(next_raw));
        let worth = |i: usize| 1.0 / f64::from(1 + counts[i]).powi(2);
        now.chain(later).map(worth).sum()
    }

    /// The integer of every node for the next sample of `chip`.
    fn evaluate(&self, chip: &Chip<nonius_model::bits::Bits>, sample: &Sample) -> Vec<i128> {
        let evaluation = Evaluation::new(self.graph, |name| match name {
            "adc_cos" => sample.cos.into(),
            "adc_sin" => sample.sin.into(),
            "preset" => sample.preset.into(),
            "calibrate" => sample.calibrate.into(),
            name => match chip.state.flag(name) {
                Some(flag) => flag.into(),
                None => {
                    let id = self.graph.inputs.iter().find(|(n, _)| n == name);
                    let fraction = id.map_or(0, |(_, id)| self.graph.node(*id).format.fraction);
                    let value = chip.state.value(name);
                    value.map_or(0, |v| v.raw(fraction).into())
                }
            },
        });
        self.graph.ids().map(|id| evaluation.raw(id)).collect()
    }

    /// How often each of [`Self::names`] is a tie while `samples` are played from reset.
    #[must_use]
    pub fn count(&self, design: &Design, samples: &[Sample]) -> Vec<u32> {
        let mut chip = Chip::bit_true(design);
        let mut counts = vec![0; self.rounded.len()];
        for sample in samples {
            let raw = self.evaluate(&chip, sample);
            self.tied(&raw).for_each(|i| counts[i] += 1);
            chip.step_codes(sample.cos, sample.sin, sample.preset, sample.calibrate);
        }
        counts
    }

    /// The samples `about`, each with codes near by that make the ties that were the rarest so far.
    #[must_use]
    pub fn search(&self, design: &Design, about: &[Sample]) -> Vec<Sample> {
        let adc = design.structure.formats.adc;
        let code = |c: i64| c.clamp(adc.min_raw() as i64, adc.max_raw() as i64);
        let input = |name: &str| self.graph.inputs.iter().find(|(n, _)| n == name);
        let [Some((_, cos)), Some((_, sin))] = [input("adc_cos"), input("adc_sin")] else {
            return about.to_vec();
        };
        let middle = (adc.min_raw() + adc.max_raw() + 1) as f64 / 2.0;
        let across = |at: Sample| {
            let (c, s) = (at.cos as f64 - middle, at.sin as f64 - middle);
            let far = (ACROSS * c.hypot(s)) as i64;
            let turned = move |t: i64| {
                let t = t as f64 / c.hypot(s).max(1.0);
                ((-s * t).round() as i64, (c * t).round() as i64)
            };
            let apart = (2 * far as usize + 1).div_ceil(TRIED);
            (-far..=far).step_by(apart).map(turned)
        };
        let mut chip = Chip::bit_true(design);
        let mut counts = vec![0u32; self.rounded.len()];
        let mut played = Vec::with_capacity(about.len());
        for &slow in about {
            let mut sought = self.names().zip(&counts);
            let missing = sought.any(|(name, &n)| name.is_some() && n == 0);
            let mut raw = self.evaluate(&chip, &slow);
            let mut next_raw = raw.clone();
            let mut best = (0.0, slow);
            for (i, j) in near().chain(across(slow).filter(|_| missing)) {
                let (c, s) = (code(slow.cos + i), code(slow.sin + j));
                for &id in &self.cone {
                    let value = match id {
                        id if id == *cos => c.into(),
                        id if id == *sin => s.into(),
                        id => compute(self.graph, id, |operand| raw[operand.index()]),
                    };
                    raw[id.index()] = value;
                }
                let worth = self.worth(&raw, &mut next_raw, &counts);
                if worth > best.0 {
                    let (cos, sin) = (c, s);
                    best = (worth, Sample { cos, sin, ..slow });
                }
            }
            let raw = self.evaluate(&chip, &best.1);
            self.tied(&raw).for_each(|i| counts[i] += 1);
            let Sample {
                cos,
                sin,
                preset,
                calibrate,
            } = best.1;
            chip.step_codes(cos, sin, preset, calibrate);
            played.push(best.1);
        }
        played
    }
}
