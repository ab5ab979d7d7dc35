//! Every OBJ file of the assets does what `expectations/obj.toml` says, and no damaged copy of one makes the reader
//! panic or hang. Needs the folder of assets: `VITRUM_ASSETS`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;

use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use toml::de::{DeTable, DeValue};
use vitrum_io::obj::{self, ObjFile};
use vitrum_math::DVec3;
use vitrum_testkit::{assets, files_with_extension};

/// Folder of the assets for each section of the table.
const FOLDERS: [(&str, &str); 3] = [("obj", "obj"), ("bad-mesh", "bad-mesh"), ("malformed", "malformed/obj")];

/// A row of the table. Numbers are kept as text, as they stand there.
struct Row<'a>(&'a DeTable<'a>);

impl<'a> Row<'a> {
    fn value(&self, key: &str) -> Option<&'a DeValue<'a>> {
        Some(self.0.get(key)?.get_ref())
    }

    fn text(&self, key: &str) -> Option<&'a str> {
        match self.value(key)? {
            DeValue::String(text) => Some(text),
            DeValue::Integer(number) => Some(number.as_str()),
            _ => panic!("`{key}` is neither text nor a number"),
        }
    }

    fn list(&self, key: &str) -> Vec<&'a str> {
        let Some(DeValue::Array(list)) = self.value(key) else { return Vec::new() };
        list.iter().map(|value| value.get_ref().as_str().expect("a list of texts")).collect()
    }
}

/// What is wrong with a file that should load, if anything.
fn check_loaded(file: &ObjFile, expected: &Row<'_>) -> Result<(), String> {
    let triangles: usize = file.parts.iter().map(|part| part.mesh.triangles.len()).sum();
    for (key, found) in [("triangles", triangles), ("parts", file.parts.len())] {
        if Some(found.to_string().as_str()) != expected.text(key) {
            return Err(format!("has {found} {key}"));
        }
    }
    for part in &file.parts {
        let found = if part.mesh.normal_triangles.is_empty() { "none" } else { "file" };
        if Some(found) != expected.text("normals") {
            return Err(format!("normals of part `{}` are {found}", part.name));
        }
        check_indices(part)?;
    }
    let phrases = expected.list("warnings");
    let unexpected =
        file.warnings.iter().find(|warning| !phrases.iter().any(|phrase| warning.contains(phrase)));
    let missing =
        phrases.iter().find(|phrase| !file.warnings.iter().any(|warning| warning.contains(*phrase)));
    match (unexpected, missing) {
        (Some(warning), _) => Err(format!("warns: {warning}")),
        (None, Some(phrase)) => Err(format!("does not warn of `{phrase}`")),
        (None, None) => Ok(()),
    }
}

/// All lists of a part fit each other, and all that was read is finite.
fn check_indices(part: &obj::Part) -> Result<(), String> {
    let mesh = &part.mesh;
    let count = mesh.triangles.len();
    let in_range = |triangles: &[[u32; 3]], size: usize| {
        triangles.iter().flatten().all(|&index| (index as usize) < size)
    };
    let fits = |length: usize| length == 0 || length == count;
    let laws = [
        ("indices", in_range(&mesh.triangles, mesh.positions.len())),
        ("normal indices", in_range(&mesh.normal_triangles, mesh.normals.len())),
        ("uv indices", in_range(&mesh.uv_triangles, mesh.uvs.len())),
        ("lengths", fits(mesh.normal_triangles.len()) && fits(mesh.uv_triangles.len())),
        ("materials", fits(part.mesh.materials.len())),
        ("groups", part.groups.iter().all(|group| group.triangles.end <= count)),
        ("positions", mesh.positions.iter().all(|position| position.is_finite())),
        ("normals", mesh.normals.iter().all(|normal| normal.is_finite() && normal.length() > 0.0)),
        ("uvs", mesh.uvs.iter().all(|uv| uv.is_finite())),
    ];
    match laws.iter().find(|(_, holds)| !holds) {
        Some((law, _)) => Err(format!("{law} of part `{}` are wrong", part.name)),
        None => Ok(()),
    }
}

#[test]
fn every_file_of_the_assets_does_what_the_table_says() {
    let Some(assets) = assets() else { return };
    let table =
        DeTable::parse(include_str!("expectations/obj.toml")).expect("the table is TOML").into_inner();
    let mut problems = Vec::new();
    let mut seen = BTreeMap::new();
    for (section, folder) in FOLDERS {
        let rows = table[section].get_ref().as_table().expect("a section of the table");
        for path in files_with_extension(&assets.join(folder), "obj") {
            let name = path.file_name().expect("a file has a name").to_string_lossy().into_owned();
            *seen.entry(section).or_insert(0) += 1;
            let Some(row) = rows.get(name.as_str()).and_then(|row| row.get_ref().as_table()).map(Row) else {
                problems.push(format!("{section}/{name} is not in the table"));
                continue;
            };
            let verdict = match (obj::read(&path), row.text("refused")) {
                (Ok(file), None) => check_loaded(&file, &row),
                (Ok(_), Some(_)) => Err("loads".to_owned()),
                (Err(error), None) => Err(format!("is refused: {error}")),
                (Err(error), Some(phrase)) if error.to_string().contains(phrase) => Ok(()),
                (Err(error), Some(_)) => Err(format!("is refused with another message: {error}")),
            };
            problems.extend(verdict.err().map(|problem| format!("{section}/{name} {problem}")));
        }
        let rows = rows.len();
        if seen.get(section) != Some(&rows) {
            problems
                .push(format!("the table has {rows} files in {section}, the assets {:?}", seen.get(section)));
        }
    }
    assert!(problems.is_empty(), "\n{}", problems.join("\n"));
}

