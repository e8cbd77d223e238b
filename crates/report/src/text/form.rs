//! The lines on the form of the machined surface.

use crate::form::{FormReport, FormSplit};

use super::numbers::{against, line, small_length};

/// What a person should know where a search changed nothing.
const DECIDED: &str = "other tolerances leave the same: the recipe's own feed and steps decide it";

/// The form against its tolerance, and how the tolerance was divided.
pub fn form(report: &FormReport, verdict: Option<bool>) -> String {
    let tolerance = report.tolerance;
    let judged = match report.pv {
        Some(pv) => against(pv, tolerance, verdict.unwrap_or(false)),
        None => "not measured: nothing of the part is cut; EXCEEDED".to_owned(),
    };
    let split = report.split.as_ref().map(split);
    line("form", judged) + &split.unwrap_or_default()
}

/// What the first path will be made for.
pub fn first_split(report: &FormReport) -> String {
    let tolerance = small_length(report.tolerance);
    let split = report.split.as_ref().map(split);
    line("form", format!("{tolerance:>12}")) + &split.unwrap_or_default()
}

fn split(split: &FormSplit) -> String {
    let [residual, interpolation] = [split.residual, split.interpolation].map(small_length);
    let made = match split.rounds {
        0 => String::new(),
        1 => "; the path was made once".to_owned(),
        rounds => format!("; the path was made {rounds} times"),
    };
    let ended = split.search_ended_because.as_ref();
    let ended = ended.map(|why| line("", format!("no other path could be made: {why}")));
    let decided = split.decided_by_recipe.then(|| line("", DECIDED));
    line(
        "",
        format!("with residual {residual}, interpolation {interpolation}{made}"),
    ) + &decided.or(ended).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(pv: Option<f64>, rounds: u32) -> FormReport {
        FormReport {
            tolerance: 150e-6,
            pv,
            split: Some(FormSplit {
                residual: 100e-6,
                interpolation: 25e-6,
                rounds,
                search_ended_because: None,
                decided_by_recipe: false,
            }),
        }
    }

    #[test]
    fn a_person_reads_the_form_and_its_split() {
        assert_eq!(
            form(&report(Some(141.2e-6), 2), Some(true)),
            "  form               141.20 nm of 150.00 nm   holds\n                  with residual \
             100.00 nm, interpolation 25.00 nm; the path was made 2 times\n"
        );
        let file = FormReport {
            split: None,
            ..report(Some(151e-6), 1)
        };
        let text = form(&file, Some(false));
        assert!(
            text.ends_with("EXCEEDED\n") && !text.contains("with"),
            "{text}"
        );
        assert!(
            form(&report(None, 1), Some(false)).contains("nothing of the part is cut; EXCEEDED")
        );
        let mut refused = report(Some(141.2e-6), 1);
        refused.split.as_mut().unwrap().search_ended_because = Some("too fine".to_owned());
        let text = form(&refused, Some(true));
        assert!(
            text.ends_with("no other path could be made: too fine\n"),
            "{text}"
        );
        let mut decided = report(Some(65.8e-6), 4);
        decided.split.as_mut().unwrap().decided_by_recipe = true;
        let text = form(&decided, Some(true));
        assert!(text.ends_with("feed and steps decide it\n"), "{text}");
        let text = first_split(&report(None, 0));
        assert!(text.ends_with("interpolation 25.00 nm\n"), "{text}");
    }
}
