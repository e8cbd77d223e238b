//! Samplers across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RSlice, RVec};
use turnpath_core::{Dependence, Path, Result, Revolutions, Sampler, Setup, SpiralLaw};

use super::data::{AbiLaw, Answer, answer, result};
use super::feed::{AbiSetup, lend_setup};
use super::panic_safe_box::PanicSafeBox;

/// How a strategy depends on its neighbours. `overlap` has a meaning for `kind` 1 alone.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiDependence {
    kind: u8,
    overlap: u64,
}

impl From<Dependence> for AbiDependence {
    fn from(dependence: Dependence) -> Self {
        match dependence {
            Dependence::Local => Self {
                kind: 0,
                overlap: 0,
            },
            Dependence::Overlap(nodes) => Self {
                kind: 1,
                overlap: nodes as u64,
            },
            Dependence::Sequential => Self {
                kind: 2,
                overlap: 0,
            },
        }
    }
}

impl From<AbiDependence> for Dependence {
    fn from(dependence: AbiDependence) -> Self {
        match dependence.kind {
            0 => Self::Local,
            1 => Self::Overlap(usize::try_from(dependence.overlap).unwrap_or(usize::MAX)),
            _ => Self::Sequential,
        }
    }
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiPath<'a, 'p> {
    setup: AbiSetup<'a>,
    law: AbiLaw,
    prepared: RSlice<'p, f64>,
    start: f64,
    end: f64,
}

fn lend_path<T>(path: &Path<'_>, block: Revolutions, call: impl FnOnce(AbiPath<'_, '_>) -> T) -> T {
    let Revolutions { start, end } = block;
    lend_setup(
        Setup {
            task: path.task,
            locus: path.locus,
        },
        |setup| {
            call(AbiPath {
                setup,
                law: path.law.into(),
                prepared: path.prepared.into(),
                start,
                end,
            })
        },
    )
}

impl AbiPath<'_, '_> {
    fn receive<T>(self, call: impl FnOnce(&Path<'_>, Revolutions) -> T) -> T {
        let block = Revolutions {
            start: self.start,
            end: self.end,
        };
        let law = SpiralLaw::from(&self.law);
        let prepared = self.prepared;
        self.setup.receive(|Setup { task, locus }| {
            call(
                &Path {
                    task,
                    locus,
                    law: &law,
                    prepared: prepared.as_slice(),
                },
                block,
            )
        })
    }
}

#[sabi_trait]
pub trait AbiSampler: Send + Sync {
    fn dependence(&self) -> Answer<AbiDependence>;
    fn prepare(&self, path: AbiPath<'_, '_>) -> Answer<RVec<f64>>;
    fn place(&self, path: AbiPath<'_, '_>, nodes: &mut RVec<f64>) -> Answer<()>;
    #[sabi(last_prefix_field)]
    fn place_sequential(
        &self,
        path: AbiPath<'_, '_>,
        state: &mut RVec<f64>,
        nodes: &mut RVec<f64>,
    ) -> Answer<()>;
}

/// A sampler that belongs to its plugin.
pub type OwnedSampler = AbiSampler_TO<'static, RBox<()>>;

/// The author's sampler, wrapped for the boundary.
pub struct OutgoingSampler(pub PanicSafeBox<dyn Sampler>);

impl AbiSampler for OutgoingSampler {
    fn dependence(&self) -> Answer<AbiDependence> {
        answer(|| Ok(self.0.dependence().into()))
    }

    fn prepare(&self, path: AbiPath<'_, '_>) -> Answer<RVec<f64>> {
        answer(|| Ok(path.receive(|path, _| self.0.prepare(path))?.into()))
    }

    fn place(&self, path: AbiPath<'_, '_>, nodes: &mut RVec<f64>) -> Answer<()> {
        answer(|| {
            let mut placed = Vec::new();
            path.receive(|path, block| self.0.place(path, block, &mut placed))?;
            nodes.extend(placed);
            Ok(())
        })
    }

    fn place_sequential(
        &self,
        path: AbiPath<'_, '_>,
        state: &mut RVec<f64>,
        nodes: &mut RVec<f64>,
    ) -> Answer<()> {
        answer(|| {
            let (mut kept, mut placed) = (state.to_vec(), Vec::new());
            path.receive(|path, block| {
                self.0.place_sequential(path, block, &mut kept, &mut placed)
            })?;
            *state = kept.into();
            nodes.extend(placed);
            Ok(())
        })
    }
}

/// A plugin's sampler, wrapped as a sampler of the core. The wrapper reads the dependence once,
/// when it is built.
pub struct IncomingSampler {
    sampler: OwnedSampler,
    dependence: Dependence,
}

impl IncomingSampler {
    /// Reads the sampler's dependence and wraps the sampler.
    pub fn new(sampler: OwnedSampler) -> Result<Self> {
        let dependence = result(sampler.dependence())?.into();
        Ok(Self {
            sampler,
            dependence,
        })
    }
}

impl Sampler for IncomingSampler {
    fn dependence(&self) -> Dependence {
        self.dependence
    }

    fn prepare(&self, path: &Path<'_>) -> Result<Vec<f64>> {
        let whole = Revolutions {
            start: 0.0,
            end: path.law.end(),
        };
        let found = lend_path(path, whole, |path| self.sampler.prepare(path));
        Ok(result(found)?.into())
    }

    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut Vec<f64>) -> Result<()> {
        let mut placed = RVec::new();
        result(lend_path(path, block, |path| {
            self.sampler.place(path, &mut placed)
        }))?;
        nodes.extend(placed);
        Ok(())
    }

    fn place_sequential(
        &self,
        path: &Path<'_>,
        block: Revolutions,
        state: &mut Vec<f64>,
        nodes: &mut Vec<f64>,
    ) -> Result<()> {
        let (mut kept, mut placed) = (RVec::from(std::mem::take(state)), RVec::new());
        let answer = lend_path(path, block, |path| {
            self.sampler.place_sequential(path, &mut kept, &mut placed)
        });
        *state = kept.into();
        nodes.extend(placed);
        result(answer)
    }
}
