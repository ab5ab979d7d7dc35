//! A picture that can't be written: found out before the render where that is possible, and never at the price of what was
//! there before.

use crate::workplace::Workplace;
use std::fs;

#[test]
fn names_that_no_picture_can_have() {
    let place = Workplace::with_scene();
    fs::create_dir(place.path("folder.png")).expect("a new name");
    let cases: [(&str, &[&str]); 7] = [
        ("picture.gif", &["picture.gif: found the extension .gif, expected .exr", ".png"]),
        ("picture", &["picture: the name has no extension, expected .exr"]),
        (".png", &[".png: the name has no extension"]),
        ("scene.toml", &["scene.toml: found the extension .toml"]),
        ("folder.png", &["folder.png: this is a folder; choose another name"]),
        ("folder.png/", &["this is a folder"]),
        ("", &["--output <FILE>"]),
    ];
    for (name, phrases) in cases {
        place.refuse(&["render", "scene.toml", "-o", name], 2, phrases);
    }
}

#[test]
fn a_folder_that_is_missing() {
    let place = Workplace::with_scene();
    let phrases = ["no/such/picture.png: there is no folder no/such; create it or choose another"];
    place.refuse(&["render", "scene.toml", "-o", "no/such/picture.png"], 1, &phrases);
    place.refuse(
        &["render", "scene.toml", "-o", "scene.toml/picture.png"],
        1,
        &["there is no folder scene.toml"],
    );
}

/// The output is looked at first: nobody waits for a scene to load that has nowhere to go.
#[test]
fn the_output_is_checked_before_the_input() {
    let place = Workplace::new();
    let message =
        place.refuse(&["render", "no.toml", "-o", "no/such/picture.png"], 1, &["no folder no/such"]);
    assert!(!message.contains("no.toml"), "{message}");
}

/// A folder without write permission; for a user who may write everywhere, one of the kernel's.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_is_read_only() {
    use std::os::unix::fs::PermissionsExt;
    let place = Workplace::with_scene();
    let locked = place.path("locked");
    fs::create_dir(&locked).expect("a new name");
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).expect("own folder");
    let may_write_anyway = fs::write(locked.join("probe"), "").is_ok();
    let folder = if may_write_anyway { "/proc" } else { "locked" };
    let said = format!("no file can be created in {folder} (");
    let output = format!("{folder}/picture.png");
    let message = place.refuse(&["render", "scene.toml", "-o", &output], 1, &[&output, &said, "permissions"]);
    assert_eq!(message.matches("os error").count(), 1, "{message}");
}

#[cfg(unix)]
#[test]
fn files_that_are_protected_and_devices() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Workplace::with_scene();
    place.write("kept.png", "the old picture");
    fs::set_permissions(place.path("kept.png"), fs::Permissions::from_mode(0o444)).expect("own file");
    place.refuse(&["render", "scene.toml", "-o", "kept.png"], 2, &["kept.png: this is write-protected"]);
    symlink("/dev/null", place.path("device.png")).expect("a new name");
    place.refuse(
        &["render", "scene.toml", "-o", "device.png"],
        2,
        &["device.png: this is a device or a pipe"],
    );
}

/// A disk without room, as far as an ordinary user can make one: no file may grow beyond 512 or 1024 bytes. The system
/// sends a signal then, which must not end the program either.
#[cfg(unix)]
#[test]
fn a_disk_without_room() {
    let place = Workplace::with_scene();
    for picture in ["picture.exr", "picture.png"] {
        place.write(picture, "the old picture");
        let names = place.names();
        let mut command = std::process::Command::new("sh");
        command.args(["-c", "ulimit -f 1 && exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_vitrum"), "render"]);
        command.args(["scene.toml", "--size", "256x256", "-q", "-o", picture]).current_dir(place.path(""));
        let outcome = crate::workplace::outcome(command);
        assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
        assert_eq!(outcome.stdout, "");
        let said = format!("error: {picture}: the file cannot be written (");
        assert!(outcome.stderr.starts_with(&said), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("free some space or choose another disk"), "{}", outcome.stderr);
        assert_eq!(place.read(picture), b"the old picture");
        assert_eq!(place.names(), names, "no half of a file is left");
    }
}

/// The same picture takes the place of the old one where there is room.
#[test]
fn an_old_picture_is_replaced() {
    let place = Workplace::with_scene();
    place.write("picture.png", "the old picture");
    place.succeed(&["render", "scene.toml", "-o", "picture.png"]);
    assert_eq!(place.png_size("picture.png"), [16, 12]);
    assert_eq!(place.names(), ["picture.png", "scene.toml"]);
}
