//! Feed strategies and the laws that they plan.

use abi_stable::sabi_trait;
use abi_stable::sabi_trait::TD_Opaque;
use abi_stable::std_types::{RBox, RVec};
use turnpath_core::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Result, Setup};

use super::declaration::{Outgoing, declare, owned};
use super::loan::Crossing;
use super::panic_safe_box::PanicSafeBox;
use super::path::{AbiSetup, row, unrow};
use super::reply::{Answer, Value, answer, result};

declare! {
    FeedStrategy => AbiFeed, AbiFeed_TO, IncomingFeed<'b>;
    properties {}
    methods {
        fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>>;
    }
    later {}
}
owned!(FeedStrategy => AbiFeed_TO, IncomingFeed, OwnedFeed);

/// The one trait that is written by hand: it changes while it is called.
#[sabi_trait]
pub trait AbiFeedPlan: Send {
    /// Appends pieces as (length, coefficients). Returns false when the law is complete.
    #[sabi(last_prefix_field)]
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool>;
}

/// A law that is being planned and belongs to its plugin.
pub type OwnedFeedPlan = AbiFeedPlan_TO<'static, RBox<()>>;

impl AbiFeedPlan for Outgoing<PanicSafeBox<dyn FeedPlan>> {
    fn extend(&mut self, setup: AbiSetup<'_>, pieces: &mut RVec<[f64; 7]>) -> Answer<bool> {
        answer(|| {
            let mut appended = Vec::new();
            let mut setup = setup.lender()?;
            let continuation = self.0.extend(AbiSetup::lend(&mut setup), &mut appended)?;
            pieces.extend(appended.iter().map(|p| row(p.length, p.coefficients)));
            Ok(continuation == Continuation::More)
        })
    }
}

struct IncomingFeedPlan(OwnedFeedPlan);

impl FeedPlan for IncomingFeedPlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let mut appended = RVec::new();
        let mut setup = setup.lender()?;
        let more = result(self.0.extend(Setup::lend(&mut setup), &mut appended))?;
        pieces.extend(appended.iter().map(|piece| {
            let (length, coefficients) = unrow(piece);
            FeedPiece {
                length,
                coefficients,
            }
        }));
        Ok(if more {
            Continuation::More
        } else {
            Continuation::End
        })
    }
}

impl Value for Box<dyn FeedPlan> {
    type Wire = OwnedFeedPlan;

    fn send(self) -> OwnedFeedPlan {
        AbiFeedPlan_TO::from_value(Outgoing(PanicSafeBox::new(self)), TD_Opaque)
    }

    fn receive(plan: OwnedFeedPlan) -> Result<Self> {
        Ok(Box::new(IncomingFeedPlan(plan)))
    }
}
