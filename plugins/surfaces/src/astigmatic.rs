//! The astigmatic surface z = k ρ² sin 2θ.

use turnpath_plugin::prelude::*;

/// z = k ρ² sin 2θ = 2k·x·y: a saddle with k·ρ² above and below its tangent plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Astigmatic {
    twice_k: f64,
}

const K: Param<PerLength> =
    Param::per_length("k", "height over the square of the radius, along the ridge");

impl Strategy for Astigmatic {
    const NAME: &'static str = "astigmatic";
    const SUMMARY: &'static str = "a saddle, z = k ρ² sin 2θ";
    const SOURCE: &'static str =
        "the astigmatic mirror of Wang et al. 2019, Materials 12, 810, doi:10.3390/ma12050810";
    const PARAMS: &'static [ParamInfo] = &[K.info()];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            twice_k: 2.0 * params.get(K),
        })
    }
}

impl Surface for Astigmatic {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * y * self.twice_k
    }
}
