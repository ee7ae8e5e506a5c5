//! What writes into the queue: one request at a time.

use std::sync::Arc;
use std::time::Duration;

use axum::http::StatusCode;
use tokio::runtime::Handle;

use super::Jobs;
use super::described::{JobChange, JobEntry, Wanted};
use super::now::blocking;
use super::posted::Posted;
use crate::model::stop::Stop;
use crate::queue::QueueError;
use crate::queue::change::{Change, change};
use crate::queue::folder::{Folder, Place};
use crate::queue::name::Name;
use crate::queue::room::Needs;
use crate::queue::states::Job;
use crate::queue::submit::{Intake, Options};
use crate::report::numbers::bytes;
use crate::serve::problem::Problem;
use crate::sweep::Plan;

/// The most sweeps that wait or are held.
const MOST_WAITING: usize = 1000;
/// How long another process may put sweeps in.
const PATIENCE: Duration = Duration::from_secs(5);

impl Jobs {
    /// Puts a sweep in, under a name made of `title`, unless it is there. Returns what is told of
    /// it, and whether it is new.
    pub(super) async fn put(
        &self,
        posted: Posted,
        title: Option<String>,
        options: Options,
        keep_free: u64,
    ) -> Result<(JobEntry, bool), Problem> {
        let plan = posted.plan;
        let title = title.unwrap_or_else(|| plan.spec.title.clone());
        let one = self.changing.lock().await;
        let (folder, maps, runtime) = (
            self.folder.clone(),
            Arc::clone(&self.maps),
            Handle::current(),
        );
        let submitted = blocking(move || {
            let intake = Intake::open_within(&folder, PATIENCE)?;
            intake.put(&plan, &title, options, |hash| {
                let made = runtime.block_on(maps.of_plan(hash))?;
                if made.is_none() {
                    check_room(&folder, &plan, keep_free)?;
                }
                Ok::<_, Problem>(
                    made.map(|map| Name::of_stem(map.strip_suffix(".h5").unwrap_or(&map))),
                )
            })
        });
        let submitted = submitted.await?;
        drop(one);
        self.events.look_soon();
        let now = self.looking.now().await?;
        let entry = match now.job(&submitted.name.to_string()) {
            Ok(job) => JobEntry::of(job),
            // A map that no job has made, or a job that was taken out at once.
            Err(_) => JobEntry::of(&Job::done(submitted.name)),
        };
        Ok((entry, submitted.is_new))
    }

    /// Changes a job.
    pub(super) async fn change(&self, name: &str, to: JobChange) -> Result<JobEntry, Problem> {
        let state = to.state.map(|state| match state {
            Wanted::Held => Change::Hold,
            Wanted::Waiting => Change::Release { fresh: false },
        });
        let first = to.first.then_some(Change::First);
        let changes: Vec<Change> = match (to.state, to.first) {
            (None, false) => return Err(unclear("expected a state, or \"first\": true")),
            (Some(Wanted::Held), true) => {
                return Err(unclear(
                    "what is held does not wait, so it cannot be the first",
                ));
            }
            _ => state.into_iter().chain(first).collect(),
        };
        let name = self.changed(name, changes).await?;
        Ok(JobEntry::of(
            self.looking.now().await?.job(&name.to_string())?,
        ))
    }

    /// Takes a job out, and with `tiles` what is computed of its map.
    pub(super) async fn take_out(&self, name: &str, tiles: bool) -> Result<(), Problem> {
        self.changed(name, vec![Change::Drop { tiles }])
            .await
            .map(drop)
    }

    /// Makes changes to the job of this name, which is one that is listed; returns its name then.
    async fn changed(&self, name: &str, changes: Vec<Change>) -> Result<Name, Problem> {
        let one = self.changing.lock().await;
        let name = self.looking.now().await?.job(name)?.name.clone();
        let folder = self.folder.clone();
        let changed = blocking(move || {
            let one_by_one = |name: Name, what: Change| change(&folder, &name, what);
            Ok(changes.into_iter().try_fold(name, one_by_one)?)
        });
        let changed = changed.await;
        drop(one);
        self.events.look_soon();
        changed
    }
}

fn unclear(detail: &str) -> Problem {
    Problem::of(StatusCode::UNPROCESSABLE_ENTITY, detail)
}

/// Refuses a sweep for which there is no place, or that the disk may not have room for.
fn check_room(folder: &Folder, plan: &Plan, keep_free: u64) -> Result<(), Problem> {
    let count = |place| Ok::<_, QueueError>(folder.names(place)?.len());
    if count(Place::Queue)? + count(Place::Held)? >= MOST_WAITING {
        let detail = format!("{MOST_WAITING} sweeps wait or are held already");
        return Err(Problem::of(StatusCode::TOO_MANY_REQUESTS, detail));
    }
    match Needs::default().lacking(plan, folder.path(), keep_free, &Stop::default()) {
        None => Ok(()),
        Some((needed, free)) => {
            let (needed, free) = (bytes(needed), bytes(free));
            let detail =
                format!("its map may take {needed} while it is made, and {free} are free for it");
            Err(Problem::of(StatusCode::INSUFFICIENT_STORAGE, detail)
                .help("slipmap serve --keep-free says what else stays free"))
        }
    }
}
