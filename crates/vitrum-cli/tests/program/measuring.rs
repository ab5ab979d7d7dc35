//! What the program says of pictures and of itself: `compare`, `bench`, `page`, `render --report`.

use crate::workplace::{Outcome, Workplace};
use std::fs;

/// A folder with the scene, and two pictures of it: a rough one and a better one.
fn with_pictures() -> Workplace {
    let place = Workplace::with_scene();
    for (name, spp) in [("rough.exr", "1"), ("better.exr", "256")] {
        place.succeed(&["render", "scene.toml", "--spp", spp, "-o", name, "-q"]);
    }
    place
}

/// The number of a key in a line of JSON.
fn number(json: &str, key: &str) -> f64 {
    let (_, rest) = json.split_once(&format!("\"{key}\":")).unwrap_or_else(|| panic!("{key} in {json}"));
    let end = rest.find([',', '}']).expect("an object ends");
    rest[..end].parse().unwrap_or_else(|_| panic!("{key} in {json}"))
}

#[test]
fn compare_says_how_far_pictures_are_apart() {
    let place = with_pictures();
    let same = place.succeed(&["compare", "better.exr", "better.exr", "--json"]).stdout;
    for key in ["rmse", "rel_mse", "rel_mse_trimmed", "mape", "flip", "bias", "bias_error", "max_abs"] {
        assert_eq!(number(&same, key), 0.0, "{key}");
    }
    let apart = place.succeed(&["compare", "rough.exr", "better.exr", "--json"]).stdout;
    assert!(number(&apart, "rel_mse") > 1e-5 && number(&apart, "flip") > 1e-4, "{apart}");
    let report = place.succeed(&["compare", "rough.exr", "better.exr"]).stdout;
    let names: Vec<&str> = report.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(names, ["RMSE", "relMSE", "MAPE", "FLIP", "bias", "largest"]);
}

#[test]
fn compare_writes_pictures_of_the_difference() {
    let place = with_pictures();
    place.succeed(&["compare", "rough.exr", "better.exr", "-o", "seen.png"]);
    assert_eq!(place.png_size("seen.png"), [16, 12]);
    // Image minus reference: added to nothing, its root mean square is that of the comparison.
    place.succeed(&["compare", "rough.exr", "better.exr", "-o", "difference.exr"]);
    let apart = place.succeed(&["compare", "rough.exr", "better.exr", "--json"]).stdout;
    place.succeed(&["compare", "better.exr", "better.exr", "-o", "nothing.exr"]);
    let of_difference = place.succeed(&["compare", "difference.exr", "nothing.exr", "--json"]).stdout;
    assert!((number(&apart, "rmse") / number(&of_difference, "rmse") - 1.0).abs() < 1e-6);
}

#[test]
fn compare_refuses_what_cannot_be_compared() {
    let place = with_pictures();
    place.succeed(&["render", "scene.toml", "--size", "8x8", "-o", "small.exr", "-q"]);
    place.refuse(&["compare", "small.exr", "better.exr"], 2, &["8 x 8", "16 x 12", "of one size"]);
    place.refuse(&["compare", "none.exr", "better.exr"], 2, &["none.exr"]);
    place.refuse(&["compare", "scene.toml", "better.exr"], 2, &["scene.toml", ".exr"]);
    place.refuse(&["compare", "rough.exr", "better.exr", "-o", "picture.jpg"], 2, &["picture.jpg"]);
}

#[test]
fn a_report_is_what_the_summary_says() {
    let place = Workplace::with_scene();
    let outcome = place.succeed(&["render", "scene.toml", "--report", "report.json"]);
    let report = String::from_utf8(place.read("report.json")).expect("it is text");
    assert_eq!(number(&report, "samples"), 16.0 * 12.0 * 2.0);
    let camera = format!(" {} camera,", number(&report, "camera_rays"));
    let background =
        format!(", less {} that only the background can meet", number(&report, "unsearched_rays"));
    assert!(outcome.stderr.contains(&camera) && outcome.stderr.contains(&background), "{}", outcome.stderr);
    if cfg!(target_os = "linux") {
        assert!(number(&report, "memory") > 1e6, "a program has at least its code in memory");
    }
    assert!(number(&report, "rendering") > 0.0 && number(&report, "loading") > 0.0);
}

