//! The interference report: what the part asks of a tool, where, and how much the tool has to spare.

use serde::Serialize;
use turnpath_core::DEG;
use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::largest_nose::LargestNose;
use turnpath_core::{Part, Tool};
use turnpath_pipeline::Prepared;

use crate::figures::{line, millimetres};

/// Angles below this, deg, round to nothing and are told as none.
const LEVEL: f64 = 0.005;
/// A place is on the part up to this much beyond its edges, mm.
const ON_PART: f64 = 1e-9;

/// What the part and its overrun ask of a tool.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Null where any fits.
    largest_nose_radius_mm: Option<f64>,
    least_included_angle_deg: f64,
    least_clearance_angle_deg: f64,
    margins: Margins,
    sections: Sections,
}

/// How much the tool has to spare; null where the recipe gives no angle, or any nose fits.
#[derive(Debug, Serialize)]
struct Margins {
    nose_radius: Margin<Millimetres>,
    included_angle: Margin<Degrees>,
    clearance_angle: Margin<Degrees>,
}

#[derive(Debug, Serialize)]
struct Margin<T> {
    #[serde(flatten)]
    values: T,
    /// What limits it; null where nothing does.
    at: Option<Place>,
}

#[derive(Debug, Serialize)]
struct Millimetres {
    given_mm: f64,
    most_mm: Option<f64>,
    margin_mm: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Degrees {
    given_deg: Option<f64>,
    least_deg: f64,
    margin_deg: Option<f64>,
}

/// The steepest sectional curves. Angles to the horizontal; below 0: nowhere that way.
#[derive(Debug, Serialize)]
struct Sections {
    /// Largest curvature of a radial section; below 0: no hollow.
    hollow: Hollow,
    rises_outward: Slope,
    falls_outward: Slope,
    rises_along_cut: Slope,
    falls_along_cut: Slope,
}

#[derive(Debug, Serialize)]
struct Hollow {
    curvature_per_mm: f64,
    at: Place,
}

#[derive(Debug, Serialize)]
struct Slope {
    angle_deg: f64,
    at: Place,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Place {
    x_mm: f64,
    y_mm: f64,
    rho_mm: f64,
    c_deg: f64,
    on: On,
}

/// Whether a place is wanted or only passed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum On {
    Part,
    Overrun,
}

impl Report {
    /// From the check and the search for the largest nose.
    pub fn new(prepared: &Prepared, nose: &LargestNose) -> Self {
        let (found, job) = (&prepared.interference, &prepared.task);
        Self {
            largest_nose_radius_mm: finite(nose.radius),
            least_included_angle_deg: least_included(found),
            least_clearance_angle_deg: least_clearance(found),
            margins: Margins::new(found, nose, &job.tool, &job.part),
            sections: Sections::new(found, &job.part),
        }
    }

    /// The lines for a person: the tool's three figures in columns, then the sectional curves.
    pub fn lines(&self) -> String {
        self.margins.lines() + &self.sections.lines()
    }
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn least_included(found: &Interference) -> f64 {
    2.0 * found.contact_angle().value / DEG
}

fn least_clearance(found: &Interference) -> f64 {
    found.cut_angle().value / DEG
}

impl Margins {
    fn new(found: &Interference, nose: &LargestNose, tool: &Tool, part: &Part) -> Self {
        let radius = tool.nose_radius;
        let angle = |given: Option<f64>, least_deg: f64, at: Extreme| {
            let given_deg = given.map(|angle| angle / DEG);
            Margin {
                values: Degrees {
                    given_deg,
                    least_deg,
                    margin_deg: given_deg.map(|given| given - least_deg),
                },
                at: Some(Place::new(&at, part)),
            }
        };
        let most = finite(nose.radius);
        Self {
            nose_radius: Margin {
                values: Millimetres {
                    given_mm: radius,
                    most_mm: most,
                    margin_mm: most.map(|most| most - radius),
                },
                at: most.map(|_| Place::new(&nose.at, part)),
            },
            included_angle: angle(
                tool.included_angle,
                least_included(found),
                found.contact_angle(),
            ),
            clearance_angle: angle(
                tool.clearance_angle,
                least_clearance(found),
                found.cut_angle(),
            ),
        }
    }

