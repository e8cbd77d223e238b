//! Blocks begin and end on the locus, and do not depend on each other.

use crate::common::{BLOCK, ast_5, minimax, nodes, nodes_between, params, smooth_law};
use turnpath_core::{NodeList, NodeOffset, Sampler, Strategy, StrategyError};
use turnpath_minimax::MinimaxSampler;
use turnpath_nose_radius::ZDirection;

#[test]
fn a_block_begins_on_the_locus_at_its_start() {
    let case = ast_5(ZDirection);
    let law = smooth_law(&case);
    let blocks = nodes(&case, &law, &minimax(7.0, 45.0));
    assert!(blocks.len() > 1 && blocks.iter().all(NodeList::has_offsets));
    for (i, block) in blocks.iter().enumerate() {
        assert_eq!(block.revolutions()[0], i as f64 * BLOCK);
        assert_eq!(block.offset(0), NodeOffset::default());
    }
}

#[test]
fn a_block_alone_has_the_nodes_that_it_has_on_the_path() {
    let case = ast_5(ZDirection);
    let law = smooth_law(&case);
    let sampler = minimax(7.0, 45.0);
    let all = nodes(&case, &law, &sampler);
    let alone = nodes_between(&case, &law, &sampler, (BLOCK, law.end())).unwrap();
    assert_eq!(all[1..], alone);
}

/// The last step of a block is no sliver beside its border.
#[test]
fn no_node_lies_close_to_a_border() {
    let case = ast_5(ZDirection);
    let law = smooth_law(&case);
    for states in [1.0, 7.0] {
        let blocks = nodes(&case, &law, &minimax(states, 45.0));
        let last = blocks[0].revolutions().last().copied().unwrap_or_default();
        let lengths = blocks[0].revolutions().windows(2).map(|n| n[1] - n[0]);
        let longest = lengths.fold(0.0, f64::max);
        assert!(BLOCK - last > 0.1 * longest, "{last}");
    }
}

#[test]
fn one_state_keeps_all_nodes_on_the_locus() {
    let case = ast_5(ZDirection);
    let law = smooth_law(&case);
    let blocks = nodes(&case, &law, &minimax(1.0, 45.0));
    assert!(!blocks.iter().any(NodeList::has_offsets));
}

#[test]
fn another_number_of_states_is_an_error_on_states() {
    let error = MinimaxSampler::new(&params(5.0, 45.0, true)).unwrap_err();
    assert!(matches!(&error, StrategyError::Parameter { name, .. } if name == "states"));
    assert!(error.to_string().contains("1, 3, 7 and 25"), "{error}");
    assert!(minimax(7.0, 45.0).needs_exact_rates());
}