/// Doing what a scene does not need changes no byte.
#[test]
fn skipping_shows_in_nothing_but_time() {
    let place = Workplace::with_scene();
    place.succeed(&["render", "scene.toml", "-o", "skipping.exr", "-q"]);
    for (number, option) in ["--no-skip", "--no-skip=lights,absorption,solids"].into_iter().enumerate() {
        let name = format!("doing{number}.exr");
        place.succeed(&["render", option, "scene.toml", "-o", &name, "-q"]);
        assert!(place.read(&name) == place.read("skipping.exr"), "{option}");
    }
    let Outcome { code, stderr, .. } = place.run(&["render", "--no-skip=glass", "scene.toml"]);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("possible values: lights, ambient"), "{stderr}");
}

/// References, results and page of a scene.
#[test]
fn a_bench_measures_scenes_with_references() {
    let place = Workplace::with_scene();
    place.refuse(
        &["bench", "scene.toml", "-o", "results"],
        2,
        &["found no reference", "--make-references --spp 4096 scene.toml"],
    );
    place.succeed(&["bench", "--make-references", "--spp", "512", "--seeds", "4", "scene.toml"]);
    let arguments = ["bench", "scene.toml", "-o", "results", "--spp", "1,4,16", "--seeds", "3", "-t", "1"];
    let table = place.succeed(&arguments).stdout;
    let row = table.lines().nth(1).expect("a row for the scene");
    assert!(row.starts_with("scene  vitrum"), "{table}");
    let lines = String::from_utf8(place.read("results/results.jsonl")).expect("it is text");
    assert_eq!(lines.lines().count(), 9);
    let error = |spp: f64| {
        let of = lines.lines().filter(|line| number(line, "spp") == spp);
        of.map(|line| number(line, "rel_mse")).sum::<f64>() / 3.0
    };
    assert!(error(1.0) > 4.0 * error(4.0) && error(4.0) > 4.0 * error(16.0), "{lines}");
    let mut csv = csv::Reader::from_path(place.path("results/results.csv")).expect("it is there");
    let column = csv.headers().expect("a row of names").iter().position(|name| name == "rel_mse");
    let column = column.expect("a column for it");
    let values: Vec<f64> =
        csv.records().map(|row| row.expect("a row")[column].parse().expect("a number")).collect();
    let expected: Vec<f64> = lines.lines().map(|line| number(line, "rel_mse")).collect();
    assert_eq!(values, expected);
    let names: Vec<_> = fs::read_dir(place.path("results/pictures")).expect("there are some").collect();
    assert_eq!(names.len(), 3, "the pictures of the first seed");
    let page = String::from_utf8(place.read("results/index.html")).expect("it is text");
    // The reference, one picture, and their difference; nothing from elsewhere.
    assert_eq!(page.matches("data:image/png;base64,").count(), 3);
    assert!(page.contains("<svg") && !page.contains("src=\"http") && !page.contains("<script"));
    // Measured results are not written over.
    place.refuse(&arguments, 2, &["choose a new folder"]);
    // The same program from another file is another curve.
    let more = [
        "bench",
        "scene.toml",
        "-o",
        "more",
        "--spp",
        "1",
        "--seeds",
        "1",
        "--include",
        "results/results.jsonl",
    ];
    place.succeed(&more);
    let both = String::from_utf8(place.read("more/index.html")).expect("it is text");
    assert!(both.contains("<td>vitrum<td>") && both.contains("<td>vitrum (results/results.jsonl)<td>"));
    // The page can be made again elsewhere, of several results.
    place.succeed(&["page", "results/results.jsonl", "-o", "again.html"]);
    assert_eq!(String::from_utf8(place.read("again.html")).expect("it is text"), page);
    // A folder of results needs nothing else; without pictures there is a page still.
    fs::rename(place.path("results"), place.path("moved")).expect("the folder is writable");
    fs::remove_file(place.path("references/scene.exr")).expect("it is there");
    place.succeed(&["page", "moved/results.jsonl", "-o", "moved.html"]);
    assert_eq!(String::from_utf8(place.read("moved.html")).expect("it is text"), page);
    fs::remove_dir_all(place.path("moved/pictures")).expect("it is there");
    place.succeed(&["page", "moved/results.jsonl", "-o", "bare.html"]);
    let bare = String::from_utf8(place.read("bare.html")).expect("it is text");
    assert!(bare.contains("<svg") && !bare.contains("<img"));
    let markdown = place.succeed(&["page", "moved/results.jsonl", "--markdown"]).stdout;
    assert!(markdown.lines().nth(2).expect("a row").starts_with("| scene | vitrum | "), "{markdown}");
    place.write("wrong.jsonl", "{\"scene\": 1}\n");
    place.refuse(&["page", "wrong.jsonl"], 2, &["wrong.jsonl:1:", "vitrum bench"]);
}

