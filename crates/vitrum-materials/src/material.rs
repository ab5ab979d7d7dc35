//! The closed family of materials.

use crate::scattering::{Scattering, unless_zero};
use crate::{ImageTexture, Media, Medium, Place, Texture};
use vitrum_bxdf::{
    Bxdf, Conductor, FresnelDielectric, Ggx, GlossySpecular, Interface, Lambertian, PerfectSpecular,
    PerfectTransmitter, RoughDielectric, ThinDielectric,
};
use vitrum_math::Rgb;

/// What a surface is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum Material {
    /// Diffuse reflection: a Phong material without highlight.
    Matte(Phong),
    /// Ambient, diffuse and highlight.
    Phong(Phong),
    /// Phong, and a mirror that reflects `kr`.
    Reflective {
        /// The Phong part.
        phong: Phong,
        /// Reflected share, per channel, 0 to 1.
        kr: Rgb,
    },
    /// Phong, and glass with constant coefficients.
    Transparent(Transparent),
    /// Glass and other clear media with Fresnel's reflectance, smooth or rough.
    Dielectric(Dielectric),
    /// A sheet of glass without thickness.
    Thin(ThinDielectric<f64>),
    /// Metal, smooth or rough.
    Conductor(Conductor<f64>),
    /// Sends out light on its front side.
    Emissive {
        /// Radiance.
        radiance: Texture,
    },
}

/// The parameters of B. Phong's illumination model, as textbooks have it.
///
/// | parameter | meaning | range |
/// |---|---|---|
/// | `colour` | of the ambient and diffuse parts | 0 to 1 per channel |
/// | `ka`, `kd` | ambient and diffuse coefficients; diffuse reflectance is kd · colour | 0 to 1 |
/// | `ks`, `exponent` | highlight: f = ks cos^exponent around the mirror direction | ≥ 0, ≥ 1 |
#[derive(Clone, Debug, PartialEq)]
pub struct Phong {
    /// Colour of the ambient and diffuse parts.
    pub colour: Texture,
    /// Ambient coefficient.
    pub ka: f64,
    /// Diffuse coefficient.
    pub kd: f64,
    /// Highlight coefficient, per channel.
    pub ks: Rgb,
    /// Highlight exponent.
    pub exponent: f64,
}

/// Glass with constant coefficients, under a Phong part that shows that it is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Transparent {
    /// The Phong part.
    pub phong: Phong,
    /// Reflected share, per channel, 0 to 1.
    pub kr: Rgb,
    /// Transmitted share, per channel, 0 to 1.
    pub kt: Rgb,
    /// The media outside (above) and inside (below).
    pub media: Media,
}

/// The surface of glass, as Fresnel's equations have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// Reflects and refracts.
    bxdf: Bxdf<f64>,
    /// Whether it makes up for the energy of repeated scattering.
    compensated: bool,
    media: Media,
}

impl Dielectric {
    /// A surface between two media, as rough as `roughness` says.
    pub fn new(media: Media, roughness: Ggx<f64>) -> Self {
        let interface = *media.interface();
        let bxdf = if roughness.is_smooth() {
            Bxdf::FresnelDielectric(FresnelDielectric { interface })
        } else {
            Bxdf::RoughDielectric(RoughDielectric::new(interface, roughness))
        };
        Self { bxdf, compensated: true, media }
    }

    /// The same without what makes up for the energy of repeated scattering in the roughness.
    #[must_use]
    pub fn single_scattering(self) -> Self {
        match self.bxdf {
            Bxdf::RoughDielectric(rough) => {
                let single = RoughDielectric::single_scattering(*self.media.interface(), *rough.roughness());
                Self { bxdf: Bxdf::RoughDielectric(single), compensated: false, ..self }
            }
            _ => self,
        }
    }

    /// The same surface with another medium outside.
    #[must_use]
    pub fn within(&self, outside: Medium) -> Self {
        let media = self.media.within(outside);
        match self.bxdf {
            Bxdf::RoughDielectric(rough) => {
                let same = Self::new(media, *rough.roughness());
                if self.compensated { same } else { same.single_scattering() }
            }
            _ => Self::new(media, Ggx::smooth()),
        }
    }

    /// What it divides.
    pub fn media(&self) -> &Media {
        &self.media
    }

    /// True where it has no roughness that scatters.
    pub fn is_smooth(&self) -> bool {
        self.bxdf.is_specular()
    }
}

impl Transparent {
    /// The part below Phong's.
    #[inline(always)]
    fn glass(&self, interface: &Interface<f64>) -> Bxdf<f64> {
        Bxdf::PerfectTransmitter(PerfectTransmitter { kr: self.kr, kt: self.kt, interface: *interface })
    }
}

