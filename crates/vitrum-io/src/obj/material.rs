//! What a material of an MTL file means to a renderer of glass.
//!
//! MTL was made for shaded polygons: nothing in it says "glass" for certain, and programs disagree about what they
//! write. The first row that fits decides:
//!
//! | the material has | meaning | parameters |
//! |---|---|---|
//! | `Ke` above 0 | emissive | radiance = `Ke` |
//! | `illum` 4, 6, 7 or 9 | glass | index = `Ni` (1.5 if not given), tint = `Tf` (white) |
//! | `illum` 3, 5 or 8 and `Ks` above 0 | mirror | kr = `Ks` |
//! | `Ni` above 1 and (`illum` 10 or `Tf` neither white nor black) | glass | as above |
//! | `Ks` above 0, and `illum` 2 or more or not given | Phong | colour = `Kd`, ks = `Ks`, exponent = `Ns` (1, at least 1) |
//! | anything else | matte | colour = `Kd` (0.8 grey) |
//!
//! - `Ni` alone is no glass: Blender writes 1.45 into every material. Neither is `Tf` alone: 3ds Max writes black, and
//!   others white, into every opaque one.
//! - `d` (and `Tr` = 1 − d) is *coverage*, the part of the surface that is there, and not transmission: light that
//!   goes through does not bend. It is never read as glass, never used, and said.
//! - `map_Kd` takes the place of the colour of Phong and matte materials, times `Kd` (white if not given).
//! - `Tf` filters light once at each crossing of the surface, whatever the thickness.
//!
//! Source: Alias Wavefront, MTL material format, 1995 (illumination models 0 to 10).

use vitrum_math::{DVec2, Rgb};

/// A material as an MTL file gives it; `None` where it says nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MtlMaterial {
    /// Name, as in `newmtl` and `usemtl`; empty for the one of faces that name none.
    pub name: String,
    /// False if the OBJ file uses the name, but no library that could be read defines it.
    pub is_defined: bool,
    /// `Kd`: diffuse colour, 0 to 1.
    pub kd: Option<Rgb>,
    /// `Ks`: specular colour, 0 to 1.
    pub ks: Option<Rgb>,
    /// `Ke`: emitted radiance, 0 or more.
    pub ke: Option<Rgb>,
    /// `Tf`: transmission filter, 0 to 1.
    pub tf: Option<Rgb>,
    /// `Ns`: exponent of the highlight, 0 or more.
    pub ns: Option<f64>,
    /// `Ni`: index of refraction, 0.001 to 10.
    pub ni: Option<f64>,
    /// `d`, or 1 − `Tr`: coverage, 0 to 1.
    pub d: Option<f64>,
    /// `illum`: illumination model, 0 to 10.
    pub illum: Option<u32>,
    /// `map_Kd`: an image, which `Kd` is multiplied by.
    pub map_kd: Option<MtlMap>,
}

/// An image of an MTL file. The place in it is uv times `scale` plus `offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMap {
    /// Its path, from the folder of the OBJ file.
    pub file: String,
    /// `-s`: how often it repeats.
    pub scale: DVec2,
    /// `-o`: the place in it of u = v = 0.
    pub offset: DVec2,
    /// `-clamp on`: beyond its edges are their colours, and not the image again.
    pub clamp: bool,
}

/// What an [`MtlMaterial`] stands for, decided by the table in the module's manual. Colours are linear Rec.709.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MtlMeaning {
    /// Diffuse reflection.
    Matte {
        /// Reflectance, 0 to 1.
        color: Rgb,
    },
    /// Diffuse reflection and a highlight.
    Phong {
        /// Diffuse reflectance, 0 to 1.
        color: Rgb,
        /// Strength of the highlight, 0 to 1.
        ks: Rgb,
        /// Exponent of the highlight, at least 1.
        exponent: f64,
    },
    /// A clear solid that bends light.
    Glass {
        /// Index of refraction, inside over outside, 0.001 to 10.
        ior: f64,
        /// Filter at each crossing of the surface, 0 to 1.
        tint: Rgb,
    },
    /// Perfect reflection.
    Mirror {
        /// Reflectance, 0 to 1.
        kr: Rgb,
    },
    /// A surface that shines.
    Emissive {
        /// Emitted radiance, 0 or more.
        radiance: Rgb,
    },
}

/// Diffuse reflectance where a file gives none.
const GREY: Rgb = Rgb::splat(0.8);
/// Index of refraction of glass where a file gives none.
const GLASS_IOR: f64 = 1.5;

