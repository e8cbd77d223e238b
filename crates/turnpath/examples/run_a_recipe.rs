//! A recipe, its report, its verdict and its points: `cargo run --release -p turnpath --example run_a_recipe`.

use turnpath::{Catalogue, Job, Outputs, Recipe, SilentObserver};

fn main() -> Result<(), turnpath::Error> {
    let recipes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/recipes");
    let recipe = Recipe::load(format!("{recipes}/astigmatic-5mm.toml"), &[])?;
    let recipe = recipe.set("tolerance.residual", "50 nm")?;
    let job = Job::new(recipe, &Catalogue::linked()?)?;
    let result = job.run(Outputs::in_memory(), &SilentObserver)?;
    print!("{}", turnpath::report::text::run(&result.report, &[]));
    println!("everything holds: {}", result.report.verdict().holds());
    if let Some(path) = result.toolpath {
        let last = path.len() - 1;
        let (t, x, z) = (path.t[last], path.x[last], path.z[last]);
        println!(
            "{} points; at {t:.3} s the nose rests at X = {x:.4} mm, Z = {z:.4} mm",
            path.len()
        );
    }
    Ok(())
}
