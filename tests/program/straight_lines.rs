//! Programs of straight lines: what their controller plays too fast is refused, and straight paths go
//! as they are.

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;

/// A small flat part with a program for LinuxCNC, at 60 rpm and a feed.
fn flat(feed: &str) -> Bench {
    let recipe = SADDLE.replace("\"5 mm\"", "\"0.1 mm\"").replace(
        "use = \"constant\"",
        &format!("use = \"constant\"\nfeed = \"{feed}\""),
    );
    Bench::with(&format!("{recipe}\n[output]\nposts = [\"linuxcnc-g93\"]\n"))
}

const RUN: &str = "run recipe.toml -o out --set surface.k=1e-12/mm --set spindle.speed=60rpm";

#[test]
fn a_flat_part_at_60_rpm_and_1_um_a_turn_is_refused_with_its_place() {
    let bench = flat("1 um/rev");
    let said = bench.line(RUN).ends(2);
    insta::assert_snapshot!(bench.shown(&said));
    assert!(!bench.path("out").exists());
    // LinuxCNC from 2.9.0 on plays it.
    let newer = format!("{RUN} --set output.linuxcnc-g93.lowest_rate=0mm/min");
    bench.line(&newer).ends(0);
}

#[test]
fn a_path_of_straight_lines_is_carried_as_it_is() {
    let bench = flat("5 um/rev");
    let said = bench
        .line(&format!("{RUN} --set velocity.use=linear --format json"))
        .ends(0);
    let report = said.json();
    let program = &report["programs"][0];
    assert_eq!(program["straight_lines"]["per_segment"], 1.0);
    // Programs of cubics cannot carry it.
    let said = bench
        .line(&format!(
            "{RUN} --set velocity.use=linear --set output.posts=[\"linuxcnc-g93\",\"pmac-pvt\"]"
        ))
        .ends(2);
    assert!(said.stderr.contains("`pmac-pvt` cannot carry"), "{said}");
}

#[test]
fn a_flat_part_is_refused_where_its_feed_runs_out_with_leads_and_without() {
    let bench = flat("5 um/rev");
    for lead in [false, true] {
        let said = bench
            .line(&format!(
                "{RUN} --set path.lead={lead} --set path.overrun=contact"
            ))
            .ends(2);
        assert!(said.stderr.contains("no line below 0.1 mm/min"), "{said}");
        // The line is one of the cut, and not that of the lead before it.
        assert!(said.stderr.contains("at 0.00096 mm/min"), "{said}");
        assert!(!bench.path("out").exists());
    }
    for lead in [false, true] {
        bench
            .line(&format!("{RUN} --set path.lead={lead}").replace("-o out", &format!("-o {lead}")))
            .ends(0);
    }
}
