//! Media, textures and materials: names become values.

use crate::diagnostic::{Diagnostics, Source};
use crate::obj::MtlMeaning;
use crate::scene::{self, ColourOrTexture, Model, Pattern, SceneDesc};
use std::collections::BTreeMap;
use vitrum_bxdf::Interface;
use vitrum_materials::{Axes, Checker, IndexOfRefraction, Material, Phong, Texture, Transparent};
use vitrum_math::Rgb;

/// What of glass reflects and transmits where a model file only says that it is glass.
const MODEL_KR: f64 = 0.1;
const MODEL_KT: f64 = 0.9;

/// The values behind the names of a scene.
pub(super) struct Matter<'d> {
    media: BTreeMap<&'d str, f64>,
    textures: BTreeMap<&'d str, Texture>,
    materials: BTreeMap<&'d str, &'d scene::Material>,
    /// What surrounds everything.
    pub(super) medium: IndexOfRefraction,
}

impl<'d> Matter<'d> {
    pub(super) fn new(desc: &'d SceneDesc) -> Self {
        let predefined = scene::schema::PREDEFINED_MEDIA.iter().map(|&(name, ior)| (name, ior));
        let declared = desc.media.iter().map(|m| (m.name.text.as_str(), m.ior));
        let media: BTreeMap<_, _> = predefined.chain(declared).collect();
        let medium = media.get(desc.surroundings.text.as_str()).and_then(|&n| IndexOfRefraction::new(n).ok());
        Self {
            medium: medium.unwrap_or(IndexOfRefraction::AIR),
            textures: desc.textures.iter().map(|t| (t.name.text.as_str(), texture(&t.pattern))).collect(),
            materials: desc
                .materials
                .iter()
                .filter_map(|m| Some((m.name.as_ref()?.text.as_str(), m)))
                .collect(),
            media,
        }
    }

    /// All media by name.
    pub(super) fn media(&self) -> Vec<(String, f64)> {
        self.media.iter().map(|(name, ior)| ((*name).to_owned(), *ior)).collect()
    }

    /// The material of that name.
    pub(super) fn named(&self, name: &str) -> Option<&'d scene::Material> {
        self.materials.get(name).copied()
    }

    fn texture(&self, of: &ColourOrTexture) -> Result<Texture, String> {
        match of {
            ColourOrTexture::Colour(colour) => Ok(Texture::Constant(*colour)),
            // Reading has checked the name; a description built in code may name nothing.
            ColourOrTexture::Texture(name) => {
                let known = self.textures.get(name.text.as_str()).copied();
                known.ok_or_else(|| format!("there is no texture `{}`", name.text))
            }
        }
    }

    /// The index of the medium of that name.
    pub(super) fn medium_of(&self, name: &scene::Name) -> Result<IndexOfRefraction, String> {
        let known = self.media.get(name.text.as_str());
        let index = known.ok_or_else(|| format!("there is no medium `{}`", name.text))?;
        IndexOfRefraction::new(*index).map_err(|e| e.to_string())
    }

    fn phong(&self, p: &scene::Phong) -> Result<Phong, String> {
        let colour = self.texture(&p.color)?;
        Ok(Phong { colour, ka: p.ka, kd: p.kd, ks: Rgb::splat(p.ks), exponent: p.exponent })
    }

    /// The material behind a description; problems are told at its place.
    pub(super) fn material(
        &self,
        material: &scene::Material,
        source: &Source<'_>,
        problems: &mut Diagnostics,
    ) -> Option<Material> {
        let material = self.model(&material.model).map_err(|reason| {
            problems.push(super::error(source, material.span, reason, "this material"));
        });
        material.ok()
    }

    fn model(&self, model: &Model) -> Result<Material, String> {
        Ok(match model {
            Model::Matte { color, ka, kd } => {
                Material::Matte(Phong { colour: self.texture(color)?, ka: *ka, kd: *kd, ..Phong::NONE })
            }
            Model::Phong(phong) => Material::Phong(self.phong(phong)?),
            Model::Reflective { phong, kr } => Material::Reflective { phong: self.phong(phong)?, kr: *kr },
            Model::Emissive { radiance } => Material::Emissive { radiance: self.texture(radiance)? },
            Model::Transparent { phong, kr, kt, ior, outside } => {
                let above = outside.as_ref().map_or(Ok(self.medium), |name| self.medium_of(name))?;
                let interface = self.interface(above, *ior)?;
                Material::Transparent(Transparent { phong: self.phong(phong)?, kr: *kr, kt: *kt, interface })
            }
        })
    }

    /// The interface of a solid with an index `relative` to what is outside: made absolute here, so that it has no history.
    fn interface(&self, above: IndexOfRefraction, relative: f64) -> Result<Interface<f64>, String> {
        let below = above.times(relative).map_err(|e| e.to_string())?;
        Interface::new(above.value(), below.value()).map_err(|e| e.to_string())
    }

    /// What a material of a model file becomes.
    pub(super) fn imported(&self, meaning: &MtlMeaning) -> Result<Material, String> {
        let matte =
            |colour: Rgb| Phong { colour: Texture::Constant(colour), ka: 1.0, kd: 1.0, ..Phong::NONE };
        Ok(match *meaning {
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
                interface: self.interface(self.medium, ior)?,
            }),
        })
    }
}

fn texture(pattern: &Pattern) -> Texture {
    match *pattern {
        Pattern::Checker { even, odd, size, origin, axes: [x, y, z] } => {
            Texture::Checker(Checker { even, odd, size, origin, axes: Axes { x, y, z } })
        }
    }
}
