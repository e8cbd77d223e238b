//! All checks of all strategies of a plugin.

use std::fmt;

use turnpath_core::{Slot, StrategyInfo};
use turnpath_host::{Catalogue, LoadError, Strategy};

use crate::chain::TrialChain;
use crate::fault::{Fault, FaultKind};
use crate::trial::Trial;
use crate::trial_part::{PARTS, TrialPart};
use crate::{compensator, feed, sampler, spindle, surface, velocity, whole_path};

/// The checks of a plugin's strategies, with what their author says of them.
#[derive(Debug)]
pub struct Conformance {
    catalogue: Result<Catalogue, LoadError>,
    plugin: String,
    trials: Vec<Trial>,
}

/// What the checks found.
#[derive(Debug, Default)]
pub struct Findings {
    /// What is wrong; empty where the plugin passes.
    pub faults: Vec<Fault>,
    /// What each strategy came to on each trial part, a line each.
    pub figures: Vec<String>,
}

impl Conformance {
    /// The strategies that the crate of this name registers, as `env!("CARGO_CRATE_NAME")` gives it.
    pub fn of_crate(name: &str) -> Self {
        Self::of(Catalogue::linked(), &name.replace('_', "-"))
    }

    /// The strategies of the plugin of this name in a catalogue. The catalogue also has the
    /// strategies of the other stages, as [`Catalogue::linked`] gives them.
    pub fn of(catalogue: Result<Catalogue, LoadError>, plugin: &str) -> Self {
        Self {
            catalogue,
            plugin: plugin.to_owned(),
            trials: Vec::new(),
        }
    }

    /// The checks with this trial in place of the strategy's defaults. A strategy may have several
    /// trials.
    #[must_use]
    pub fn with(mut self, trial: Trial) -> Self {
        self.trials.push(trial);
        self
    }

    /// Does all checks.
    pub fn findings(self) -> Findings {
        let mut findings = Findings::default();
        match self.catalogue {
            Ok(catalogue) => {
                let plugin = PluginTrials {
                    plugin: &self.plugin,
                    trials: &self.trials,
                };
                plugin.check_all(&catalogue, &mut findings);
            }
            Err(error) => findings.faults.push(of_declaration(&self.plugin, error)),
        }
        findings
    }

    /// Does all checks, and panics with what they found.
    ///
    /// # Panics
    /// Where a check finds a fault, or where there is no strategy.
    #[track_caller]
    pub fn assert(self) {
        let plugin = self.plugin.clone();
        let findings = self.findings();
        println!("{findings}");
        assert!(findings.faults.is_empty(), "\n{findings}");
        assert!(
            !findings.figures.is_empty(),
            "the crate {plugin} exports no strategy; is `export!` in it?"
        );
    }
}

/// The trials of a plugin's strategies.
struct PluginTrials<'a> {
    plugin: &'a str,
    trials: &'a [Trial],
}

impl PluginTrials<'_> {
    fn check_all(&self, catalogue: &Catalogue, findings: &mut Findings) {
        let own = |one: &&Strategy| one.plugin().name == self.plugin;
        let infos: Vec<StrategyInfo> = catalogue
            .strategies()
            .filter(own)
            .map(Strategy::info)
            .collect();
        for info in &infos {
            let trials: Vec<&Trial> = self.trials.iter().filter(|one| is_of(one, info)).collect();
            let default = Trial::of(info.name);
            let trials = match trials.is_empty() {
                true => vec![&default],
                false => trials,
            };
            for trial in trials {
                for part in &PARTS {
                    check_on(part, info, trial, catalogue, findings);
                }
            }
        }
        let names: Vec<&str> = infos.iter().map(|info| info.name).collect();
        for trial in self.trials {
            if !infos.iter().any(|info| is_of(trial, info)) {
                findings.faults.push(Fault {
                    slot: None,
                    strategy: trial.name.clone(),
                    part: None,
                    kind: FaultKind::Unknown {
                        known: names.join(", "),
                    },
                });
            }
        }
    }
}

