//! Media, textures and materials: names become values.

use crate::diagnostic::{Diagnostics, Source};
use crate::obj::MtlMeaning;
use crate::scene::{self, ColourOrTexture, Index, Model, Pattern, SceneDesc};
use std::collections::BTreeMap;
use vitrum_bxdf::{ComplexIndex, Conductor, Ggx, Interface, ThinDielectric};
use vitrum_materials::{
    Absorption, Axes, Checker, Dielectric, IndexOfRefraction, Material, Media, Phong, Texture, Transparent,
};
use vitrum_math::Rgb;

/// What of glass reflects and transmits where a model file only says that it is glass.
const MODEL_KR: f64 = 0.1;
const MODEL_KT: f64 = 0.9;

/// The values behind the names of a scene.
pub(super) struct Matter<'d> {
    media: BTreeMap<&'d str, (f64, scene::Absorption)>,
    textures: BTreeMap<&'d str, Texture>,
    materials: BTreeMap<&'d str, &'d scene::Material>,
    /// What surrounds everything.
    pub(super) medium: IndexOfRefraction,
    /// What that absorbs.
    pub(super) absorption: Absorption,
}

impl<'d> Matter<'d> {
    pub(super) fn new(desc: &'d SceneDesc) -> Self {
        let clear = scene::Absorption::Clear;
        let predefined = scene::schema::PREDEFINED_MEDIA.iter().map(|&(name, ior)| (name, (ior, clear)));
        let declared = desc.media.iter().map(|m| (m.name.text.as_str(), (m.ior, m.absorption)));
        let media: BTreeMap<_, _> = predefined.chain(declared).collect();
        let around = media.get(desc.surroundings.text.as_str()).and_then(|medium| valid(medium).ok());
        let (medium, absorption) = around.unwrap_or((IndexOfRefraction::AIR, Absorption::NONE));
        Self {
            medium,
            absorption,
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
        self.media.iter().map(|(name, (ior, _))| ((*name).to_owned(), *ior)).collect()
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

    /// The medium of that name: its index, and what it absorbs.
    pub(super) fn medium_of(&self, name: &scene::Name) -> Result<(IndexOfRefraction, Absorption), String> {
        let known = self.media.get(name.text.as_str());
        valid(known.ok_or_else(|| format!("there is no medium `{}`", name.text))?)
    }

    /// The medium of that name, or the scene's.
    fn outside(&self, name: Option<&scene::Name>) -> Result<(IndexOfRefraction, Absorption), String> {
        name.map_or(Ok((self.medium, self.absorption)), |name| self.medium_of(name))
    }

    fn dielectric(
        &self,
        inside: &Index,
        outside: Option<&scene::Name>,
        roughness: f64,
        absorbed: scene::Absorption,
    ) -> Result<Dielectric, String> {
        let (above, outside) = self.outside(outside)?;
        let (interface, inside) = match inside {
            Index::Absolute(n) => (between(above, IndexOfRefraction::new(*n))?, absorption(absorbed)?),
            Index::Relative(ratio) => (between(above, above.times(*ratio))?, absorption(absorbed)?),
            Index::Medium(name) => {
                let (below, inside) = self.medium_of(name)?;
                (between(above, Ok(below))?, inside)
            }
        };
        Ok(Dielectric::new(interface, ggx(roughness)?, Media { outside, inside }))
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
                let (above, outside) = self.outside(outside.as_ref())?;
                let interface = between(above, above.times(*ior))?;
                let media = Media { outside, inside: Absorption::NONE };
                Material::Transparent(Transparent {
                    phong: self.phong(phong)?,
                    kr: *kr,
                    kt: *kt,
                    interface,
                    media,
                })
            }
            Model::Dielectric { inside, outside, roughness, compensation, absorption } => {
                let glass = self.dielectric(inside, outside.as_ref(), *roughness, *absorption)?;
                Material::Dielectric(if *compensation { glass } else { glass.single_scattering() })
            }
            Model::Thin { ior, outside, transmittance } => {
                let (above, _) = self.outside(outside.as_ref())?;
                let interface = between(above, IndexOfRefraction::new(*ior))?;
                Material::Thin(ThinDielectric { interface, transmittance: *transmittance })
            }
            Model::Conductor { n, k, outside, roughness } => {
                let (above, _) = self.outside(outside.as_ref())?;
                let index = ComplexIndex::new(*n, *k, above.value()).map_err(|e| e.to_string())?;
                Material::Conductor(Conductor { index, roughness: ggx(*roughness)? })
            }
        })
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
                interface: between(self.medium, self.medium.times(ior))?,
                media: Media { outside: self.absorption, inside: Absorption::NONE },
            }),
        })
    }
}

/// The interface between two media. Relative indices have been made absolute by now, so that they have no history.
fn between(
    above: IndexOfRefraction,
    below: Result<IndexOfRefraction, vitrum_materials::InvalidIndex>,
) -> Result<Interface<f64>, String> {
    let below = below.map_err(|e| e.to_string())?;
    Interface::new(above.value(), below.value()).map_err(|e| e.to_string())
}

fn valid(&(ior, absorbed): &(f64, scene::Absorption)) -> Result<(IndexOfRefraction, Absorption), String> {
    Ok((IndexOfRefraction::new(ior).map_err(|e| e.to_string())?, absorption(absorbed)?))
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

fn texture(pattern: &Pattern) -> Texture {
    match *pattern {
        Pattern::Checker { even, odd, size, origin, axes: [x, y, z] } => {
            Texture::Checker(Checker { even, odd, size, origin, axes: Axes { x, y, z } })
        }
    }
}
