//! A whole tool path as columns.

use turnpath_core::toolpath::{PathBlock, Section};

/// A tool path: a column for each quantity, a row for each control point, from the first lead to
/// the last.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ToolPath {
    /// What each point is for.
    pub section: Vec<Section>,
    /// Time, s.
    pub t: Vec<f64>,
    /// C, unwrapped, rad.
    pub c: Vec<f64>,
    /// X of the nose centre, mm.
    pub x: Vec<f64>,
    /// Z of the nose centre, mm.
    pub z: Vec<f64>,
    /// dC/dt, rad/s.
    pub vc: Vec<f64>,
    /// dX/dt, mm/s.
    pub vx: Vec<f64>,
    /// dZ/dt, mm/s.
    pub vz: Vec<f64>,
}

impl ToolPath {
    /// How many control points there are.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    pub(crate) fn append(&mut self, section: Section, block: &PathBlock) {
        let rows = self.len() + block.len();
        self.section.resize(rows, section);
        self.t.extend_from_slice(&block.t);
        self.c.extend_from_slice(&block.c);
        self.x.extend_from_slice(&block.x);
        self.z.extend_from_slice(&block.z);
        self.vc.extend_from_slice(&block.vc);
        self.vx.extend_from_slice(&block.vx);
        self.vz.extend_from_slice(&block.vz);
    }
}
