//! What is wrong with a formula, underlined.

use turnpath_core::StrategyError;

use crate::common::made;

/// The formula, what is underlined, and the message.
fn said(z: &str) -> String {
    match made(z, &[("k", 0.1, -1), ("R", 40.0, 1)]) {
        Err(StrategyError::Parameter {
            name,
            message,
            place: Some(place),
        }) => {
            let before = z[..place.start].chars().count();
            let under = z[*place].chars().count().max(1);
            assert_eq!(name, "z");
            format!(
                "{z}\n{}{}\n{message}\n",
                " ".repeat(before),
                "^".repeat(under)
            )
        }
        other => panic!("{z}: {other:?}"),
    }
}

#[test]
fn mistakes() {
    let texts = [
        "",
        "x +",
        "x * * y",
        "(x + y",
        "x + y)",
        "5 um * x",
        "x y",
        "sin(x)",
        "x + 1",
        "k*rho^2 + 0.1*rho^2",
        "rho^2",
        "k*rho^x",
        "k*rho^(1*mm)",
        "sqrt",
        "sqrt(x, y)",
        "hypot(x)",
        "R(1)",
        "q*x",
        "Rho*2",
        "x $ y",
        "1e999*mm",
        "x/0",
        "sqrt(-1)*x",
        "asin(2)*x",
        "x + ,",
        "atan2(y)",
        "min(x, 1)",
        "2*µm + 3*ρ",
        "1.2.3*x",
    ];
    let said: Vec<String> = texts.into_iter().map(said).collect();
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn bounds() {
    let message = |z: &str| made(z, &[]).unwrap_err().to_string();
    let deep = format!("{}x{}", "(".repeat(70), ")".repeat(70));
    assert!(message(&deep).contains("nested more than 64 deep"));
    let signs = format!("{}x", "-".repeat(200));
    assert!(message(&signs).contains("nested more than 64 deep"));
    assert!(message(&"x+".repeat(9000)).contains("at most 16384 bytes"));
    let many: Vec<String> = (0..2000).map(|k| format!("{k}*x")).collect();
    assert!(message(&many.join("+")).contains("more than 4096 steps"));
    let long = vec!["x"; 4000].join("+");
    assert!(made(&long, &[]).is_ok());
}

#[test]
fn a_constant_cannot_have_a_name_of_every_formula() {
    for name in ["x", "rho", "mm", "sin", "pi"] {
        let error = made("x", &[(name, 1.0, 0)]).unwrap_err().to_string();
        assert!(error.contains(&format!("its own `{name}`")), "{error}");
    }
    // `r` is only a second name of ρ.
    assert!(made("r", &[("r", 1.0, 1)]).is_ok());
}
