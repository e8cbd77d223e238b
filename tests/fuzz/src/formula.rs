//! Formulas of recipes: a text is a surface, or is refused at a place of its own.

use std::sync::OnceLock;

use turnpath::Catalogue;
use turnpath_core::{NamedConstant, ParamValue, Params, Slot, StrategyError};

/// Words of formulas.
pub const WORDS: &[&str] = &[
    "x",
    "y",
    "rho",
    "theta",
    "k",
    "mm",
    "um",
    "deg",
    "pi",
    "(",
    ")",
    ",",
    " + ",
    " - ",
    "*",
    "/",
    "^",
    "^2",
    "^-1",
    "^0.5",
    "0",
    "1e308",
    "1e-308",
    "0.1",
    "sqrt(",
    "cos(",
    "sin(",
    "exp(",
    "ln(",
    "atan2(",
    "min(",
    "abs(",
    "rho^3*cos(3*theta)",
    "\u{2212}",
    "\u{b7}",
    "\u{b5}m",
];

fn catalogue() -> &'static Catalogue {
    static CATALOGUE: OnceLock<Catalogue> = OnceLock::new();
    CATALOGUE.get_or_init(|| Catalogue::linked().expect("the built-in strategies"))
}

/// Makes a surface of the text, and asks it for heights.
pub fn read(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let formula = catalogue().find(Slot::Surface, "formula");
    let formula = formula.expect("the surface is built in");
    let mut params = Params::new();
    params.set("z", ParamValue::Text(text.to_owned()));
    // A constant that the formula does not use is refused.
    if text.contains('k') {
        let constants = vec![NamedConstant {
            name: "k".to_owned(),
            value: 0.05,
            length_power: -1,
        }];
        params.set("constants", ParamValue::Constants(constants));
    }
    let surface = match formula.offer().surface(&params) {
        Ok(surface) => surface,
        Err(StrategyError::Parameter {
            place: Some(place), ..
        }) => {
            assert!(text.get(*place.clone()).is_some(), "no place: {place:?}");
            return;
        }
        Err(StrategyError::Parameter { name, .. }) if name == "constants" => return,
        Err(error) => panic!("{error}"),
    };
    // Nine points go as eight together and one alone: each is what it is alone.
    let x: Vec<f64> = (0..9).map(|i| f64::from(i) * 0.75 - 3.0).collect();
    let y: Vec<f64> = x.iter().map(|x| 0.5 - x * 0.25).collect();
    let (mut together, mut alone) = ([0.0; 9], [0.0; 9]);
    surface
        .heights(&x, &y, &mut together)
        .expect("heights of a formula");
    for ((x, y), z) in x.iter().zip(&y).zip(&mut alone) {
        let (x, y) = (std::slice::from_ref(x), std::slice::from_ref(y));
        surface
            .heights(x, y, std::slice::from_mut(z))
            .expect("the height of a formula");
    }
    for (one, other) in together.iter().zip(alone) {
        let same = one.to_bits() == other.to_bits() || (one.is_nan() && other.is_nan());
        assert!(same, "{one} {other}");
    }
}
