//! A check: everything but the path.

use turnpath_core::interference::{Extreme, Interference};
use turnpath_core::largest_nose::LargestNose;
use turnpath_core::toolpath::Section;
use turnpath_core::{DEG, Part, Tolerance, Tool};
use turnpath_pipeline::{Estimate, Observer, PathSample, Stage, largest_nose, sample_path};
use turnpath_post::PathWriter;
use turnpath_report as report;
use turnpath_report::{CheckReport, LimitFigure};

use crate::axis_notes::axis_notes;
use crate::commands::controller_commands;
use crate::diagnosis::{not_carried, of_pipeline};
use crate::error::Error;
use crate::figures::{self, machine_source};
use crate::job::Job;
use crate::part_shape;
use crate::posts::NotCarried;
use crate::program::Program;
use crate::region::region;
use crate::remarks::PathSubject;
use crate::sampled_stretches::sampled_stretches;

impl Job {
    /// What the part asks of the tool, and what the path and its rough paths will be, without making them.
    ///
    /// # Errors
    /// When a strategy fails, when a program cannot carry the path, and when the observer cancels. The searches on the
    /// part do not ask the observer.
    pub fn check(&self, observer: &dyn Observer) -> Result<CheckReport, Error> {
        let failed = |error| of_pipeline(&self.recipe, error);
        let task = &self.preparation.task;
        let find_nose =
            || largest_nose(&self.chain.locus_links(), &self.preparation).map_err(failed);
        let find_shape = || part_shape::shape(&self.recipe, &self.chain.surface, &task.part);
        let look_at_data = || self.data_remarks(task.tolerance.interpolation);
        let (sampled, (nose, (shape, on_data))) = rayon::join(
            || {
                let sampled = self.sample(observer);
                observer.begin(Stage::Part, 0);
                sampled
            },
            || rayon::join(find_nose, || rayon::join(find_shape, look_at_data)),
        );
        let ((expected, sample), nose) = (sampled?, nose?);
        if observer.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let rough_jobs = self.rough_jobs()?;
        let rough_paths = rough_jobs.iter().map(|rough| rough.expected(observer));
        let path = PathSubject {
            tolerance: task.tolerance,
            cutting_time: expected.cutting_time,
            lead_time: lead_time(&sample),
            revolutions: expected.revolutions,
            control_points: expected.control_points,
            z_acceleration: None,
        };
        let report = CheckReport {
            format: report::FORMAT,
            name: self.recipe.name.clone(),
            part: Some(shape?),
            tool_fit: self.tool_fit(&nose),
            machine: self.machine_limits(),
            unreached: self.unreached()?,
            form: self.first_form(),
            expected: self.estimate(&expected, &sample)?,
            rough_paths: rough_paths.collect::<Result<_, _>>()?,
            feed_cap: figures::feed_cap(expected.feed_cap.as_ref()),
            axis_notes: Some(match self.programs.first() {
                Some(program) => program.axis_notes(&self.recipe),
                None => axis_notes(&self.recipe, false),
            }),
            remarks: self.remarks(&path, on_data?),
            controller_commands: controller_commands(&self.recipe),
        };
        Ok(report.rounded())
    }

    /// What the path and its files will be.
    ///
    /// # Errors
    /// When a strategy fails, when a program cannot carry the path, and when the observer cancels.
    pub(crate) fn expected(&self, observer: &dyn Observer) -> Result<report::Estimate, Error> {
        let (expected, sample) = self.sample(observer)?;
        self.estimate(&expected, &sample)
    }

    fn sample(&self, observer: &dyn Observer) -> Result<(Estimate, PathSample), Error> {
        let sample = sample_path(
            &self.chain,
            &self.path_preparation(),
            self.options(),
            observer,
        );
        sample.map_err(|error| of_pipeline(&self.recipe, error))
    }

    fn estimate(
        &self,
        expected: &Estimate,
        sample: &PathSample,
    ) -> Result<report::Estimate, Error> {
        let size = |program: &Program| -> Result<report::ProgramEstimate, NotCarried> {
            let sampled = program.sampled_size(sample)?;
            Ok(report::ProgramEstimate {
                file: program.file.clone(),
                bytes: sampled.size.bytes,
                blocks: sampled.size.blocks,
                parts: sampled.parts,
                c_means: Some(program.axis_notes(&self.recipe).c),
            })
        };
        let programs: Result<Vec<_>, _> = self.programs.iter().map(size).collect();
        let programs = programs.map_err(|error| not_carried(&self.recipe, error))?;
        Ok(report::Estimate {
            revolutions: expected.revolutions,
            cutting_time: expected.cutting_time,
            control_points: expected.control_points.round() as u64,
            toolpath_bytes: self.toolpath_bytes(sample)? as u64,
            programs,
        })
    }

