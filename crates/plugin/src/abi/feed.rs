//! Feed strategies and the laws that they plan.

use abi_stable::std_types::RVec;
use turnpath_core::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Result, Setup};

use super::declaration::prelude::*;
use super::laws::{row, unrow};
use super::loan::lists;

/// Pieces as (length, coefficients). The host appends them to those that it has.
type AbiPieces = RVec<[f64; 7]>;

lists! {
    Vec<FeedPiece> => AbiPieces: |_list| AbiPieces::new(), |list, pieces| {
        list.extend(pieces.iter().map(unrow).map(|(length, coefficients)| {
            FeedPiece { length, coefficients }
        }));
    };
    AbiPieces => Vec<FeedPiece>: |_list| Vec::new(), |list, pieces| {
        list.extend(pieces.iter().map(|piece| row(piece.length, piece.coefficients)));
    };
}

declare! {
    FeedStrategy: Deref AsPtr, Send Sync => AbiFeed, AbiFeed_TO, IncomingFeed<'b>;
    methods {
        fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>>;
    }
    owned by OwnedFeed
}

declare! {
    FeedPlan: DerefMut AsMutPtr, Send => AbiFeedPlan, AbiFeedPlan_TO, IncomingFeedPlan<'b>;
    methods {
        fn extend[mut](
            &self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>,
        ) -> Result<Continuation>;
    }
    owned by OwnedFeedPlan
}
