//! `[ablation]`: the variants of a recipe. Each takes values of the lists instead of the recipe's own.
//!
//! ```toml
//! [ablation]
//! mode = "all-pairs"                                # the full product; or "one-at-a-time"
//! feed = [{ use = "constant" }, { use = "ats" }]    # tables, each in place of the whole [feed]
//! tolerance.residual = ["50 nm", "100 nm"]          # values of any other key
//! ```

mod label;
mod lists;
mod sums;

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Entry, Node, Table, Value};
use crate::recipe::{Recipe, build};
use crate::set::{self, Setting};

use lists::{List, Lists, Mode};

/// Most variants of a recipe: whoever asks for more has made a mistake in a list.
pub const MOST_RUNS: usize = 4096;

/// One of the recipes that `[ablation]` asks for.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// The keys that vary, in the order of the lists, with this variant's values. All variants have
    /// the same keys.
    pub variations: Vec<Variation>,
    /// The recipe, without `[ablation]`.
    pub recipe: Recipe,
}

/// A key that varies, and one of its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variation {
    /// The path of the key, `feed` or `tolerance.residual`.
    pub key: String,
    /// The value as text. For a strategy this is its name, with its parameters if several values of
    /// the list have that name; `(default)` if the recipe leaves the key out.
    pub value: String,
}

/// The index of the chosen value in each list; 0 is the recipe's own value.
type Pick = Vec<usize>;

impl Recipe {
    /// The recipes that `[ablation]` asks for. This recipe comes first; the others follow in the
    /// order of the lists, and the last list varies fastest. A value that the recipe has already is
    /// not repeated. If the recipe does not give `refine`, it is off.
    ///
    /// # Errors
    /// When there is no `[ablation]`, or something in it is wrong. The messages have their spans in
    /// that table.
    pub fn variants(&self) -> Result<Vec<Variant>, Diagnostics> {
        let base = self.ablation_base();
        let Lists { mode, lists } = Lists::read(self.document(), &base, self.whole())?;
        let picks = match mode {
            Mode::AllPairs => all_pairs(&lists),
            Mode::OneAtATime => one_at_a_time(&lists),
        };
        let Some(picks) = picks else {
            return Err(too_many(self, &lists).into());
        };
        let mut diagnostics = Vec::new();
        let variants = picks
            .iter()
            .map(|pick| self.variant(&base, &lists, pick, &mut diagnostics));
        let variants: Option<Vec<Variant>> = variants.collect::<Vec<_>>().into_iter().collect();
        // A wrong value gives the same message with each value of the other lists.
        let mut once: Vec<Diagnostic> = Vec::new();
        for diagnostic in diagnostics {
            if !once.contains(&diagnostic) {
                once.push(diagnostic);
            }
        }
        Diagnostics::unless_any(variants, once)
    }

    /// The recipe's own values without `[ablation]`, and with `refine` off unless the recipe gives
    /// it.
    fn ablation_base(&self) -> Table {
        let mut base = self.document().clone();
        base.remove("ablation");
        if base.get("refine").is_none() {
            let span = self.whole().clone();
            let value = Value::Flag(false);
            base.put(Entry {
                key: "refine".to_owned(),
                span: span.clone(),
                node: Node { value, span },
            });
        }
        base
    }

    fn variant(
        &self,
        base: &Table,
        lists: &[List],
        pick: &Pick,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Variant> {
        let mut document = base.clone();
        for (list, &index) in lists.iter().zip(pick).filter(|(_, index)| **index > 0) {
            let setting = Setting {
                keys: list.path.clone(),
                node: list.choices.get(index)?.clone()?,
            };
            diagnostics.extend(set::put(&mut document, setting).err());
        }
        let sets = self.sets().to_vec();
        let recipe = build(
            document,
            sets,
            self.whole().clone(),
            self.path(),
            diagnostics,
        )?;
        let variations = lists.iter().zip(pick).map(|(list, &index)| Variation {
            key: list.key(),
            value: label::of_choice(list, index),
        });
        Some(Variant {
            variations: variations.collect(),
            recipe,
        })
    }
}

/// Every value with every other; `None` if there are too many.
fn all_pairs(lists: &[List]) -> Option<Vec<Pick>> {
    let mut picks = vec![Pick::new()];
    for list in lists {
        let count = list.choices.len();
        if picks.len().saturating_mul(count) > MOST_RUNS {
            return None;
        }
        let longer = |pick: &Pick| {
            let pick = pick.clone();
            (0..count).map(move |index| [pick.as_slice(), &[index]].concat())
        };
        picks = picks.iter().flat_map(longer).collect();
    }
    Some(picks)
}

/// The recipe's own values, then each other value alone; `None` if there are too many.
fn one_at_a_time(lists: &[List]) -> Option<Vec<Pick>> {
    let own = vec![0; lists.len()];
    let mut picks = vec![own.clone()];
    for (which, list) in lists.iter().enumerate() {
        for index in 1..list.choices.len() {
            let mut pick = own.clone();
            pick[which] = index;
            picks.push(pick);
        }
    }
    (picks.len() <= MOST_RUNS).then_some(picks)
}

fn too_many(recipe: &Recipe, lists: &[List]) -> Diagnostic {
    let counts: Vec<String> = lists
        .iter()
        .map(|list| list.choices.len().to_string())
        .collect();
    let title = format!("this ablation asks for more than {MOST_RUNS} runs");
    Diagnostic::new(recipe.nearest_span("ablation"), title)
        .with_label(format!("{} values", counts.join(" × ")))
        .with_help("shorten its lists, or write mode = \"one-at-a-time\"")
}

#[cfg(test)]
mod tests;
