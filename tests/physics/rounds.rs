//! Rounds: with an error to reach, the picture is right, the error is what is said, and going on after a stop changes nothing.

use crate::estimate::means;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use vitrum::io::checkpoint;
use vitrum::io::load::{Loaded, scene_text};
use vitrum::tracer::{Branching, Ended, Film, Progress, Settings, Target, render, resume};
use vitrum_testkit::Moments;

fn glass() -> Loaded {
    load("glass on a floor", include_str!("../scenes/glass_on_a_floor.toml"))
}

fn load(name: &str, text: &str) -> Loaded {
    scene_text(name, text, Path::new("")).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn until(loaded: &Loaded, target: Target, most: u32) -> Settings {
    Settings { size: [48, 32], spp: most, until: Some(target), ..loaded.settings }
}

/// Mean squared error as relMSE has it.
fn rel_mse(image: &[[f32; 3]], reference: &[[f32; 3]]) -> f64 {
    let pairs = image.iter().flatten().zip(reference.iter().flatten());
    let sum: f64 = pairs
        .map(|(x, r)| {
            let (x, r) = (f64::from(*x), f64::from(*r));
            (x - r) * (x - r) / (r * r + 0.01)
        })
        .sum();
    sum / (3 * image.len()) as f64
}

/// Where the samples go depends on the picture, and the picture does not on where they go.
#[test]
fn an_error_to_reach_changes_no_mean() {
    let many = load("many lights", include_str!("../scenes/many_lights.toml"));
    for (loaded, limit) in [(glass(), 4e-3), (many, 4e-3)] {
        let size = [48, 32];
        let fixed = Settings { size, spp: 256, ..loaded.settings };
        let reference = means(&loaded.scene, &fixed, 12);
        for target in [Target::RelMse(limit), Target::Noise(0.2)] {
            let found = means(&loaded.scene, &until(&loaded, target, 1 << 12), 24);
            let error = reference.standard_error().hypot(found.standard_error());
            let z = (found.mean() - reference.mean()) / error;
            assert!(z.abs() < 4.0, "{target:?}: {found:?} instead of {reference:?}");
            assert!(error < 0.01 * reference.mean(), "{target:?}: {error} says nothing");
        }
    }
}

/// The error that is said is the one that there is: of two buffers on average, within its interval about as often as it should;
/// of one buffer rather too large.
#[test]
fn the_error_is_what_is_said() {
    let loaded = glass();
    let size = [48, 32];
    let reference = Settings { size, spp: 1 << 13, seed: 1000, ..loaded.settings };
    let reference = render(&loaded.scene, &reference, &()).expect("valid settings").film.image();
    let seeds = 12;
    let (mut ratios, mut within) = (Moments::default(), 0);
    for seed in 0..seeds {
        let settings = Settings { seed, ..until(&loaded, Target::RelMse(2e-3), 1 << 12) };
        let rendering = render(&loaded.scene, &settings, &()).expect("valid settings");
        assert_eq!(rendering.ended, Ended::Error);
        let said = rendering.film.error().expect("two buffers tell");
        assert!(said.rel_mse <= 2e-3, "{said:?}");
        let found = rel_mse(&rendering.film.image(), &reference);
        ratios.push(found / said.rel_mse);
        within += u32::from((said.interval[0]..=said.interval[1]).contains(&found));
        let [least, most] = rendering.film.samples();
        assert!(least < most, "some pixels need more than others");
    }
    let ratio = ratios.mean();
    assert!((ratio - 1.0).abs() < 0.15 + 3.0 * ratios.standard_error(), "{ratios:?}");
    assert!(within >= 6, "the interval of 90 % held {within} of {seeds}");

    let mut ratios = Moments::default();
    for seed in 0..seeds {
        let settings = Settings { size, seed, spp: 64, ..loaded.settings };
        let rendering = render(&loaded.scene, &settings, &()).expect("valid settings");
        assert_eq!((rendering.ended, rendering.film.samples()), (Ended::Samples, [64, 64]));
        let said = rendering.film.error().expect("four rounds tell");
        ratios.push(rel_mse(&rendering.film.image(), &reference) / said.rel_mse);
    }
    assert!(ratios.mean() < 1.05 && ratios.mean() > 0.3, "{ratios:?}");
}

/// Samples go where the noise is, and make the error smaller than as many everywhere: the more, the more of the picture is calm.
#[test]
fn samples_go_where_they_are_needed() {
    let hollow = load("hollow ball", include_str!("../scenes/hollow_ball.toml"));
    for (loaded, target, most_left) in [(hollow, 5e-4, 0.85), (glass(), 2e-4, 1.0)] {
        let settings = until(&loaded, Target::RelMse(target), 1 << 14);
        let reference = Settings { spp: 1 << 13, seed: 1000, until: None, ..settings };
        let reference = render(&loaded.scene, &reference, &()).expect("valid settings").film.image();
        let (mut of_adaptive, mut of_even) = (0.0, 0.0);
        for seed in 0..5 {
            let settings = Settings { seed, ..settings };
            let adaptive = render(&loaded.scene, &settings, &()).expect("valid settings");
            let [least, most] = adaptive.film.samples();
            assert!(most >= 2 * least, "{least} to {most} samples");
            of_adaptive += rel_mse(&adaptive.film.image(), &reference);
            // As many on average, everywhere alike.
            let counts = adaptive.film.sample_counts();
            let mean = counts.iter().sum::<u32>().div_ceil(counts.len() as u32);
            let even = Settings { spp: mean, until: None, ..settings };
            let even = render(&loaded.scene, &even, &()).expect("valid settings").film.image();
            of_even += rel_mse(&even, &reference);
        }
        let left = of_adaptive / of_even;
        assert!(left < most_left, "{left} of the error of as many samples everywhere, target {target}");
    }
}

/// Stops after so many samples.
struct StopAfter(AtomicU64);

impl Progress for StopAfter {
    fn advance(&self, _samples: u64, _rays: u64) {}
    fn is_stopped(&self) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1)).is_err()
    }
}

