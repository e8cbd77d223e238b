//! `turnpath sag`: the surface on a grid.

use std::io::{BufWriter, ErrorKind};

use turnpath::{Catalogue, Error, write_sag, write_sag_to};

use super::output::is_standard;
use super::setup;
use crate::args::SagArgs;
use crate::failure::Failure;
use crate::print::Output;
use crate::{Outcome, Status};

/// Writes the recipe's surface on a grid over the square around the aperture.
pub fn sag(args: &SagArgs, catalogue: Catalogue) -> Outcome {
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    let count = args.grid as usize;
    if !is_standard(&args.output) {
        write_sag(&recipe, &catalogue, count, &args.output)?;
        return Ok(Status::Holds);
    }
    let mut output = BufWriter::new(Output);
    match write_sag_to(&recipe, &catalogue, count, &mut output, &args.output) {
        // A reader that has gone, such as `head`, is no failure.
        Err(Error::File(error)) if error.error.kind() == ErrorKind::BrokenPipe => {}
        Err(Error::File(error)) => return Err(Failure::Output(error.error)),
        answer => answer?,
    }
    Ok(Status::Holds)
}
