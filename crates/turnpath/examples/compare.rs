//! Three samplers side by side on one part: `cargo run --release -p turnpath --example compare`.

use turnpath::report::comparison::{by_names, table};
use turnpath::report::{AblationRun, MeasuredRun, RunOutcome};
use turnpath::{Catalogue, Job, Outputs, Recipe, SilentObserver};

fn main() -> Result<(), turnpath::Error> {
    let recipes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/recipes");
    let catalogue = Catalogue::linked()?;
    let mut runs = Vec::new();
    for sampler in [
        "{ use = \"equal-angle\" }",
        "{ use = \"atpg\" }",
        "{ use = \"fft-adaptive\" }",
    ] {
        let recipe = Recipe::load(format!("{recipes}/astigmatic-5mm.toml"), &[])?;
        let recipe = recipe.set("sampler", sampler)?;
        let result = Job::new(recipe, &catalogue)?.run(Outputs::nowhere(), &SilentObserver)?;
        let name = result.report.chain.sampler.clone();
        println!(
            "{name}: {}",
            if result.report.verdict().holds() {
                "holds"
            } else {
                "exceeded"
            }
        );
        runs.push(AblationRun {
            varied: vec![("sampler".to_owned(), name)],
            outcome: RunOutcome::Measured(Box::new(MeasuredRun {
                report: result.report,
                program_bytes: None,
                planning_time: f64::NAN,
            })),
        });
    }
    let columns = [
        "points",
        "added",
        "error-max",
        "error-rms",
        "residual",
        "time",
    ]
    .map(str::to_owned);
    println!("\n{}", table(&runs, &by_names(&columns), 100));
    Ok(())
}
