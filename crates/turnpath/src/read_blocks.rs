//! Blocks of a path that are read while those before are measured.

use turnpath_core::toolpath::{PathBlock, Section, SegmentShape};
use turnpath_post::ReadPath;

use crate::error::Error;

/// Rows that are measured in one go.
pub const BLOCK_ROWS: usize = 20_000;

/// Blocks of a path. If reading failed behind them, the failure is kept until they are measured. So what is wrong with a
/// block is told before what is wrong behind it, however many blocks were read together. The block in which reading
/// fails is lost.
#[derive(Debug)]
pub struct ReadBlocks {
    /// The blocks, each with its section.
    pub blocks: Vec<(Section, PathBlock)>,
    /// What failed behind them.
    pub failure: Option<Error>,
}

impl ReadBlocks {
    /// Reads on until there are `most` blocks, until one or more are enough, or to the end of the path.
    pub fn read(
        reader: &mut dyn ReadPath,
        shape: SegmentShape,
        most: usize,
        is_enough: impl Fn() -> bool,
    ) -> Self {
        let mut read = Self {
            blocks: Vec::new(),
            failure: None,
        };
        while read.blocks.len() < most && (read.blocks.is_empty() || !is_enough()) {
            match reader.next_block(BLOCK_ROWS) {
                Ok(Some((section, block))) => {
                    read.blocks.push((section, PathBlock { shape, ..block }));
                }
                Ok(None) => break,
                Err(error) => {
                    read.failure = Some(error.into());
                    break;
                }
            }
        }
        read
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use turnpath_core::toolpath::ControlPoint;
    use turnpath_post::{ReadCount, ReadError};

    use super::*;

    /// So many blocks of a cut, behind which the path ends or cannot be read.
    struct Cut {
        left: usize,
        fails: bool,
        count: ReadCount,
    }

    impl Cut {
        fn of(left: usize) -> Self {
            Self {
                left,
                fails: false,
                count: ReadCount::default(),
            }
        }
    }

    impl ReadPath for Cut {
        fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
            Ok(None)
        }

        fn next_block(&mut self, _: usize) -> Result<Option<(Section, PathBlock)>, ReadError> {
            if self.left > 0 {
                self.left -= 1;
                return Ok(Some((Section::Cutting, PathBlock::default())));
            }
            let damaged = || ReadError::File {
                path: "path.csv".into(),
                error: std::io::Error::other("damaged"),
            };
            self.fails.then(damaged).map_or(Ok(None), Err)
        }

        fn read_count(&self) -> &ReadCount {
            &self.count
        }

        fn read_count_mut(&mut self) -> &mut ReadCount {
            &mut self.count
        }
    }

    fn read(cut: &mut Cut, is_enough: impl Fn() -> bool) -> ReadBlocks {
        ReadBlocks::read(cut, SegmentShape::Cubic, 4, is_enough)
    }

    #[test]
    fn it_reads_one_block_at_least_and_so_many_at_the_most() {
        let mut cut = Cut::of(7);
        assert_eq!(read(&mut cut, || true).blocks.len(), 1);
        let asked = Cell::new(0);
        let is_enough = || asked.replace(asked.get() + 1) == 1;
        assert_eq!(read(&mut cut, is_enough).blocks.len(), 2);
        assert_eq!(read(&mut cut, || false).blocks.len(), 4);
        let end = read(&mut cut, || false);
        assert!(end.blocks.is_empty() && end.failure.is_none(), "{end:?}");
    }

    #[test]
    fn blocks_before_a_failure_are_kept() {
        let mut cut = Cut::of(2);
        cut.fails = true;
        let read = read(&mut cut, || false);
        assert_eq!(read.blocks.len(), 2);
        assert!(read.failure.is_some());
    }
}
