//! Velocity solvers.

use abi_stable::StableAbi;
use abi_stable::std_types::RSlice;
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Dependence, Nodes, Result, Velocities, VelocitySolver};

use super::declaration::prelude::*;
use super::loan::{composite, crossing};

composite! {
    Velocities => AbiVelocities { c: &'a mut [f64], x: &'a mut [f64], z: &'a mut [f64] }
}

/// The columns of the nodes: t, c, x, z, c_rate, x_rate, z_theta, z_x. More may follow. Bit 0 of
/// `ends` marks the path's first node, and bit 1 its last.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiNodes<'a> {
    columns: RSlice<'a, RSlice<'a, f64>>,
    ends: u32,
}

crossing! {
    ['a] Nodes<'a> => AbiNodes<'w>, ([RSlice<'a, f64>; 8], u32):
        |nodes, lengths| {
            let Nodes { t, c, x, z, c_rate, x_rate, z_theta, z_x, at_start, at_end } = nodes;
            let columns = [t, c, x, z, c_rate, x_rate, z_theta, z_x];
            columns.iter().for_each(|column| lengths.add(column.len()));
            (columns.map(RSlice::from_slice), u32::from(at_start) | u32::from(at_end) << 1)
        },
        |lender| AbiNodes { columns: lender.0.as_slice().into(), ends: lender.1 };
    ['a] AbiNodes<'a> => Nodes<'w>, AbiNodes<'a>: |nodes| nodes, |nodes| {
        let mut columns = nodes.columns.iter().map(RSlice::as_slice);
        let mut column = || columns.next().unwrap_or_default();
        let [t, c, x, z, c_rate, x_rate, z_theta, z_x] = std::array::from_fn(|_| column());
        let (at_start, at_end) = (nodes.ends & 1 != 0, nodes.ends & 2 != 0);
        Nodes { t, c, x, z, c_rate, x_rate, z_theta, z_x, at_start, at_end }
    };
}

declare! {
    VelocitySolver: Deref AsPtr, Send Sync => AbiVelocity, AbiVelocity_TO, IncomingVelocity<'b>;
    properties {
        dependence: Dependence,
        segments: SegmentShape = SegmentShape::Cubic,
        gives_exact_rates: bool = false,
    }
    methods {
        fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()>;
        fn solve_sequential(
            &self, nodes: Nodes<'_>, state: &mut Vec<f64>, out: Velocities<'_>,
        ) -> Result<()>;
    }
    owned by OwnedVelocity
}
