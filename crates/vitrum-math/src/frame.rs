//! Orthonormal frames around a normal.

use crate::DVec3;

/// A right-handed orthonormal frame whose third axis is a given normal. Scattering models work in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    x: DVec3,
    y: DVec3,
    z: DVec3,
}

impl Frame {
    /// The frame around the unit vector `normal` (Duff et al., Building an Orthonormal Basis, Revisited, 2017):
    /// continuous but at the equator's sign change, and free of branches.
    #[inline]
    pub fn around(normal: DVec3) -> Self {
        let sign = 1.0f64.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            x: DVec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x),
            y: DVec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            z: normal,
        }
    }

    /// The third axis: the normal that the frame was made around.
    #[inline]
    pub const fn normal(&self) -> DVec3 {
        self.z
    }

    /// A world vector in this frame.
    #[inline]
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// A vector of this frame in the world.
    #[inline]
    pub fn to_world(&self, v: DVec3) -> DVec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::unit;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for n in [
            DVec3::X,
            -DVec3::Z,
            DVec3::Z,
            unit(DVec3::new(1e-9, -1e-9, -1.0)),
            unit(DVec3::new(1.0, -2.0, 0.5)),
        ] {
            let f = Frame::around(n);
            for (a, b, expected) in
                [(f.x, f.x, 1.0), (f.y, f.y, 1.0), (f.x, f.y, 0.0), (f.x, n, 0.0), (f.y, n, 0.0)]
            {
                assert!((a.dot(b) - expected).abs() < 4e-16, "{n:?}");
            }
            assert!((f.x.cross(f.y) - n).length() < 4e-16);
            let v = DVec3::new(0.3, -0.7, 0.2);
            assert!((f.to_world(f.to_local(v)) - v).length() < 4e-16);
        }
    }
}
