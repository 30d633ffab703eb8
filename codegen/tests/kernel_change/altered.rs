//! A reading of [`Signal`] that records like `Node`, but changes one formula: every difference in it is a sum.

use std::cell::Cell;
use std::ops::{Add, Mul, Neg, Sub};

use nonius_model::format::Quantiser;
use nonius_model::graph::{Flag, Node, WideNode};
use nonius_model::kernel::{Coefficients, Input, Probes, State, Structure, sample};
use nonius_model::rom::Rom;
use nonius_model::signal::{Formula, Signal, Wide};

thread_local! {
    /// Title of the formula that is changed.
    static CHANGED: Cell<&'static str> = const { Cell::new("") };
    /// What is being recorded belongs to it.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// A node, narrow or wide.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Altered<N>(N);

impl<N: Add<Output = N>> Add for Altered<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl<N: Add<Output = N> + Sub<Output = N>> Sub for Altered<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self(if INSIDE.get() { a + b } else { a - b })
    }
}

impl Neg for Altered<Node<'_>> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<'g> Mul for Altered<Node<'g>> {
    type Output = Altered<WideNode<'g>>;
    fn mul(self, other: Self) -> Altered<WideNode<'g>> {
        Altered(self.0 * other.0)
    }
}

impl<'g> Signal for Altered<Node<'g>> {
    type Wide = Altered<WideNode<'g>>;
    type Bool = Flag<'g>;

    fn widen(self) -> Altered<WideNode<'g>> {
        Altered(self.0.widen())
    }
    fn scale(self, power: i32) -> Self {
        Self(self.0.scale(power))
    }
    fn quantise(self, to: &Quantiser) -> Self {
        Self(self.0.quantise(to))
    }
    fn less_than(self, other: Self) -> Flag<'g> {
        self.0.less_than(other.0)
    }
    fn select(condition: Flag<'g>, yes: Self, no: Self) -> Self {
        Self(Node::select(condition, yes.0, no.0))
    }
    fn lookup(rom: &Rom, column: usize, address: Self) -> Self {
        Self(Node::lookup(rom, column, address.0))
    }
    fn named(self, name: &'static str) -> Self {
        Self(self.0.named(name))
    }
    fn begin(self, formula: &'static Formula) {
        INSIDE.set(formula.title == CHANGED.get());
        self.0.begin(formula);
    }
}

impl<'g> Wide for Altered<WideNode<'g>> {
    type Narrow = Altered<Node<'g>>;

    fn scale(self, power: i32) -> Self {
        Self(self.0.scale(power))
    }
    fn quantise(self, to: &Quantiser) -> Altered<Node<'g>> {
        Altered(self.0.quantise(to))
    }
    fn quantise_geared(
        self,
        gear: Altered<Node<'g>>,
        stride: u32,
        last: u32,
        to: &Quantiser,
    ) -> Altered<Node<'g>> {
        Altered(self.0.quantise_geared(gear.0, stride, last, to))
    }
    fn named(self, name: &'static str) -> Self {
        Self(self.0.named(name))
    }
}

/// The formula that [`kernel`] changes.
pub(crate) fn change(title: &'static str) {
    CHANGED.set(title);
    INSIDE.set(false);
}

/// The chip's own kernel, recorded with that formula changed.
pub(crate) fn kernel<'g>(
    input: &Input<Node<'g>>,
    state: &State<Node<'g>>,
    k: &Coefficients<Node<'g>>,
    structure: &Structure,
) -> (State<Node<'g>>, Probes<Node<'g>>) {
    let there = "a member of this name";
    let (next, probes) = sample(
        &Input {
            adc_cos: Altered(input.adc_cos),
            adc_sin: Altered(input.adc_sin),
            preset: input.preset,
            calibrate: input.calibrate,
        },
        &State::build(
            |name| Altered(state.value(name).expect(there)),
            |name| state.flag(name).expect(there),
        ),
        &k.map(|_, node| Altered(node)),
        structure,
    );
    (
        State::build(
            |name| next.value(name).expect(there).0,
            |name| next.flag(name).expect(there),
        ),
        Probes::build(
            |name| probes.value(name).expect(there).0,
            |name| probes.flag(name).expect(there),
        ),
    )
}
