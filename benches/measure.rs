//! How every bench is measured: one pass over a fixed set of inputs, reported per input.
//!
//! A pass is long enough (thousands of inputs) that the clock does not show in it, and varied enough that the branch
//! predictor can't learn it by heart. Times are short by default, so that everything together takes a few minutes;
//! criterion's own options (`--measurement-time` and the like) go over them.
//!
//! With `--count` nothing is timed. Each pass runs twice, the second time as what `counted` calls, so that valgrind can count its
//! instructions: `benches/gate.py` does that. So times and counts are of the same code, and no bench is written twice.

use criterion::{Criterion, Throughput};
use std::time::Duration;

/// Times or counts, as the command line says.
pub(crate) struct Harness {
    /// Times by criterion; without it, counts for valgrind.
    times: Option<Criterion>,
}

impl Harness {
    /// What the command line asks for.
    pub(crate) fn of_the_command_line() -> Self {
        let short = || {
            Criterion::default()
                .warm_up_time(Duration::from_millis(300))
                .measurement_time(Duration::from_secs(2))
                .sample_size(40)
                .nresamples(10_000)
                .configure_from_args()
        };
        let is_count = std::env::args().any(|argument| argument == "--count");
        Self { times: (!is_count).then(short) }
    }

    /// Measures `pass`, which works through so many `elements`, under the name `GROUP/NAME`.
    #[expect(clippy::print_stdout, reason = "whoever counts wants to know what was counted")]
    pub(crate) fn measure(&mut self, name: &str, elements: usize, mut pass: impl FnMut()) {
        let Some(criterion) = &mut self.times else {
            // What is made at its first use is made now.
            pass();
            counted(&mut pass);
            println!("{elements}\t{name}");
            return;
        };
        let (group, name) = name.split_once('/').expect("a bench is named GROUP/NAME");
        let mut group = criterion.benchmark_group(group);
        group.throughput(Throughput::Elements(elements as u64));
        group.bench_function(name, |bencher| bencher.iter(&mut pass));
        group.finish();
    }

    /// Whether what takes long to prepare is left out: under valgrind it takes fifty times as long.
    pub(crate) fn is_count(&self) -> bool {
        self.times.is_none()
    }

    /// Says what criterion has to say at the end.
    pub(crate) fn finish(self) {
        if let Some(criterion) = self.times {
            criterion.final_summary();
        }
    }
}

/// Valgrind counts from here until it returns.
#[inline(never)]
fn counted(pass: &mut dyn FnMut()) {
    pass();
}
