//! First touch: how high the nose centre stands when the tool, lowered at (C, X), meets the part.
//!
//! The height of the centre over a contact s of the radial profile is H(s) = g(θ, s) +
//! sqrt(R² − (s − X)²), and the tool is stopped by the largest one. Where Rκ < 1 all over the
//! tool's reach, H has a single maximum, which a bracketed secant finds; elsewhere the whole reach
//! is scanned first.

use turnpath_core::{Gradients, Result, Scalar, SurfaceModel, Tool};

use crate::Subject;

/// The secant stops when it moves less than this part of the nose radius. The height is wrong by
/// the square of it: 1e-16 of the radius.
const FOOT_TOLERANCE: f64 = 1e-8;
/// Most steps of the search, and from where on every second one halves the bracket: that alone
/// reaches [`FOOT_TOLERANCE`] in 28 halvings.
const MOST_STEPS: usize = 80;
const PATIENCE: usize = 16;
/// Places of the scan over the reach. Ripples narrower than two of its steps can be missed.
const SCAN: usize = 257;
/// Angles and radii at which the profile's curvature is looked at before a single maximum is
/// taken for granted.
const LOOK: (usize, usize) = (90, 400);
/// Rκ up to which a single maximum is taken for granted, a little below 1 for what lies between
/// the places looked at.
const LARGEST_FIT: f64 = 0.95;

/// Finds first touches of one tool on one surface.
#[derive(Clone)]
pub struct FirstTouch {
    subject: Subject,
    single: bool,
}

/// Where the tool is stopped.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Z of the nose centre, mm; with a point for a tool, of the point.
    pub z: f64,
    /// Radius of the contact, mm; negative beyond the axis.
    pub foot: f64,
    /// Slope of the profile at the contact.
    pub slope: f64,
}

impl FirstTouch {
    /// For tool positions whose X lies within the aperture, or beyond it by what a normal to the
    /// rim takes: the nose radius.
    pub fn new(subject: Subject) -> Result<Self> {
        let reach = subject.part.aperture_radius + 2.0 * subject.tool.nose_radius;
        let single = !subject.compensates_nose
            || largest_curvature(subject.surface.as_ref(), reach)?
                .is_some_and(|curvature| subject.tool.nose_radius * curvature < LARGEST_FIT);
        Ok(Self { subject, single })
    }

    /// What is measured.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Whether the profile leaves a single maximum everywhere, so that no scan is needed.
    pub fn is_single(&self) -> bool {
        self.single
    }

    /// The first touch at each (θ, X).
    pub fn find(&self, theta: &[f64], x: &[f64], out: &mut Vec<Touch>) -> Result<()> {
        let surface = self.subject.surface.as_ref();
        let mut profile = Profiles::new(surface, theta);
        out.clear();
        out.resize(x.len(), Touch::default());
        if !self.subject.compensates_nose {
            profile.at_all(x)?;
            for (i, touch) in out.iter_mut().enumerate() {
                *touch = Touch {
                    z: profile.height[i],
                    foot: x[i],
                    slope: profile.slope[i],
                };
            }
            return Ok(());
        }
        let mut brackets = match self.single {
            true => Bracket::of_reach(&self.subject.tool, x),
            false => self.scanned(&mut profile, x)?,
        };
        close_in(
            &mut profile,
            self.subject.tool.nose_radius,
            x,
            &mut brackets,
            out,
        )
    }

    /// Brackets around the highest of [`SCAN`] places in the reach.
    fn scanned(&self, profile: &mut Profiles<'_>, x: &[f64]) -> Result<Vec<Bracket>> {
        let (radius, reach) = (self.subject.tool.nose_radius, self.subject.tool.reach());
        let step = 2.0 * reach / (SCAN - 1) as f64;
        let mut best = vec![(f64::NEG_INFINITY, 0.0); x.len()];
        for place in 0..SCAN {
            let offset = -reach + place as f64 * step;
            let feet: Vec<f64> = x.iter().map(|x| x + offset).collect();
            profile.at_all(&feet)?;
            let lift = (radius * radius - offset * offset).max(0.0).sqrt();
            for (best, height) in best.iter_mut().zip(&profile.height) {
                if height + lift > best.0 {
                    *best = (height + lift, offset);
                }
            }
        }
        let around = |(x, (_, offset)): (&f64, &(f64, f64))| Bracket {
            low: x + (offset - step).max(-reach),
            high: x + (offset + step).min(reach),
            start: x + offset,
        };
        Ok(x.iter().zip(&best).map(around).collect())
    }
}

/// Where a maximum lies.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    low: f64,
    high: f64,
    start: f64,
}

impl Bracket {
    fn of_reach(tool: &Tool, x: &[f64]) -> Vec<Self> {
        let reach = tool.reach();
        x.iter()
            .map(|x| Self {
                low: x - reach,
                high: x + reach,
                start: *x,
            })
            .collect()
    }
}

/// One search: F(s) = g_ρ q − (s − X), q = sqrt(R² − (s − X)²), falls through zero at a maximum.
#[derive(Clone, Copy)]
struct Search {
    index: usize,
    at: f64,
    before: Option<(f64, f64)>,
}

