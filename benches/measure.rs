//! How every bench measures: one pass over a fixed set of inputs, reported per input.
//!
//! A pass is long enough (thousands of inputs) that the clock does not show in it, and varied enough that the branch
//! predictor can't learn it by heart. Times are short by default, so that everything together takes about two minutes;
//! criterion's own options (`--measurement-time` and the like) go over them.

use criterion::{Criterion, Throughput};
use std::time::Duration;

/// The times that a bench takes unless the command line says otherwise.
pub(crate) fn short() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(2))
        .sample_size(40)
        .nresamples(10_000)
}

/// Times `pass`, which works through so many `elements`, under the name `GROUP/NAME`.
pub(crate) fn measure(criterion: &mut Criterion, name: &str, elements: usize, mut pass: impl FnMut()) {
    let (group, name) = name.split_once('/').expect("a bench is named GROUP/NAME");
    let mut group = criterion.benchmark_group(group);
    group.throughput(Throughput::Elements(elements as u64));
    group.bench_function(name, |bencher| bencher.iter(&mut pass));
    group.finish();
}