impl Phong {
    /// No ambient, no diffuse, no highlight.
    pub const NONE: Self =
        Self { colour: Texture::Constant(Rgb::ONE), ka: 0.0, kd: 0.0, ks: Rgb::ZERO, exponent: 1.0 };

    #[inline(always)]
    fn scattering(&self, place: &mut impl Place) -> Scattering {
        let colour = if self.ka == 0.0 && self.kd == 0.0 { Rgb::ZERO } else { self.colour.at(place) };
        let reflectance = colour * self.kd;
        let ks = self.ks;
        Scattering {
            ambient: colour * self.ka,
            diffuse: unless_zero(reflectance, Lambertian { reflectance }),
            glossy: unless_zero(ks, GlossySpecular::unnormalised(ks, self.exponent)),
            ..Scattering::BLACK
        }
    }

    fn is_nothing(&self) -> bool {
        self.ka == 0.0 && self.kd == 0.0 && self.ks == Rgb::ZERO
    }
}

impl Material {
    /// The models at a place, which is asked for its point and its texture coordinates where a texture needs them.
    // Always, because what it returns is large and would be copied.
    #[inline(always)]
    pub fn scattering(&self, place: &mut impl Place) -> Scattering {
        match self {
            Self::Matte(phong) | Self::Phong(phong) => phong.scattering(place),
            Self::Reflective { phong, kr } => Scattering {
                body: unless_zero(*kr, Bxdf::PerfectSpecular(PerfectSpecular { kr: *kr })),
                ..phong.scattering(place)
            },
            Self::Transparent(t) => {
                Scattering { body: Some(t.glass(t.media.interface())), ..t.phong.scattering(place) }
            }
            Self::Dielectric(glass) => Scattering::of(glass.bxdf),
            Self::Thin(sheet) => Scattering::of(Bxdf::ThinDielectric(*sheet)),
            Self::Conductor(metal) => Scattering::of(Bxdf::Conductor(*metal)),
            Self::Emissive { radiance } => Scattering { emitted: radiance.at(place), ..Scattering::BLACK },
        }
    }

    /// The media on both sides, where the surface divides two.
    #[inline]
    pub fn media(&self) -> Option<&Media> {
        match self {
            Self::Transparent(t) => Some(&t.media),
            Self::Dielectric(glass) => Some(&glass.media),
            _ => None,
        }
    }

    /// The pair of indices, where the surface divides two media.
    pub fn interface(&self) -> Option<&Interface<f64>> {
        self.media().map(Media::interface)
    }

    /// What the surface does to light with another medium outside, where it divides two media: as [`scattering`](Self::scattering)
    /// has it in its specular or rough part.
    pub fn within(&self, outside: Medium) -> Option<Bxdf<f64>> {
        match self {
            Self::Transparent(t) => Some(t.glass(t.media.within(outside).interface())),
            Self::Dielectric(glass) => Some(glass.within(outside).bxdf),
            _ => None,
        }
    }

    /// True when crossing the surface changes nothing at all: the same index on both sides, nothing reflected, everything
    /// transmitted, no Phong part. Objects made of it are left out of the scene, so they are invisible to the last bit.
    pub fn is_invisible(&self) -> bool {
        self.is_clear() && self.media().is_some_and(Media::are_equal)
    }

    /// True when crossing the surface changes nothing but by the media on both sides.
    pub fn is_clear(&self) -> bool {
        match self {
            Self::Transparent(t) => t.phong.is_nothing() && t.kr == Rgb::ZERO && t.kt == Rgb::ONE,
            Self::Dielectric(_) => true,
            _ => false,
        }
    }

    /// The share that a straight shadow ray keeps when it crosses the surface, with another medium outside where one is given; zero for
    /// what is opaque.
    pub fn straight_transmittance(&self, outside: Option<Medium>) -> Rgb {
        match self {
            Self::Transparent(t) => t.kt,
            // What goes straight through at a right angle; the rest of a straight shadow's errors is larger.
            Self::Dielectric(glass) => {
                let media = outside.map_or(glass.media, |outside| glass.media.within(outside));
                Rgb::splat(1.0 - media.interface().reflectance(1.0).unpolarised())
            }
            Self::Thin(sheet) => sheet.shares(1.0).1,
            _ => Rgb::ZERO,
        }
    }

    /// True for glass: rays are refracted, and the object needs an inside.
    pub fn is_dielectric(&self) -> bool {
        self.interface().is_some()
    }