    fn lines(&self) -> String {
        let nose = &self.nose_radius;
        let limit = match (nose.values.most_mm, nose.values.margin_mm) {
            (Some(most), Some(margin)) => {
                let (most, margin) = (millimetres(most, 4), millimetres(margin, 4));
                format!("at most  {most:>12}, {margin:>12} to spare")
            }
            _ => "any fits: no hollow limits it".to_owned(),
        };
        let given = millimetres(nose.values.given_mm, 4);
        let mut text = row("nose radius", &given, &limit, nose.at.as_ref());
        text += &self.included_angle.line("included angle");
        text += &self.clearance_angle.line("clearance angle");
        text
    }
}

impl Margin<Degrees> {
    fn line(&self, label: &str) -> String {
        let Degrees {
            given_deg,
            least_deg,
            margin_deg,
        } = self.values;
        let least = format!("{least_deg:.2} deg");
        let (given, limit) = match (given_deg, margin_deg) {
            (Some(given), Some(margin)) => {
                let margin = format!("{margin:.2} deg");
                let limit = format!("at least {least:>12}, {margin:>12} to spare");
                (format!("{given:.2} deg"), limit)
            }
            _ => {
                let limit = format!("at least {least:>12}, check not made");
                ("not given".to_owned(), limit)
            }
        };
        row(label, &given, &limit, self.at.as_ref())
    }
}

/// Width of a limit with its margin.
const LIMIT: usize = 44;

fn row(label: &str, given: &str, limit: &str, at: Option<&Place>) -> String {
    let at = at.map_or(String::new(), Place::told);
    let text = format!("{given:>11}; {limit:<LIMIT$} {at}");
    line(label, text.trim_end())
}

impl Sections {
    fn new(found: &Interference, part: &Part) -> Self {
        let slope = |extreme: &Extreme| Slope {
            angle_deg: extreme.value / DEG,
            at: Place::new(extreme, part),
        };
        Self {
            hollow: Hollow {
                curvature_per_mm: found.curvature.value,
                at: Place::new(&found.curvature, part),
            },
            rises_outward: slope(&found.rise),
            falls_outward: slope(&found.fall),
            rises_along_cut: slope(&found.uphill),
            falls_along_cut: slope(&found.downhill),
        }
    }

    fn lines(&self) -> String {
        let curvature = self.hollow.curvature_per_mm;
        let hollow = match curvature > 0.0 {
            true if curvature < 1e-3 => format!("curvature {curvature:.3e} /mm"),
            true => format!("curvature {curvature:.5} /mm"),
            false => "none".to_owned(),
        };
        let mut text = section("hollow", &hollow, curvature > 0.0, &self.hollow.at);
        for (label, slope) in [
            ("rises outward", &self.rises_outward),
            ("falls outward", &self.falls_outward),
            ("rises along cut", &self.rises_along_cut),
            ("falls along cut", &self.falls_along_cut),
        ] {
            let angle = slope.angle_deg;
            let slopes = angle >= LEVEL;
            let told = match slopes {
                true => format!("by {angle:.2} deg"),
                false => "nowhere".to_owned(),
            };
            text += &section(label, &told, slopes, &slope.at);
        }
        text
    }
}

/// Width of what is told of a section before its place.
const SECTION: usize = 24;

fn section(label: &str, told: &str, somewhere: bool, at: &Place) -> String {
    let at = if somewhere { at.told() } else { String::new() };
    line(label, format!("{told:<SECTION$}{at}").trim_end())
}

impl Place {
    fn new(extreme: &Extreme, part: &Part) -> Self {
        let at = extreme.position();
        let rho = extreme.rho;
        let inside = rho < part.inner_radius - ON_PART;
        let outside = rho > part.aperture_radius + ON_PART;
        Self {
            x_mm: at.x,
            y_mm: at.y,
            rho_mm: rho,
            c_deg: (extreme.theta / DEG).rem_euclid(360.0),
            on: if inside || outside {
                On::Overrun
            } else {
                On::Part
            },
        }
    }

    fn told(&self) -> String {
        let (x, y) = (millimetres(self.x_mm, 3), millimetres(self.y_mm, 3));
        let on = match self.on {
            On::Part => "part",
            On::Overrun => "overrun",
        };
        format!("at x = {x}, y = {y} ({on})")
    }
}