impl MtlMaterial {
    /// A material of which nothing is known but its name.
    pub fn undefined(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// What the material stands for: see the table in the module's manual.
    pub fn meaning(&self) -> MtlMeaning {
        let color = self.kd.unwrap_or(GREY);
        let ks = self.ks.unwrap_or(Rgb::ZERO);
        let ke = self.ke.unwrap_or(Rgb::ZERO);
        let tf = self.tf.unwrap_or(Rgb::ONE);
        let glass = MtlMeaning::Glass { ior: self.ni.unwrap_or(GLASS_IOR), tint: tf };
        let is_tinted = tf != Rgb::ONE && tf != Rgb::ZERO;
        let bends = self.ni.is_some_and(|ni| ni > 1.0);
        match self.illum {
            _ if ke != Rgb::ZERO => MtlMeaning::Emissive { radiance: ke },
            Some(4 | 6 | 7 | 9) => glass,
            Some(3 | 5 | 8) if ks != Rgb::ZERO => MtlMeaning::Mirror { kr: ks },
            illum if bends && (illum == Some(10) || is_tinted) => glass,
            None | Some(2..) if ks != Rgb::ZERO => {
                MtlMeaning::Phong { color, ks, exponent: self.ns.unwrap_or(1.0).max(1.0) }
            }
            _ => MtlMeaning::Matte { color },
        }
    }

    /// What a user should know about the choice: a sentence for each assumption that [`Self::meaning`] makes.
    pub fn remarks(&self) -> Vec<String> {
        let name = &self.name;
        let mut remarks = Vec::new();
        let is_glass = matches!(self.meaning(), MtlMeaning::Glass { .. });
        match self.d {
            Some(d) if d < 1.0 && !is_glass => remarks.push(format!(
                "material `{name}` has d = {d} (d, or 1 - Tr): that is coverage, not transmission, and is not used; \
                 for glass write `illum 7` and `Ni`, or give the object a material in the scene"
            )),
            _ => {}
        }
        let has_colour = matches!(self.meaning(), MtlMeaning::Matte { .. } | MtlMeaning::Phong { .. });
        if self.map_kd.is_some() && !has_colour {
            remarks.push(format!("material `{name}` has no diffuse colour, so its map_Kd is not used"));
        }
        match self.ni {
            None if is_glass => remarks.push(format!(
                "material `{name}` is glass without an index of refraction; {GLASS_IOR} is taken, write `Ni` to change it"
            )),
            Some(1.0) if is_glass => remarks.push(format!(
                "material `{name}` is glass with index of refraction 1, which bends nothing; write `Ni` to change it"
            )),
            _ => {}
        }
        remarks
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(edit: impl FnOnce(&mut MtlMaterial)) -> MtlMaterial {
        let mut material = MtlMaterial::undefined("m");
        edit(&mut material);
        material
    }

    #[test]
    fn every_row_of_the_table() {
        let half = Rgb::splat(0.5);
        let matte = MtlMeaning::Matte { color: half };
        let glass = |ior, tint| MtlMeaning::Glass { ior, tint };
        let meaning = |edit: fn(&mut MtlMaterial)| {
            material(|m| {
                m.kd = Some(Rgb::splat(0.5));
                edit(m);
            })
            .meaning()
        };
        assert_eq!(meaning(|m| m.ke = Some(Rgb::X)), MtlMeaning::Emissive { radiance: Rgb::X });
        for illum in [4, 6, 7, 9] {
            assert_eq!(material(|m| m.illum = Some(illum)).meaning(), glass(1.5, Rgb::ONE));
        }
        assert_eq!(
            meaning(|m| (m.illum, m.ni, m.tf) = (Some(7), Some(1.33), Some(Rgb::Y))),
            glass(1.33, Rgb::Y)
        );
        for illum in [3, 5, 8] {
            let mirror = material(|m| (m.illum, m.ks) = (Some(illum), Some(half)));
            assert_eq!(mirror.meaning(), MtlMeaning::Mirror { kr: half });
        }
        assert_eq!(meaning(|m| m.illum = Some(3)), matte, "a mirror that reflects nothing is none");
        assert_eq!(
            meaning(|m| (m.ni, m.tf) = (Some(1.5), Some(Rgb::splat(0.9)))),
            glass(1.5, Rgb::splat(0.9))
        );
        assert_eq!(meaning(|m| (m.ni, m.illum) = (Some(1.5), Some(10))), glass(1.5, Rgb::ONE));
        assert_eq!(meaning(|m| (m.ni, m.illum) = (Some(1.45), Some(2))), matte, "Blender's default");
        assert_eq!(meaning(|m| (m.ni, m.tf) = (Some(1.5), Some(Rgb::ZERO))), matte, "3ds Max's default");
        assert_eq!(meaning(|m| (m.ni, m.tf) = (Some(1.0), Some(Rgb::Y))), matte);
        let phong = |exponent| MtlMeaning::Phong { color: half, ks: Rgb::ONE, exponent };
        assert_eq!(meaning(|m| (m.ks, m.ns) = (Some(Rgb::ONE), Some(96.0))), phong(96.0));
        assert_eq!(meaning(|m| (m.ks, m.ns, m.illum) = (Some(Rgb::ONE), Some(0.0), Some(2))), phong(1.0));
        assert_eq!(meaning(|m| (m.ks, m.illum) = (Some(Rgb::ONE), Some(1))), matte);
        assert_eq!(MtlMaterial::undefined("m").meaning(), MtlMeaning::Matte { color: GREY });
    }

    #[test]
    fn coverage_is_no_glass_and_said() {
        let thin = material(|m| m.d = Some(0.2));
        assert!(matches!(thin.meaning(), MtlMeaning::Matte { .. }));
        assert!(thin.remarks()[0].contains("coverage, not transmission"));
        assert!(material(|m| (m.d, m.illum, m.ni) = (Some(0.2), Some(7), Some(1.5))).remarks().is_empty());
        assert!(material(|m| m.illum = Some(7)).remarks()[0].contains("1.5 is taken"));
        assert!(material(|m| (m.illum, m.ni) = (Some(7), Some(1.0))).remarks()[0].contains("bends nothing"));
    }
}
