//! The machined surface in a summary, and in lines for a person.

use serde::Serialize;
use turnpath_verify::machined::{MachinedFigures, PartPoint};

use crate::figures::{line, millimetres, nanometres};
use crate::summary::NM_PER_MM;

/// Microradians in a radian.
const URAD_PER_RAD: f64 = 1e6;
/// Per cent in a whole.
const PERCENT: f64 = 100.0;

/// Machined − wanted along z, weighted by area; `null` where nothing of the part is cut.
#[derive(Debug, Serialize)]
pub struct SurfaceError {
    surface_error_nm: ErrorNm,
    /// RMS of the radial slope's error, µrad.
    slope_error_urad: Option<f64>,
}

#[derive(Debug, Default, Serialize)]
struct ErrorNm {
    pv: Option<f64>,
    /// About zero.
    rms: Option<f64>,
    /// RMS about the mean.
    sq: Option<f64>,
    /// Mean amount about the mean.
    sa: Option<f64>,
    mean: Option<f64>,
    highest: Option<Extreme>,
    lowest: Option<Extreme>,
    /// Part of the area that no nose reaches; no other figure speaks of it.
    uncut_percent: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Extreme {
    error_nm: f64,
    x_mm: f64,
    y_mm: f64,
}

impl SurfaceError {
    /// In the units of the file.
    pub fn of(machined: Option<&MachinedFigures>) -> Self {
        let Some(found) = machined else {
            return Self {
                surface_error_nm: ErrorNm::default(),
                slope_error_urad: None,
            };
        };
        let nm = |mm: f64| Some(mm * NM_PER_MM);
        Self {
            surface_error_nm: ErrorNm {
                pv: nm(found.pv()),
                rms: nm(found.rms),
                sq: nm(found.sq),
                sa: nm(found.sa),
                mean: nm(found.mean),
                highest: Some(Extreme::of(&found.highest)),
                lowest: Some(Extreme::of(&found.lowest)),
                uncut_percent: Some(found.uncut * PERCENT),
            },
            slope_error_urad: Some(found.rms_slope * URAD_PER_RAD),
        }
    }

    /// The lines for a person.
    pub fn lines(&self) -> String {
        let error = &self.surface_error_nm;
        let (Some(pv), Some(rms)) = (error.pv, error.rms) else {
            return line("surface error", "not measured: nothing of the part is cut");
        };
        let mut text = format!("{:>12} PV, {} rms", nanometres(pv), nanometres(rms));
        if let Some(high) = &error.highest {
            let (x, y) = (millimetres(high.x_mm, 4), millimetres(high.y_mm, 4));
            text += &format!("; the highest at x = {x}, y = {y}");
        }
        let uncut = error.uncut_percent.filter(|uncut| *uncut > 0.0);
        let uncut = uncut.map(|uncut| line("", format!("{uncut:>10.3} % of the part is not cut")));
        line("surface error", text) + &uncut.unwrap_or_default()
    }
}

impl Extreme {
    fn of(place: &PartPoint) -> Self {
        Self {
            error_nm: place.error * NM_PER_MM,
            x_mm: place.x,
            y_mm: place.y,
        }
    }
}