/// Every edge has one face on each side, in opposite directions.
fn is_closed(part: &obj::Part) -> bool {
    let edges = part.mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    let edges: Vec<(u32, u32)> = edges.collect();
    let unique: BTreeSet<(u32, u32)> = edges.iter().copied().collect();
    unique.len() == edges.len() && unique.iter().all(|&(a, b)| unique.contains(&(b, a)))
}

#[test]
fn closed_solids_stay_closed() {
    let Some(assets) = assets() else { return };
    let names = [
        "obj/fandisk.obj",
        "obj/spot.obj",
        "obj/quadknot.obj",
        "obj/rabbit.obj",
        "bad-mesh/joined_tetrahedra.obj",
    ];
    for name in names {
        let file = obj::read(&assets.join(name)).expect("loads");
        assert!(file.parts.iter().all(is_closed), "{name}");
    }
    let open = obj::read(&assets.join("bad-mesh/moebius.obj")).expect("loads");
    assert!(!is_closed(&open.parts[0]), "the check sees an open surface");
}

#[test]
fn concave_faces_of_the_assets_are_cut_without_overlap() {
    let Some(assets) = assets() else { return };
    for name in ["concave_polygon.obj", "issue-319-003.obj", "wallhole.obj"] {
        let file = obj::read(&assets.join("bad-mesh").join(name)).expect("loads");
        let mesh = &file.parts[0].mesh;
        let corner = |index: u32| mesh.positions[index as usize];
        let area = |t: &[u32; 3]| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0]));
        // In `wallhole.obj` each face has a plane of its own, and its vertices are shared with no other.
        let mut faces = vec![vec![mesh.triangles[0]]];
        for triangle in &mesh.triangles[1..] {
            let last = faces.last_mut().expect("not empty");
            if triangle.iter().any(|corner| last.iter().flatten().any(|other| other == corner)) {
                last.push(*triangle);
            } else {
                faces.push(vec![*triangle]);
            }
        }
        for face in &faces {
            let areas: Vec<_> = face.iter().map(area).collect();
            let whole: DVec3 = areas.iter().sum();
            let shares: Vec<f64> =
                areas.iter().map(|area| area.dot(whole) / whole.length_squared()).collect();
            assert!(shares.iter().all(|&share| share > 0.0), "{name}: {shares:?}");
            let lengths: f64 = areas.iter().map(|area| area.length()).sum();
            // The corners have six or seven digits, so that the faces are plane to about 1e-6.
            assert!((lengths / whole.length() - 1.0).abs() < 1e-6, "{name}");
        }
    }
}

#[test]
fn reading_twice_gives_the_same() {
    let Some(assets) = assets() else { return };
    for name in ["obj/rabbit.obj", "obj/monkey.obj", "bad-mesh/concave_polygon.obj"] {
        let read = || obj::read(&assets.join(name)).expect("loads");
        assert_eq!(read(), read());
    }
}

