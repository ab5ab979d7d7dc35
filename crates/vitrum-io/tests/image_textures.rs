//! Images on surfaces, from the file to the picture: right way up, not mirrored, each colour where it belongs; and what a scene
//! without images is spared.

use image::{ImageFormat, RgbImage};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use vitrum_geometry::Shape;
use vitrum_io::load::{self, LoadError, Loaded, ModelMaterial, ModelOptions};
use vitrum_materials::srgb_to_linear;
use vitrum_tracer::{Plan, render};

/// A folder with an image of four by four pixels, all different.
struct Place(tempfile::TempDir);

fn byte(column: u32, row: u32) -> [u8; 3] {
    [60 * column as u8, 60 * row as u8, 200]
}

fn linear(column: u32, row: u32) -> [f32; 3] {
    byte(column, row).map(|byte| srgb_to_linear(f64::from(byte) / 255.0) as f32)
}

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().expect("a folder"));
        let image = RgbImage::from_fn(4, 4, |x, y| image::Rgb(byte(x, y)));
        image.save_with_format(place.path("four.png"), ImageFormat::Png).expect("encoded");
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    fn load(&self, scene: &str) -> Result<Loaded, LoadError> {
        load::scene_text("scene.toml", scene, self.0.path())
    }
}

/// Looks at the square from (-1, -1) to (1, 1), along -z, with the ray tree unless told otherwise.
fn scene(size: u32, texture: &str, object: &str) -> String {
    format!(
        "[render]\nsize = [{size}, {size}]\nspp = 1\nintegrator = \"whitted\"\n\
         [camera]\ntype = \"orthographic\"\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\nheight = 2\n\
         [[texture]]\nname = \"four\"\ntype = \"image\"\nfile = \"four.png\"\n{texture}\n\
         [[material]]\nname = \"picture\"\ntype = \"emissive\"\nradiance = \"four\"\n\
         [[object]]\n{object}\n"
    )
}

const SQUARE: &str = "shape = \"rectangle\"\ncorner = [-1, -1, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 2, 0]\nmaterial = \"picture\"";

fn pixels(loaded: &Loaded) -> Vec<[f32; 3]> {
    let rendering = render(&loaded.scene, &loaded.settings, &()).expect("valid settings");
    assert_eq!(rendering.stats.dropped, 0);
    rendering.film.image()
}

fn picture(place: &Place, scene: &str) -> Vec<[f32; 3]> {
    pixels(&place.load(scene).unwrap_or_else(|error| panic!("{error}")))
}

/// The image, pixel by pixel.
fn four() -> Vec<[f32; 3]> {
    (0..16).map(|i| linear(i % 4, i / 4)).collect()
}

#[test]
fn a_square_shows_its_image_pixel_by_pixel() {
    let place = Place::new();
    let nearest = "filter = \"nearest\"";
    assert_eq!(picture(&place, &scene(4, nearest, SQUARE)), four());
    // Placed by a transform, the image goes along: a quarter turn to the left.
    let turned = format!("{SQUARE}\ntransform = [{{ rotate = {{ axis = [0, 0, 1], angle = 90 }} }}]");
    let expected: Vec<_> = (0..16).map(|i| linear(3 - i / 4, i % 4)).collect();
    assert_eq!(picture(&place, &scene(4, nearest, &turned)), expected);
    // Mirrored, it is mirrored.
    let mirrored = format!("{SQUARE}\ntransform = [{{ scale = [-1, 1, 1] }}]");
    let backwards: Vec<_> = (0..16).map(|i| linear(3 - i % 4, i / 4)).collect();
    assert_eq!(picture(&place, &scene(4, nearest, &mirrored)), backwards);
    // Twice each way, and a linear one.
    let twice = picture(&place, &scene(8, "filter = \"nearest\"\nscale = 2", SQUARE));
    let expected: Vec<_> = (0..64).map(|i| linear(i % 8 % 4, i / 8 % 4)).collect();
    assert_eq!(twice, expected);
    let plain = picture(&place, &scene(4, "filter = \"nearest\"\nencoding = \"linear\"\nfactor = 3", SQUARE));
    let expected: Vec<_> =
        (0..16).map(|i| byte(i % 4, i / 4).map(|b| (f64::from(b) / 255.0 * 3.0) as f32)).collect();
    assert_eq!(plain, expected);
}

