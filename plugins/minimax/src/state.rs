//! The states of a node: how far it lies off the locus, and how far its rate differs.

/// A state (α, β). The node lies αε above the locus, and dZ/dθ is βε/h larger than that of the
/// locus, with h the natural step at the node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// α, from −1 to 1.
    pub height: f64,
    /// β.
    pub slope: f64,
}

/// The state of a node on the locus: the first of every set.
pub const ON_LOCUS: State = state(0.0, 0.0);

/// Nodes on the locus only.
const ONE: [State; 1] = [ON_LOCUS];
/// Nodes at the edges of the tolerance.
const THREE: [State; 3] = [ON_LOCUS, state(1.0, 0.0), state(-1.0, 0.0)];
/// With rates at which the path changes from one edge to the other within a step.
const SEVEN: [State; 7] = [
    ON_LOCUS,
    state(1.0, 0.0),
    state(-1.0, 0.0),
    state(0.0, 4.0),
    state(0.0, -4.0),
    state(0.0, 8.0),
    state(0.0, -8.0),
];
/// All heights in halves with all of these rates.
const TWENTY_FIVE: [State; 25] = [
    ON_LOCUS,
    state(1.0, 0.0),
    state(-1.0, 0.0),
    state(0.0, 4.0),
    state(0.0, -4.0),
    state(0.0, 8.0),
    state(0.0, -8.0),
    state(0.5, 0.0),
    state(-0.5, 0.0),
    state(1.0, 4.0),
    state(1.0, -4.0),
    state(-1.0, 4.0),
    state(-1.0, -4.0),
    state(0.5, 4.0),
    state(0.5, -4.0),
    state(-0.5, 4.0),
    state(-0.5, -4.0),
    state(1.0, 8.0),
    state(1.0, -8.0),
    state(-1.0, 8.0),
    state(-1.0, -8.0),
    state(0.5, 8.0),
    state(0.5, -8.0),
    state(-0.5, 8.0),
    state(-0.5, -8.0),
];

const fn state(height: f64, slope: f64) -> State {
    State { height, slope }
}

/// The set of so many states, or `None` if there is none.
pub fn states(count: u64) -> Option<&'static [State]> {
    match count {
        1 => Some(&ONE),
        3 => Some(&THREE),
        7 => Some(&SEVEN),
        25 => Some(&TWENTY_FIVE),
        _ => None,
    }
}
