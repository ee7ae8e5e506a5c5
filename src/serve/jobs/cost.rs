//! What the map of a sweep would cost.

use std::sync::Arc;

use super::Jobs;
use super::described::{SweepCost, TimedCost};
use super::now::blocking;
use super::posted::Posted;
use crate::maps::cost::MapCost;
use crate::model::stop::Stop;
use crate::queue::room::{free_bytes, most_bytes};
use crate::serve::problem::Problem;
use crate::serve::served::Served;
use crate::serve::work::Pace;
use crate::sweep::{Memory, Plan};

impl Jobs {
    /// What the map of a sweep would cost; with seconds if it is to be `timed`.
    pub(super) async fn cost(
        &self,
        served: &Served,
        posted: Posted,
        timed: bool,
    ) -> Result<SweepCost, Problem> {
        let Posted { plan, remarks } = posted;
        let (plan, folder) = (Arc::new(plan), self.folder.path().to_owned());
        let free = blocking(move || Ok(free_bytes(&folder))).await?;
        let kept = self.submission.keep_free.unwrap_or(0);
        let pieces = plan.pieces().total();
        let threads = self.submission.threads.min(pieces as usize).max(1);
        let timed = match timed {
            true => Some(time(served, &plan, threads).await?),
            false => None,
        };
        Ok(SweepCost {
            cells: plan.cells(),
            pieces,
            bytes: plan.cells().saturating_mul(plan.bytes_per_cell()),
            bytes_needed: most_bytes(&plan),
            bytes_free: free.map(|free| free.saturating_sub(kept)),
            memory: Memory::of(&plan).on(threads),
            threads,
            remarks,
            timed,
        })
    }
}

/// Times a sample of a plan, as long as its client waits.
async fn time(served: &Served, plan: &Arc<Plan>, threads: usize) -> Result<TimedCost, Problem> {
    let turn = served.work.turn(Pace::Slow).await?;
    let room = served.slow_room.take(Memory::of(plan).per_thread).await?;
    let plan = Arc::clone(plan);
    let cost = turn.run(move |stop| {
        let stop = Stop::when(stop);
        let cost = MapCost::of(&plan, &stop);
        match stop.is_set() {
            true => Err(Problem::stopped()),
            false => Ok(cost),
        }
    });
    let cost = cost.await?;
    drop(room);
    Ok(TimedCost {
        seconds: cost.seconds_on(threads),
        bytes_on_disk: cost.bytes_on_disk,
        tiles_timed: cost.tiles_timed,
    })
}
