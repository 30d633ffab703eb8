//! From graph to clock cycles.
//!
//! Cycle 0 is the one in which `sample_valid` is high; the ADC codes are registered at its end. A product is issued in
//! a cycle: its operands are put into the multiplier's operand registers at the end of the cycle before, the product
//! register holds the result in the cycle after. What is computed from a product register may go straight into an
//! operand register, so dependent products follow each other every second cycle. A table row is there one cycle after
//! its address. Shifts by the same gear share as many shifters as there may be multipliers. Everything else is
//! combinational, chained within a cycle up to a depth. All registers of the chip commit at the end of the last cycle.

use nonius_model::format::{Quantiser, Rounding};
use nonius_model::graph::{Graph, NodeId, Op};
use nonius_model::spec::Multipliers;

use crate::settle::settle;

/// Names of the inputs that are registered at the end of cycle 0.
pub const SAMPLED: [&str; 4] = ["adc_cos", "adc_sin", "preset", "calibrate"];

/// Longest chain in a cycle, in about tenths of nanoseconds of an iCE40 HX: the first, or a longer one that saves clocks.
const DEPTHS: [u32; 2] = [115, 125];

/// When and where each node is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Cycle in which a node's value is there.
    pub ready: Vec<usize>,
    /// For products: multiplier and cycle of issue.
    pub issue: Vec<Option<(usize, usize)>>,
    /// For geared quantisations that share shifters: index in [`Schedule::shifters`].
    pub shift: Vec<Option<usize>>,
    /// The shared shifters.
    pub shifters: Vec<Shifter>,
    /// Multipliers that have a product in some cycle, no more than asked for.
    pub multipliers: usize,
    /// Clocks from one sample to the next.
    pub clocks: usize,
}

/// A shifter that several geared quantisations share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shifter {
    /// The gear.
    pub gear: NodeId,
    /// Bits of shift per gear.
    pub stride: u32,
    /// Last gear.
    pub last: u32,
    /// Format, rounding and overflow of the results.
    pub to: Quantiser,
}

/// The shifter that node `id` may share.
fn shifter(graph: &Graph, id: NodeId) -> Option<Shifter> {
    match graph.node(id).op {
        Op::QuantiseGeared {
            gear,
            stride,
            last,
            to,
            ..
        } => Some(Shifter {
            gear,
            stride,
            last,
            to,
        }),
        _ => None,
    }
}

/// Combinational delay of a node in units of [`DEPTHS`].
pub(crate) fn delay(graph: &Graph, id: NodeId) -> u32 {
    let width = graph.node(id).format.width;
    match graph.node(id).op {
        Op::Input | Op::Constant(_) | Op::Scale(..) | Op::Lookup { .. } | Op::Mul(..) => 0,
        Op::Add(..) | Op::Sub(..) | Op::Neg(_) | Op::LessThan(..) => 15 + width,
        Op::Quantise(_, to) if to.rounding != Rounding::Nearest => 5,
        Op::Quantise(..) => 25 + width,
        Op::QuantiseGeared { .. } => 45 + width,
        Op::Select(..) | Op::And(..) | Op::Or(..) | Op::Xor(..) | Op::Not(_) => 10,
    }
}

/// Longest chain of delays from each node to the end.
fn urgency(graph: &Graph) -> Vec<u32> {
    let mut urgency = vec![0u32; graph.nodes.len()];
    for id in graph.ids().collect::<Vec<_>>().into_iter().rev() {
        let own = match graph.node(id).op {
            Op::Mul(..) => 200,
            Op::Lookup { .. } => 100,
            _ => delay(graph, id),
        };
        let here = urgency[id.index()] + own;
        for operand in graph.node(id).op.operands() {
            let u = &mut urgency[operand.index()];
            *u = (*u).max(here);
        }
    }
    urgency
}

/// The schedule that a design asks for: `"all"` takes the fewest multipliers with which a sample takes no more clocks than with
/// one for each product.
#[must_use]
pub fn schedule_for(graph: &Graph, wanted: Multipliers) -> Schedule {
    let most = wanted.count(graph.products());
    let fastest = Listed::new(graph, most);
    let clocks = fastest.schedule.clocks;
    let chosen = match wanted {
        Multipliers::Count(_) => fastest,
        Multipliers::All(_) => (1..most)
            .map(|fewer| Listed::new(graph, fewer))
            .find(|fewer| fewer.schedule.clocks <= clocks)
            .unwrap_or(fastest),
    };
    chosen.settled(graph)
}

/// Lists the graph on `multipliers` multipliers, or on fewer where never so many products are waiting.
#[must_use]
pub fn schedule(graph: &Graph, multipliers: usize) -> Schedule {
    Listed::new(graph, multipliers).settled(graph)
}

/// A schedule with every value as early as it can be, and the longest chain that it allows itself.
struct Listed {
    schedule: Schedule,
    depth: u32,
}

impl Listed {
    fn new(graph: &Graph, multipliers: usize) -> Self {
        let [short, long] = DEPTHS.map(|depth| Self {
            schedule: list(graph, multipliers, depth),
            depth,
        });
        if long.schedule.clocks < short.schedule.clocks {
            long
        } else {
            short
        }
    }

    fn settled(mut self, graph: &Graph) -> Schedule {
        settle(graph, &mut self.schedule, self.depth);
        self.schedule.keep_shared_shifters();
        self.schedule
    }
}

impl Schedule {
    /// The cycle in which a node reads its operands: a product when it is issued, a table a cycle before its value is there.
    pub(crate) fn reads_in(&self, graph: &Graph, id: NodeId) -> usize {
        let ready = self.ready[id.index()];
        match graph.node(id).op {
            Op::Mul(..) => self.issue[id.index()].map_or(0, |(_, cycle)| cycle - 1),
            Op::Lookup { .. } => ready - 1,
            _ => ready,
        }
    }

