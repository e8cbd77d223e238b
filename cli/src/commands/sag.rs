//! `turnpath sag`: the surface on a grid.

use turnpath::{Catalogue, write_sag};

use super::setup;
use crate::args::SagArgs;
use crate::{Outcome, Status};

/// Writes the recipe's surface on a grid over the square around the aperture.
pub fn sag(args: &SagArgs, catalogue: Catalogue) -> Outcome {
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    write_sag(&recipe, &catalogue, args.grid as usize, &args.output)?;
    Ok(Status::Holds)
}
