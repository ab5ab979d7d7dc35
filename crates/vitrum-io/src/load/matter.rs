//! Media, textures and materials: names become values.

use super::images::{Images, Refusal};
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::obj::{MtlMap, MtlMaterial, MtlMeaning};
use crate::scene::{self, Around, ColourOrTexture, Index, MetalIndex, Model, Pattern, SceneDesc};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use vitrum_bxdf::{ComplexIndex, Conductor, Ggx, ThinDielectric};
use vitrum_materials::{
    Absorption, Axes, Checker, Dielectric, Filter, ImageTexture, IndexOfRefraction, Material, Media, Medium,
    NamedMedium, Phong, Texture, Transparent, Wrap,
};
use vitrum_math::Rgb;

/// What of glass reflects and transmits where a model file only says that it is glass.
const MODEL_KR: f64 = 0.1;
const MODEL_KT: f64 = 0.9;

/// The values behind the names of a scene.
pub(super) struct Matter<'d> {
    media: BTreeMap<&'d str, Result<Medium, String>>,
    /// Those of them that the scene declares or uses.
    used: RefCell<BTreeSet<String>>,
    textures: BTreeMap<&'d str, &'d scene::Texture>,
    images: Images,
    /// Where files are looked for.
    folder: &'d Path,
    materials: BTreeMap<&'d str, &'d scene::Material>,
    /// What surrounds everything.
    pub(super) medium: Medium,
}

/// Where problems are told.
pub(super) struct Told<'t> {
    pub(super) source: &'t Source<'t>,
    pub(super) problems: &'t mut Diagnostics,
}

/// Why there is no material.
enum Flaw {
    /// Something about the material itself.
    Own(String),
    /// Something that it uses, and that has been told.
    Told,
}

impl From<String> for Flaw {
    fn from(reason: String) -> Self {
        Self::Own(reason)
    }
}

impl<'d> Matter<'d> {
    /// Of a description, whose files are looked for in `folder`.
    pub(super) fn new(desc: &'d SceneDesc, folder: &'d Path) -> Self {
        let named = NamedMedium::ALL.iter().map(|named| (named.name, Ok(named.medium)));
        let declared = desc.media.iter().map(|m| (m.name.text.as_str(), valid(m.ior, m.absorption)));
        let media: BTreeMap<_, _> = named.chain(declared).collect();
        let around = desc.surroundings.text.as_str();
        let medium = media.get(around).and_then(|medium| medium.clone().ok()).unwrap_or(Medium::AIR);
        let used = desc.media.iter().map(|m| m.name.text.clone()).chain([around.to_owned()]).collect();
        Self {
            medium,
            used: RefCell::new(used),
            textures: desc.textures.iter().map(|t| (t.name.text.as_str(), t)).collect(),
            images: Images::default(),
            folder,
            materials: desc
                .materials
                .iter()
                .filter_map(|m| Some((m.name.as_ref()?.text.as_str(), m)))
                .collect(),
            media,
        }
    }

    /// The images that it has read.
    pub(super) fn images(&self) -> &Images {
        &self.images
    }

    /// The media that the scene declares or uses, by name.
    pub(super) fn media(&self) -> Vec<(String, Medium)> {
        let used = self.used.borrow();
        let of_scene = self.media.iter().filter(|(name, _)| used.contains(**name));
        of_scene.filter_map(|(name, m)| Some(((*name).to_owned(), *m.as_ref().ok()?))).collect()
    }

