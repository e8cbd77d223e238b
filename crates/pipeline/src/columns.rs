//! What a velocity solver gets, a column for each quantity.

use std::ops::Range;

use turnpath_core::{NodeList, NodeOffset, Nodes};

/// Nodes on the locus. The columns have the same length; units and meaning are those of
/// [`Nodes`].
#[derive(Default)]
pub struct Columns {
    pub t: Vec<f64>,
    pub c: Vec<f64>,
    pub x: Vec<f64>,
    pub z: Vec<f64>,
    pub c_rate: Vec<f64>,
    pub x_rate: Vec<f64>,
    pub z_theta: Vec<f64>,
    pub z_x: Vec<f64>,
    /// Z of each node above the locus, mm. It is part of `z`.
    pub dz: Vec<f64>,
}

impl Columns {
    fn each(&self) -> [&Vec<f64>; 9] {
        let Self {
            t,
            c,
            x,
            z,
            c_rate,
            x_rate,
            z_theta,
            z_x,
            dz,
        } = self;
        [t, c, x, z, c_rate, x_rate, z_theta, z_x, dz]
    }

    fn each_mut(&mut self) -> [&mut Vec<f64>; 9] {
        let Self {
            t,
            c,
            x,
            z,
            c_rate,
            x_rate,
            z_theta,
            z_x,
            dz,
        } = self;
        [t, c, x, z, c_rate, x_rate, z_theta, z_x, dz]
    }

    /// Appends the nodes `range` of another set.
    pub fn append(&mut self, other: &Self, range: Range<usize>) {
        for (own, other) in self.each_mut().into_iter().zip(other.each()) {
            own.extend_from_slice(&other[range.clone()]);
        }
    }

    /// All quantities of a node.
    pub fn node(&self, node: usize) -> Option<[f64; 9]> {
        (node < self.len()).then(|| self.each().map(|column| column[node]))
    }

    /// Appends a node.
    pub fn push(&mut self, node: [f64; 9]) {
        for (own, value) in self.each_mut().into_iter().zip(node) {
            own.push(value);
        }
    }

    /// Moves the nodes off the locus. The offsets must not have been added yet.
    pub fn shift(&mut self, nodes: &NodeList) {
        if !nodes.has_offsets() {
            return;
        }
        for i in 0..self.len() {
            let NodeOffset { dz, dz_dc } = nodes.offset(i);
            self.z[i] += dz;
            self.z_theta[i] += dz_dc;
            self.dz[i] = dz;
        }
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// The first node of which a quantity is no number.
    pub fn first_unknown(&self) -> Option<usize> {
        // Without a way out of the loop it goes through vector registers.
        let is_known = |column: &&Vec<f64>| {
            column
                .iter()
                .fold(true, |all, value| all & value.is_finite())
        };
        if self.each().iter().all(is_known) {
            return None;
        }
        let is_unknown = |node: &usize| self.each().iter().any(|column| !column[*node].is_finite());
        (0..self.len()).find(is_unknown)
    }

    /// A further column without values.
    pub fn unset(&self) -> Vec<f64> {
        vec![f64::NAN; self.len()]
    }

    /// The nodes as a velocity solver gets them. `at_start` and `at_end` say whether the first
    /// node is the path's first, and the last one its last.
    pub fn nodes(&self, at_start: bool, at_end: bool) -> Nodes<'_> {
        Nodes {
            t: &self.t,
            c: &self.c,
            x: &self.x,
            z: &self.z,
            c_rate: &self.c_rate,
            x_rate: &self.x_rate,
            z_theta: &self.z_theta,
            z_x: &self.z_x,
            at_start,
            at_end,
        }
    }
}
