//! The shape of a surface out of its lines.
//!
//! The numbers of the parameters are those of the tables "Parameter definitions" in the OpticStudio
//! help (Ansys, v242: Toroidal, Extended Asphere, Extended Polynomial), where the parameters from 13
//! on are the `XDAT` from 1 on. Those of Even Asphere, Odd Asphere, Extended Odd Asphere, Biconic
//! and Zernike Standard Sag are as open readers have them: optiland `fileio/zemax/surfaces.py`,
//! ray-optics `zemax/zmxread.py`, and the reader of `.zmx` for batoid. Those of Zernike Fringe Sag are as
//! pyzdd scales them and as the readers of zmxtools and pyrate take them: all three agree.

use std::collections::BTreeMap;

use crate::base::Base;
use crate::error::{LensProblem, ProblemKind};
use crate::numbers::{no_number, power, radius};
use crate::record::shown;
use crate::shape::{Powers, Shape, ZernikeList};
use crate::slots::Slots;
use crate::surface_block::SurfaceBlock;

/// Highest power of ρ that a surface of turnpath has.
const MOST_POWER: u32 = 40;

/// Parameters of the even and the odd asphere, and those of the Zernike surface with powers.
const ASPHERE_TERMS: u32 = 8;

/// Terms of y of a toroid, in the parameters from 2 on.
const TOROID_TERMS: u32 = 7;

/// `XDAT` with the count of terms, that with the normalisation radius, and the one before the first
/// term.
const COUNT: u32 = 1;
const NORMALIZATION: u32 = 2;
const BEFORE_TERMS: u32 = 2;

/// Most terms of the lists: those of the tables.
const MOST_EXTENDED: u32 = 240;
const MOST_POLYNOMIAL: u32 = 230;
const MOST_ZERNIKE: u32 = 231;
const MOST_FRINGE: u32 = 37;
/// The last term of the list of design programs is 924ρ¹² − … + 1. By the rule of the terms before it the
/// list comes to it only here.
const LAST_FRINGE: u32 = 49;

/// A shape, and where its Zernike terms end.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadShape {
    /// The shape in the frame of the design.
    pub shape: Shape,
    /// The radius beyond which the design leaves terms out, mm, and the line that says so.
    pub end: Option<(f64, usize)>,
}

/// The lines of a surface as its type needs them.
struct Reader<'a, 'b> {
    block: &'b SurfaceBlock<'a>,
    /// mm in the file's unit.
    unit: f64,
    parm: Slots,
    xdat: Slots,
}

/// The shape of a surface; `unit` is the file's unit in mm.
pub fn read_shape(block: &SurfaceBlock<'_>, unit: f64) -> Result<ReadShape, Vec<LensProblem>> {
    let one = |problem| vec![problem];
    let (name, line) = block.kind();
    block.only("TYPE").map_err(one)?;
    let reader = Reader {
        block,
        unit,
        parm: Slots::read(block, "PARM").map_err(one)?,
        xdat: Slots::read(block, "XDAT").map_err(one)?,
    };
    let none = |_| false;
    let terms = |index| (1..=ASPHERE_TERMS).contains(&index);
    let any = |_| true;
    let shape = match name.as_str() {
        "STANDARD" => reader.within("STANDARD", none, none, Reader::standard),
        "EVENASPH" => reader.within("EVENASPH", terms, none, |one| one.asphere(2)),
        "ODDASPHE" => reader.within("ODDASPHE", terms, none, |one| one.asphere(1)),
        "XASPHERE" => reader.within("XASPHERE", none, any, |one| one.extended(2)),
        "XOSPHERE" => reader.within("XOSPHERE", none, any, |one| one.extended(1)),
        "BICONICX" => reader.within("BICONICX", |i| i == 1 || i == 2, none, Reader::biconic),
        // Parameter 0 is about Zernike terms, which are in XDAT.
        "TOROIDAL" => reader.within("TOROIDAL", |i| i <= TOROID_TERMS + 1, none, Reader::toroid),
        "XPOLYNOM" => reader.within("XPOLYNOM", none, any, Reader::polynomial),
        "SZERNSAG" => return reader.zernike("SZERNSAG", ZernikeList::Noll, MOST_ZERNIKE),
        "FZERNSAG" => return reader.zernike("FZERNSAG", ZernikeList::Fringe, MOST_FRINGE),
        _ => {
            let name = shown(&name);
            Err(one(ProblemKind::UnknownType { name }.at(line)))
        }
    };
    shape.map(|shape| ReadShape { shape, end: None })
}

impl Reader<'_, '_> {
    /// The shape that `make` gives, if no other parameters than those that are known are set.
    fn within(
        &self,
        kind: &'static str,
        parm: impl Fn(u32) -> bool,
        xdat: impl Fn(u32) -> bool,
        make: impl Fn(&Self) -> Result<Shape, LensProblem>,
    ) -> Result<Shape, Vec<LensProblem>> {
        let mut problems = self.parm.check(kind, parm);
        problems.extend(self.xdat.check(kind, xdat));
        match make(self) {
            Ok(shape) if problems.is_empty() => Ok(shape),
            Ok(_) => Err(problems),
            Err(problem) => {
                problems.push(problem);
                Err(problems)
            }
        }
    }

    fn base(&self) -> Result<Base, LensProblem> {
        let curvature = self.block.curvature()?;
        Ok(Base {
            radius: radius(curvature).map(|curvature| self.unit / curvature),
            conic: self.block.conic()?,
        })
    }

