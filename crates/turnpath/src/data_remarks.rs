//! Remarks on a surface that was made from data: what was filled, and where the path leaves them.

use turnpath_pipeline::{DataReach, Farthest, data_reach};
use turnpath_report::Remark;

use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::job::Job;
use crate::remarks::{PathSubject, remarks};

impl Job {
    /// All remarks on the recipe and its path.
    pub(crate) fn remarks(&self, path: &PathSubject) -> Result<Vec<Remark>, Error> {
        let cut_angle = self.preparation.interference.cut_angle().value;
        let mut all = remarks(&self.recipe, path, cut_angle);
        all.extend(self.data_remarks()?);
        Ok(all)
    }

    fn data_remarks(&self) -> Result<Vec<Remark>, Error> {
        let reach = data_reach(&self.chain, &self.preparation);
        let reach = reach.map_err(|error| of_pipeline(&self.recipe, error))?;
        Ok(reach.map(on_data).unwrap_or_default())
    }
}

fn on_data(reach: DataReach) -> Vec<Remark> {
    let DataReach {
        data,
        part,
        overrun,
    } = reach;
    let filled = (data.filled > 0).then_some(Remark::FilledPoints {
        filled: data.filled,
        points: data.points,
    });
    let beyond = |place: Option<Farthest>, on_part: bool| {
        place.map(|place| Remark::BeyondData {
            on_part,
            distance: place.distance,
            radius: place.radius,
            c: place.angle,
            continuation: data.continuation.clone(),
        })
    };
    let all = [filled, beyond(part, true), beyond(overrun, false)];
    all.into_iter().flatten().collect()
}