/// Closes in on the maximum in every bracket.
fn close_in(
    profile: &mut Profiles<'_>,
    radius: f64,
    x: &[f64],
    brackets: &mut [Bracket],
    out: &mut [Touch],
) -> Result<()> {
    let mut open: Vec<Search> = brackets
        .iter()
        .enumerate()
        .map(|(index, bracket)| Search {
            index,
            at: bracket.start,
            before: None,
        })
        .collect();
    for step in 0..MOST_STEPS {
        if open.is_empty() {
            break;
        }
        profile.at(open.iter().map(|search| (search.index, search.at)))?;
        let mut still_open = 0;
        for i in 0..open.len() {
            let mut search = open[i];
            let (index, offset) = (search.index, search.at - x[search.index]);
            let lift = (radius * radius - offset * offset).max(0.0).sqrt();
            let slope = profile.slope[i];
            out[index] = Touch {
                z: profile.height[i] + lift,
                foot: search.at,
                slope,
            };
            let seen = Seen {
                fall: slope * lift - offset,
                by_normal: x[index] + radius * slope / (1.0 + slope * slope).sqrt(),
            };
            let halve = step > PATIENCE && step % 2 == 0;
            let next = search.next(&seen, &mut brackets[index], halve);
            if (next - search.at).abs() > FOOT_TOLERANCE * radius {
                search.before = Some((search.at, seen.fall));
                search.at = next;
                open[still_open] = search;
                still_open += 1;
            }
        }
        open.truncate(still_open);
    }
    Ok(())
}

/// What a search finds at one place.
struct Seen {
    /// F there.
    fall: f64,
    /// Where the normal through this contact leads: the first guess of a better one.
    by_normal: f64,
}

impl Search {
    /// The next place: by the normal through the contact at first, then by the secant; the middle
    /// of the bracket where either leaves it, or when it is time to halve. Where the surface has
    /// no value the bracket shrinks towards its start, which had one.
    fn next(&self, seen: &Seen, bracket: &mut Bracket, halve: bool) -> f64 {
        let nowhere = seen.fall.is_nan();
        if seen.fall > 0.0 || (nowhere && self.at < bracket.start) {
            bracket.low = self.at;
        } else if seen.fall < 0.0 || (nowhere && self.at > bracket.start) {
            bracket.high = self.at;
        }
        let proposed = match self.before {
            None => seen.by_normal,
            Some((at, then)) if then != seen.fall => {
                self.at - seen.fall * (self.at - at) / (seen.fall - then)
            }
            Some(_) => self.at,
        };
        if !halve && (bracket.low..=bracket.high).contains(&proposed) {
            proposed
        } else {
            0.5 * (bracket.low + bracket.high)
        }
    }
}

/// Radial profiles at a set of angles, in batches.
struct Profiles<'a> {
    surface: &'a dyn SurfaceModel,
    turned: Vec<(f64, f64)>,
    x: Vec<f64>,
    y: Vec<f64>,
    zx: Vec<f64>,
    zy: Vec<f64>,
    height: Vec<f64>,
    slope: Vec<f64>,
}

impl<'a> Profiles<'a> {
    fn new(surface: &'a dyn SurfaceModel, theta: &[f64]) -> Self {
        let turned = theta.iter().map(|theta| Scalar::sin_cos(*theta)).collect();
        let empty = Vec::new;
        let (x, y, zx, zy) = (empty(), empty(), empty(), empty());
        Self {
            surface,
            turned,
            x,
            y,
            zx,
            zy,
            height: empty(),
            slope: empty(),
        }
    }

    /// Height and slope at one radius for each angle.
    fn at_all(&mut self, rho: &[f64]) -> Result<()> {
        self.at(rho.iter().copied().enumerate())
    }

    /// Height and slope at (which angle, radius).
    fn at(&mut self, places: impl Iterator<Item = (usize, f64)> + Clone) -> Result<()> {
        self.x.clear();
        self.y.clear();
        for (index, rho) in places.clone() {
            let (s, c) = self.turned[index];
            self.x.push(rho * c);
            self.y.push(rho * s);
        }
        let count = self.x.len();
        for places in [
            &mut self.height,
            &mut self.slope,
            &mut self.zx,
            &mut self.zy,
        ] {
            places.resize(count, 0.0);
        }
        let out = Gradients {
            z: &mut self.height,
            zx: &mut self.zx,
            zy: &mut self.zy,
        };
        self.surface.gradient(&self.x, &self.y, out)?;
        for (i, (index, _)) in places.enumerate() {
            let (s, c) = self.turned[index];
            self.slope[i] = self.zx[i] * c + self.zy[i] * s;
        }
        Ok(())
    }
}

/// The largest curvature of the radial profiles out to ±`reach`; `None` where there is no value.
fn largest_curvature(surface: &dyn SurfaceModel, reach: f64) -> Result<Option<f64>> {
    let (angles, radii) = LOOK;
    let mut largest = f64::NEG_INFINITY;
    let mut profiles = vec![turnpath_core::locus::Profile::default(); angles];
    let theta: Vec<f64> = (0..angles)
        .map(|i| std::f64::consts::PI * i as f64 / angles as f64)
        .collect();
    for i in 0..=radii {
        let rho = vec![reach * (2.0 * i as f64 / radii as f64 - 1.0); angles];
        turnpath_core::locus::profile_at(surface, &theta, &rho, &mut profiles)?;
        for profile in &profiles {
            let curvature = profile.curvature();
            if !curvature.is_finite() {
                return Ok(None);
            }
            largest = largest.max(curvature);
        }
    }
    Ok(Some(largest))
}
