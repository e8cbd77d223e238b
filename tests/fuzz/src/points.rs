//! Control points as a reader gives them, one by one and in blocks.

use turnpath_core::toolpath::{ControlPoint, Section};
use turnpath_post::{ReadError, ReadPath};

/// Most points that are read of one input.
const MOST_POINTS: usize = 20_000;
/// Sizes of blocks: the smallest, a small one that divides nothing, and one for all.
const BLOCKS: [usize; 3] = [1, 7, MOST_POINTS];

/// A point and its section.
pub type ReadPoint = (ControlPoint, Section);

/// The points that a reader gives one by one, and the error that ended it. All numbers of a point are
/// finite, and sections come in their order.
pub fn one_by_one(reader: &mut impl ReadPath) -> (Vec<ReadPoint>, Option<ReadError>) {
    let mut points: Vec<ReadPoint> = Vec::new();
    while points.len() < MOST_POINTS {
        match reader.next_point() {
            Ok(Some((point, section))) => {
                assert!(is_finite(&point), "a reader gave {point:?}");
                let before = points.last().map(|(_, section)| *section);
                assert!(before.is_none_or(|before| before <= section));
                points.push((point, section));
            }
            Ok(None) => return (points, None),
            Err(error) => return (points, Some(error)),
        }
    }
    (points, None)
}

/// Blocks of any size have the points that come one by one, and end with the same error.
pub fn assert_blocks_agree<R: ReadPath>(
    new: impl Fn() -> Option<R>,
    points: &[ReadPoint],
    error: Option<&ReadError>,
) {
    if points.len() == MOST_POINTS {
        return;
    }
    for most in BLOCKS {
        let Some(mut reader) = new() else { return };
        let mut segments = 0;
        let ended = loop {
            match reader.next_block(most) {
                Ok(Some((_, block))) => {
                    assert!((2..=most + 1).contains(&block.len()), "a block's length");
                    segments += block.len() - 1;
                }
                Ok(None) => break None,
                Err(error) => break Some(error.to_string()),
            }
        };
        assert_eq!(ended, error.map(ToString::to_string));
        // Of a damaged file, the segments of the last block are lost.
        let all = points.len().saturating_sub(1);
        assert!(segments == all || (error.is_some() && segments <= all));
        assert_eq!(reader.read_count().points(), points.len() as u64);
    }
}

fn is_finite(point: &ControlPoint) -> bool {
    let &ControlPoint {
        t,
        c,
        x,
        z,
        vc,
        vx,
        vz,
    } = point;
    [t, c, x, z, vc, vx, vz].iter().all(|n| n.is_finite())
}
