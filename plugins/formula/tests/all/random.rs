//! Random formulas against an evaluation of their tree, and random bytes against panics.

use proptest::prelude::*;
use turnpath_core::{Dual, Scalar, Surface, Taylor};

use crate::common::{Given, formula, made};

/// A formula whose value is a pure number, as its text and as a function.
#[derive(Debug, Clone)]
enum Tree {
    X,
    Y,
    Number(f64),
    Sum(Box<Self>, Box<Self>),
    Difference(Box<Self>, Box<Self>),
    Product(Box<Self>, Box<Self>),
    Quotient(Box<Self>, Box<Self>),
    Negative(Box<Self>),
    Power(Box<Self>, i32),
    Sine(Box<Self>),
    Root(Box<Self>),
    Arc(Box<Self>, Box<Self>),
}

impl Tree {
    fn text(&self) -> String {
        match self {
            Self::X => "x/mm".to_owned(),
            Self::Y => "y/mm".to_owned(),
            Self::Number(number) => format!("({number})"),
            Self::Sum(a, b) => format!("({} + {})", a.text(), b.text()),
            Self::Difference(a, b) => format!("({} - {})", a.text(), b.text()),
            Self::Product(a, b) => format!("({})*({})", a.text(), b.text()),
            Self::Quotient(a, b) => format!("({})/(2 + ({})^2)", a.text(), b.text()),
            Self::Negative(a) => format!("-({})", a.text()),
            Self::Power(a, exponent) => format!("({})^{exponent}", a.text()),
            Self::Sine(a) => format!("sin({})", a.text()),
            Self::Root(a) => format!("sqrt(1 + ({})^2)", a.text()),
            Self::Arc(a, b) => format!("atan2({}, 2 + ({})^2)", a.text(), b.text()),
        }
    }

    fn value<S: Scalar>(&self, x: S, y: S) -> S {
        let of = |tree: &Self| tree.value(x, y);
        match self {
            Self::X => x,
            Self::Y => y,
            Self::Number(number) => S::constant(*number),
            Self::Sum(a, b) => of(a) + of(b),
            Self::Difference(a, b) => of(a) - of(b),
            Self::Product(a, b) => of(a) * of(b),
            Self::Quotient(a, b) => of(a) / (of(b).squared() + 2.0),
            Self::Negative(a) => -of(a),
            Self::Power(a, exponent) => of(a).powi(*exponent),
            Self::Sine(a) => of(a).sin(),
            Self::Root(a) => (of(a).squared() + 1.0).sqrt(),
            Self::Arc(a, b) => of(a).atan2(of(b).squared() + 2.0),
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let number = (-400i32..400).prop_map(|n| Tree::Number(f64::from(n) / 128.0));
    let leaf = prop_oneof![Just(Tree::X), Just(Tree::Y), number];
    leaf.prop_recursive(6, 40, 2, |inner| {
        let one = inner.clone().prop_map(Box::new);
        let two = (inner.clone().prop_map(Box::new), inner.prop_map(Box::new));
        prop_oneof![
            two.clone().prop_map(|(a, b)| Tree::Sum(a, b)),
            two.clone().prop_map(|(a, b)| Tree::Difference(a, b)),
            two.clone().prop_map(|(a, b)| Tree::Product(a, b)),
            two.clone().prop_map(|(a, b)| Tree::Quotient(a, b)),
            two.prop_map(|(a, b)| Tree::Arc(a, b)),
            one.clone().prop_map(Tree::Negative),
            (one.clone(), 0..4).prop_map(|(a, n)| Tree::Power(a, n)),
            one.clone().prop_map(Tree::Sine),
            one.prop_map(Tree::Root),
        ]
    })
}

/// Rounding may differ as much as the formula magnifies it: values are compared where they and
/// their derivatives are moderate.
const MODERATE: f64 = 1e4;

fn close(found: &[f64], expected: &[f64]) -> bool {
    let most = expected.iter().fold(1.0f64, |most, c| most.max(c.abs()));
    let same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * most;
    most >= MODERATE || found.iter().zip(expected).all(same)
}

/// `k`, where a text may use it: a constant that is not used is refused.
fn constants(text: &str) -> Given<'static> {
    if text.contains('k') {
        &[("k", 0.5, -1)]
    } else {
        &[]
    }
}

proptest! {
    #[test]
    fn a_formula_is_what_its_tree_says(tree in tree(), x in -2.0..2.0f64, y in -2.0..2.0f64) {
        let formula = formula(&format!("mm*({})", tree.text()), &[]);
        let value = [tree.value(x, y)];
        prop_assert!(close(&[formula.sag(x, y)], &value), "{}", tree.text());
        let (dx, dy) = (Dual::variable_x(x), Dual::variable_y(y));
        let (found, expected) = (formula.sag(dx, dy), tree.value(dx, dy));
        prop_assert!(
            close(&[found.dx, found.dy], &[expected.dx, expected.dy]),
            "{}: {found:?} {expected:?}",
            tree.text()
        );
        let (tx, ty) = (Taylor([x, 0.5, 0.1, 0.0, 0.0]), Taylor([y, -0.25, 0.0, 0.1, 0.0]));
        let (found, expected) = (formula.sag(tx, ty), tree.value(tx, ty));
        prop_assert!(close(&found.0, &expected.0), "{}: {found:?} {expected:?}", tree.text());
    }

    #[test]
    fn no_text_panics(text in "[-+*/^(),. 0-9exyrhotasincqmu_µ²]{0,60}") {
        if let Ok(formula) = made(&text, constants(&text)) {
            let _ = formula.sag(0.5, -0.25);
        }
    }

    /// Words of formulas in any order come further than random letters.
    #[test]
    fn no_order_of_words_panics(words in prop::collection::vec(
        prop::sample::select(vec![
            "x", "y", "rho", "theta", "cos(", "sin(", "sqrt(", "(", ")", "+", "-", "*", "/", "^", "2",
            "3", "mm", "k", ",", "atan2(", "0", "1e300",
        ]), 0..40,
    )) {
        let text = words.join(" ");
        if let Ok(formula) = made(&text, constants(&text)) {
            let _ = formula.sag(0.0, 0.0);
        }
    }
}
