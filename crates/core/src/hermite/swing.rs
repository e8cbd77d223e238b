//! Whether X moves within the turn, beside the slow feed.

use crate::{Path, Result};

/// Turns of the path that are looked at.
const TURNS: usize = 64;
/// Places within a turn. Their distances are no simple parts of it, so that a surface with equal
/// sectors does not look the same at all of them.
const PLACES: [f64; 4] = [0.0, 0.37, 0.61, 1.0];
/// X moves within a turn if its rate leaves the straight line over that turn by this part of itself.
const SWING: f64 = 0.1;
/// X moves within the turn if it does so on one of so many turns. Where the feed comes to rest, at
/// the ends of a path, any law leaves the line.
const ONE_OF: usize = 4;

/// Whether X moves within the turn: with a compensator that moves it, or with a law that follows the
/// angle. The path must be whole.
///
/// # Errors
/// If the locus has no value on the path.
pub fn x_swings(path: &Path<'_>) -> Result<bool> {
    let last = path.law.end() - 1.0;
    if last <= 0.0 {
        return Ok(false);
    }
    let start = |k: usize| last * (k as f64 + 0.5) / TURNS as f64;
    let places = (0..TURNS).flat_map(|k| PLACES.map(|place| start(k) + place));
    let places: Vec<f64> = places.collect();
    let blank = vec![[f64::NAN; 5]; places.len()];
    let (mut x, mut z) = (blank.clone(), blank);
    path.series_at(&places, &mut x, &mut z)?;
    let rates: Vec<f64> = x.iter().map(|x| x[1]).collect();
    let swinging = rates.chunks_exact(PLACES.len()).filter(|turn| swings(turn));
    Ok(ONE_OF * swinging.count() >= TURNS)
}

/// Whether the rates at [`PLACES`] of a turn leave the line from the first to the last.
fn swings(turn: &[f64]) -> bool {
    let [first, .., last] = *turn else {
        return false;
    };
    let most = SWING * first.abs().max(last.abs());
    turn.iter().zip(PLACES).any(|(rate, place)| {
        let line = first + place * (last - first);
        (rate - line).abs() > most
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_follows_the_angle_swings_and_a_slow_one_does_not() {
        assert!(swings(&[1.0, 1.2, 0.7, 1.0]));
        assert!(!swings(&[1.0, 1.05, 1.08, 1.1]));
        assert!(!swings(&[0.0; 4]));
    }
}
