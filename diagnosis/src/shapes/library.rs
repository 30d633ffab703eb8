//! The functions that shapes are made of: each is used along the radius, along the circle, or both. A cause is a
//! weighted sum of them, so that one pass over the samples serves every cause.

use std::rc::Rc;

use crate::shapes::block::Block;
use crate::shapes::trig::Trig;

/// Which residual a function stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Row {
    /// Along the radius.
    Radial,
    /// Along the circle: above the motion, or against the reference.
    Tangential,
    /// Real motion, apart from the tangential residual where there is a reference.
    Motion,
}

/// All rows, in the order of their numbers.
pub(crate) const ROWS: [Row; 3] = [Row::Radial, Row::Tangential, Row::Motion];

/// Writes functions of a block one after the other. Blocks come in the order of the samples.
pub(crate) type Fill = Rc<dyn Fn(&Block, &mut [f64])>;

/// How the functions of a group are used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Use {
    /// As they are, along the radius.
    Radial,
    /// As they are, each in both ways.
    Both,
    /// As real motion.
    Motion,
    /// Changes of the corrected cosine, then as many of the sine: rotated to the radius and to the circle.
    Pairs,
    /// Changes along the radius, then as many along the circle.
    Rows,
}

impl Use {
    /// Values that one function has at a sample.
    pub(crate) fn values(self) -> usize {
        match self {
            Self::Pairs | Self::Rows => 2,
            Self::Radial | Self::Both | Self::Motion => 1,
        }
    }
}

/// Functions that are made together.
#[derive(Clone)]
pub(crate) struct Group {
    /// Number of atoms in each row that it stands in.
    pub count: usize,
    /// How they are used.
    pub way: Use,
    pub(crate) fill: Fill,
}

impl Group {
    /// Writes its functions as they stand in the rows.
    pub(crate) fn write(&self, block: &Block, out: &mut [f64]) {
        (self.fill)(block, out);
        if self.way == Use::Pairs {
            rotate(block, out, self.count);
        }
    }
}

/// Changes of cosine and sine → along the radius and along the circle.
fn rotate(block: &Block, values: &mut [f64], count: usize) {
    let n = block.len();
    let (c, s) = values.split_at_mut(count * n);
    for (c, s) in c.chunks_mut(n).zip(s.chunks_mut(n)) {
        rotated([c, s], [block.cos, block.sin]);
    }
}

/// Pairs, turned back by an angle of which these are cosine and sine.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn rotated([c, s]: [&mut [f64]; 2], [cos, sin]: [&[f64]; 2]) {
    for ((c, s), (cos, sin)) in c.iter_mut().zip(s).zip(cos.iter().zip(sin)) {
        (*c, *s) = (*c * cos + *s * sin, *s * cos - *c * sin);
    }
}

/// One function in one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Atom {
    pub(crate) row: Row,
    pub(crate) group: usize,
    pub(crate) function: usize,
}

/// A weighted sum of atoms.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape(pub(crate) Vec<(usize, f64)>);

/// Every function there is.
#[derive(Clone, Default)]
pub(crate) struct Library {
    pub(crate) groups: Vec<Group>,
    pub(crate) atoms: Vec<Atom>,
    /// There is a third row.
    pub(crate) with_motion: bool,
}

/// Where the atoms of a group stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    radial: Option<usize>,
    tangential: Option<usize>,
}

impl Library {
    /// Adds functions.
    pub(crate) fn add(&mut self, count: usize, way: Use, fill: Fill) -> Place {
        let group = self.groups.len();
        let fast = if self.with_motion {
            Row::Motion
        } else {
            Row::Tangential
        };
        let (radial, tangential) = match way {
            Use::Radial => (true, None),
            Use::Motion => (false, Some(fast)),
            Use::Both | Use::Pairs | Use::Rows => (true, Some(Row::Tangential)),
        };
        self.groups.push(Group { count, way, fill });
        let mut enter = |row: Row| {
            let first = self.atoms.len();
            let atom = |function| Atom {
                row,
                group,
                function,
            };
            self.atoms.extend((0..count).map(atom));
            first
        };
        Place {
            radial: radial.then(|| enter(Row::Radial)),
            tangential: tangential.map(enter),
        }
    }

