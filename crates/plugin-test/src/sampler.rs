//! Samplers: the nodes of a block depend on the block alone, in whatever order and on whatever thread
//! the host asks.

use turnpath_core::{
    Dependence, NodeList, Path, Result as Answer, Revolutions, SamplerPlan, SpindleLaw,
};

use crate::chain::TrialChain;
use crate::fault::FaultKind;
use crate::laws::straight;

/// Turns of the law that is asked about, and of its blocks.
const TURNS: f64 = 48.0;
const BLOCK: f64 = 8.0;
/// Threads that ask at the same time.
const THREADS: usize = 4;

/// Checks the sampler of a chain.
pub fn check(chain: &TrialChain) -> Option<FaultKind> {
    repetition(chain).err()
}

fn blocks() -> Vec<Revolutions> {
    let block = |i: usize| Revolutions {
        start: BLOCK * i as f64,
        end: BLOCK * (i + 1) as f64,
    };
    (0..(TURNS / BLOCK) as usize).map(block).collect()
}

/// Asks for the blocks in order, and then backwards on several threads at once.
fn repetition(chain: &TrialChain) -> Result<(), FaultKind> {
    let task = chain.task();
    let (law, spindle) = (
        straight(task, TURNS),
        SpindleLaw::constant(task.spindle_speed),
    );
    let path = Path {
        task,
        locus: &chain.preparation.locus,
        law: &law,
        spindle: &spindle,
    };
    let failed = |call| move |error| FaultKind::Call { call, error };
    let sampler = &chain.chain.sampler.strategy;
    let plan = sampler.plan(&path).map_err(failed("plan"))?;
    if plan.dependence() == Dependence::Sequential {
        return Ok(());
    }
    let plan = plan.as_ref();
    let blocks = blocks();
    let in_order: Vec<NodeList> = blocks
        .iter()
        .map(|block| place(plan, &path, *block))
        .collect::<Answer<_>>()
        .map_err(failed("place"))?;
    let backwards = || -> Answer<Vec<NodeList>> {
        let blocks = blocks.iter().rev();
        blocks.map(|block| place(plan, &path, *block)).collect()
    };
    let answers: Vec<Option<Answer<Vec<NodeList>>>> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|_| scope.spawn(backwards)).collect();
        let joined = threads.into_iter().map(|thread| thread.join().ok());
        joined.collect()
    });
    for answer in answers.into_iter().flatten() {
        let mut again = answer.map_err(failed("place"))?;
        again.reverse();
        for (block, (first, second)) in blocks.iter().zip(in_order.iter().zip(&again)) {
            same(*block, first, second)?;
        }
    }
    Ok(())
}

fn place(plan: &dyn SamplerPlan, path: &Path<'_>, block: Revolutions) -> Answer<NodeList> {
    let mut nodes = NodeList::default();
    plan.place(path, block, &mut nodes)?;
    Ok(nodes)
}

fn same(block: Revolutions, first: &NodeList, second: &NodeList) -> Result<(), FaultKind> {
    let [first, second] = [first, second].map(|nodes| nodes.clone().into_columns());
    let context = format!("of revolutions {:.0} to {:.0}", block.start, block.end);
    let when = "when several threads ask in another order";
    for (name, (first, second)) in ["n", "dz", "dz_dc"].iter().zip(first.iter().zip(&second)) {
        if first.len() != second.len() {
            return Err(FaultKind::Repeat {
                what: format!("the number of nodes {context}"),
                when,
                first: first.len() as f64,
                second: second.len() as f64,
            });
        }
        let differs = |(one, other): (&f64, &f64)| one.to_bits() != other.to_bits();
        if let Some(i) = first.iter().zip(second).position(differs) {
            return Err(FaultKind::Repeat {
                what: format!("{name} of node {i} {context}"),
                when,
                first: first[i],
                second: second[i],
            });
        }
    }
    Ok(())
}