    /// True where light may be scattered into a range of directions about the mirror or refracted direction, which a ray
    /// tree of two children can't follow.
    pub fn is_rough(&self) -> bool {
        match self {
            Self::Dielectric(glass) => !glass.is_smooth(),
            Self::Conductor(metal) => !metal.is_specular(),
            _ => false,
        }
    }

    /// The Phong part, where there is one.
    pub fn phong(&self) -> Option<&Phong> {
        match self {
            Self::Matte(phong) | Self::Phong(phong) | Self::Reflective { phong, .. } => Some(phong),
            Self::Transparent(t) => Some(&t.phong),
            Self::Dielectric(_) | Self::Thin(_) | Self::Conductor(_) | Self::Emissive { .. } => None,
        }
    }

    /// The texture that its points ask for a colour, where they ask for one.
    pub fn texture(&self) -> Option<&Texture> {
        match self {
            Self::Emissive { radiance } => Some(radiance),
            _ => self.phong().filter(|p| p.ka > 0.0 || p.kd > 0.0).map(|p| &p.colour),
        }
    }

    /// The image that it shows, where it shows one: only then are texture coordinates worked out.
    pub fn image(&self) -> Option<&ImageTexture> {
        self.texture().and_then(Texture::image)
    }

    /// Its name in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Matte(_) => "matte",
            Self::Phong(_) => "phong",
            Self::Reflective { .. } => "reflective",
            Self::Transparent(_) => "transparent",
            Self::Dielectric(_) => "dielectric",
            Self::Thin(_) => "thin",
            Self::Conductor(_) => "conductor",
            Self::Emissive { .. } => "emissive",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Encoding, Image, IndexOfRefraction};
    use std::sync::Arc;
    use vitrum_math::{DVec2, DVec3};

    fn clear(ior: f64) -> Transparent {
        let inside = Medium::clear(IndexOfRefraction::new(ior).expect("valid"));
        let media = Media::new(Medium::AIR, inside);
        Transparent { phong: Phong::NONE, kr: Rgb::ZERO, kt: Rgb::ONE, media }
    }

    #[test]
    fn only_what_changes_nothing_is_invisible() {
        assert!(Material::Transparent(clear(1.0)).is_invisible());
        assert!(!Material::Transparent(clear(1.5)).is_invisible());
        assert!(!Material::Transparent(Transparent { kt: Rgb::splat(0.9), ..clear(1.0) }).is_invisible());
        let highlight = Phong { ks: Rgb::splat(0.2), ..Phong::NONE };
        assert!(!Material::Transparent(Transparent { phong: highlight, ..clear(1.0) }).is_invisible());
    }

    #[test]
    fn zero_coefficients_leave_no_parts() {
        let scattering = Material::Matte(Phong { ka: 1.0, ..Phong::NONE })
            .scattering(&mut (DVec3::ZERO, || -> DVec2 { unreachable!() }));
        assert!(!scattering.answers_lights() && scattering.specular().is_none());
        assert_eq!(scattering.ambient, Rgb::ONE);
        let scattering = Material::Reflective { phong: Phong::NONE, kr: Rgb::ZERO }
            .scattering(&mut (DVec3::ZERO, || -> DVec2 { unreachable!() }));
        assert_eq!(scattering, Scattering::BLACK);
    }

    /// Texture coordinates are worked out for an image that is looked at, and for nothing else.
    #[test]
    fn only_an_image_that_is_seen_asks_for_texture_coordinates() {
        let image = Image::from_bytes("red", [1, 1], vec![[255, 0, 0]], Encoding::Srgb).expect("valid");
        let colour = Texture::Image(ImageTexture::new(Arc::new(image)));
        let asks = |material: &Material| {
            let mut asked = false;
            let uv = || {
                asked = true;
                DVec2::ZERO
            };
            material.scattering(&mut (DVec3::ZERO, uv));
            assert_eq!(asked, material.image().is_some());
            asked
        };
        let with = |kd: f64| Phong { colour: colour.clone(), kd, ..Phong::NONE };
        assert!(asks(&Material::Matte(with(0.5))) && asks(&Material::Phong(with(0.5))));
        assert!(asks(&Material::Emissive { radiance: colour.clone() }));
        assert!(!asks(&Material::Reflective { phong: with(0.0), kr: Rgb::ONE }));
        assert!(!asks(&Material::Transparent(Transparent { phong: with(0.0), ..clear(1.5) })));
        assert!(!asks(&Material::Matte(Phong { kd: 0.5, ..Phong::NONE })));
        let red = Material::Matte(with(0.5)).scattering(&mut (DVec3::ZERO, || DVec2::ZERO));
        assert_eq!(red.diffuse.map(|d| d.reflectance), Some(Rgb::X * 0.5));
    }
}
