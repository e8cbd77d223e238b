//! The cubic spline in slope form on uneven nodes: one tridiagonal matrix for any number of axes.
//!
//! Let h_k = t_{k+1} − t_k, d_k = Δp_k/h_k, λ_k = h_k/(h_{k−1} + h_k) and μ_k = 1 − λ_k. Second
//! derivatives are equal on both sides of node k if the slopes m satisfy λ_k m_{k−1} + 2 m_k + μ_k
//! m_{k+1} = 3(λ_k d_{k−1} + μ_k d_k) (de Boor, *A Practical Guide to Splines*, ch. IV).
//! Elimination needs no pivots, however uneven the steps are: λ_k + μ_k = 1 < 2.

/// The condition at an end of the spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The slope is given.
    Clamped,
    /// No second derivative: 2m₀ + m₁ = 3d₀.
    Natural,
    /// The first two segments are one cubic; see [`not_a_knot`].
    NotAKnot,
    /// The first segment is a parabola: m₀ + m₁ = 2d₀.
    Parabola,
}

/// One equation: lower·m_{k−1} + middle·m_k + upper·m_{k+1}.
#[derive(Debug, Clone, Copy)]
struct Row {
    lower: f64,
    middle: f64,
    upper: f64,
}

/// A row after forward elimination: m_k = (right side − lower·m_{k−1})·scale − upper·m_{k+1}.
#[derive(Debug, Clone, Copy)]
struct EliminatedRow {
    lower: f64,
    scale: f64,
    upper: f64,
}

/// The factored matrix of the nodes at times `t`.
pub struct System<'a> {
    t: &'a [f64],
    ends: [End; 2],
    rows: Vec<EliminatedRow>,
}

impl<'a> System<'a> {
    /// Factors the matrix by a forward sweep. A single node has a slope only if the slope is given.
    pub fn factor(t: &'a [f64], ends: [End; 2]) -> Self {
        let ends = solvable(ends, t.len());
        let mut system = Self {
            t,
            ends,
            rows: Vec::with_capacity(t.len()),
        };
        let mut before = 0.0;
        for k in 0..t.len() {
            let row = system.row(k);
            let scale = 1.0 / (row.middle - row.lower * before);
            before = row.upper * scale;
            system.rows.push(EliminatedRow {
                lower: row.lower,
                scale,
                upper: before,
            });
        }
        system
    }

    /// The slopes of the spline through `p`. `clamp` gives the slope at node 0 and at the last
    /// node.
    pub fn solve(&self, p: &[f64], clamp: impl Fn(usize) -> f64, slopes: &mut [f64]) {
        let mut before = 0.0;
        for (k, (row, slope)) in self.rows.iter().zip(slopes.iter_mut()).enumerate() {
            before = (self.right_side(k, p, &clamp) - row.lower * before) * row.scale;
            *slope = before;
        }
        let mut after = 0.0;
        for (row, slope) in self.rows.iter().zip(slopes.iter_mut()).rev() {
            *slope -= row.upper * after;
            after = *slope;
        }
    }

    fn step(&self, k: usize) -> f64 {
        self.t[k + 1] - self.t[k]
    }

    fn chord(&self, k: usize, p: &[f64]) -> f64 {
        (p[k + 1] - p[k]) / self.step(k)
    }

    fn last(&self) -> usize {
        self.t.len() - 1
    }

    fn row(&self, k: usize) -> Row {
        if k == 0 {
            let (middle, upper) = self.end_row(self.ends[0], 0, 1);
            return Row {
                lower: 0.0,
                middle,
                upper,
            };
        }
        if k == self.last() {
            let (middle, lower) = self.end_row(self.ends[1], k - 1, k.saturating_sub(2));
            return Row {
                lower,
                middle,
                upper: 0.0,
            };
        }
        let (lower, upper) = self.weights(k);
        Row {
            lower,
            middle: 2.0,
            upper,
        }
    }

    /// λ_k and μ_k.
    fn weights(&self, k: usize) -> (f64, f64) {
        let (before, after) = (self.step(k - 1), self.step(k));
        let both = before + after;
        (after / both, before / both)
    }

    /// The factors of the end's slope and of its neighbour's slope. Segments are numbered from the
    /// end inwards.
    fn end_row(&self, end: End, first: usize, second: usize) -> (f64, f64) {
        match end {
            End::Clamped => (1.0, 0.0),
            End::Natural => (2.0, 1.0),
            End::Parabola => (1.0, 1.0),
            End::NotAKnot => {
                let (h0, h1) = (self.step(first), self.step(second));
                (1.0, (h0 + h1) / h1)
            }
        }
    }

    fn right_side(&self, k: usize, p: &[f64], clamp: &impl Fn(usize) -> f64) -> f64 {
        if k == 0 {
            return self.end_value(self.ends[0], [0, 1], p, || clamp(0));
        }
        if k == self.last() {
            return self.end_value(self.ends[1], [k - 1, k.saturating_sub(2)], p, || clamp(k));
        }
        let (lower, upper) = self.weights(k);
        3.0 * (lower * self.chord(k - 1, p) + upper * self.chord(k, p))
    }

    fn end_value(
        &self,
        end: End,
        [first, second]: [usize; 2],
        p: &[f64],
        clamp: impl Fn() -> f64,
    ) -> f64 {
        match end {
            End::Clamped => clamp(),
            End::Natural => 3.0 * self.chord(first, p),
            End::Parabola => 2.0 * self.chord(first, p),
            End::NotAKnot => not_a_knot(
                [self.step(first), self.step(second)],
                [self.chord(first, p), self.chord(second, p)],
            ),
        }
    }
}

/// The right side of m₀ + (h₀ + h₁)/h₁·m₁ = [(3h₀ + 2h₁)d₀ + h₀²/h₁·d₁]/(h₀ + h₁), which says that
/// the third derivative does not jump at node 1.
fn not_a_knot([h0, h1]: [f64; 2], [d0, d1]: [f64; 2]) -> f64 {
    ((3.0 * h0 + 2.0 * h1) * d0 + h0 * h0 / h1 * d1) / (h0 + h1)
}

/// The same ends if `count` nodes are enough for them; otherwise the nearest ends that have a
/// solution. Two segments as one cubic through three nodes, with nothing else known, are a
/// parabola. A single segment is a parabola or a straight line.
fn solvable(ends: [End; 2], count: usize) -> [End; 2] {
    use End::{Clamped, Natural, NotAKnot, Parabola};
    match (count, ends) {
        (0 | 1, _) => [Clamped, Clamped],
        (2, [NotAKnot, NotAKnot]) => [Natural, Natural],
        (2, [NotAKnot, other]) => [Parabola, other],
        (2, [other, NotAKnot]) => [other, Parabola],
        (3, [NotAKnot, NotAKnot]) => [Parabola, NotAKnot],
        _ => ends,
    }
}