    /// Adds one change of the corrected pair.
    pub(crate) fn pair(
        &mut self,
        fill: impl Fn(&Block, &mut [f64], &mut [f64]) + 'static,
    ) -> Shape {
        let fill: Fill = Rc::new(move |block, out| {
            let (c, s) = out.split_at_mut(block.len());
            fill(block, c, s);
        });
        self.add(1, Use::Pairs, fill).both(0)
    }

    /// Leaves out every atom that is not kept; the new number of each.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let mut next = 0;
        let map: Vec<Option<usize>> = (0..self.atoms.len())
            .map(|i| {
                keep(i).then(|| {
                    next += 1;
                    next - 1
                })
            })
            .collect();
        let kept = self.atoms.iter().zip(&map).filter(|(_, new)| new.is_some());
        self.atoms = kept.map(|(atom, _)| *atom).collect();
        map
    }
}

impl Place {
    /// Function `i` along the radius.
    pub(crate) fn radial(&self, i: usize) -> Shape {
        Shape(
            self.radial
                .map(|first| (first + i, 1.0))
                .into_iter()
                .collect(),
        )
    }

    /// Function `i` along the circle, or as motion.
    pub(crate) fn tangential(&self, i: usize) -> Shape {
        Shape(
            self.tangential
                .map(|first| (first + i, 1.0))
                .into_iter()
                .collect(),
        )
    }

    /// Function `i` in both rows at once: a pair.
    pub(crate) fn both(&self, i: usize) -> Shape {
        let mut shape = self.radial(i);
        shape.0.extend(self.tangential(i).0);
        shape
    }

    /// Polynomials of the angle along the radius and along the circle, times the `by`-th of the modulations of which
    /// each has waves up to order `top`.
    pub(crate) fn waves(&self, parts: &[Trig; 2], by: usize, top: usize) -> Shape {
        let mut shape = Shape::default();
        for (trig, first) in parts.iter().zip([self.radial, self.tangential]) {
            let Some(first) = first else { continue };
            for (order, [a, b]) in trig.0.iter().enumerate() {
                debug_assert!(order <= top || (*a == 0.0 && *b == 0.0));
                let at = first + by * (2 * top + 1);
                let pairs = if order == 0 {
                    [(at, *a), (at, 0.0)]
                } else {
                    [(at + 2 * order - 1, *a), (at + 2 * order, *b)]
                };
                shape.0.extend(pairs.into_iter().filter(|p| p.1 != 0.0));
            }
        }
        shape
    }
}

impl Shape {
    /// With other atom numbers.
    pub(crate) fn mapped(&self, map: &[Option<usize>]) -> Self {
        let kept = self.0.iter();
        Self(
            kept.filter_map(|(i, x)| map[*i].map(|new| (new, *x)))
                .collect(),
        )
    }

    /// The same by places in an ordered list of atoms, those that are there.
    pub(crate) fn among(&self, atoms: &[usize]) -> Self {
        let at = |i: &usize| atoms.binary_search(i).ok();
        let known = self.0.iter().filter_map(|(i, x)| Some((at(i)?, *x)));
        Self(known.collect())
    }

    /// The same of several.
    pub(crate) fn all_among(shapes: &[Self], atoms: &[usize]) -> Vec<Self> {
        shapes.iter().map(|s| s.among(atoms)).collect()
    }

    /// What of it stands in these atoms.
    pub(crate) fn only(&self, kept: &[bool]) -> Self {
        let list = self.0.iter().copied();
        Self(list.filter(|(i, _)| kept[*i]).collect())
    }

    /// So many times the shape.
    pub(crate) fn scaled(&self, by: f64) -> Self {
        Self(self.0.iter().map(|(i, x)| (*i, x * by)).collect())
    }

    /// The sum of two.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self(self.0.iter().chain(&other.0).copied().collect())
    }
}
