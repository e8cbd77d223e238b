//! Circles in a directed graph.

/// The sets of nodes that reach each other, each sorted; sets of one node are left out.
pub fn circles(nodes: usize, pairs: &[(usize, usize)]) -> Vec<Vec<usize>> {
    let reached: Vec<Vec<bool>> = (0..nodes).map(|node| from(node, nodes, pairs)).collect();
    let mut found = Vec::new();
    for (node, from_here) in reached.iter().enumerate() {
        let with = (0..nodes).filter(|other| from_here[*other] && reached[*other][node]);
        let circle: Vec<usize> = with.collect();
        if circle.len() > 1 && circle.first() == Some(&node) {
            found.push(circle);
        }
    }
    found
}

/// Which nodes are reached from one of them.
fn from(start: usize, nodes: usize, pairs: &[(usize, usize)]) -> Vec<bool> {
    let mut reached = vec![false; nodes];
    let mut left = vec![start];
    while let Some(node) = left.pop() {
        let next = pairs.iter().filter(|(from, _)| *from == node);
        for (_, to) in next {
            if !reached[*to] {
                reached[*to] = true;
                left.push(*to);
            }
        }
    }
    reached
}
