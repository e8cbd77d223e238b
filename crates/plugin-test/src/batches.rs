//! One point asked alone and in batches of any length: the answers have the same bits.

use turnpath_core::Result as Answer;

use crate::fault::FaultKind;
use crate::place::OnPart;

/// Lengths of batches: around those at which answers change between vector registers and single
/// points.
const LENGTHS: [usize; 7] = [1, 2, 3, 7, 8, 9, 19];

/// Asks for the points one by one and in batches; `ask` gives the numbers of each point of its batch,
/// `of` is what they are.
pub fn check<const N: usize>(
    call: &'static str,
    of: [&str; N],
    points: &[OnPart],
    ask: impl Fn(&[OnPart]) -> Answer<Vec<[f64; N]>>,
) -> Result<(), FaultKind> {
    let failed = |error| FaultKind::Call { call, error };
    let mut alone = Vec::with_capacity(points.len());
    for point in points {
        alone.extend(ask(std::slice::from_ref(point)).map_err(failed)?);
    }
    for length in LENGTHS {
        for (points, alone) in points.chunks(length).zip(alone.chunks(length)) {
            let together = ask(points).map_err(failed)?;
            for (i, (first, second)) in alone.iter().zip(&together).enumerate() {
                let differs = |k: &usize| first[*k].to_bits() != second[*k].to_bits();
                if let Some(k) = (0..N).find(differs) {
                    return Err(FaultKind::Repeat {
                        what: format!("{} at {}", of[k], points[i]),
                        when: in_batch(length),
                        first: first[k],
                        second: second[k],
                    });
                }
            }
        }
    }
    Ok(())
}

fn in_batch(length: usize) -> &'static str {
    match length {
        1 => "when it is asked again",
        _ => "in a batch of other points",
    }
}
