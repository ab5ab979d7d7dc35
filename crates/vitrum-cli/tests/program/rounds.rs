//! Errors to reach, limits of time, checkpoints and channels, as a user meets them.

use crate::workplace::{CUBE, SCENE, Workplace, scene_with};
use vitrum_io::image::read_exr;

fn metadata(place: &Workplace, name: &str) -> Vec<(String, String)> {
    read_exr(&place.path(name)).expect("readable").metadata
}

fn value<'m>(metadata: &'m [(String, String)], key: &str) -> Option<&'m str> {
    metadata.iter().find(|(k, _)| k.strip_prefix("vitrum:") == Some(key)).map(|(_, value)| value.as_str())
}

#[test]
fn an_error_to_reach_is_reached_and_said() {
    let place = Workplace::new();
    place.write("scene.toml", scene_with("ior = 1.5", "ior = 1.5, kr = 0.1, kt = 0.5"));
    let arguments = ["render", "scene.toml", "--size", "64x48", "--until", "noise=1%", "-o", "a.exr"];
    let said = place.succeed(&arguments).stderr;
    assert!(said.contains("the error to reach was reached"), "{said}");
    assert!(said.contains("relMSE") && said.contains("(90 %: "), "{said}");
    let metadata = metadata(&place, "a.exr");
    assert_eq!(value(&metadata, "until"), Some("noise=0.01"));
    // The edge of the ball needs more than its surroundings.
    let spp = value(&metadata, "spp").expect("said");
    assert!(spp.starts_with("32 to "), "{spp}");
    // No more than are allowed.
    let said = place.succeed(&[&arguments[..], &["--spp", "16"]].concat()).stderr;
    assert!(said.contains("16 samples per pixel") && said.contains("all samples were taken"), "{said}");
}

#[test]
fn a_limit_of_time_ends_the_render() {
    let place = Workplace::with_scene();
    let said = place.succeed(&["render", "scene.toml", "--time", "0.3s", "-o", "a.exr"]).stderr;
    assert!(said.contains("there was no time for another round"), "{said}");
    let metadata = metadata(&place, "a.exr");
    assert!(value(&metadata, "spp").expect("said").parse::<u32>().expect("the same everywhere") >= 8);
    assert_eq!(value(&metadata, "until"), None);
}

#[test]
fn a_checkpoint_is_of_one_picture() {
    let place = Workplace::with_scene();
    let render = ["render", "scene.toml", "-o", "a.exr"];
    place.refuse(
        &[&render[..], &["--resume"]].concat(),
        2,
        &["a.exr.checkpoint: the checkpoint cannot be read"],
    );
    place.succeed(&[&render[..], &["--checkpoint", "--spp", "16"]].concat());
    assert_eq!(place.names(), ["a.exr", "a.exr.checkpoint", "scene.toml"]);
    let few = "was made with branching auto, found tree";
    place.refuse(&[&render[..], &["--resume", "--spp", "4"]].concat(), 2, &[few]);
    let render = ["render", "scene.toml", "-o", "a.exr", "--spp", "16"];
    place.refuse(
        &[&render[..], &["--resume", "--seed", "3"]].concat(),
        2,
        &["was made with seed 0, found 3"],
    );
    let until = ["--resume", "--until", "noise=1%"];
    place.refuse(
        &[&render[..], &until].concat(),
        2,
        &["was made with rounds of all pixels, found until an error"],
    );
    place.write("scene.toml", scene_with("color = 1", "color = 0.5"));
    let resume = [&render[..], &["--resume"]].concat();
    place.refuse(&resume, 2, &["the checkpoint is of another scene"]);
    place.write("scene.toml", SCENE);
    // More samples than before: those that there are count.
    let render = ["render", "scene.toml", "-o", "a.exr"];
    place.succeed(&[&render[..], &["--resume", "--spp", "64"]].concat());
    assert_eq!(place.names(), ["a.exr", "scene.toml"]);
    let more = place.read("a.exr");
    // Fewer than there are change nothing.
    place.succeed(&[&render[..], &["--checkpoint", "--spp", "64"]].concat());
    place.succeed(&[&render[..], &["--resume", "--spp", "16"]].concat());
    assert!(more == place.read("a.exr"), "64 samples stay 64");
    place.succeed(&[&render[..], &["--spp", "64"]].concat());
    assert!(more == place.read("a.exr"), "16 and then 64 samples are 64 samples");
    place.write("a.exr.checkpoint", "no checkpoint");
    place.refuse(&resume, 2, &["this is not a checkpoint"]);
    place.write("a.exr.checkpoint", "vitrum checkpoint 1\nand no more");
    place.refuse(&resume, 2, &["the checkpoint is damaged or cut off"]);
}