/// Costs that follow a law are told by its exponent: seconds 2e-6 n^1.5, 3 rays each, 40 bytes each, half of two threads idle.
#[test]
fn growth_is_told_by_its_exponent() {
    let place = Workplace::with_scene();
    let line = |n: u32, threads: u32| {
        let seconds = 2e-6 * f64::from(n).powf(1.5);
        let memory = 1_000_000 + 40 * n;
        format!(
            "{{\"growing\": \"things & <more>\", \"tell\": [\"rendering\", \"ray\", \"memory\"], \"number\": {n}, \"threads\": {threads}, \"loading\": 0.5, \"rendering\": {seconds}, \
             \"processors\": {seconds}, \"memory\": {memory}, \"camera_rays\": {}}}\n",
            3 * n
        )
    };
    // Turn after turn.
    let turn: String = [100, 10_000, 1_000_000].map(|n| line(n, 2)).concat();
    // In one of them the machine was busy: medians don't mind.
    let busy = turn.replace("\"rendering\": ", "\"rendering\": 9");
    place.write("cost.jsonl", format!("{turn}{busy}{turn}"));
    let markdown = place.succeed(&["page", "--costs", "cost.jsonl", "--markdown"]).stdout;
    for said in [
        "rendering: exponent 1.50",
        "a ray: exponent 0.50",
        "40 bytes each",
        "| 1000000 | 0.500 | 2000 | 2000 | 50.0 |",
    ] {
        assert!(markdown.contains(said), "{said} in\n{markdown}");
    }
    place.succeed(&["page", "--costs", "cost.jsonl", "-o", "page.html"]);
    let page = String::from_utf8(place.read("page.html")).expect("it is text");
    assert!(
        page.contains("<svg") && page.contains("things &amp; &lt;more&gt;") && !page.contains("<more>"),
        "{page}"
    );
    assert!(!page.contains("Run time against error</h1>"));
    place.write("wrong.jsonl", "{}\n");
    place.refuse(&["page", "--costs", "wrong.jsonl"], 2, &["wrong.jsonl:1:", "benches/cost.py"]);
    place.refuse(&["page"], 2, &["<RESULTS>"]);
}

