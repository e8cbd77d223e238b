//! Feed strategies across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RVec};
use turnpath_core::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Result, Setup, Task};

use super::contained::Contained;
use super::data::{AbiTask, Answer, answer, result};
use super::locus::{self, IncomingLocus, LentLocus, OutgoingLocus};
use super::surface::{self, LentSurface, Outgoing};

/// Task and locus, lent for the time of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiSetup<'a> {
    task: AbiTask,
    locus: LentLocus<'a>,
    surface: LentSurface<'a>,
}

/// Lends a setup for the time of `call`.
pub fn lend_setup<T>(setup: Setup<'_>, call: impl FnOnce(AbiSetup<'_>) -> T) -> T {
    let (locus, surface) = (OutgoingLocus(setup.locus), Outgoing(setup.locus.surface()));
    call(AbiSetup {
        task: setup.task.into(),
        locus: locus::lend(&locus),
        surface: surface::lend(&surface),
    })
}

impl AbiSetup<'_> {
    /// The setup as the core's, for the time of `call`.
    pub fn receive<T>(self, call: impl FnOnce(Setup<'_>) -> T) -> T {
        let task = Task::from(&self.task);
        let locus = IncomingLocus::new(self.locus, self.surface);
        call(Setup {
            task: &task,
            locus: &locus,
        })
    }
}

#[sabi_trait]
pub trait AbiFeed: Send + Sync {
    #[sabi(last_prefix_field)]
    fn plan(&self, setup: AbiSetup<'_>) -> Answer<OwnedPlan>;
}

#[sabi_trait]
pub trait AbiPlan: Send {
    /// Appends pieces as (length, coefficients); false when the law is done.
    #[sabi(last_prefix_field)]
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool>;
}

/// A feed strategy that its plugin made.
pub type OwnedFeed = AbiFeed_TO<'static, RBox<()>>;
/// A law in the making that its plugin holds.
pub type OwnedPlan = AbiPlan_TO<'static, RBox<()>>;

/// The author's strategy, on its way out.
pub struct OutgoingFeed(pub Contained<dyn FeedStrategy>);

impl AbiFeed for OutgoingFeed {
    fn plan(&self, setup: AbiSetup<'_>) -> Answer<OwnedPlan> {
        answer(|| {
            let plan = setup.receive(|setup| self.0.plan(setup))?;
            Ok(AbiPlan_TO::from_value(
                OutgoingPlan(Contained::new(plan)),
                sabi_trait::TD_Opaque,
            ))
        })
    }
}

struct OutgoingPlan(Contained<dyn FeedPlan>);

impl AbiPlan for OutgoingPlan {
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool> {
        answer(|| {
            let mut made = Vec::new();
            let continuation = setup.receive(|setup| self.0.extend(setup, &mut made))?;
            pieces.extend(made.iter().map(
                |FeedPiece {
                     length,
                     coefficients: c,
                 }| { [*length, c[0], c[1], c[2], c[3], c[4], c[5]] },
            ));
            Ok(continuation == Continuation::More)
        })
    }
}

/// A plugin's feed strategy, as the core's.
pub struct IncomingFeed(pub OwnedFeed);

impl FeedStrategy for IncomingFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let plan = result(lend_setup(setup, |setup| self.0.plan(setup)))?;
        Ok(Box::new(IncomingPlan(plan)))
    }
}

struct IncomingPlan(OwnedPlan);

impl FeedPlan for IncomingPlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let mut made = RVec::new();
        let more = result(lend_setup(setup, |setup| self.0.extend(setup, &mut made)))?;
        pieces.extend(
            made.iter()
                .map(|[length, c0, c1, c2, c3, c4, c5]| FeedPiece {
                    length: *length,
                    coefficients: [*c0, *c1, *c2, *c3, *c4, *c5],
                }),
        );
        Ok(if more {
            Continuation::More
        } else {
            Continuation::End
        })
    }
}