/// A model whose image is missing shows its plain colour, and can be gone on with all the same.
#[test]
fn a_missing_image_of_a_model_keeps_no_checkpoint_away() {
    let place = Workplace::new();
    place.write("cube.obj", format!("mtllib cube.mtl\nusemtl paint\nvt 0 0\n{CUBE}"));
    place.write("cube.mtl", "newmtl paint\nKd 0.5 0.5 0.5\nmap_Kd nowhere.png\n");
    let render = ["render", "cube.obj", "--material", "file", "--size", "16x12", "-o", "a.exr"];
    place.succeed(&[&render[..], &["--checkpoint", "--spp", "8"]].concat());
    place.succeed(&[&render[..], &["--resume", "--spp", "8"]].concat());
}

#[test]
fn channels_are_for_exr() {
    let place = Workplace::with_scene();
    let render = ["render", "scene.toml", "--spp", "32"];
    place.succeed(&[&render[..], &["-o", "plain.exr"]].concat());
    place.succeed(&[&render[..], &["-o", "more.exr", "--channels", "error,samples"]].concat());
    let (plain, more) = (read_exr(&place.path("plain.exr")), read_exr(&place.path("more.exr")));
    assert_eq!(plain.expect("readable").pixels, more.expect("readable").pixels);
    let all = exr::prelude::read_all_flat_layers_from_file(place.path("more.exr")).expect("readable");
    let channels = &all.layer_data[0].channel_data.list;
    let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["B", "G", "R", "error.B", "error.G", "error.R", "samples.Y"]);
    let values = |at: usize| channels[at].sample_data.values_as_f32().collect::<Vec<_>>();
    assert!(values(6).iter().all(|n| *n == 32.0));
    let errors = values(5);
    assert_eq!(errors[0], 0.0, "the sky is the same in every sample");
    assert!(errors.iter().all(|e| (0.0..0.2).contains(e)) && errors.iter().any(|e| *e > 0.0), "{errors:?}");
    place.refuse(
        &[&render[..], &["-o", "a.png", "--channels", "error"]].concat(),
        2,
        &["only .exr holds channels"],
    );
    let one = ["render", "scene.toml", "--spp", "1", "-o", "a.exr", "--channels", "error"];
    place.refuse(&one, 2, &["found 1 samples per pixel; a standard error takes at least 9"]);
}

/// What is seen beside light, of the ball before the sky: in its middle and in a corner.
#[test]
fn channels_say_what_is_seen() {
    let place = Workplace::with_scene();
    let asked = "object,object,material,depth,normal,albedo,normal-behind,albedo-behind,media,unmatched";
    place.succeed(&["render", "scene.toml", "-o", "seen.exr", "--channels", asked]);
    let all = exr::prelude::read_all_flat_layers_from_file(place.path("seen.exr")).expect("readable");
    let channels = &all.layer_data[0].channel_data.list;
    let names: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names.len(), 3 + 5 + 4 * 3, "each once: {names:?}");
    let at = |name: &str, place: usize| {
        let channel = channels.iter().find(|c| c.name.to_string() == name).expect(name);
        channel.sample_data.values_as_f32().nth(place).expect("a pixel")
    };
    let (corner, middle) = (0, 6 * 16 + 8);
    for (name, in_corner, in_middle) in
        [("object.id", 0.0, 1.0), ("media.Y", 0.0, 1.0), ("unmatched.Y", 0.0, 0.0)]
    {
        assert_eq!((at(name, corner), at(name, middle)), (in_corner, in_middle), "{name}");
    }
    assert!(at("depth.Z", corner).is_infinite() && (at("depth.Z", middle) - 4.0).abs() < 0.1);
    assert!(at("normal.Z", middle) > 0.95 && at("behind.albedo.R", middle) == 1.0);
}
