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
        "2*\u{3bc}m + 2*\u{b5}m + 3*ρ",
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
    // A constant `r` would silently take the place of ρ.
    let error = made("r", &[("r", 1.0, 1)]).unwrap_err().to_string();
    assert!(error.contains("its own `r`"), "{error}");
}

#[test]
fn a_constant_that_the_formula_does_not_use_is_refused() {
    let constants = [("k", 0.1, -1), ("R", 40.0, 1)];
    let error = made("k*rho^2", &constants).unwrap_err().to_string();
    assert!(error.contains("does not use `R`"), "{error}");
    assert!(made("k*rho^3/R", &constants).is_ok());
}

/// θ ends at ±π: a formula that does not come back there has a wall.
#[test]
fn a_height_that_jumps_where_an_angle_ends_is_refused() {
    for (z, under) in [
        ("1e-2*mm*theta", "theta"),
        ("k*x^2 + 1e-4*rho^2/R*(theta - 1)", "theta"),
        ("um*sin(0.5*theta) + 1/R*x^2*k*mm", "theta"),
        ("k*x^2 + um*atan2(x, y)/R*mm", "atan2"),
        ("k*rho^2 + um*atan(R/x)", "atan"),
    ] {
        let constants: Vec<_> = [("k", 0.1, -1), ("R", 40.0, 1)]
            .into_iter()
            .filter(|(name, ..)| z.contains(name))
            .collect();
        match made(z, &constants) {
            Err(StrategyError::Parameter {
                message,
                place: Some(place),
                ..
            }) => {
                assert!(message.contains("the height jumps by"), "{z}: {message}");
                assert_eq!(&z[*place], under, "{z}");
            }
            other => panic!("{z}: {other:?}"),
        }
    }
    // Creases and what comes back are no walls.
    for z in [
        "um*sin(3*theta)",
        "um*cos(2.5*theta)",
        "um*theta^2",
        "0.1*rho*abs(theta)",
        "um*atan(1e6*x/mm)",
        "um*sin(theta)^3*exp(cos(theta))",
    ] {
        assert!(made(z, &[]).is_ok(), "{z}: {:?}", made(z, &[]));
    }
}