    /// Bytes of the table of the path, from a sample of it.
    fn toolpath_bytes(&self, sample: &PathSample) -> Result<f64, Error> {
        let stretches = sampled_stretches(sample, |block| {
            Ok::<_, Error>(PathWriter::rows(block.section, block.points).len() as u64)
        })?;
        let of_path = stretches.iter().map(|rows| rows.of_path(rows.measured));
        Ok(of_path.sum())
    }

    /// The tolerance of form, with what the first path is made for.
    fn first_form(&self) -> Option<report::FormReport> {
        let Tolerance {
            interpolation,
            residual,
        } = self.preparation.task.tolerance;
        self.recipe
            .tolerances
            .form
            .map(|tolerance| report::FormReport {
                tolerance,
                pv: None,
                split: Some(report::FormSplit {
                    residual,
                    interpolation,
                    rounds: 0,
                    search_ended_because: None,
                    decided_by_recipe: false,
                }),
            })
    }

    fn machine_limits(&self) -> Option<report::MachineLimits> {
        let limits = self.recipe.machine.limits();
        Some(report::MachineLimits {
            machine: machine_source(&self.recipe)?,
            limits: limits.map(LimitFigure::unmeasured).collect(),
            spindle: self.recipe.spindle_speed,
        })
    }

    fn tool_fit(&self, nose: &LargestNose) -> report::ToolFit {
        let (found, task) = (&self.preparation.interference, &self.preparation.task);
        report::ToolFit {
            largest_nose_radius: finite(nose.radius),
            least_included_angle: least_included(found),
            least_clearance_angle: found.cut_angle().value,
            margins: margins(found, nose, &task.tool, &task.part),
            sections: sections(found, &task.part),
        }
    }
}

/// The time of the leads of a sampled path, s. The segments that join them to the cut are theirs.
fn lead_time(sample: &PathSample) -> f64 {
    let cut = [sample.blocks.first(), sample.blocks.last()];
    let [Some(begin), Some(end)] = cut.map(|block| block.map(|block| &block.points.t)) else {
        return 0.0;
    };
    let times = sample.leads.iter().map(|(section, points)| match section {
        Section::LeadOut => points.t.last().zip(end.last()),
        Section::LeadIn | Section::Cutting => begin.first().zip(points.t.first()),
    });
    times.flatten().map(|(late, early)| late - early).sum()
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn least_included(found: &Interference) -> f64 {
    2.0 * found.contact_angle().value
}

fn margins(found: &Interference, nose: &LargestNose, tool: &Tool, part: &Part) -> report::Margins {
    let angle = |given: Option<f64>, least: f64, at: Extreme| report::AngleMargin {
        given,
        least,
        margin: given.map(|given| given - least),
        at: Some(place(&at, part)),
    };
    let most = finite(nose.radius);
    let (contact, cut) = (found.contact_angle(), found.cut_angle());
    report::Margins {
        nose_radius: report::NoseMargin {
            given: tool.nose_radius,
            most,
            margin: most.map(|most| most - tool.nose_radius),
            // Where the surface ends within the reach of a larger nose, no place limits it.
            at: most
                .filter(|_| nose.at.value.is_finite())
                .map(|_| place(&nose.at, part)),
        },
        included_angle: angle(tool.included_angle, least_included(found), contact),
        clearance_angle: angle(tool.clearance_angle, cut.value, cut),
    }
}

fn sections(found: &Interference, part: &Part) -> report::Sections {
    let slope = |extreme: &Extreme| report::Slope {
        angle: extreme.value,
        at: place(extreme, part),
    };
    report::Sections {
        hollow: report::Hollow {
            curvature: found.curvature.value,
            at: place(&found.curvature, part),
        },
        rises_outward: slope(&found.rise),
        falls_outward: slope(&found.fall),
        rises_along_cut: slope(&found.uphill),
        falls_along_cut: slope(&found.downhill),
    }
}

fn place(extreme: &Extreme, part: &Part) -> report::ContactPlace {
    let (at, rho) = (extreme.position(), extreme.rho);
    report::ContactPlace {
        x: at.x,
        y: at.y,
        rho,
        c: extreme.theta.rem_euclid(360.0 * DEG),
        on: region(rho, part),
    }
}
