//! What a scene may need, one name for each: what the [`Plan`](crate::Plan) decides on, and what `inspect` lists.
//!
//! A feature that a scene does not need executes none of its instructions. So that this can be tested, builds with debug assertions
//! count every use; in all others counting is nothing.

/// Something that rendering does for those scenes that need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Lights are asked at what can answer them.
    Lights,
    /// Objects are searched on the way to lights.
    ShadowRays,
    /// Ambient light is added.
    AmbientLight,
    /// Rays are refracted.
    Refraction,
    /// Media take their share of each segment.
    Absorption,
    /// Rays know which solids they are in.
    NestedMedia,
    /// Light that is asked for goes through sheets of glass.
    ThinSheets,
    /// Glass and metal scatter into a range of directions.
    Roughness,
    /// Mirrors and metals reflect.
    Mirrors,
    /// Colours vary in space.
    Textures,
    /// Texture coordinates are worked out.
    Images,
    /// Triangles are searched in their trees.
    Meshes,
    /// Normals are interpolated.
    SmoothNormals,
    /// Objects are searched in a tree.
    ObjectTree,
    /// Rays start from points of a lens.
    Lens,
    /// Shadow rays go through glass.
    StraightShadows,
}

impl Feature {
    /// All of them.
    pub const ALL: [Self; 16] = [
        Self::Lights,
        Self::ShadowRays,
        Self::AmbientLight,
        Self::Refraction,
        Self::Absorption,
        Self::NestedMedia,
        Self::ThinSheets,
        Self::Roughness,
        Self::Mirrors,
        Self::Textures,
        Self::Images,
        Self::Meshes,
        Self::SmoothNormals,
        Self::ObjectTree,
        Self::Lens,
        Self::StraightShadows,
    ];

    /// Whether this build has it. All builds for users have everything; `RUSTFLAGS='--cfg vitrum_without="absorption"'` leaves one
    /// out, to count what carrying it costs scenes without it (`benches/skip.py`).
    pub const fn is_built(self) -> bool {
        match self {
            Self::Lights => cfg!(not(vitrum_without = "lights")),
            Self::Absorption => cfg!(not(vitrum_without = "absorption")),
            Self::NestedMedia => cfg!(not(vitrum_without = "nested media")),
            Self::ThinSheets => cfg!(not(vitrum_without = "thin sheets")),
            Self::Images => cfg!(not(vitrum_without = "images")),
            _ => true,
        }
    }

    /// What reports call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lights => "lights",
            Self::ShadowRays => "shadow rays",
            Self::AmbientLight => "ambient",
            Self::Refraction => "refraction",
            Self::Absorption => "absorption",
            Self::NestedMedia => "nested media",
            Self::ThinSheets => "thin sheets",
            Self::Roughness => "rough glass, metal",
            Self::Mirrors => "mirrors",
            Self::Textures => "textures",
            Self::Images => "images",
            Self::Meshes => "meshes",
            Self::SmoothNormals => "smooth normals",
            Self::ObjectTree => "object tree",
            Self::Lens => "lens",
            Self::StraightShadows => "straight shadows",
        }
    }
}

// The last one is the last of the list, so that the list has them all.
const _: () = assert!(Feature::ALL.len() == Feature::StraightShadows as usize + 1);

/// How often each feature was used. Always zero in builds without debug assertions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Uses([u64; Feature::ALL.len()]);

impl Uses {
    /// Whether this build counts.
    pub const ARE_COUNTED: bool = cfg!(debug_assertions);

    #[inline(always)]
    pub(crate) fn count(&mut self, feature: Feature) {
        if Self::ARE_COUNTED {
            self.0[feature as usize] += 1;
        }
    }

    /// Of a feature.
    pub fn of(&self, feature: Feature) -> u64 {
        self.0[feature as usize]
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(sum, more)| *sum += more);
    }
}
