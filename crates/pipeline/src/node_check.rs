//! What the host requires of the nodes of a block.

use turnpath_core::{LARGEST_OFFSET, MOST_STEPS_OF_TURN, NM, NodeList, NodeOffset, Revolutions};

/// Most nodes that a sampler may place in a block. More are taken for a mistake.
const MOST_NODES: usize = 4_000_000;
/// Smallest distance between nodes, in revolutions. Closer nodes are a sampler's mistake: the
/// velocity between them would be rounding.
pub const CLOSEST_NODES: f64 = 1e-9;
/// An offset may exceed its limit by this part: rounding.
const ROUNDING: f64 = 1e-12;

/// The requirements on the nodes of one block.
pub struct NodeCheck {
    /// The block.
    pub block: Revolutions,
    /// Whether it is the path's last block, which may be empty.
    pub is_last: bool,
    /// The interpolation tolerance, mm.
    pub tolerance: f64,
    /// Whether nodes may lie off the locus: the solver gives the rates that they rely on.
    pub allows_offsets: bool,
}

impl NodeCheck {
    /// Checks the nodes.
    ///
    /// # Errors
    /// What is wrong, and where.
    pub fn check(&self, nodes: &NodeList) -> Result<(), String> {
        let context = in_revolutions(self.block);
        if nodes.is_empty() && !self.is_last {
            return Err(format!("no node {context}"));
        }
        if nodes.len() > MOST_NODES {
            return Err(format!(
                "{} nodes {context}; at most {MOST_NODES} are allowed",
                nodes.len()
            ));
        }
        self.check_order(nodes.revolutions())
            .and_then(|()| self.check_offsets(nodes))
            .map_err(|what| format!("{what}, {context}"))
    }

    fn check_order(&self, nodes: &[f64]) -> Result<(), String> {
        let mut last: Option<f64> = None;
        for (i, node) in nodes.iter().enumerate() {
            if node.is_nan() {
                let said = "`subdivide` gives that for less than one step, and for more than";
                return Err(format!(
                    "node {i} is NaN ({said} {MOST_STEPS_OF_TURN:e}, on a revolution)"
                ));
            }
            if node.is_infinite() {
                return Err(format!("node {i} is {node}"));
            }
            if !(self.block.start..self.block.end).contains(node) {
                return Err(format!("node {i} at {node} lies outside the block"));
            }
            if let Some(last) = last.filter(|last| node - last < CLOSEST_NODES) {
                return Err(format!("node {i} at {node} does not lie beyond {last}"));
            }
            last = Some(*node);
        }
        Ok(())
    }

    fn check_offsets(&self, nodes: &NodeList) -> Result<(), String> {
        if !nodes.has_offsets() {
            return Ok(());
        }
        let most = LARGEST_OFFSET * self.tolerance;
        for (i, node) in nodes.revolutions().iter().enumerate() {
            let NodeOffset { dz, dz_dc } = nodes.offset(i);
            if !(dz.is_finite() && dz_dc.is_finite()) {
                return Err(format!(
                    "node {i} at {node} has the offsets {dz} and {dz_dc}"
                ));
            }
            if dz.abs() > most * (1.0 + ROUNDING) {
                let [dz, most] = [dz, most].map(|length| length / NM);
                return Err(format!(
                    "node {i} at {node} lies {dz:.4} nm off the locus; at most {LARGEST_OFFSET} of \
                     the interpolation tolerance are allowed, {most:.4} nm"
                ));
            }
            let is_off = dz != 0.0 || dz_dc != 0.0;
            if is_off && !self.allows_offsets {
                return Err(format!(
                    "node {i} at {node} lies off the locus, but the sampler does not say that it needs \
                     exact rates"
                ));
            }
            if is_off && *node < CLOSEST_NODES {
                return Err("the path's first point lies off the locus".to_owned());
            }
        }
        Ok(())
    }
}

/// A block in the words of messages.
pub fn in_revolutions(block: Revolutions) -> String {
    format!("in revolutions {:.0} to {:.3}", block.start, block.end)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_of(offset: NodeOffset, n: f64) -> Result<(), String> {
        let check = NodeCheck {
            block: Revolutions {
                start: 0.0,
                end: 2.0,
            },
            is_last: false,
            tolerance: 100.0 * NM,
            allows_offsets: true,
        };
        let mut nodes = NodeList::default();
        nodes.push_off(n, offset);
        check.check(&nodes)
    }

    #[test]
    fn offsets_within_the_limit_pass() {
        for dz in [98.0 * NM, -98.0 * NM, 0.0] {
            let offset = NodeOffset { dz, dz_dc: 1e-3 };
            assert_eq!(check_of(offset, 1.0), Ok(()));
        }
        assert_eq!(check_of(NodeOffset::default(), 0.0), Ok(()));
    }

    #[test]
    fn other_offsets_are_refused_with_their_place() {
        let refused =
            |dz: f64, dz_dc: f64, n: f64| check_of(NodeOffset { dz, dz_dc }, n).unwrap_err();
        let far = refused(98.1 * NM, 0.0, 1.0);
        assert!(
            far.contains("98.1000 nm") && far.contains("98.0000 nm"),
            "{far}"
        );
        assert!(far.ends_with("in revolutions 0 to 2.000"), "{far}");
        assert!(refused(f64::NAN, 0.0, 1.0).contains("NaN"));
        assert!(refused(0.0, f64::INFINITY, 1.0).contains("inf"));
        assert!(refused(NM, 0.0, 0.0).contains("first point"));
        assert!(refused(0.0, 1e-9, 0.0).contains("first point"));
    }
}
