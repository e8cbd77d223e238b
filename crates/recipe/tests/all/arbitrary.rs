//! No text makes the reader panic, and every refusal has a message.

#![allow(clippy::unwrap_used, reason = "an unwrap in a helper is a failed test")]

use crate::common::FULL;
use proptest::prelude::*;
use turnpath_core::Quantity;
use turnpath_recipe::{Recipe, RecipeError};

fn reads_without_panic(text: &str, sets: &[String]) {
    match Recipe::parse(text, "odd.toml", sets) {
        Ok(_) => {}
        Err(RecipeError::Wrong(wrong)) => {
            let messages = wrong.messages();
            assert!(messages.iter().count() > 0);
            assert!(messages.render(false).starts_with("error"));
            assert!(messages.render(true).len() > 5);
        }
        Err(error) => panic!("{error}"),
    }
}

/// The full recipe with some of its bytes replaced.
fn mutated(start: usize, length: usize, new: &str) -> String {
    let border = |at: usize| {
        (0..=at.min(FULL.len()))
            .rev()
            .find(|&i| FULL.is_char_boundary(i))
    };
    let (start, end) = (border(start).unwrap(), border(start + length).unwrap());
    format!("{}{new}{}", &FULL[..start], &FULL[end..])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4 * ProptestConfig::default().cases))]

    #[test]
    fn any_text(text in "\\PC{0,200}", set in "\\PC{0,40}") {
        reads_without_panic(&text, &[set]);
    }

    #[test]
    fn toml_like_text(text in "([a-z]{1,6}( = |\\.|\\]\n|\n\\[)(\"[0-9]{1,3} ?m?m?\"|[0-9]\n|\\[|\\{)?){0,20}") {
        reads_without_panic(&text, &[]);
    }

    #[test]
    fn mutated_recipe(start in 0..900usize, length in 0..30usize, new in "[ -~\n\r\u{0}é]{0,12}") {
        reads_without_panic(&mutated(start, length, &new), &[]);
    }

    #[test]
    fn lines_left_out(kept in prop::collection::vec(prop::bool::weighted(0.9), 64)) {
        let lines = FULL.lines().zip(kept).filter(|(_, kept)| *kept).map(|(line, _)| line);
        reads_without_panic(&lines.collect::<Vec<_>>().join("\n"), &[]);
    }

    #[test]
    fn any_set(
        key in "(tool|part|sampler|name|path|output|format)(\\.[a-z_]{1,6}){0,3}",
        value in "(-?[0-9]{1,3} ?(mm|nm|deg|s|µm)?|\\[.{0,6}\\]?|\\{.{0,9}\\}?|true|\\PC{0,9})",
    ) {
        reads_without_panic(FULL, &[format!("{key}={value}")]);
    }

    #[test]
    fn every_value_replaced(line in 0..46usize, value in "(1|true|\\[\\]|\\{\\}|\"\"|nan|1979-05-27|\"x\")") {
        let replace = |(index, text): (usize, &str)| match text.split_once(" = ") {
            Some((key, _)) if index == line => format!("{key} = {value}"),
            _ => text.to_owned(),
        };
        reads_without_panic(&FULL.lines().enumerate().map(replace).collect::<Vec<_>>().join("\n"), &[]);
    }

    #[test]
    fn any_quantity(number in "[-+−]?[0-9.]{0,30}(e[-+]?[0-9]{1,20})?", unit in "\\PC{0,6}| ?[nuµmck]?m(/rev)?") {
        for quantity in KINDS {
            if let Ok(value) = quantity.parse(&format!("{number}{unit}")) {
                prop_assert!(value.is_finite());
            }
        }
    }

    #[test]
    fn a_written_value_reads_back(value in -1e300..1e300f64, size in -300..0i32) {
        let value: f64 = format!("{value}e{size}").parse().unwrap();
        for quantity in KINDS {
            let text = quantity.format(value);
            let read = quantity.parse(&text).unwrap();
            prop_assert!((read - value).abs() <= 1e-11 * value.abs(), "{text}");
        }
    }

    #[test]
    fn a_length_is_the_nearest_double(digits in 0..u64::MAX, places in 0..30i64) {
        for (unit, shift) in [("mm", 0), ("um", -3), ("nm", -6), ("cm", 1), ("m", 3)] {
            let nearest: f64 = format!("{digits}e{}", shift - places).parse().unwrap();
            prop_assert_eq!(Quantity::Length.parse(&format!("{digits}e-{places} {unit}")), Ok(nearest));
        }
    }
}

const KINDS: [Quantity; 5] = [
    Quantity::Length,
    Quantity::Angle,
    Quantity::PerLength,
    Quantity::Feed,
    Quantity::RotationSpeed,
];
