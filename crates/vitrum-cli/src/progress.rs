//! One line that says how far the render is: on stderr, and only on a terminal.

use crate::interrupt::Interrupt;
use crate::store::Store;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use vitrum_tracer::{Film, Progress};

/// Watches a render.
pub(crate) struct Watcher<'s> {
    bar: ProgressBar,
    rays: AtomicU64,
    start: Instant,
    limit: Option<Duration>,
    /// Whether all samples are known beforehand; otherwise rounds tell.
    is_known: bool,
    interrupt: Interrupt,
    /// Where rounds are kept.
    store: Option<&'s Store>,
}

impl<'s> Watcher<'s> {
    /// For a render of so many samples, or of some number that rounds tell, within a time if there is a limit.
    pub(crate) fn new(
        samples: Option<u64>,
        limit: Option<Duration>,
        quiet: bool,
        interrupt: Interrupt,
        store: Option<&'s Store>,
    ) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target =
            if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let style =
            ProgressStyle::with_template("rendering {percent:>3} %  {elapsed} elapsed, {eta} left  {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(samples.unwrap_or(0)), target).with_style(style);
        let is_known = samples.is_some();
        Self { bar, rays: AtomicU64::new(0), start: crate::render::now(), limit, is_known, interrupt, store }
    }

    /// Takes the line off the terminal.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Time since the render began.
    pub(crate) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }
}

impl Progress for Watcher<'_> {
    fn advance(&self, samples: u64, rays: u64) {
        // Nobody looks, so nobody asks the clock: renders without a terminal take the same instructions every time.
        if self.bar.is_hidden() {
            return;
        }
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        self.bar.inc(samples);
        let rate = rays as f64 / self.elapsed().as_secs_f64().max(1e-3);
        self.bar.set_message(format!("{:.1} million rays/s", rate / 1e6));
    }

    fn is_stopped(&self) -> bool {
        self.interrupt.is_asked()
    }

    fn plan(&self, samples: u64) {
        if !self.is_known {
            self.bar.inc_length(samples);
        }
    }

    fn keep(&self, film: &Film) {
        if let Some(store) = self.store {
            store.keep(film);
        }
    }

    fn seconds_left(&self) -> Option<f64> {
        self.limit.map(|limit| limit.as_secs_f64() - self.elapsed().as_secs_f64())
    }
}
