//! Feed strategies across the boundary.

use abi_stable::StableAbi;
use abi_stable::sabi_trait;
use abi_stable::std_types::{RBox, RVec};
use turnpath_core::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Result, Setup, Task};

use super::data::{AbiTask, Answer, answer, result};
use super::locus::{self, IncomingLocus, LentLocus, OutgoingLocus};
use super::panic_safe_box::PanicSafeBox;
use super::surface::{self, LentSurface, OutgoingSurface};

/// Task and locus, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiSetup<'a> {
    task: AbiTask,
    locus: LentLocus<'a>,
    surface: LentSurface<'a>,
}

/// Lends a setup for the duration of `call`.
pub fn lend_setup<T>(setup: Setup<'_>, call: impl FnOnce(AbiSetup<'_>) -> T) -> T {
    let (locus, surface) = (
        OutgoingLocus(setup.locus),
        OutgoingSurface(setup.locus.surface()),
    );
    call(AbiSetup {
        task: setup.task.into(),
        locus: locus::lend(&locus),
        surface: surface::lend(&surface),
    })
}

impl AbiSetup<'_> {
    /// Converts the setup to that of the core, for the duration of `call`.
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
    /// Appends pieces as (length, coefficients). Returns false when the law is complete.
    #[sabi(last_prefix_field)]
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool>;
}

/// A feed strategy that belongs to its plugin.
pub type OwnedFeed = AbiFeed_TO<'static, RBox<()>>;
/// A law that is being planned and belongs to its plugin.
pub type OwnedPlan = AbiPlan_TO<'static, RBox<()>>;

/// The author's strategy, wrapped for the boundary.
pub struct OutgoingFeed(pub PanicSafeBox<dyn FeedStrategy>);

impl AbiFeed for OutgoingFeed {
    fn plan(&self, setup: AbiSetup<'_>) -> Answer<OwnedPlan> {
        answer(|| {
            let plan = setup.receive(|setup| self.0.plan(setup))?;
            Ok(AbiPlan_TO::from_value(
                OutgoingPlan(PanicSafeBox::new(plan)),
                sabi_trait::TD_Opaque,
            ))
        })
    }
}

struct OutgoingPlan(PanicSafeBox<dyn FeedPlan>);

impl AbiPlan for OutgoingPlan {
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool> {
        answer(|| {
            let mut appended = Vec::new();
            let continuation = setup.receive(|setup| self.0.extend(setup, &mut appended))?;
            pieces.extend(appended.iter().map(
                |FeedPiece {
                     length,
                     coefficients: c,
                 }| { [*length, c[0], c[1], c[2], c[3], c[4], c[5]] },
            ));
            Ok(continuation == Continuation::More)
        })
    }
}

/// A plugin's feed strategy, wrapped as a strategy of the core.
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
        let mut appended = RVec::new();
        let more = result(lend_setup(setup, |setup| {
            self.0.extend(setup, &mut appended)
        }))?;
        pieces.extend(
            appended
                .iter()
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
