//! Makes a recipe's path in one thread and writes the lines of its programs, without measuring them:
//! `cargo run --release -p turnpath-cli --example chain RECIPE FILE`. `cargo xtask bench` times it.

use std::error::Error;
use std::fs::File;
use std::path::PathBuf;

use turnpath::{Catalogue, Job, Recipe, SilentObserver};

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args_os().skip(1).map(PathBuf::from);
    let (Some(recipe), Some(file)) = (words.next(), words.next()) else {
        return Err("chain RECIPE FILE".into());
    };
    turnpath_cli::keep_memory();
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()?;
    let catalogue = Catalogue::linked()?;
    let job = Job::new(Recipe::load(recipe, &[])?, &catalogue)?;
    let mut output = File::create(&file)?;
    let points = job.write_unmeasured(&file, &mut output, &SilentObserver)?;
    println!("{points}");
    Ok(())
}
