//! The parts on which strategies are tried: small, so that a whole path takes a part of a second.

use std::path::Path;

use toml::{Table, Value};
use turnpath_core::Slot;
use turnpath_recipe::{Recipe, tables};

use crate::fault::FaultKind;
use crate::trial::Trial;

/// A part to try strategies on, with the other stages.
#[derive(Debug)]
pub struct TrialPart {
    /// Its name in messages.
    pub name: &'static str,
    recipe: &'static str,
}

/// A saddle from the axis outward, and a ring of a sinusoidal array from the rim inward. The path of the
/// saddle has two blocks, so that several threads have something to do.
pub const PARTS: [TrialPart; 2] = [
    TrialPart {
        name: "saddle",
        recipe: r#"
format = 1
part = { aperture = "3.6 mm" }
surface = { use = "astigmatic", k = "0.08 /mm" }
tool = { nose_radius = "1 mm", included_angle = "120 deg", clearance_angle = "30 deg" }
tolerance = { interpolation = "100 nm", residual = "100 nm" }
spindle = { speed = "500 rpm" }
machine = { z_acceleration = "3 m/s^2", c_acceleration = "50 rad/s^2" }
path = { direction = "outward", lead = false }
feed = { use = "constant" }
sampler = { use = "equal-angle" }
compensator = { use = "z-direction" }
velocity = { use = "analytic" }
"#,
    },
    TrialPart {
        name: "ring",
        recipe: r#"
format = 1
part = { aperture = "5 mm", inner = "3 mm" }
surface = { use = "sinusoidal-array", form = "sum", amplitude_x = "5 um", frequency_x = "0.4 /mm" }
tool = { nose_radius = "0.5 mm", included_angle = "120 deg", clearance_angle = "30 deg" }
tolerance = { interpolation = "50 nm", residual = "200 nm" }
spindle = { speed = "300 rpm" }
machine = { z_acceleration = "1 m/s^2", c_acceleration = "50 rad/s^2" }
path = { direction = "inward", lead = false }
feed = { use = "constant" }
sampler = { use = "equal-angle" }
compensator = { use = "normal" }
velocity = { use = "analytic" }
"#,
    },
];

impl TrialPart {
    /// The recipe with a strategy in its slot, and with what the trial changes.
    pub fn recipe(&self, slot: Slot, strategy: &str, trial: &Trial) -> Result<Recipe, FaultKind> {
        let mut recipe: Table = self.recipe.parse().map_err(FaultKind::Toml)?;
        let mut own = Table::new();
        own.insert("use".to_owned(), strategy.into());
        let lines: Table = trial.lines.parse().map_err(FaultKind::Toml)?;
        for (key, value) in lines {
            match value {
                Value::Table(table) if is_table(&key) => change(&mut recipe, key, table),
                value => {
                    own.insert(key, value);
                }
            }
        }
        if slot == Slot::Spindle {
            change(&mut recipe, "spindle".to_owned(), own);
        } else {
            recipe.insert(slot.key().to_owned(), own.into());
        }
        let file = Path::new(&trial.folder).join("trial.toml");
        Recipe::parse(&recipe.to_string(), file, &[]).map_err(FaultKind::Lines)
    }
}

/// Whether a recipe has a table of this name.
fn is_table(key: &str) -> bool {
    tables().any(|table| table.name == key) || Slot::ALL.iter().any(|slot| slot.key() == key)
}

/// Changes keys of a table, or the whole table where another strategy is used.
fn change(recipe: &mut Table, name: String, table: Table) {
    match recipe.get_mut(&name) {
        Some(Value::Table(old)) if name == "spindle" || !table.contains_key("use") => {
            old.extend(table);
        }
        _ => {
            recipe.insert(name, table.into());
        }
    }
}