/// Stopped anywhere, written down, read again and gone on with, by other threads and tiles: the same picture to the last bit.
#[test]
fn going_on_gives_the_picture_that_it_would_have_been() {
    let loaded = glass();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.checkpoint");
    let about = [("seed".to_owned(), "0".to_owned())];
    let cases = [
        Settings { size: [33, 21], spp: 100, ..loaded.settings },
        Settings { size: [33, 21], ..until(&loaded, Target::RelMse(4e-3), 4096) },
    ];
    for settings in cases {
        let whole = render(&loaded.scene, &settings, &()).expect("valid settings");
        for after in [0, 1, 700, 6_000, 20_000] {
            let stopped = StopAfter(AtomicU64::new(after));
            let mut rendering = render(&loaded.scene, &settings, &stopped).expect("valid settings");
            assert_eq!(rendering.ended, Ended::Stopped, "after {after}");
            for (threads, tile, more) in [(1, 5, 9_000), (2, 16, u64::MAX)] {
                checkpoint::write(&path, &about, &rendering.film).expect("writable");
                let read = checkpoint::read(&path).expect("readable");
                assert_eq!((&read.about[..], &read.film), (&about[..], &rendering.film));
                let settings = Settings { threads, tile, ..settings };
                let progress = StopAfter(AtomicU64::new(more));
                rendering = resume(&loaded.scene, &settings, read.film, &progress).expect("its settings");
            }
            assert_eq!(rendering.ended, whole.ended);
            assert_eq!(rendering.film, whole.film, "after {after}");
        }
    }
}

/// Asked for fewer samples than it has, a film stays as it is; with a limit of time it takes a few before it knows what time is good
/// for.
#[test]
fn what_was_taken_stays() {
    let loaded = glass();
    for until in [None, Some(Target::RelMse(1e-9))] {
        let settings = Settings { size: [9, 5], spp: 128, until, ..loaded.settings };
        let film = render(&loaded.scene, &settings, &()).expect("valid settings").film;
        let fewer = Settings { spp: 32, ..settings };
        let rendering = resume(&loaded.scene, &fewer, film.clone(), &()).expect("its settings");
        assert_eq!((rendering.ended, &rendering.film), (Ended::Samples, &film));
    }
    let settings = Settings { size: [9, 5], spp: 1024, ..loaded.settings };
    let film = render(&loaded.scene, &settings, &()).expect("valid settings").film;
    let clock = Clock { limit: 0.2, taken: AtomicU64::new(0) };
    let more = Settings { spp: 1_000_000, ..settings };
    let rendering = resume(&loaded.scene, &more, film, &clock).expect("its settings");
    assert_eq!((rendering.ended, rendering.film.samples()), (Ended::Time, [1032, 1032]));
}

