//! Cameras: from a point of the film to a ray.

use vitrum_math::{Bounds, DVec3, Ray, concentric_disk, unit};

/// How directions map to the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Everything is sharp.
    Pinhole {
        /// Vertical field of view, radians, between 0 and π.
        fov: f64,
    },
    /// One distance is sharp.
    ThinLens {
        /// Vertical field of view, radians, between 0 and π.
        fov: f64,
        /// Radius of the lens, metres.
        lens_radius: f64,
        /// Distance of the sharp plane along the view direction, metres.
        focus_distance: f64,
    },
    /// Parallel rays.
    Orthographic {
        /// Height of the picture, metres.
        height: f64,
    },
}

/// A camera in its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: DVec3,
    forward: DVec3,
    /// Half the width per half height of the picture, and half the height, each per unit of distance (metres for an
    /// orthographic camera), as vectors.
    right: DVec3,
    up: DVec3,
    projection: Projection,
}

/// A view that can't be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// Position and target coincide, or are not finite.
    #[error("the camera's position and target are the same point, so it looks nowhere")]
    NoDirection,
    /// `up` is parallel to the view.
    #[error("the camera's `up` is parallel to its view, so the picture has no upright")]
    NoUpright,
}

impl Camera {
    /// A camera at `position` that looks at `target`, with `up` upright in the picture.
    ///
    /// # Errors
    /// [`CameraError`] when the view has no direction or no upright.
    pub fn new(
        position: DVec3,
        target: DVec3,
        up: DVec3,
        projection: Projection,
    ) -> Result<Self, CameraError> {
        let view = target - position;
        if view == DVec3::ZERO || !view.is_finite() {
            return Err(CameraError::NoDirection);
        }
        let forward = view / view.length();
        let side = forward.cross(up);
        // Parallel to within a few roundings: the cross product is then noise.
        if side.length() <= 1e-12 * up.length() {
            return Err(CameraError::NoUpright);
        }
        let right = unit(side);
        let up = right.cross(forward);
        let half_height = match projection {
            Projection::Pinhole { fov } | Projection::ThinLens { fov, .. } => libm::tan(0.5 * fov),
            Projection::Orthographic { height } => 0.5 * height,
        };
        Ok(Self { position, forward, right: right * half_height, up: up * half_height, projection })
    }

    /// True when a ray needs a point on the lens.
    pub fn has_lens(&self) -> bool {
        matches!(self.projection, Projection::ThinLens { lens_radius, .. } if lens_radius > 0.0)
    }

    /// False where `up` was so nearly parallel to the view that the axes of the picture are not perpendicular to it.
    pub(crate) fn is_square(&self) -> bool {
        [self.right, self.up].iter().all(|axis| self.forward.dot(*axis).abs() <= 1e-12 * axis.length())
    }

    /// Where the camera stands, metres.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// A box around all points at which rays start.
    pub(crate) fn origins(&self, [width, height]: [u32; 2]) -> Bounds {
        let radius = match self.projection {
            Projection::Pinhole { .. } => 0.0,
            Projection::ThinLens { lens_radius, .. } => lens_radius,
            Projection::Orthographic { .. } => {
                // To a corner, and a pixel farther, where filters reach.
                let across = 1.0 + f64::from(width) / f64::from(height);
                (across + 4.0 / f64::from(height)) * self.up.length().max(self.right.length())
            }
        };
        Bounds { min: self.position, max: self.position }.padded(radius)
    }

    /// How it maps directions to the film.
    pub fn projection(&self) -> &Projection {
        &self.projection
    }

    /// From the middle of the film to a point of it, per unit of distance.
    #[inline]
    fn across(&self, x: f64, y: f64, [width, height]: [u32; 2]) -> DVec3 {
        let (width, height) = (f64::from(width), f64::from(height));
        self.right * ((2.0 * x - width) / height) + self.up * (1.0 - 2.0 * y / height)
    }

    /// Where rays of a pinhole camera go, linear in the film point; of any length.
    pub(crate) fn towards(&self, x: f64, y: f64, size: [u32; 2]) -> DVec3 {
        self.forward + self.across(x, y, size)
    }

