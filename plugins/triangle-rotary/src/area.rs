//! The area method: velocities from one node to the next, such that their curve has the right area.

use turnpath_plugin::prelude::*;

/// Least share of the later velocity. Below it, each error is larger at the next node.
const LEAST: f64 = 0.5;
/// Largest share. With 1 the area is that of the later velocity alone.
const LARGEST: f64 = 1.0;

/// The method takes the mean velocity of a segment as V_k + c(V_{k+1} − V_k). So V_{k+1} = V_k +
/// (ΔP_k/h_k − V_k)/c, starting from the exact rate at the path's start.
///
/// The available texts of the publications have lost the formula. This one is derived from their
/// description, and it gives the pattern of their figures. Each velocity contains the one before
/// with the factor 1 − 1/c. With c = ⅔ an error halves from node to node, and the error of position
/// is of order 2 in the step. With c = ½ it is of order 3 on even steps, on halved steps and on
/// steps that change smoothly. On steps in no order it is of order 2½, since no error ever decays:
/// all of them ring through the rest of the path. Therefore the method solves in order from the
/// path's start for every c: no overlap is long enough for all values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    c: f64,
}

const C: Param<Number> = Param::number(
        "c",
        "share of the later velocity in a segment's mean, 0.5 to 1; 0.5 rings, 0.667 decays by half a point",
    )
    .default(0.5)
    .max(LARGEST);

impl Strategy for Area {
    const NAME: &'static str = "area";
    const SUMMARY: &'static str =
        "velocities whose curve has each segment's area, one after the other";
    const SOURCE: &'static str = "the area method of the paper on triangle rotary, doi:10.1177/0954405416654192, \
        V₊ = V + (ΔP/h − V)/c (derived: the printed formula is lost); error of order 3 for c = ½, \
        ringing (2½ on steps in no order), of order 2 for larger c";
    const PARAMS: &'static [ParamInfo] = &[C.info()];

    /// The constructor, not the declared range, refuses c below ½, since it can give the reason.
    fn new(params: &Params) -> Result<Self> {
        let c = params.get(C);
        if c < LEAST {
            return Err(C.refused(format!(
                "c = {c} is unstable: an error of velocity grows from point to point, by \
                     |1 − 1/c| = {:.3}; choose 0.5 to 1",
                (1.0 - c.recip()).abs()
            )));
        }
        Ok(Self { c })
    }
}

impl VelocitySolver for Area {
    fn dependence(&self) -> Dependence {
        Dependence::Sequential
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        self.solve_sequential(nodes, &mut Vec::new(), out)
    }

    /// The state is the velocity of each axis at the block's last node, which is the next block's
    /// first.
    fn solve_sequential(
        &self,
        nodes: Nodes<'_>,
        state: &mut Vec<f64>,
        out: Velocities<'_>,
    ) -> Result<()> {
        if nodes.is_empty() {
            return Ok(());
        }
        let first = match state[..] {
            [c, x, z] => [c, x, z],
            _ => [nodes.c_rate[0], nodes.x_rate[0], nodes.z_rate(0)],
        };
        *state = vec![
            self.recurse(nodes.t, nodes.c, first[0], out.c),
            self.recurse(nodes.t, nodes.x, first[1], out.x),
            self.recurse(nodes.t, nodes.z, first[2], out.z),
        ];
        Ok(())
    }
}

impl Area {
    /// The velocities of one axis, starting with `first`. Returns the last velocity.
    fn recurse(&self, t: &[f64], p: &[f64], first: f64, out: &mut [f64]) -> f64 {
        let mut velocity = first;
        for (k, out) in out.iter_mut().enumerate() {
            if k > 0 {
                let mean = (p[k] - p[k - 1]) / (t[k] - t[k - 1]);
                velocity += (mean - velocity) / self.c;
            }
            *out = velocity;
        }
        velocity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_below_a_half_is_refused_and_the_reason_given() {
        let error = Area::new(&Params::new().with("c", 0.4)).unwrap_err();
        assert_eq!(
            error.to_string(),
            "parameter `c`: c = 0.4 is unstable: an error of velocity grows from point to point, \
             by |1 − 1/c| = 1.500; choose 0.5 to 1"
        );
        for c in [0.5, 2.0 / 3.0, 1.0] {
            assert!(Area::new(&Params::new().with("c", c)).is_ok());
        }
    }
}