/// A film of another size, or of another kind, is refused; so is a file that is damaged anywhere.
#[test]
fn what_does_not_fit_is_refused() {
    let loaded = glass();
    let settings = Settings { size: [9, 5], spp: 8, ..loaded.settings };
    let film = render(&loaded.scene, &settings, &()).expect("valid settings").film;
    let go_on = |settings: &Settings, film: Film| resume(&loaded.scene, settings, film, &()).map(|r| r.ended);
    assert!(go_on(&Settings { size: [9, 6], ..settings }, film.clone()).is_err());
    assert!(go_on(&Settings { until: Some(Target::Noise(0.1)), ..settings }, film.clone()).is_err());
    assert_eq!(go_on(&settings, film.clone()), Ok(Ended::Samples));

    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.checkpoint");
    checkpoint::write(&path, &[], &film).expect("writable");
    let bytes = std::fs::read(&path).expect("readable");
    for at in (0..bytes.len()).step_by(97).chain(0..64) {
        let mut damaged = bytes.clone();
        damaged[at] ^= 0x10;
        std::fs::write(&path, &damaged).expect("writable");
        checkpoint::read(&path).expect_err("damaged");
        std::fs::write(&path, &bytes[..at]).expect("writable");
        checkpoint::read(&path).expect_err("cut off");
    }
}

/// A clock on which a sample takes a thousandth of a second.
struct Clock {
    limit: f64,
    taken: AtomicU64,
}

impl Progress for Clock {
    fn advance(&self, samples: u64, _rays: u64) {
        self.taken.fetch_add(samples, Ordering::Relaxed);
    }
    fn seconds_left(&self) -> Option<f64> {
        Some(self.limit - self.taken.load(Ordering::Relaxed) as f64 * 1e-3)
    }
}

/// A limit of time is used and kept, on whole rounds; the picture is the one of its number of samples.
#[test]
fn time_ends_on_a_whole_round() {
    let loaded = glass();
    let (size, branching) = ([16, 8], Branching::Tree);
    let base = Settings { size, branching, spp: 1_000_000, ..loaded.settings };
    // 128 pixels: a sample of each takes 0.128 s.
    for (limit, least, most) in [(0.01, 8, 8), (2.0, 8, 8), (3.0, 16, 16), (10.0, 64, 78), (100.0, 640, 781)]
    {
        let clock = Clock { limit, taken: AtomicU64::new(0) };
        let rendering = render(&loaded.scene, &base, &clock).expect("valid settings");
        let [fewest, mosts] = rendering.film.samples();
        assert_eq!((rendering.ended, fewest), (Ended::Time, mosts), "{limit}");
        assert!((least..=most).contains(&fewest), "{fewest} samples in {limit} s");
        let same = Settings { spp: fewest, ..base };
        let same = render(&loaded.scene, &same, &()).expect("valid settings");
        let differ = same.film.image().iter().zip(rendering.film.image()).filter(|(a, b)| *a != b).count();
        // Rounds of other sizes sum in another order: the last bit may differ where they are not the same.
        assert!(differ == 0 || !fewest.is_power_of_two(), "{differ} pixels differ");
    }
    let clock = Clock { limit: 1e9, taken: AtomicU64::new(0) };
    let rendering = render(&loaded.scene, &Settings { spp: 32, ..base }, &clock).expect("valid settings");
    assert_eq!((rendering.ended, rendering.film.samples()), (Ended::Samples, [32, 32]));
    // With an error that can't be reached in that time.
    let clock = Clock { limit: 20.0, taken: AtomicU64::new(0) };
    let settings = Settings { until: Some(Target::RelMse(1e-12)), ..base };
    let rendering = render(&loaded.scene, &settings, &clock).expect("valid settings");
    assert_eq!(rendering.ended, Ended::Time);
    assert!(clock.seconds_left() > Some(-1.0), "{:?} s left of 20", clock.seconds_left());
}
