//! `Node`: the reading of [`Signal`] that writes the graph down.

use std::ops::{Add, Mul, Neg, Sub};

use super::recorder::Recorder;
use super::{NodeId, Op};
use crate::format::Quantiser;
use crate::rom::Rom;
use crate::signal::{Formula, Logic, Signal, Wide};

/// A number in the recording reading.
#[derive(Clone, Copy, Debug)]
pub struct Node<'g> {
    pub(super) recorder: &'g Recorder,
    /// Its place in the graph.
    pub id: NodeId,
}

/// An exact product, or a sum of such, in the recording reading.
#[derive(Clone, Copy, Debug)]
pub struct WideNode<'g>(Node<'g>);

/// A decision in the recording reading.
#[derive(Clone, Copy, Debug)]
pub struct Flag<'g>(pub(super) Node<'g>);

impl<'g> Node<'g> {
    fn with(self, op: Op) -> Self {
        self.recorder.record(op)
    }
}

impl<'g> Flag<'g> {
    /// Its place in the graph.
    #[must_use]
    pub fn id(self) -> NodeId {
        self.0.id
    }
}

impl Add for Node<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(Op::Add(self.id, other.id))
    }
}

impl Sub for Node<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(Op::Sub(self.id, other.id))
    }
}

impl Neg for Node<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(Op::Neg(self.id))
    }
}

impl<'g> Mul for Node<'g> {
    type Output = WideNode<'g>;
    fn mul(self, other: Self) -> WideNode<'g> {
        WideNode(self.with(Op::Mul(self.id, other.id)))
    }
}

impl<'g> Signal for Node<'g> {
    type Wide = WideNode<'g>;
    type Bool = Flag<'g>;

    fn widen(self) -> WideNode<'g> {
        WideNode(self)
    }
    fn scale(self, power: i32) -> Self {
        if power == 0 {
            self
        } else {
            let constant = self.recorder.scaled(self.id, power);
            constant.unwrap_or_else(|| self.with(Op::Scale(self.id, power)))
        }
    }
    fn quantise(self, to: &Quantiser) -> Self {
        self.with(Op::Quantise(self.id, *to))
    }
    fn less_than(self, other: Self) -> Flag<'g> {
        Flag(self.with(Op::LessThan(self.id, other.id)))
    }
    fn select(condition: Flag<'g>, yes: Self, no: Self) -> Self {
        yes.with(Op::Select(condition.0.id, yes.id, no.id))
    }
    fn lookup(rom: &Rom, column: usize, address: Self) -> Self {
        let index = address.recorder.rom(rom);
        address.with(Op::Lookup {
            rom: index,
            column,
            address: address.id,
        })
    }
    fn named(self, name: &'static str) -> Self {
        self.recorder.name(self.id, name);
        self
    }
    fn begin(self, formula: &'static Formula) {
        self.recorder.begin(formula);
    }
}

impl Add for WideNode<'_> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for WideNode<'_> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl<'g> Wide for WideNode<'g> {
    type Narrow = Node<'g>;

    fn scale(self, power: i32) -> Self {
        Self(self.0.scale(power))
    }
    fn quantise(self, to: &Quantiser) -> Node<'g> {
        self.0.quantise(to)
    }
    fn quantise_geared(self, gear: Node<'g>, stride: u32, last: u32, to: &Quantiser) -> Node<'g> {
        // What has one gear alone is never shifted.
        if last == 0 {
            return self.quantise(to);
        }
        self.0.with(Op::QuantiseGeared {
            value: self.0.id,
            gear: gear.id,
            stride,
            last,
            to: *to,
        })
    }
    fn named(self, name: &'static str) -> Self {
        Self(self.0.named(name))
    }
}

impl Logic for Flag<'_> {
    fn and(self, other: Self) -> Self {
        Self(self.0.with(Op::And(self.0.id, other.0.id)))
    }
    fn or(self, other: Self) -> Self {
        Self(self.0.with(Op::Or(self.0.id, other.0.id)))
    }
    fn xor(self, other: Self) -> Self {
        Self(self.0.with(Op::Xor(self.0.id, other.0.id)))
    }
    fn not(self) -> Self {
        Self(self.0.with(Op::Not(self.0.id)))
    }
    fn named(self, name: &'static str) -> Self {
        Self(self.0.named(name))
    }
}