    /// A shifter of one value is none that is shared: it is written where the value is.
    fn keep_shared_shifters(&mut self) {
        let shared: Vec<usize> = (0..self.shifters.len())
            .filter(|&unit| self.shift.iter().filter(|s| **s == Some(unit)).count() > 1)
            .collect();
        for shift in &mut self.shift {
            *shift = shift.and_then(|unit| shared.iter().position(|&of| of == unit));
        }
        self.shifters = shared.iter().map(|&unit| self.shifters[unit]).collect();
    }
}

/// With chains no longer than `depth`.
fn list(graph: &Graph, multipliers: usize, depth: u32) -> Schedule {
    let n = graph.nodes.len();
    let urgency = urgency(graph);
    let mut lister = Lister {
        graph,
        ready: vec![None; n],
        arrival: vec![0u32; n],
        shift: vec![None; n],
        shifters: vec![],
        multipliers,
        depth,
    };
    let mut issue = vec![None; n];
    for id in graph.ids() {
        let node = graph.node(id);
        match node.op {
            Op::Input => {
                let sampled = node
                    .name
                    .as_deref()
                    .is_some_and(|name| SAMPLED.contains(&name));
                lister.ready[id.index()] = Some(usize::from(sampled));
            }
            Op::Constant(_) => lister.ready[id.index()] = Some(0),
            _ => {}
        }
    }
    let mut cycle = 0;
    while lister.ready.iter().any(Option::is_none) {
        lister.combinational(cycle);
        read_tables(graph, &mut lister.ready, cycle);
        let mut waiting: Vec<NodeId> = graph
            .ids()
            .filter(|&id| {
                matches!(graph.node(id).op, Op::Mul(..))
                    && lister.ready[id.index()].is_none()
                    && lister.operands_done(id, cycle)
            })
            .collect();
        waiting.sort_by_key(|id| (std::cmp::Reverse(urgency[id.index()]), id.index()));
        for (multiplier, id) in waiting.into_iter().take(multipliers).enumerate() {
            issue[id.index()] = Some((multiplier, cycle + 1));
            lister.ready[id.index()] = Some(cycle + 2);
        }
        cycle += 1;
    }
    let ready: Vec<usize> = lister.ready.into_iter().flatten().collect();
    let clocks = ready.iter().max().copied().unwrap_or(0) + 1;
    // The first ones are taken first.
    let used = issue.iter().flatten().map(|(m, _)| m + 1).max();
    Schedule {
        ready,
        issue,
        shift: lister.shift,
        shifters: lister.shifters,
        multipliers: used.unwrap_or(0),
        clocks,
    }
}

struct Lister<'a> {
    graph: &'a Graph,
    ready: Vec<Option<usize>>,
    arrival: Vec<u32>,
    shift: Vec<Option<usize>>,
    shifters: Vec<Shifter>,
    multipliers: usize,
    depth: u32,
}

impl Lister<'_> {
    fn operands_done(&self, id: NodeId, cycle: usize) -> bool {
        let mut operands = self.graph.node(id).op.operands();
        operands.all(|o| self.ready[o.index()].is_some_and(|r| r <= cycle))
    }

    /// Everything that is neither product nor table and fits into this cycle.
    fn combinational(&mut self, cycle: usize) {
        let mut taken: Vec<usize> = vec![];
        for id in self.graph.ids() {
            let op = self.graph.node(id).op;
            let waits = matches!(op, Op::Mul(..) | Op::Lookup { .. });
            if self.ready[id.index()].is_some() || waits || !self.operands_done(id, cycle) {
                continue;
            }
            let chained = |o: NodeId| {
                if self.ready[o.index()] == Some(cycle) {
                    self.arrival[o.index()]
                } else {
                    0
                }
            };
            let start = op.operands().map(chained).max().unwrap_or(0);
            let end = start + delay(self.graph, id);
            if start > 0 && end > self.depth {
                continue;
            }
            if let Some(wanted) = shifter(self.graph, id) {
                let free = self.unit(wanted, &taken);
                let Some(unit) = free else { continue };
                taken.push(unit);
                self.shift[id.index()] = Some(unit);
            }
            self.ready[id.index()] = Some(cycle);
            self.arrival[id.index()] = end;
        }
    }

    /// A shifter of this kind that is not taken in this cycle; a new one while there are fewer than there may be multipliers.
    fn unit(&mut self, wanted: Shifter, taken: &[usize]) -> Option<usize> {
        let same: Vec<usize> = (0..self.shifters.len())
            .filter(|&u| self.shifters[u] == wanted)
            .collect();
        same.iter()
            .copied()
            .find(|u| !taken.contains(u))
            .or_else(|| {
                (same.len() < self.multipliers).then(|| {
                    self.shifters.push(wanted);
                    self.shifters.len() - 1
                })
            })
    }
}

/// One address per table and cycle; all columns of its row come together.
fn read_tables(graph: &Graph, ready: &mut [Option<usize>], cycle: usize) {
    for rom in 0..graph.roms.len() {
        let next = graph.ids().find_map(|id| match graph.node(id).op {
            Op::Lookup {
                rom: r, address, ..
            } if r == rom && ready[id.index()].is_none() => ready[address.index()]
                .is_some_and(|at| at <= cycle)
                .then_some(address),
            _ => None,
        });
        for id in graph.ids() {
            if let Op::Lookup {
                rom: r, address, ..
            } = graph.node(id).op
                && r == rom
                && Some(address) == next
            {
                ready[id.index()] = Some(cycle + 1);
            }
        }
    }
}
