//! How many bytes the files of a path take, and whether they fit on the disk.

use std::io;
use std::path::Path;

use turnpath_files::FileError;
use turnpath_pipeline::Estimate;

/// Bytes that a row of `toolpath.csv` takes, give or take a tenth: seven doubles and a digit.
const ROW_BYTES: f64 = 125.0;

/// Bytes of a row in a file of columns: seven doubles and a section.
const COLUMN_ROW_BYTES: f64 = 57.0;

/// Bytes of `toolpath.csv` before refinement, to see whether a disk has room.
pub fn toolpath_bytes(expected: &Estimate) -> f64 {
    expected.control_points * ROW_BYTES
}

/// Bytes that a file of columns takes at most while it is put together: the columns wait beside it.
pub fn column_bytes(expected: &Estimate) -> f64 {
    2.0 * COLUMN_ROW_BYTES * expected.control_points
}

/// Bytes that programs of these sizes take at most while they are put together: one after the other is
/// copied from its scratch file, which is there until the copy is whole.
pub fn bytes_while_assembled(programs: impl Iterator<Item = f64>) -> f64 {
    let (sum, largest) = programs.fold((0.0, 0.0_f64), |(sum, largest), bytes| {
        (sum + bytes, largest.max(bytes))
    });
    sum + largest
}

/// Refuses files that the disk of a folder has no room for. The folder need not be there yet. Where
/// the system does not say how much is free, the files are begun.
///
/// # Errors
/// When less is free than the files take.
pub fn check_room(folder: &Path, needed: f64) -> Result<(), FileError> {
    let whole = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let nearest = whole.ancestors().find(|part| part.exists());
    match nearest.and_then(|part| fs4::available_space(part).ok()) {
        Some(free) => fits(folder, needed, free as f64),
        None => Ok(()),
    }
}

fn fits(folder: &Path, needed: f64, free: f64) -> Result<(), FileError> {
    if needed <= free {
        return Ok(());
    }
    let [needed, free] = [needed, free].map(turnpath_report::text::bytes);
    let cause = format!("the files take about {needed}, and {free} are free there");
    Err(FileError {
        path: folder.to_owned(),
        error: io::Error::new(io::ErrorKind::StorageFull, cause),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_larger_than_the_free_space_are_refused_with_both_numbers() {
        let folder = Path::new("out/part");
        assert!(fits(folder, 1e9, 1e9).is_ok());
        let error = fits(folder, 1.25e11, 2e10).unwrap_err();
        assert_eq!(error.error.kind(), io::ErrorKind::StorageFull);
        let said = error.error.to_string();
        assert!(
            said.contains("125.00 GB") && said.contains("20.00 GB"),
            "{said}"
        );
    }

    #[test]
    fn the_largest_program_counts_twice() {
        assert_eq!(bytes_while_assembled([1.0, 5.0, 2.0].into_iter()), 13.0);
        assert_eq!(bytes_while_assembled(std::iter::empty()), 0.0);
    }

    /// No disk has room for 10²⁵ bytes, and every disk of a test has room for one.
    #[test]
    fn the_free_space_is_that_of_the_nearest_folder() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("not/yet/there");
        assert!(check_room(&missing, 1.0).is_ok());
        assert!(check_room(&missing, 1e25).is_err());
        assert!(check_room(Path::new("not/there/either"), 1e25).is_err());
    }
}