/// Whether a trial is of this strategy.
fn is_of(trial: &Trial, info: &StrategyInfo) -> bool {
    trial.name == info.name || trial.name == format!("{}/{}", info.slot.key(), info.name)
}

/// The fault of strategies that no catalogue takes.
fn of_declaration(plugin: &str, error: LoadError) -> Fault {
    let (slot, strategy) = match &error {
        LoadError::UnusableName { slot, name, .. } | LoadError::TwoOfOneName { slot, name, .. } => {
            (Some(*slot), name.clone())
        }
        LoadError::HostKey { slot, strategy, .. }
        | LoadError::TooManyColumns { slot, strategy, .. } => (Some(*slot), strategy.clone()),
        _ => (None, plugin.to_owned()),
    };
    Fault {
        slot,
        strategy,
        part: None,
        kind: FaultKind::Declaration(error),
    }
}

/// All checks of one strategy on one part.
fn check_on(
    part: &TrialPart,
    info: &StrategyInfo,
    trial: &Trial,
    catalogue: &Catalogue,
    findings: &mut Findings,
) {
    let faults = match chains(part, info, trial, catalogue) {
        Ok([chain, anew]) => check_chain(info.slot, trial, [&chain, &anew], |figures| {
            let (slot, name, part) = (info.slot, info.name, part.name);
            findings
                .figures
                .push(format!("{slot}/{name} on the {part}: {figures}"));
        }),
        Err(kind) => vec![kind],
    };
    findings.faults.extend(faults.into_iter().map(|kind| Fault {
        slot: Some(info.slot),
        strategy: info.name.to_owned(),
        part: Some(part.name),
        kind,
    }));
}

/// The chain twice, each with strategies of its own.
fn chains(
    part: &TrialPart,
    info: &StrategyInfo,
    trial: &Trial,
    catalogue: &Catalogue,
) -> Result<[TrialChain; 2], FaultKind> {
    let recipe = part.recipe(info.slot, info.name, trial)?;
    Ok([
        TrialChain::new(&recipe, catalogue)?,
        TrialChain::new(&recipe, catalogue)?,
    ])
}

/// The checks of the slot alone, and those of whole paths.
fn check_chain(
    slot: Slot,
    trial: &Trial,
    [chain, anew]: [&TrialChain; 2],
    mut tell: impl FnMut(String),
) -> Vec<FaultKind> {
    let mut faults = match slot {
        Slot::Surface => surface::check(chain.chain.surface.strategy.as_ref(), &chain.task().part),
        Slot::Feed => feed::check(chain),
        Slot::Sampler => sampler::check(chain).into_iter().collect(),
        Slot::Compensator => compensator::check(chain),
        Slot::Velocity => {
            let solver = chain.chain.velocity.strategy.as_ref();
            tell(format!(
                "exact on motions of degree {}",
                velocity::exact_degree(solver)
            ));
            velocity::check(trial, solver)
        }
        Slot::Spindle => Vec::new(),
    };
    if !faults.is_empty() {
        // A path of wrong answers says nothing more, and may take long to refine.
        return faults;
    }
    match whole_path::check(chain, anew) {
        Err(kind) => faults.push(kind),
        Ok(outcomes) => {
            tell(whole_path::figures(&outcomes));
            faults.extend(whole_path::holds_as_played(trial, chain, &outcomes));
            let [_, refined] = &outcomes;
            faults.extend(whole_path::holds_residual(trial, chain, refined));
            if slot == Slot::Spindle {
                faults.extend(spindle::check(chain, refined));
            }
        }
    }
    faults
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for figures in &self.figures {
            writeln!(f, "{figures}")?;
        }
        for fault in &self.faults {
            writeln!(f, "fault: {fault}")?;
        }
        Ok(())
    }
}