/// One change to the bytes of a file: where (as a share of its length), and what.
#[derive(Clone, Debug)]
enum Damage {
    Set(u8),
    Remove(usize),
    Repeat(usize),
    Insert(&'static str),
    Cut,
}

fn damage() -> impl Strategy<Value = (f64, Damage)> {
    const WORDS: [&str; 20] = [
        "-1",
        "0",
        "99999999999999999999",
        "-9223372036854775808",
        "4294967297",
        "/",
        "//",
        "1//2",
        "\\\n",
        "\n",
        "\r",
        "#",
        "nan",
        "1e999",
        "\nf 1 2 3 4 5\n",
        "\no \n",
        "\ng a b\n",
        "\nusemtl x\n",
        "\nmtllib x\n",
        "\nvn 0 0 0\n",
    ];
    let kind = prop_oneof![
        any::<u8>().prop_map(Damage::Set),
        (1_usize..200).prop_map(Damage::Remove),
        (1_usize..200).prop_map(Damage::Repeat),
        proptest::sample::select(&WORDS[..]).prop_map(Damage::Insert),
        Just(Damage::Cut),
    ];
    (0.0..1.0, kind)
}

fn apply(bytes: &mut Vec<u8>, place: f64, damage: &Damage) {
    let at = (place * bytes.len() as f64) as usize;
    let end = |count: usize| (at + count).min(bytes.len());
    let (range, piece) = match damage {
        Damage::Set(byte) => (at..end(1), vec![*byte]),
        Damage::Remove(count) => (at..end(*count), Vec::new()),
        Damage::Repeat(count) => (at..at, bytes[at..end(*count)].to_vec()),
        Damage::Insert(word) => (at..at, word.as_bytes().to_vec()),
        Damage::Cut => (at..bytes.len(), Vec::new()),
    };
    bytes.splice(range, piece);
}

/// Reads bytes as both kinds of file; whatever loads must be consistent.
fn read_anything(bytes: &[u8]) -> Result<(), TestCaseError> {
    if let Ok(file) = obj::parse("random.obj", bytes, |_| Ok(bytes.to_vec())) {
        for part in &file.parts {
            prop_assert_eq!(check_indices(part), Ok(()));
        }
        let _ = file.materials.iter().map(obj::MtlMaterial::meaning).count();
    }
    Ok(())
}

#[test]
fn damaged_files_never_panic() {
    let Some(assets) = assets() else { return };
    let mut originals = Vec::new();
    for (_, folder) in FOLDERS {
        originals.extend(
            files_with_extension(&assets.join(folder), "obj")
                .iter()
                .map(|path| fs::read(path).expect("readable")),
        );
    }
    originals.retain(|bytes| bytes.len() < 100_000);
    assert!(originals.len() > 20);
    let strategy = (0..originals.len(), proptest::collection::vec(damage(), 1..8));
    let config = Config { cases: 1500, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, fixed_seed())
        .run(&strategy, |(original, all_damage)| {
            let mut bytes = originals[original].clone();
            for (place, damage) in &all_damage {
                apply(&mut bytes, *place, damage);
            }
            read_anything(&bytes)
        })
        .expect("no damage makes the reader fail otherwise than by an error");
}

/// The same cases in every run.
fn fixed_seed() -> proptest::test_runner::TestRng {
    proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha)
}

#[test]
fn random_bytes_never_panic() {
    let statement = prop_oneof![
        proptest::collection::vec(any::<u8>(), 0..40),
        "(v|vt|vn|f|l|p|o|g|usemtl|mtllib|newmtl|Kd|Ni|illum|d|s|\\\\)( (-?[0-9]{1,2}(/-?[0-9]?){0,3}|[a-z.]{1,4})){0,9}"
            .prop_map(String::into_bytes),
    ];
    let lines = proptest::collection::vec(statement, 0..60).prop_map(|lines| lines.join(&b'\n'));
    let config = Config { cases: 3000, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, fixed_seed())
        .run(&lines, |bytes| read_anything(&bytes))
        .expect("no bytes make the reader fail otherwise than by an error");
}

#[test]
fn libraries_are_read_beside_the_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("writable");
    fs::create_dir(folder.path().join("sub")).expect("writable");
    write("sub/clear glass.mtl", "newmtl clear\nillum 7\nNi 1.5\n");
    write("a.mtl", "newmtl a\nKd 1 0 0\n");
    write("b.mtl", "newmtl b\nKd 0 1 0\n");
    write(
        "m.obj",
        "mtllib sub\\clear glass.mtl\nmtllib a.mtl b.mtl\nmtllib sub\nv 0 0 0\nv 1 0 0\nv 0 1 0\n\
         usemtl clear\nf 1 2 3\nusemtl b\nf 3 2 1\n",
    );
    let file = obj::read(&folder.path().join("m.obj")).expect("loads");
    let names: Vec<_> = file.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["clear", "a", "b"]);
    assert_eq!(file.parts[0].mesh.materials, [0, 2]);
    assert_eq!(file.warnings.len(), 1);
    assert!(file.warnings[0].contains("`sub` (line 3) cannot be read: not a file"), "{}", file.warnings[0]);
}

#[test]
fn each_way_of_not_being_a_file_has_its_error() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("empty.obj"), "").expect("writable");
    let error = |path: &Path| obj::read(path).expect_err("must be refused").to_string();
    assert!(error(&path("missing.obj")).contains("no such file"));
    assert!(error(folder.path()).contains("this is a folder"));
    assert!(error(&path("empty.obj")).contains("the file is empty"));
    let endless = |_: &str| -> io::Result<Vec<u8>> { Err(io::ErrorKind::NotFound.into()) };
    assert!(obj::parse("x.obj", b"v 0 0 0", endless).expect_err("refused").to_string().contains("no faces"));
    if cfg!(unix) {
        assert!(error(Path::new("/dev/null")).contains("this is a device or a pipe"));
    }
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_says_so() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("locked.obj");
    fs::write(&path, "v 0 0 0\n").expect("writable");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).expect("own file");
    if fs::read(&path).is_ok() {
        eprintln!("skipped: this user may read everything");
        return;
    }
    assert!(obj::read(&path).expect_err("refused").to_string().contains("check its permissions"));
}
