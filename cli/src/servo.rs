//! What the servo makes of the path, as the summary, `verify` and a person get it. No tolerance is
//! held against it: it is a model.

use serde::Serialize;
use turnpath_core::DEG;
use turnpath_verify::{FollowingError, ServoFigures};

use crate::figures::{line, millimetres, nanometres};
use crate::summary::{NM_PER_MM, Place, UM_PER_MM};

/// Seconds of arc in a degree.
const ARCSEC_PER_DEG: f64 = 3600.0;

/// Following error of the axes, and the error of the surface that it predicts.
#[derive(Debug, Serialize)]
pub struct ServoSummary {
    following_error: FollowingErrors,
    predicted_error_nm: Predicted,
}

/// What axes do − what they are told, over the cut.
#[derive(Debug, Serialize)]
struct FollowingErrors {
    x_um: Amounts,
    z_um: Amounts,
    c_arcsec: Amounts,
}

#[derive(Debug, Serialize)]
struct Amounts {
    max: f64,
    rms: f64,
}

/// Where the axes bring the tool − the true tool centre, along z.
#[derive(Debug, Serialize)]
struct Predicted {
    max: f64,
    rms: f64,
    at: Place,
}

impl Amounts {
    fn of(error: &FollowingError, unit: f64) -> Self {
        Self {
            max: error.max / unit,
            rms: error.rms() / unit,
        }
    }
}

impl ServoSummary {
    /// In the units of the file.
    pub fn of(figures: &ServoFigures) -> Self {
        Self {
            following_error: FollowingErrors {
                x_um: Amounts::of(&figures.x, UM_PER_MM.recip()),
                z_um: Amounts::of(&figures.z, UM_PER_MM.recip()),
                c_arcsec: Amounts::of(&figures.c, DEG / ARCSEC_PER_DEG),
            },
            predicted_error_nm: Predicted {
                max: figures.max() * NM_PER_MM,
                rms: figures.rms() * NM_PER_MM,
                at: Place {
                    c_deg: figures.at_c / DEG,
                    x_mm: figures.at_x,
                },
            },
        }
    }

    /// The lines for a person.
    pub fn lines(&self) -> String {
        let (error, axes) = (&self.predicted_error_nm, &self.following_error);
        let mut text = line(
            "servo",
            format!(
                "{:>12} predicted, {} rms; the largest at C = {:.2} deg, X = {}",
                nanometres(error.max),
                nanometres(error.rms),
                error.at.c_deg,
                millimetres(error.at.x_mm, 4)
            ),
        );
        text += &line(
            "",
            format!(
                "follows to {} in X, {} in Z, {:.2} arcsec in C",
                nanometres(axes.x_um.max * UM_PER_MM),
                nanometres(axes.z_um.max * UM_PER_MM),
                axes.c_arcsec.max
            ),
        );
        text
    }
}
