//! The nodes that a sampler places: their revolutions, and how far they lie off the locus.

use std::ops::Range;

/// The largest distance of a node from the locus, as a part of the interpolation tolerance.
/// Refinement halves segments whose error exceeds 0.99 of the tolerance, so a node itself must stay
/// below that.
pub const LARGEST_OFFSET: f64 = 0.98;

/// How a node lies off the locus of the nose centre.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeOffset {
    /// Z of the node above the locus, mm.
    pub dz: f64,
    /// What the node adds to dZ/dθ of the locus, mm/rad.
    pub dz_dc: f64,
}

/// Nodes along the spiral, in order. A node lies on the locus unless it was pushed with an offset.
///
/// ```
/// use turnpath_core::{NodeList, NodeOffset};
///
/// let mut nodes = NodeList::default();
/// nodes.push(0.0);
/// nodes.push_off(0.1, NodeOffset { dz: 2e-6, dz_dc: 0.0 });
/// assert_eq!(nodes.revolutions(), [0.0, 0.1]);
/// assert_eq!(nodes.offset(0), NodeOffset::default());
/// assert_eq!(nodes.offset(1).dz, 2e-6);
/// nodes.push(0.2);
/// nodes.keep(1..2);
/// assert_eq!((nodes.revolutions(), nodes.offset(0).dz), (&[0.1][..], 2e-6));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NodeList {
    n: Vec<f64>,
    /// Empty, or as long as `n`; so is `dz_dc`.
    dz: Vec<f64>,
    dz_dc: Vec<f64>,
}

impl NodeList {
    /// The list of these columns: revolutions, mm, mm/rad. The last two columns are both empty, or
    /// both as long as `n`; `None` if they are not.
    pub fn from_columns(n: Vec<f64>, dz: Vec<f64>, dz_dc: Vec<f64>) -> Option<Self> {
        let fits = dz.len() == dz_dc.len() && (dz.is_empty() || dz.len() == n.len());
        fits.then_some(Self { n, dz, dz_dc })
    }

    /// The columns `n`, `dz` and `dz_dc`, as [`from_columns`](Self::from_columns) takes them.
    pub fn into_columns(self) -> [Vec<f64>; 3] {
        [self.n, self.dz, self.dz_dc]
    }

    /// Appends a node on the locus at `n` revolutions.
    pub fn push(&mut self, n: f64) {
        if self.has_offsets() {
            self.dz.push(0.0);
            self.dz_dc.push(0.0);
        }
        self.n.push(n);
    }

    /// Appends a node off the locus at `n` revolutions.
    pub fn push_off(&mut self, n: f64, offset: NodeOffset) {
        self.dz.resize(self.n.len(), 0.0);
        self.dz_dc.resize(self.n.len(), 0.0);
        self.dz.push(offset.dz);
        self.dz_dc.push(offset.dz_dc);
        self.n.push(n);
    }

    /// Appends all nodes of another list.
    pub fn append(&mut self, other: Self) {
        if !other.has_offsets() {
            self.extend(other.n);
            return;
        }
        for i in 0..other.len() {
            self.push_off(other.n[i], other.offset(i));
        }
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.n.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.n.is_empty()
    }

    /// The nodes' positions in revolutions.
    pub fn revolutions(&self) -> &[f64] {
        &self.n
    }

    /// Whether a node may lie off the locus.
    pub fn has_offsets(&self) -> bool {
        !self.dz.is_empty()
    }

    /// The offset of node `index`; zero for a node on the locus, and beyond the list's end.
    pub fn offset(&self, index: usize) -> NodeOffset {
        match (self.dz.get(index), self.dz_dc.get(index)) {
            (Some(dz), Some(dz_dc)) => NodeOffset {
                dz: *dz,
                dz_dc: *dz_dc,
            },
            _ => NodeOffset::default(),
        }
    }

    /// Keeps the first `len` nodes.
    pub fn truncate(&mut self, len: usize) {
        self.n.truncate(len);
        self.dz.truncate(len);
        self.dz_dc.truncate(len);
    }

    /// Keeps the nodes of a range of numbers, which must not go beyond the last node.
    pub fn keep(&mut self, range: Range<usize>) {
        self.truncate(range.end);
        self.n.drain(..range.start);
        if self.has_offsets() {
            self.dz.drain(..range.start);
            self.dz_dc.drain(..range.start);
        }
    }

    /// Replaces the first `count` nodes by one node on the locus at `n` revolutions.
    pub fn replace_first(&mut self, count: usize, n: f64) {
        let count = count.min(self.len());
        if self.has_offsets() {
            self.dz.splice(..count, [0.0]);
            self.dz_dc.splice(..count, [0.0]);
        }
        self.n.splice(..count, [n]);
    }

    /// The same nodes so many revolutions on.
    #[must_use]
    pub fn turned_on(mut self, revolutions: f64) -> Self {
        self.n.iter_mut().for_each(|n| *n += revolutions);
        self
    }
}

impl Extend<f64> for NodeList {
    /// Appends nodes on the locus.
    fn extend<I: IntoIterator<Item = f64>>(&mut self, nodes: I) {
        self.n.extend(nodes);
        if self.has_offsets() {
            self.dz.resize(self.n.len(), 0.0);
            self.dz_dc.resize(self.n.len(), 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OFF: NodeOffset = NodeOffset {
        dz: 1e-6,
        dz_dc: -3e-6,
    };

    fn dz(nodes: &NodeList) -> Vec<f64> {
        (0..nodes.len()).map(|i| nodes.offset(i).dz).collect()
    }

    #[test]
    fn nodes_on_the_locus_take_no_offset_columns() {
        let mut nodes = NodeList::default();
        nodes.push(1.0);
        nodes.extend([2.0, 3.0]);
        assert_eq!(
            nodes.into_columns(),
            [vec![1.0, 2.0, 3.0], Vec::new(), Vec::new()]
        );
    }

    #[test]
    fn every_way_to_append_keeps_the_columns_as_long() {
        let mut nodes = NodeList::default();
        nodes.push(1.0);
        nodes.push_off(2.0, OFF);
        nodes.push(3.0);
        nodes.extend([4.0]);
        let mut other = NodeList::default();
        other.push_off(5.0, OFF);
        nodes.append(other.clone());
        other.append(NodeList::default());
        assert_eq!(dz(&nodes), [0.0, 1e-6, 0.0, 0.0, 1e-6]);
        nodes.replace_first(2, 0.0);
        nodes.truncate(3);
        assert_eq!(nodes.revolutions(), [0.0, 3.0, 4.0]);
        assert_eq!(dz(&nodes), [0.0; 3]);
        let [n, dz, dz_dc] = nodes.into_columns();
        assert!(NodeList::from_columns(n, dz, dz_dc).is_some());
    }

    #[test]
    fn columns_of_other_lengths_are_no_list() {
        assert!(NodeList::from_columns(vec![1.0], vec![0.0], Vec::new()).is_none());
        assert!(NodeList::from_columns(vec![1.0], vec![0.0; 2], vec![0.0; 2]).is_none());
        assert!(NodeList::from_columns(vec![1.0], Vec::new(), Vec::new()).is_some());
    }

    #[test]
    fn nodes_that_are_turned_on_keep_their_steps_and_their_offsets() {
        let mut nodes = NodeList::default();
        nodes.push_off(3.25, OFF);
        nodes.push(3.5);
        let on = nodes.clone().turned_on(-3.0);
        assert_eq!(on.revolutions(), [0.25, 0.5]);
        assert_eq!(dz(&on), dz(&nodes));
        assert_eq!(on.turned_on(3.0), nodes);
    }
}
