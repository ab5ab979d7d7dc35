//! Embree 4, loaded at run time: the handful of functions that the comparison calls.
//!
//! Types and numbers are those of Embree's public headers (`rtcore_ray.h`, `rtcore_common.h`, `rtcore_buffer.h`).
#![allow(unsafe_code, reason = "a C library is called; each block says why it may be")]

use libloading::{Library, Symbol};
use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::mem::ManuallyDrop;
use std::path::Path;
use std::ptr;

/// `RTCRayHit`, with room for the hit of a scene with instances.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(crate) struct RayHit {
    pub(crate) origin: [f32; 3],
    pub(crate) tnear: f32,
    pub(crate) direction: [f32; 3],
    pub(crate) time: f32,
    pub(crate) tfar: f32,
    pub(crate) mask: c_uint,
    pub(crate) id: c_uint,
    pub(crate) flags: c_uint,
    hit: [c_uint; 12],
}

/// Place of `geomID` in the hit.
const GEOMETRY: usize = 6;
const INVALID: c_uint = c_uint::MAX;

impl RayHit {
    pub(crate) fn new(origin: [f32; 3], direction: [f32; 3], tnear: f32, tfar: f32) -> Self {
        let hit = [INVALID; 12];
        Self { origin, tnear, direction, time: 0.0, tfar, mask: c_uint::MAX, id: 0, flags: 0, hit }
    }

    pub(crate) fn is_hit(&self) -> bool {
        self.hit[GEOMETRY] != INVALID
    }
}

type Query = unsafe extern "C" fn(*mut c_void, *mut RayHit, *const c_void);

/// A mesh in a scene of Embree's.
pub(crate) struct Scene {
    /// Never unloaded: its threads may still be on their way out.
    embree: ManuallyDrop<Library>,
    device: *mut c_void,
    scene: *mut c_void,
    intersect: Query,
    occluded: Query,
}

// SAFETY: Embree's scenes may be asked from any number of threads once they are committed, and they are never changed here.
unsafe impl Sync for Scene {}

/// How a scene is made.
#[derive(Clone, Copy)]
pub(crate) struct Options {
    pub(crate) robust: bool,
    pub(crate) threads: usize,
}

impl Scene {
    /// Loads the library and builds a scene at medium quality; the time of the build comes with it, in seconds.
    pub(crate) fn build(
        file: &Path,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        options: Options,
    ) -> Result<(Self, f64), libloading::Error> {
        // SAFETY: loading Embree runs its initialisers, which expect nothing; the functions below have the types of its
        // headers, and what is passed is as they ask: buffers have room for what is written, handles come from Embree.
        unsafe {
            let library = Library::new(file)?;
            let new_device: Symbol<'_, unsafe extern "C" fn(*const c_char) -> *mut c_void> =
                library.get(b"rtcNewDevice")?;
            let new_scene: Symbol<'_, unsafe extern "C" fn(*mut c_void) -> *mut c_void> =
                library.get(b"rtcNewScene")?;
            let set_flags: Symbol<'_, unsafe extern "C" fn(*mut c_void, c_int)> =
                library.get(b"rtcSetSceneFlags")?;
            let new_geometry: Symbol<'_, unsafe extern "C" fn(*mut c_void, c_int) -> *mut c_void> =
                library.get(b"rtcNewGeometry")?;
            let new_buffer: Symbol<
                '_,
                unsafe extern "C" fn(*mut c_void, c_int, c_uint, c_int, usize, usize) -> *mut c_void,
            > = library.get(b"rtcSetNewGeometryBuffer")?;
            let commit_geometry: Symbol<'_, unsafe extern "C" fn(*mut c_void)> =
                library.get(b"rtcCommitGeometry")?;
            let attach: Symbol<'_, unsafe extern "C" fn(*mut c_void, *mut c_void) -> c_uint> =
                library.get(b"rtcAttachGeometry")?;
            let commit: Symbol<'_, unsafe extern "C" fn(*mut c_void)> = library.get(b"rtcCommitScene")?;
            let intersect = *library.get::<Query>(b"rtcIntersect1")?;
            let occluded = *library.get::<Query>(b"rtcOccluded1")?;

            let config = CString::new(format!("threads={}", options.threads)).expect("no zero byte");
            let device = new_device(config.as_ptr());
            assert!(!device.is_null(), "Embree makes no device");
            let scene = new_scene(device);
            set_flags(scene, if options.robust { 4 } else { 0 });
            // RTC_GEOMETRY_TYPE_TRIANGLE; vertices RTC_FORMAT_FLOAT3, indices RTC_FORMAT_UINT3.
            let geometry = new_geometry(device, 0);
            let vertices = new_buffer(geometry, 1, 0, 0x9003, 12, positions.len());
            ptr::copy_nonoverlapping(positions.as_ptr(), vertices.cast(), positions.len());
            let indices = new_buffer(geometry, 0, 0, 0x5003, 12, triangles.len());
            ptr::copy_nonoverlapping(triangles.as_ptr(), indices.cast(), triangles.len());
            commit_geometry(geometry);
            attach(scene, geometry);
            let start = super::now();
            commit(scene);
            let seconds = start.elapsed().as_secs_f64();
            Ok((Self { embree: ManuallyDrop::new(library), device, scene, intersect, occluded }, seconds))
        }
    }

    /// The first hit: `tfar` becomes its distance.
    #[inline]
    pub(crate) fn intersect(&self, ray: &mut RayHit) {
        // SAFETY: the scene is committed and the ray is aligned and as large as Embree's; no arguments are the default ones.
        unsafe { (self.intersect)(self.scene, ray, ptr::null()) };
    }

    /// Any hit: `tfar` becomes negative infinity.
    #[inline]
    pub(crate) fn occluded(&self, ray: &mut RayHit) {
        // SAFETY: as above; only the part of the ray is read and written.
        unsafe { (self.occluded)(self.scene, ray, ptr::null()) };
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        for (release, handle) in [(&b"rtcReleaseScene"[..], self.scene), (b"rtcReleaseDevice", self.device)] {
            // SAFETY: both handles come from this library and are released once, the scene first.
            unsafe {
                let release: Symbol<'_, unsafe extern "C" fn(*mut c_void)> =
                    self.embree.get(release).expect("Embree has it");
                release(handle);
            }
        }
    }
}

/// Has subnormal numbers taken for zero while it lives, as Embree's manual recommends.
pub(crate) struct FlushToZero(u32);

impl FlushToZero {
    pub(crate) fn new() -> Self {
        let mut before = 0u32;
        // SAFETY: the control register of SSE is read and written; its two bits change nothing but subnormal numbers.
        unsafe {
            std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut before);
            let with = before | 0x8040;
            std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const with);
        }
        Self(before)
    }
}

impl Drop for FlushToZero {
    fn drop(&mut self) {
        // SAFETY: the register gets the value back that it had.
        unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const self.0) };
    }
}
