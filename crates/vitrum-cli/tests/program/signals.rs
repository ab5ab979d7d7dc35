//! ^C and termination: the picture is kept, as far as it is, and can be gone on with; asked twice, the program ends at once.

use crate::workplace::{SCENE, Workplace, scene_with};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Sends a signal, by its name without SIG.
fn send(signal: &str, child: &Child) {
    let sent = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status();
    assert!(sent.expect("a shell").success(), "the program is still there");
}

/// The exit code of a program that must end within a minute.
fn code(child: &mut Child) -> Option<i32> {
    for _ in 0..600 {
        if let Some(status) = child.try_wait().expect("a child can be waited for") {
            return status.code();
        }
        thread::sleep(Duration::from_millis(100));
    }
    child.kill().expect("a child can be killed");
    child.wait().expect("a child can be waited for");
    panic!("the program did not end");
}

/// A render of about a minute, stopped after its first second: the picture has all its pixels.
#[test]
fn asked_once_the_picture_is_kept() {
    for (signal, expected) in [("INT", 130), ("TERM", 143)] {
        let place = Workplace::new();
        // Its warning says that the rendering is about to begin.
        place.write("scene.toml", scene_with("ior = 1.5", "ior = 1.5, kr = 0.1, kt = 1"));
        place.write("picture.exr", "the old picture");
        let options = ["--size", "64x48", "--spp", "40000", "-o", "picture.exr"];
        let mut command = place.command(&[&["render", "scene.toml"], &options[..]].concat());
        let mut child =
            command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts");
        let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
        let mut said = String::new();
        stderr.read_line(&mut said).expect("text");
        assert!(said.starts_with("warning: "), "{said}");
        thread::sleep(Duration::from_secs(1));
        assert_eq!(place.read("picture.exr"), b"the old picture", "nothing is written before the end");

        send(signal, &child);
        assert_eq!(code(&mut child), Some(expected), "SIG{signal}");
        stderr.read_to_string(&mut said).expect("text");
        assert!(said.contains("samples per pixel (stopped))"), "{said}");
        let picture = vitrum_io::image::read_exr(&place.path("picture.exr")).expect("a complete picture");
        assert_eq!((picture.width, picture.height), (64, 48));
        assert!(
            picture.pixels.iter().flatten().all(|c| c.is_finite() && *c > 0.0),
            "no pixel without samples"
        );
        assert!(said.ends_with("--resume, from picture.exr.checkpoint\n"), "{said}");
        assert_eq!(place.names(), ["picture.exr", "picture.exr.checkpoint", "scene.toml"]);
    }
}

/// Stopped and gone on with, the picture is the one that it would have been, byte by byte; then the checkpoint goes.
#[test]
fn going_on_gives_the_same_file() {
    let place = Workplace::new();
    place.write("scene.toml", scene_with("ior = 1.5", "ior = 1.5, kr = 0.1, kt = 1"));
    for more in [&["--spp", "1500"][..], &["--until", "relmse=3e-9", "--spp", "3000"]] {
        let render = ["render", "scene.toml", "--size", "64x48", "--channels", "error,samples"];
        let whole = [&render[..], &["-o", "whole.exr"], more].concat();
        place.succeed(&whole);
        let part = [&render[..], &["-o", "part.exr"], more].concat();
        let mut child = place.command(&part).stderr(Stdio::null()).spawn().expect("the program starts");
        thread::sleep(Duration::from_millis(300));
        // On a fast machine it may be done by now.
        if child.try_wait().expect("a child can be waited for").is_none() {
            send("INT", &child);
        }
        let code = code(&mut child);
        if code == Some(130) {
            place.succeed(&[&part[..], &["--resume"]].concat());
        }
        assert!(place.read("part.exr") == place.read("whole.exr"), "{more:?} ended with {code:?}");
        assert_eq!(place.names(), ["part.exr", "scene.toml", "whole.exr"]);
    }
}

/// A program that waits for a scene, which comes through a pipe that the caller holds: it listens to signals by then.
fn waiting(place: &Workplace) -> (Child, File) {
    let made = Command::new("mkfifo").arg(place.path("scene.toml")).status();
    assert!(made.expect("mkfifo is part of every Unix").success());
    let mut command = place.command(&["render", "scene.toml", "-o", "picture.png"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let (path, (sender, receiver)) = (place.path("scene.toml"), mpsc::channel());
    // Opening a pipe waits for its reader.
    thread::spawn(move || sender.send(File::options().write(true).open(path)));
    let pipe = receiver.recv_timeout(Duration::from_secs(60)).expect("the program opens the scene");
    (child, pipe.expect("the pipe is writable"))
}

/// Stopped before there is anything to keep, the program leaves the old picture alone.
#[test]
fn asked_while_loading_the_old_picture_stays() {
    for (signal, expected) in [("INT", 130), ("TERM", 143)] {
        let place = Workplace::new();
        place.write("picture.png", "the old picture");
        let (mut child, mut pipe) = waiting(&place);
        send(signal, &child);
        thread::sleep(Duration::from_millis(200));
        pipe.write_all(SCENE.as_bytes()).expect("the program still reads");
        drop(pipe);
        assert_eq!(code(&mut child), Some(expected), "SIG{signal}");
        let mut said = String::new();
        child.stderr.take().expect("a pipe").read_to_string(&mut said).expect("text");
        assert_eq!(said, "stopped before the first sample; picture.png is as it was\n");
        assert_eq!(place.read("picture.png"), b"the old picture");
        assert_eq!(place.names(), ["picture.png", "scene.toml"]);
    }
}

/// The second signal doesn't wait for the work in hand, here a scene that never comes.
#[test]
fn asked_twice_it_ends_at_once() {
    for (first, second, expected) in
        [("INT", "INT", 130), ("TERM", "TERM", 143), ("INT", "TERM", 143), ("TERM", "INT", 130)]
    {
        let place = Workplace::new();
        place.write("picture.png", "the old picture");
        let (mut child, pipe) = waiting(&place);
        send(first, &child);
        thread::sleep(Duration::from_millis(200));
        assert!(child.try_wait().expect("a child can be waited for").is_none(), "one signal is not enough");
        send(second, &child);
        assert_eq!(code(&mut child), Some(expected), "SIG{first}, SIG{second}");
        drop(pipe);
        assert_eq!(place.read("picture.png"), b"the old picture");
        assert_eq!(place.names(), ["picture.png", "scene.toml"]);
    }
}
