//! Velocity solvers.

use abi_stable::StableAbi;
use abi_stable::std_types::RSlice;
use turnpath_core::toolpath::SegmentShape;
use turnpath_core::{Dependence, Nodes, Result, Velocities, VelocitySolver};

use super::declaration::{declare, owned};
use super::loan::{Crossing, Lengths, columns, crossing};
use super::reply::codes;

codes! {
    SegmentShape { 0 => SegmentShape::Cubic, 1 => SegmentShape::Linear }
}

columns! {
    Velocities => AbiVelocities { c, x, z } of f64;
}

/// The columns of the nodes in this order: t, c, x, z, c_rate, x_rate, z_theta, z_x. More may
/// follow. Bit 0 of `ends` marks the path's first node, and bit 1 its last.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiNodes<'a> {
    columns: RSlice<'a, RSlice<'a, f64>>,
    ends: u32,
}

pub struct NodesLender<'a> {
    columns: [RSlice<'a, f64>; 8],
    ends: u32,
}

impl<'a> Crossing for Nodes<'a> {
    type Wire<'w> = AbiNodes<'w>;
    type Lender = NodesLender<'a>;

    fn lender(self) -> Result<NodesLender<'a>> {
        let Nodes {
            t,
            c,
            x,
            z,
            c_rate,
            x_rate,
            z_theta,
            z_x,
            at_start,
            at_end,
        } = self;
        Ok(NodesLender {
            columns: [t, c, x, z, c_rate, x_rate, z_theta, z_x].map(RSlice::from_slice),
            ends: u32::from(at_start) | u32::from(at_end) << 1,
        })
    }

    fn lend<'l>(lender: &'l mut NodesLender<'a>) -> AbiNodes<'l> {
        AbiNodes {
            columns: lender.columns.as_slice().into(),
            ends: lender.ends,
        }
    }

    fn count(lender: &NodesLender<'a>, lengths: &mut Lengths) {
        lender
            .columns
            .iter()
            .for_each(|column| lengths.add(column.len()));
    }
}

crossing! {
    ['a] AbiNodes<'a> => Nodes<'w>, |nodes| {
        let mut columns = nodes.columns.iter().map(RSlice::as_slice);
        let mut column = || columns.next().unwrap_or_default();
        Nodes {
            t: column(),
            c: column(),
            x: column(),
            z: column(),
            c_rate: column(),
            x_rate: column(),
            z_theta: column(),
            z_x: column(),
            at_start: nodes.ends & 1 != 0,
            at_end: nodes.ends & 2 != 0,
        }
    };
}

declare! {
    VelocitySolver => AbiVelocity, AbiVelocity_TO, IncomingVelocity<'b>;
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
    later {}
}
owned!(VelocitySolver => AbiVelocity_TO, IncomingVelocity, OwnedVelocity);
