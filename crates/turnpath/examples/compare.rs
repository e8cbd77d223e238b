//! Three samplers side by side: `cargo run --release -p turnpath --example compare`.

use turnpath::report::AblationRun;
use turnpath::report::comparison::{by_name, table};
use turnpath::{Catalogue, Job, Outputs, Recipe, SilentObserver};

fn main() -> Result<(), turnpath::Error> {
    let recipes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/recipes");
    let catalogue = Catalogue::linked()?;
    let mut runs = Vec::new();
    for sampler in ["equal-angle", "atpg", "fft-adaptive"] {
        let recipe = Recipe::load(format!("{recipes}/astigmatic-5mm.toml"), &[])?;
        let recipe = recipe.set("sampler", &format!("{{ use = \"{sampler}\" }}"))?;
        let result = Job::new(recipe, &catalogue)?.run(Outputs::nowhere(), &SilentObserver)?;
        println!(
            "{sampler}: everything holds: {}",
            result.report.verdict().holds()
        );
        let varied = vec![("sampler".to_owned(), sampler.to_owned())];
        runs.push(AblationRun::new(varied, result.report));
    }
    let columns = [
        "points",
        "added",
        "error-max",
        "error-rms",
        "residual",
        "time",
    ];
    let columns: Vec<_> = columns.into_iter().filter_map(by_name).collect();
    print!("\n{}", table(&runs, &columns, 100, runs.first()));
    Ok(())
}
