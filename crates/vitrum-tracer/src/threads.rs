//! Work on threads.

use crate::render::RenderError;
use crate::settings::Settings;
use rayon::prelude::*;

/// Does some work on so many threads, where it can use more than one: as many as there are processors for 0, the calling
/// one alone for 1.
///
/// # Errors
/// [`RenderError::Threads`] where the system gives none.
pub fn on_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R, RenderError> {
    if threads == 1 {
        return Ok(work());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|e| RenderError::Threads(e.to_string()))?.install(work))
}

/// What work makes of each item, one by one on the threads at hand: parts of the picture that see glass take many times as long as
/// others, and would be left for one thread at the end.
pub(crate) fn on_each<T: Sync, R: Send>(
    settings: &Settings,
    items: &[T],
    work: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    if settings.threads == 1 {
        items.iter().map(work).collect()
    } else {
        items.par_iter().with_max_len(1).map(&work).collect()
    }
}