    fn standard(&self) -> Result<Shape, LensProblem> {
        Ok(Shape::Radial {
            base: self.base()?,
            terms: Powers::new(),
        })
    }

    /// Parameter n is the coefficient of the power n·step.
    fn asphere(&self, step: u32) -> Result<Shape, LensProblem> {
        Ok(Shape::Radial {
            base: self.base()?,
            terms: self.powers(1..=ASPHERE_TERMS, |index| index * step),
        })
    }

    /// Coefficients of these parameters, in mm.
    fn powers(&self, slots: std::ops::RangeInclusive<u32>, of: impl Fn(u32) -> u32) -> Powers {
        let term = |index| {
            let (value, of) = (self.parm.get(index), of(index));
            (value != 0.0).then(|| (of, value * self.unit / power(self.unit, of)))
        };
        slots.filter_map(term).collect()
    }

    /// Term n is the coefficient of (ρ/r) to the power n·step.
    fn extended(&self, step: u32) -> Result<Shape, LensProblem> {
        let (normalization, terms) = self.list(MOST_EXTENDED)?;
        let mut powers = Powers::new();
        for (number, coefficient) in terms {
            let of = number * step;
            if of > MOST_POWER {
                let (power, most) = (of, MOST_POWER);
                let line = self.xdat.line(number + BEFORE_TERMS);
                return Err(ProblemKind::Power { power, most }.at(line));
            }
            let value = coefficient / power(normalization, of);
            if !value.is_finite() {
                let line = self.xdat.line(number + BEFORE_TERMS);
                return Err(no_number(line, &value.to_string(), "coefficient"));
            }
            powers.insert(of, value);
        }
        Ok(Shape::Radial {
            base: self.base()?,
            terms: powers,
        })
    }

    fn biconic(&self) -> Result<Shape, LensProblem> {
        Ok(Shape::Biconic {
            x: Base {
                radius: radius(self.parm.get(1)).map(|radius| radius * self.unit),
                conic: self.parm.get(2),
            },
            y: self.base()?,
        })
    }

    fn toroid(&self) -> Result<Shape, LensProblem> {
        Ok(Shape::Toroid {
            rotation: radius(self.parm.get(1)).map(|radius| radius * self.unit),
            base: self.base()?,
            terms: self.powers(2..=TOROID_TERMS + 1, |index| 2 * (index - 1)),
        })
    }

    fn polynomial(&self) -> Result<Shape, LensProblem> {
        let (normalization_radius, terms) = self.list(MOST_POLYNOMIAL)?;
        let all = terms.into_iter();
        Ok(Shape::Polynomial {
            base: self.base()?,
            normalization_radius,
            coefficients: all
                .map(|(number, value)| (powers_of(number), value))
                .collect(),
        })
    }

    fn zernike(
        &self,
        kind: &'static str,
        list: ZernikeList,
        most: u32,
    ) -> Result<ReadShape, Vec<LensProblem>> {
        let known = |index| index <= ASPHERE_TERMS;
        let shape = self.within(
            kind,
            known,
            |_| true,
            |one| {
                let (normalization_radius, mut coefficients) = one.list(most)?;
                if list == ZernikeList::Fringe
                    && let Some(last) = coefficients.remove(&MOST_FRINGE)
                {
                    coefficients.insert(LAST_FRINGE, last);
                }
                Ok(Shape::Zernike {
                    list,
                    base: one.base()?,
                    terms: one.powers(1..=ASPHERE_TERMS, |index| 2 * index),
                    normalization_radius,
                    coefficients,
                })
            },
        )?;
        let goes_on = self.parm.get(0) != 0.0;
        let end = match &shape {
            Shape::Zernike {
                normalization_radius,
                coefficients,
                ..
            } if !goes_on && !coefficients.is_empty() => {
                Some((*normalization_radius, self.parm.line(0)))
            }
            _ => None,
        };
        Ok(ReadShape { shape, end })
    }

    /// The normalisation radius in mm, and the terms of a list that are not 0, by their numbers from
    /// 1, in mm. Terms beyond the count are left out, as the design program does.
    fn list(&self, most: u32) -> Result<(f64, BTreeMap<u32, f64>), LensProblem> {
        let count = self.xdat.count(COUNT, most)?;
        let term = |number| {
            let value = self.xdat.get(number + BEFORE_TERMS);
            (value != 0.0).then_some((number, value * self.unit))
        };
        let terms: BTreeMap<u32, f64> = (1..=count).filter_map(term).collect();
        let value = self.xdat.get(NORMALIZATION);
        if terms.is_empty() || value > 0.0 {
            return Ok((value * self.unit, terms));
        }
        let line = self.xdat.line(NORMALIZATION);
        Err(ProblemKind::Normalization { value }.at(line))
    }
}

/// The powers of x and y of a term of the extended polynomial: x, y, x², xy, y², x³, …
fn powers_of(number: u32) -> (u32, u32) {
    let (mut degree, mut place) = (1, number - 1);
    while place > degree {
        place -= degree + 1;
        degree += 1;
    }
    (degree - place, place)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// "For example, the 12th term in the polynomial expansion, which is extra data term number 14,
    /// is the coefficient on the term in x²y²"; "xy³, which is term number 13".
    #[test]
    fn the_order_of_the_extended_polynomial_is_that_of_its_help_page() {
        let first: Vec<(u32, u32)> = (1..=5).map(powers_of).collect();
        assert_eq!(first, [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]);
        assert_eq!((powers_of(12), powers_of(13)), ((2, 2), (1, 3)));
        assert_eq!(powers_of(MOST_POLYNOMIAL), (0, 20));
    }
}
