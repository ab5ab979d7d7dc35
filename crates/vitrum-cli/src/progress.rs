//! One line that says how far the render is: on stderr, and only on a terminal.

use crate::interrupt::Interrupt;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use vitrum_tracer::Progress;

/// Watches a render.
pub(crate) struct Watcher {
    bar: ProgressBar,
    rays: AtomicU64,
    start: Instant,
    interrupt: Interrupt,
}

impl Watcher {
    /// For a render of so many samples.
    pub(crate) fn new(samples: u64, quiet: bool, interrupt: Interrupt) -> Self {
        let visible = !quiet && std::io::stderr().is_terminal();
        let target =
            if visible { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
        let style =
            ProgressStyle::with_template("rendering {percent:>3} %  {elapsed} elapsed, {eta} left  {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::with_draw_target(Some(samples), target).with_style(style);
        Self { bar, rays: AtomicU64::new(0), start: crate::render::now(), interrupt }
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

impl Progress for Watcher {
    fn advance(&self, samples: u64, rays: u64) {
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        self.bar.inc(samples);
        if !self.bar.is_hidden() {
            let rate = rays as f64 / self.elapsed().as_secs_f64().max(1e-3);
            self.bar.set_message(format!("{:.1} million rays/s", rate / 1e6));
        }
    }

    fn is_stopped(&self) -> bool {
        self.interrupt.is_asked()
    }
}