/// A mesh shows its image where its file says, on parts of its own as the rectangle does.
#[test]
fn a_mesh_shows_its_image_where_its_file_says() {
    let place = Place::new();
    place.write(
        "square.obj",
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
    );
    let mesh = "shape = \"mesh\"\nfile = \"square.obj\"\nmaterial = \"picture\"";
    assert_eq!(picture(&place, &scene(4, "filter = \"nearest\"", mesh)), four());
    let bilinear = picture(&place, &scene(33, "wrap = \"clamp\"", mesh));
    let square = picture(&place, &scene(33, "wrap = \"clamp\"", SQUARE));
    for (a, b) in bilinear.iter().flatten().zip(square.iter().flatten()) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn faces_without_a_place_on_the_image_are_said() {
    let place = Place::new();
    let points = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n";
    place.write("half.obj", &format!("{points}f 1/1 2/2 3/3\nf 1 3 4\n"));
    let loaded = place.load(&scene(4, "", "shape = \"mesh\"\nfile = \"half.obj\"\nmaterial = \"picture\""));
    let said = loaded.expect("loads").warnings.to_string();
    assert!(said.contains("which show the lower left corner of `four.png`: 1"), "{said}");
}

/// The mesh of a model file shows the image of its own material, times its colour.
#[test]
fn a_model_shows_the_map_of_its_material() {
    let place = Place::new();
    fs::create_dir(place.path("maps")).expect("a folder");
    fs::copy(place.path("four.png"), place.path("maps/four four.png")).expect("copied");
    place.write("m.mtl", "newmtl wood\nKd 0.5 1 1\nmap_Kd -s 1 1 1 maps\\four four.png\nillum 1\n");
    let faces = "usemtl wood\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    place.write("m.obj", &format!("mtllib m.mtl\n{faces}f 1/1 2/2 3/3 4/4\n"));
    place.write("plain.obj", &format!("mtllib m.mtl\n{faces}f 1 2 3 4\n"));
    let lit = |file: &str| {
        let mesh =
            format!("shape = \"mesh\"\nfile = \"{file}\"\n[[light]]\ntype = \"ambient\"\nradiance = 1");
        place.load(&scene(4, "", &mesh)).unwrap_or_else(|error| panic!("{error}"))
    };
    let mapped = lit("m.obj");
    assert!(mapped.warnings.is_empty(), "{}", mapped.warnings);
    let found = pixels(&mapped);
    let middle = linear(2, 1);
    // Between texels there is a mixture; the samples are somewhere in the pixel.
    assert!((found[6][0] / (0.5 * middle[0]) - 1.0).abs() < 0.9 && (found[6][2] - middle[2]).abs() < 1e-6);
    let plain = lit("plain.obj");
    let said = plain.warnings.to_string();
    assert!(
        said.contains("material `wood` shows `maps\\four four.png` on faces without texture coordinates"),
        "{said}"
    );
    assert_eq!(pixels(&plain)[5], [0.5, 1.0, 1.0]);
    fs::remove_dir_all(place.path("maps")).expect("removed");
    let missing = lit("m.obj");
    let said = missing.warnings.to_string();
    assert!(
        said.contains("`wood` has its plain colour, for its map cannot be shown")
            && said.contains("no such file")
    );
    assert_eq!(pixels(&missing)[5], [0.5, 1.0, 1.0]);
    let options = ModelOptions { material: ModelMaterial::File, ..ModelOptions::default() };
    assert!(load::model_file(&place.path("m.obj"), &options, load::SceneOptions::default()).is_ok());
}

#[test]
fn every_shape_shows_an_image_and_every_way_of_asking_agrees() {
    let place = Place::new();
    let shapes = [
        "shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.9",
        "shape = \"plane\"\npoint = [-1, -1, 0]\nnormal = [0, 0, 1]",
        "shape = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1",
        "shape = \"box\"\nmin = [-0.5, -0.5, -0.5]\nmax = [0.5, 0.5, 0.5]\ntransform = [{ rotate = { axis = [1, 1, 0], angle = 40 } }]",
        "shape = \"cylinder\"\nbottom = [0, -0.9, 0]\ntop = [0, 0.9, 0]\nradius = 0.5",
    ];
    for shape in shapes {
        let object = format!("{shape}\nmaterial = \"picture\"");
        for integrator in ["whitted", "path"] {
            let text = scene(16, "", &object).replace("whitted", integrator);
            let found = picture(&place, &text);
            let different: std::collections::BTreeSet<_> =
                found.iter().map(|p| p.map(f32::to_bits)).collect();
            assert!(different.len() > 40, "{shape}: {}", different.len());
            let brightest = linear(3, 3)[2].max(linear(3, 3)[0]) * (1.0 + 1e-6);
            assert!(found.iter().flatten().all(|c| *c <= brightest), "{shape}");
        }
    }
}

const LAMP: &str = r#"
[render]
size = [4, 4]
spp = 4096
integrator = "path"
[camera]
type = "orthographic"
position = [0, 1, 0]
target = [0, 0, 0]
up = [0, 0, -1]
height = 0.01
[[texture]]
name = "lamp"
type = "image"
file = "lamp.png"
filter = "nearest"
factor = 3
[[object]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = { type = "matte", color = 0.5 }
[[object]]
name = "lamp"
shape = "rectangle"
corner = [-1, 2, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = { type = "emissive", radiance = RADIANCE }
"#;

/// A lamp of which the left half shines lights the floor under its middle half as much as a whole one, by symmetry; and one that
/// shines evenly is exactly the lamp without an image.
#[test]
fn shining_images_are_lights() {
    let place = Place::new();
    let lamp = |left: u8, right: u8| {
        let image = RgbImage::from_fn(2, 1, |x, _| image::Rgb([if x == 0 { left } else { right }; 3]));
        image.save_with_format(place.path("lamp.png"), ImageFormat::Png).expect("encoded");
        picture(&place, &LAMP.replace("RADIANCE", "\"lamp\""))
    };
    let mean =
        |pixels: &[[f32; 3]]| pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64;
    let plain = picture(&place, &LAMP.replace("RADIANCE", "3"));
    let (half, whole) = (lamp(255, 0), lamp(255, 255));
    assert_eq!(whole, plain);
    let loaded = place.load(&LAMP.replace("RADIANCE", "\"lamp\"")).expect("loads");
    let plan = Plan::new(&loaded.scene, &loaded.settings);
    assert!(plan.area_lights == 1 && plan.textures && plan.images);
    // 65536 samples, of which each is the whole or nothing: a standard error of 0.4 % of the half at most.
    assert!((mean(&half) / mean(&plain) - 0.5).abs() < 0.01, "{} {}", mean(&half), mean(&plain));
    // Ray trees that see nothing else know what is the brightest.
    let seen = place.load(&scene(4, "factor = 7", SQUARE)).expect("loads");
    let plan = Plan::new(&seen.scene, &seen.settings);
    let brightest = srgb_to_linear(200.0 / 255.0) * 7.0;
    assert_eq!(plan.radiance_bound, Some(brightest));
}

/// One file, one image; and no texture coordinates where nothing shows one.
#[test]
fn files_are_read_once_and_what_shows_no_image_has_no_coordinates() {
    let place = Place::new();
    place.write("tri.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    let mesh = |material: &str| format!("shape = \"mesh\"\nfile = \"tri.obj\"\nmaterial = {material}");
    let has_uvs = |object: &str| {
        let loaded = place.load(&scene(4, "", object)).unwrap_or_else(|error| panic!("{error}"));
        let plan = Plan::new(&loaded.scene, &loaded.settings);
        let Shape::Mesh(mesh) = loaded.scene.aggregate().objects()[0].shape() else { panic!("a mesh") };
        assert_eq!(plan.images, mesh.has_uvs());
        (mesh.has_uvs(), mesh.memory())
    };
    let (without, plain) = has_uvs(&mesh("{ type = \"matte\", color = 0.5 }"));
    let (unused, same) =
        has_uvs(&mesh("{ type = \"transparent\", ior = 1.5, color = \"four\" }\nforce = true"));
    let (with, more) = has_uvs(&mesh("\"picture\""));
    assert!(with && !without && !unused && same == plain && more == plain + 36, "{plain} {same} {more}");
    // Two objects, two textures, one mesh file and one image.
    let two = format!(
        "{}\n[[texture]]\nname = \"again\"\ntype = \"image\"\nfile = \"four.png\"\nscale = 2\n\
         [[object]]\nshape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {{ type = \"matte\", color = \"again\" }}\n",
        mesh("\"picture\"")
    );
    let loaded = place.load(&scene(4, "", &two)).expect("loads");
    let images: Vec<_> =
        loaded.scene.materials().iter().filter_map(|m| m.image()).map(|texture| &texture.image).collect();
    assert!(images.len() == 2 && Arc::ptr_eq(images[0], images[1]));
}