    /// The material of that name.
    pub(super) fn named(&self, name: &str) -> Option<&'d scene::Material> {
        self.materials.get(name).copied()
    }

    /// Whether a material, as it is described, shows an image.
    pub(super) fn shows_image(&self, material: &scene::Material) -> bool {
        let color = match &material.model {
            Model::Matte { color, ka, kd } => (*ka > 0.0 || *kd > 0.0).then_some(color),
            Model::Phong(phong) | Model::Reflective { phong, .. } | Model::Transparent { phong, .. } => {
                (phong.ka > 0.0 || phong.kd > 0.0).then_some(&phong.color)
            }
            Model::Emissive { radiance } => Some(radiance),
            Model::Dielectric { .. } | Model::Thin { .. } | Model::Conductor { .. } => None,
        };
        let Some(ColourOrTexture::Texture(name)) = color else { return false };
        let texture = self.textures.get(name.text.as_str());
        texture.is_some_and(|texture| matches!(texture.pattern, Pattern::Image { .. }))
    }

    /// The texture that gives a radiance.
    fn texture(&mut self, of: &ColourOrTexture, told: &mut Told<'_>) -> Result<Texture, Flaw> {
        let name = match of {
            ColourOrTexture::Colour(colour) => return Ok(Texture::Constant(*colour)),
            ColourOrTexture::Texture(name) => name,
        };
        // Reading has checked the name; a description built in code may name nothing.
        let known = self.textures.get(name.text.as_str());
        let texture = known.ok_or_else(|| format!("there is no texture `{}`", name.text))?;
        match texture.pattern {
            Pattern::Checker { even, odd, size, origin, axes: [x, y, z] } => {
                Ok(Texture::Checker(Checker { even, odd, size, origin, axes: Axes { x, y, z } }))
            }
            Pattern::Image { ref file, file_span, scale, offset, wrap, filter, encoding, factor } => {
                let path = self.folder.join(file);
                let Told { source, problems } = told;
                let warn = |warning: String| problems.push(Diagnostic::warning(source.name(), warning));
                match self.images.image(&path, &file.to_string_lossy(), encoding, warn) {
                    Ok(image) => {
                        Ok(Texture::Image(ImageTexture { image, scale, offset, wrap, filter, factor }))
                    }
                    Err(Refusal { message, is_missing }) => {
                        let mut problem = super::error(source, file_span, message, "this file");
                        if is_missing {
                            problem = problem.help("paths are relative to the folder of the scene file");
                        }
                        problems.push(problem);
                        Err(Flaw::Told)
                    }
                }
            }
        }
    }

    /// The texture that gives the colour of a surface: nothing of it is brighter than 1. Of images only their files say so; of the
    /// rest, reading has seen to it.
    fn surface_colour(&mut self, of: &ColourOrTexture, told: &mut Told<'_>) -> Result<Texture, Flaw> {
        let texture = self.texture(of, told)?;
        let brightest = texture.brightest();
        let (ColourOrTexture::Texture(name), Some(image)) = (of, texture.image()) else { return Ok(texture) };
        if brightest <= 1.0 {
            return Ok(texture);
        }
        let message = format!("the texture \"{}\" is too bright for a surface", name.text);
        let label = format!("expected colours from 0 to 1, found up to {brightest}");
        let problem = super::error(told.source, name.span, message, &label);
        let problem = problem.also(
            told.source,
            self.textures[name.text.as_str()].span,
            format!("it shows {}", image.image.name()),
        );
        let help = "only `radiance` of an emissive material can exceed 1; a smaller `factor` makes it darker";
        told.problems.push(problem.help(help));
        Err(Flaw::Told)
    }

    /// The medium of that name.
    pub(super) fn medium_of(&self, name: &scene::Name) -> Result<Medium, String> {
        self.used.borrow_mut().insert(name.text.clone());
        let known = self.media.get(name.text.as_str());
        known.cloned().unwrap_or_else(|| Err(format!("there is no medium `{}`", name.text)))
    }

    /// The medium of that name, or the scene's.
    fn outside(&self, name: Option<&scene::Name>) -> Result<Medium, String> {
        name.map_or(Ok(self.medium), |name| self.medium_of(name))
    }

    /// The medium that is around glass, or that its index is relative to.
    fn around(&self, around: &Around) -> Result<Medium, String> {
        match around {
            Around::Anything { .. } => Ok(self.medium),
            Around::Medium(name) => self.medium_of(name),
        }
    }

    /// What the surface of glass divides.
    fn divided(&self, around: &Around, inside: Medium) -> Result<Media, String> {
        Ok(match around {
            Around::Anything { priority } => Media::solid(self.medium, inside, *priority),
            Around::Medium(name) => Media::new(self.medium_of(name)?, inside),
        })
    }

    fn dielectric(
        &self,
        inside: &Index,
        around: &Around,
        roughness: f64,
        absorbed: scene::Absorption,
    ) -> Result<Dielectric, String> {
        let inside = match inside {
            Index::Absolute(n) => valid(*n, absorbed)?,
            Index::Relative(ratio) => relative(self.around(around)?, *ratio, absorbed)?,
            Index::Medium(name) => self.medium_of(name)?,
        };
        Ok(Dielectric::new(self.divided(around, inside)?, ggx(roughness)?))
    }

    fn phong(&mut self, p: &scene::Phong, told: &mut Told<'_>) -> Result<Phong, Flaw> {
        let colour = self.surface_colour(&p.color, told)?;
        Ok(Phong { colour, ka: p.ka, kd: p.kd, ks: Rgb::splat(p.ks), exponent: p.exponent })
    }

    /// The material behind a description; problems are told at its place.
    pub(super) fn material(&mut self, material: &scene::Material, mut told: Told<'_>) -> Option<Material> {
        match self.model(&material.model, &mut told) {
            Ok(material) => Some(material),
            Err(Flaw::Own(reason)) => {
                told.problems.push(super::error(told.source, material.span, reason, "this material"));
                None
            }
            Err(Flaw::Told) => None,
        }
    }

    fn model(&mut self, model: &Model, told: &mut Told<'_>) -> Result<Material, Flaw> {
        Ok(match model {
            Model::Matte { color, ka, kd } => {
                let colour = self.surface_colour(color, told)?;
                Material::Matte(Phong { colour, ka: *ka, kd: *kd, ..Phong::NONE })
            }
            Model::Phong(phong) => Material::Phong(self.phong(phong, told)?),
            Model::Reflective { phong, kr } => {
                Material::Reflective { phong: self.phong(phong, told)?, kr: *kr }
            }
            Model::Emissive { radiance } => Material::Emissive { radiance: self.texture(radiance, told)? },
            Model::Transparent { phong, kr, kt, ior, around } => {
                let inside = relative(self.around(around)?, *ior, scene::Absorption::Clear)?;
                let media = self.divided(around, inside)?;
                Material::Transparent(Transparent {
                    phong: self.phong(phong, told)?,
                    kr: *kr,
                    kt: *kt,
                    media,
                })
            }
            Model::Dielectric { inside, around, roughness, compensation, absorption } => {
                let glass = self.dielectric(inside, around, *roughness, *absorption)?;
                Material::Dielectric(if *compensation { glass } else { glass.single_scattering() })
            }
            Model::Thin { ior, outside, transmittance } => {
                let sheet = valid(*ior, scene::Absorption::Clear)?;
                let interface = *Media::new(self.outside(outside.as_ref())?, sheet).interface();
                Material::Thin(ThinDielectric { interface, transmittance: *transmittance })
            }
            Model::Conductor { index, outside, roughness } => {
                let above = self.outside(outside.as_ref())?.index;
                let (n, k) = match *index {
                    MetalIndex::Named(metal) => (metal.n(), metal.k()),
                    MetalIndex::Given { n, k } => (n, k),
                };
                let index = ComplexIndex::new(n, k, above.value()).map_err(|e| e.to_string())?;
                Material::Conductor(Conductor { index, roughness: ggx(*roughness)? })
            }
        })
    }

    /// What a material of a model file becomes, with an image instead of its colour where it shows one. `folder` is that of the
    /// file.
    ///
    /// # Errors
    /// What is the matter, where it can't be a material at all.
    pub(super) fn imported(
        &mut self,
        material: &MtlMaterial,
        folder: &Path,
        has_uvs: bool,
        warn: &mut dyn FnMut(String),
    ) -> Result<Material, String> {
        let mut matte = |color: Rgb| Phong {
            colour: self.imported_colour(material, color, folder, has_uvs, warn),
            ka: 1.0,
            kd: 1.0,
            ..Phong::NONE
        };
        Ok(match material.meaning() {
            MtlMeaning::Matte { color } => Material::Matte(matte(color)),
            MtlMeaning::Phong { color, ks, exponent } => {
                Material::Phong(Phong { ks, exponent, ..matte(color) })
            }
            MtlMeaning::Mirror { kr } => Material::Reflective { phong: Phong::NONE, kr },
            MtlMeaning::Emissive { radiance } => Material::Emissive { radiance: Texture::Constant(radiance) },
            MtlMeaning::Glass { ior, tint } => Material::Transparent(Transparent {
                phong: Phong::NONE,
                kr: Rgb::splat(MODEL_KR),
                kt: tint * MODEL_KT,
                media: self
                    .divided(&Around::default(), relative(self.medium, ior, scene::Absorption::Clear)?)?,
            }),
        })
    }

    /// The colour of a material of a model file: its map, or without a good one its plain colour. A library is never a reason to
    /// refuse a model.
    fn imported_colour(
        &mut self,
        material: &MtlMaterial,
        color: Rgb,
        folder: &Path,
        has_uvs: bool,
        warn: &mut dyn FnMut(String),
    ) -> Texture {
        let plain = Texture::Constant(color);
        let Some(MtlMap { file, scale, offset, clamp }) = &material.map_kd else { return plain };
        let name = &material.name;
        if !has_uvs {
            warn(format!(
                "material `{name}` shows `{file}` on faces without texture coordinates (vt), which have its plain colour"
            ));
            return plain;
        }
        let path = folder.join(file);
        let path = if path.exists() { path } else { folder.join(file.replace('\\', "/")) };
        let image = match self.images.image(&path, file, None, &mut *warn) {
            Ok(image) => image,
            Err(Refusal { message, .. }) => {
                warn(format!(
                    "material `{name}` has its plain colour, for its map cannot be shown: {message}"
                ));
                return plain;
            }
        };
        let image = ImageTexture {
            image,
            scale: *scale,
            offset: *offset,
            wrap: if *clamp { Wrap::Clamp } else { Wrap::Repeat },
            filter: Filter::Bilinear,
            factor: material.kd.unwrap_or(Rgb::ONE),
        };
        if image.brightest().max_element() > 1.0 {
            warn(format!(
                "material `{name}` has its plain colour, for `{file}` is brighter than a surface can be"
            ));
            return plain;
        }
        Texture::Image(image)
    }
}

/// A medium that absorbs.
fn valid(ior: f64, absorbed: scene::Absorption) -> Result<Medium, String> {
    let index = IndexOfRefraction::new(ior).map_err(|e| e.to_string())?;
    Ok(Medium { index, absorption: absorption(absorbed)? })
}

/// A medium whose index is relative to another. It is made absolute here, so that it has no history.
fn relative(to: Medium, ratio: f64, absorbed: scene::Absorption) -> Result<Medium, String> {
    let index = to.index.times(ratio).map_err(|e| e.to_string())?;
    Ok(Medium { index, absorption: absorption(absorbed)? })
}

fn absorption(described: scene::Absorption) -> Result<Absorption, String> {
    match described {
        scene::Absorption::Clear => Ok(Absorption::NONE),
        scene::Absorption::PerMetre(sigma_a) => Absorption::per_metre(sigma_a),
        scene::Absorption::Transmittance { share, distance } => {
            Absorption::from_transmittance(share, distance)
        }
    }
    .map_err(|e| e.to_string())
}

fn ggx(alpha: f64) -> Result<Ggx<f64>, String> {
    if alpha == 0.0 { Ok(Ggx::smooth()) } else { Ggx::isotropic(alpha).map_err(|e| e.to_string()) }
}
