//! `vitrum explain`: the ray tree through a pixel, told in full.

use crate::args::Explain;
use crate::failure::Failure;
use crate::input;
use crate::terminal;
use std::fmt::Write;
use std::process::ExitCode;
use vitrum_io::load::{Loaded, SceneOptions};
use vitrum_materials::Medium;
use vitrum_math::{DVec3, Rgb};
use vitrum_tracer::{Ending, ExplainedHit, ExplainedRay, Way, explain};

pub(crate) fn run(arguments: &Explain) -> Result<ExitCode, Failure> {
    let options = SceneOptions { repair: arguments.repair, ..SceneOptions::default() };
    let loaded = input::load(arguments.scene.as_deref(), options, &arguments.model, arguments.size)?;
    let mut settings = loaded.settings;
    settings.size = arguments.size.unwrap_or(settings.size);
    let [x, y] = arguments.pixel;
    let [width, height] = settings.size;
    if x >= width || y >= height {
        return Err(Failure::usage(format!(
            "--pixel {x},{y} is not in the picture, whose pixels are 0,0 to {},{}",
            width - 1,
            height - 1
        )));
    }
    let most = arguments.rays as usize;
    let tree = explain(&loaded.scene, &settings, [f64::from(x) + 0.5, f64::from(y) + 0.5], most);
    let mut text = format!("ray tree through the middle of the pixel ({x}, {y})\n");
    for ray in &tree {
        // Writing to a String can't fail.
        let _ = tell(&mut text, ray, &loaded);
    }
    if tree.len() == most {
        let _ = writeln!(text, "... {most} rays told; --rays tells more");
    }
    terminal::answer(&text)?;
    Ok(ExitCode::SUCCESS)
}

fn tell(out: &mut String, ray: &ExplainedRay, loaded: &Loaded) -> std::fmt::Result {
    let names = loaded.scene.names();
    let name = |id: u32| names[id as usize].as_str();
    let margin = "  ".repeat(ray.depth as usize);
    let way = match ray.way {
        Way::Camera => "from the camera",
        Way::Reflected => "reflected",
        Way::Transmitted => "transmitted",
    };
    write!(out, "{margin}{way}: weight {}, in {}", colour(ray.throughput), medium(&ray.medium, loaded))?;
    if !ray.solids.is_empty() {
        let solids: Vec<String> = ray.solids.iter().map(|id| format!("`{}`", name(*id))).collect();
        write!(out, " (inside {})", solids.join(", "))?;
    }
    writeln!(out)?;
    for (distance, id) in &ray.passed {
        writeln!(
            out,
            "{margin}  passes `{}` after {} m: the same medium is on both sides",
            name(*id),
            number(*distance)
        )?;
    }
    if let Some(hit) = &ray.met {
        tell_hit(out, hit, &margin, loaded)?;
    }
    match ray.ended {
        Ending::Divides => Ok(()),
        Ending::Escapes(radiance) => {
            writeln!(out, "{margin}  escapes, to a background of {}", colour(radiance))
        }
        Ending::Scatters(Rgb::ZERO) => writeln!(out, "{margin}  ends: the surface scatters or absorbs"),
        Ending::Scatters(radiance) => {
            writeln!(out, "{margin}  ends: the surface shines, {}", colour(radiance))
        }
        Ending::TooDeep => writeln!(out, "{margin}  ends: its children are deeper than max_depth"),
        Ending::TooFaint => writeln!(out, "{margin}  ends: what is not followed weighs less than 0.001"),
    }
}

fn tell_hit(out: &mut String, hit: &ExplainedHit, margin: &str, loaded: &Loaded) -> std::fmt::Result {
    let scene = &loaded.scene;
    let material = scene.material(hit.object, hit.face).name();
    let side = if hit.front { "front" } else { "back" };
    let angle = libm::acos(hit.cos_theta_i.min(1.0)).to_degrees();
    writeln!(
        out,
        "{margin}  meets `{}` ({material}, face {}) from its {side} after {} m, at {}, normal {}, {angle:.2}° off it",
        scene.names()[hit.object as usize],
        hit.face,
        number(hit.distance),
        point(hit.point),
        point(hit.normal),
    )?;
    if let (Some(beyond), Some(eta)) = (&hit.beyond, hit.eta) {
        write!(out, "{margin}  beyond is {}, eta {}", medium(beyond, loaded), number(eta))?;
        match hit.shares {
            Some([reflected, transmitted]) if transmitted == Rgb::ZERO => {
                writeln!(out, ": total reflection, {}", colour(reflected))?;
            }
            Some([reflected, transmitted]) => {
                writeln!(out, ": reflects {}, transmits {}", colour(reflected), colour(transmitted))?;
            }
            None => writeln!(out)?,
        }
    } else if let Some([reflected, transmitted]) = hit.shares {
        writeln!(out, "{margin}  reflects {}, transmits {}", colour(reflected), colour(transmitted))?;
    }
    if hit.unmatched {
        writeln!(
            out,
            "{margin}  the surface does not expect a ray in this medium: there is a gap before it, or media do not fit"
        )?;
    }
    Ok(())
}

/// A medium by its name, if the scene gives it one.
fn medium(medium: &Medium, loaded: &Loaded) -> String {
    let index = medium.index.value();
    let name = loaded.media.iter().find(|(_, known)| known == medium).map(|(name, _)| name.as_str());
    let absorbs = match medium.absorption.sigma_a() {
        Rgb::ZERO => String::new(),
        sigma_a => format!(", sigma_a {}", colour(sigma_a)),
    };
    match name {
        Some(name) => format!("{name} ({index}{absorbs})"),
        None => format!("index {index}{absorbs}"),
    }
}

/// Six digits.
fn number(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    rounded.to_string()
}

fn colour(c: Rgb) -> String {
    let [r, g, b] = c.to_array().map(number);
    if r == g && g == b { r } else { format!("[{r}, {g}, {b}]") }
}

fn point(p: DVec3) -> String {
    let [x, y, z] = p.to_array().map(number);
    format!("({x}, {y}, {z})")
}