/// What was measured before a program fails is kept; and names may hold anything.
#[test]
fn a_failure_loses_nothing() {
    let place = Workplace::with_scene();
    place.write("odd & <named> v1.2.toml", crate::workplace::SCENE);
    let make = [
        "bench",
        "--make-references",
        "--spp",
        "256",
        "--seeds",
        "2",
        "scene.toml",
        "odd & <named> v1.2.toml",
    ];
    place.succeed(&make);
    place.refuse(&make, 2, &["this reference is there already"]);
    let bad = place.path("scene.toml");
    place.write("broken.toml", "[camera]\n");
    fs::copy(place.path("references/scene.exr"), place.path("references/broken.exr")).expect("it is there");
    let outcome = place.run(&[
        "bench",
        "odd & <named> v1.2.toml",
        "broken.toml",
        "-o",
        "results",
        "--spp",
        "1",
        "--seeds",
        "2",
    ]);
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("broken.toml") && outcome.stderr.contains("missing"),
        "{}",
        outcome.stderr
    );
    place.succeed(&["page", "results/results.jsonl", "-o", "page.html"]);
    let page = String::from_utf8(place.read("page.html")).expect("it is text");
    assert!(page.contains("odd &amp; &lt;named&gt;") && !page.contains("<named>"), "{page}");
    let twice = bad.to_str().expect("the path is text");
    place.refuse(&["bench", "scene.toml", twice, "-o", "other"], 2, &["two scenes of one name"]);
}

/// Radiance that is not finite is named, and not measured.
#[test]
fn what_is_infinite_is_refused() {
    let place = with_pictures();
    let pixel =
        |x: usize, y: usize| if (x, y) == (3, 2) { (f32::INFINITY, 1.0, 1.0) } else { (1.0, 1.0, 1.0) };
    exr::prelude::write_rgb_file(place.path("bright.exr"), 16, 12, pixel).expect("the folder is writable");
    place.refuse(
        &["compare", "bright.exr", "better.exr"],
        2,
        &["bright.exr: found [inf, 1.0, 1.0] in pixel (3, 2)"],
    );
}

/// One program against itself: the same errors, and a ratio of times around one.
#[test]
fn two_programs_are_measured_in_turn() {
    let place = Workplace::with_scene();
    place.succeed(&["bench", "--make-references", "--spp", "512", "--seeds", "2", "scene.toml"]);
    let program = env!("CARGO_BIN_EXE_vitrum");
    let table = place.succeed(&[
        "bench",
        "scene.toml",
        "-o",
        "results",
        "--spp",
        "4",
        "--seeds",
        "3",
        "--against",
        program,
        program,
    ]);
    let row = table.stdout.lines().last().expect("a table of ratios");
    assert!(row.starts_with("scene ") && row.contains("1.000 (1.000-1.000)"), "{}", table.stdout);
    let lines = String::from_utf8(place.read("results/results.jsonl")).expect("it is text");
    let second: Vec<bool> = lines.lines().map(|line| line.contains("(second)")).collect();
    assert_eq!(second, [false, true].repeat(3));
    place.refuse(&["bench", "scene.toml", "-o", "other", "--against", "none", program], 2, &["none"]);
}

/// Every scene of the repository's bench has a reference of its size that is good enough for an error of 1e-3.
#[test]
fn the_scenes_of_the_bench_have_references() {
    let place = Workplace::new();
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/bench");
    let scenes = vitrum_testkit::files_with_extension(&folder, "toml");
    assert!(scenes.len() >= 12);
    let mut arguments = vec!["bench", "--spp", "1", "--seeds", "1", "-o", "results"];
    arguments.extend(scenes.iter().map(|path| path.to_str().expect("the path is text")));
    place.succeed(&arguments);
    let lines = String::from_utf8(place.read("results/results.jsonl")).expect("it is text");
    for line in lines.lines() {
        let error = number(line, "reference_error");
        assert!(error > 0.0 && 20.0 * error < 1e-3, "{line}");
    }
    // The scene of a thousandth of the size is to be the picture of the other.
    let reference = |name: &str| fs::read(folder.join("references").join(name)).expect("it is there");
    assert!(reference("01_ball.exr") == reference("10_ball_far_and_small.exr"));
}