    /// The film point, times a depth, of a point at `offset` from the middle of the lens; and the depth, which is not above 0 for
    /// what is behind a camera that sees from a point.
    pub(crate) fn on_film(&self, offset: DVec3, [width, height]: [u32; 2]) -> [f64; 3] {
        let depth = match self.projection {
            Projection::Pinhole { .. } | Projection::ThinLens { .. } => self.forward.dot(offset),
            Projection::Orthographic { .. } => 1.0,
        };
        let along = |axis: DVec3| axis.dot(offset) / axis.dot(axis);
        let (width, height) = (f64::from(width), f64::from(height));
        let x = 0.5 * (width * depth + height * along(self.right));
        let y = 0.5 * height * (depth - along(self.up));
        [x, y, depth]
    }

    /// The ray of the film point `(x, y)`, in pixels from the upper left corner of an image of `size` pixels. `lens` gives a
    /// point of the unit square, and is asked only by a camera with a lens.
    #[inline]
    pub fn ray(&self, x: f64, y: f64, size: [u32; 2], lens: impl FnOnce() -> [f64; 2]) -> Ray {
        let across = self.across(x, y, size);
        match self.projection {
            Projection::Pinhole { .. } => Ray::new(self.position, unit(self.forward + across)),
            Projection::Orthographic { .. } => Ray::new(self.position + across, self.forward),
            Projection::ThinLens { lens_radius, focus_distance, fov: _ } => {
                let sharp = (self.forward + across) * focus_distance;
                let on_lens = concentric_disk(lens()) * lens_radius;
                let offset = unit(self.right) * on_lens.x + unit(self.up) * on_lens.y;
                Ray::new(self.position + offset, unit(sharp - offset))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(projection: Projection) -> Camera {
        Camera::new(DVec3::new(0.0, 1.0, 4.0), DVec3::new(0.0, 1.0, 0.0), DVec3::Y, projection)
            .expect("valid")
    }

    #[test]
    fn the_middle_of_the_film_sees_the_target_and_the_corners_span_the_angle() {
        let c = camera(Projection::Pinhole { fov: core::f64::consts::FRAC_PI_2 });
        let ray = |x, y| c.ray(x, y, [200, 100], || unreachable!("no lens"));
        assert!((ray(100.0, 50.0).direction - -DVec3::Z).length() < 1e-15);
        assert!((ray(100.0, 0.0).direction - unit(DVec3::new(0.0, 1.0, -1.0))).length() < 1e-15, "up is up");
        assert!(
            (ray(200.0, 50.0).direction - unit(DVec3::new(2.0, 0.0, -1.0))).length() < 1e-15,
            "right is right"
        );
    }

    #[test]
    fn orthographic_rays_are_parallel_and_a_height_apart() {
        let c = camera(Projection::Orthographic { height: 3.0 });
        let ray = |x, y| c.ray(x, y, [100, 100], || unreachable!("no lens"));
        assert_eq!(ray(0.0, 0.0).direction, -DVec3::Z);
        assert!((ray(50.0, 0.0).origin - DVec3::new(0.0, 2.5, 4.0)).length() < 1e-15);
    }

    #[test]
    fn all_rays_of_one_film_point_meet_at_the_focus() {
        let c = camera(Projection::ThinLens { fov: 0.7, lens_radius: 0.1, focus_distance: 2.0 });
        let at = |u| {
            let ray = c.ray(13.0, 71.0, [100, 80], || u);
            ray.at((2.0 - ray.origin.z) / ray.direction.z)
        };
        for u in [[0.1, 0.9], [0.5, 0.0], [0.99, 0.3]] {
            assert!((at(u) - at([0.5, 0.5])).length() < 1e-14);
        }
    }

    #[test]
    fn impossible_views_are_refused() {
        let pinhole = Projection::Pinhole { fov: 1.0 };
        let new = |target, up| Camera::new(DVec3::ZERO, target, up, pinhole);
        assert_eq!(new(DVec3::ZERO, DVec3::Y), Err(CameraError::NoDirection));
        assert_eq!(new(DVec3::Y, DVec3::Y), Err(CameraError::NoUpright));
        assert_eq!(new(DVec3::X, DVec3::ZERO), Err(CameraError::NoUpright));
    }
}
