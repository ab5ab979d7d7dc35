//! From linear radiance to the eight bits of a display: exposure, tone curve, sRGB.
//!
//! 1. Exposure: each stop doubles.
//! 2. Tone curve. `Clip` keeps every value up to 1 as it is and cuts what is above. `Neutral` is the Khronos PBR
//!    Neutral tone mapper (E. Chalmers and others, Khronos Group, 2024): base colours keep their hue and saturation, as
//!    they would be seen under grey light, and only what is brighter than 0.8 is compressed towards white. That keeps
//!    the tint of glass, which other film-like curves bleach.
//! 3. The transfer function of sRGB (IEC 61966-2-1) and rounding to the nearest of 256 steps.
//!
//! A channel that is not a number or negative becomes 0, an infinite one the brightest there is. All transcendental
//! functions are `libm`'s, so that the bytes are the same on every machine.

/// How a picture is brought to a display. The default changes nothing that a display can show.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Display {
    /// Exposure in stops, added to the picture's own: 1 is twice as bright. Usual range −10 to 10.
    pub exposure_stops: f64,
    /// What happens to values that a display cannot show.
    pub tone: Tone,
}

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// Values above 1 are cut off.
    #[default]
    Clip,
    /// Khronos PBR Neutral: highlights roll off towards white, other colours stay.
    Neutral,
}

impl Tone {
    /// The name in scene files and image metadata.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Clip => "clip",
            Self::Neutral => "neutral",
        }
    }
}

impl Display {
    /// Encodes one pixel of linear Rec.709 radiance as sRGB.
    pub fn encode(self, pixel: [f32; 3]) -> [u8; 3] {
        self.encoder()(pixel)
    }

    /// [`Self::encode`] for many pixels.
    pub(super) fn encoder(self) -> impl Fn([f32; 3]) -> [u8; 3] {
        let scale = libm::exp2(self.exposure_stops);
        move |pixel| {
            let exposed = pixel.map(|channel| displayable(f64::from(channel) * scale));
            let toned = match self.tone {
                Tone::Clip => exposed,
                Tone::Neutral => neutral(exposed),
            };
            toned.map(quantised)
        }
    }
}

/// Stands for infinity where infinity itself would give no number.
const BRIGHTEST: f64 = 1e30;

/// A value from 0 to the brightest; 0 for what is no number.
fn displayable(channel: f64) -> f64 {
    if channel > 0.0 { channel.min(BRIGHTEST) } else { 0.0 }
}

/// Khronos PBR Neutral, for values of 0 or more. The constants and names are those of its specification.
fn neutral(color: [f64; 3]) -> [f64; 3] {
    const F90_OFFSET: f64 = 0.04;
    const START_COMPRESSION: f64 = 0.8 - F90_OFFSET;
    const DESATURATION: f64 = 0.15;
    let least = color[0].min(color[1]).min(color[2]);
    let offset =
        if least < 2.0 * F90_OFFSET { least - least * least / (4.0 * F90_OFFSET) } else { F90_OFFSET };
    let color = color.map(|channel| channel - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < START_COMPRESSION {
        return color;
    }
    let room = 1.0 - START_COMPRESSION;
    let new_peak = 1.0 - room * room / (peak + room - START_COMPRESSION);
    let towards_white = 1.0 - 1.0 / (DESATURATION * (peak - new_peak) + 1.0);
    color.map(|channel| {
        let compressed = channel * (new_peak / peak);
        compressed + (new_peak - compressed) * towards_white
    })
}

/// The nearest of the 256 steps of sRGB.
fn quantised(linear: f64) -> u8 {
    // The cast cuts off what is above 255 and turns what is no number into 0.
    (255.0 * srgb(linear) + 0.5) as u8
}

/// The transfer function of sRGB, IEC 61966-2-1.
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clip(value: f32) -> u8 {
        Display::default().encode([value; 3])[1]
    }

    #[test]
    fn published_values_of_srgb() {
        // Mid grey, half, and the foot of the curve (0.0031308 is 10.3 of 255).
        let cases = [(0.0, 0), (0.18, 118), (0.5, 188), (1.0, 255), (0.214_041_14, 128), (0.003_130_8, 10)];
        for (linear, expected) in cases {
            assert_eq!(clip(linear), expected, "{linear}");
        }
        let steps: Vec<u8> = (0..=1000).map(|i| clip(i as f32 / 1000.0)).collect();
        assert!(steps.is_sorted());
    }

    #[test]
    fn every_step_decodes_to_itself() {
        for step in 0..=255_u8 {
            let encoded = f64::from(step) / 255.0;
            let linear =
                if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) };
            assert_eq!(clip(linear as f32), step);
        }
    }

    #[test]
    fn exposure_doubles_with_each_stop() {
        let display = Display { exposure_stops: 1.0, tone: Tone::Clip };
        assert_eq!(display.encode([0.25, 0.09, 3.0]), [188, 118, 255]);
    }

    #[test]
    fn neutral_keeps_base_colours_and_never_reaches_white() {
        // Below the compression only the 4 % of a dielectric's reflection go.
        let kept = neutral([0.5, 0.3, 0.2]);
        let expected = [0.46, 0.26, 0.16];
        for channel in 0..3 {
            assert!((kept[channel] - expected[channel]).abs() < 1e-15);
        }
        // 1 -> 0.96, and 1 - 0.24^2 / (0.96 + 0.24 - 0.76) = 0.86909...
        assert!((neutral([1.0; 3])[0] - (1.0 - 0.0576 / 0.44)).abs() < 1e-15);
        // x - 6.25 x^2 is taken off below 0.08: 6.25 x^2 is left.
        assert!((neutral([0.04; 3])[0] - 0.01).abs() < 1e-15);
        let ramp: Vec<f64> =
            (0..400).map(|i| neutral([libm::exp2(f64::from(i) / 10.0 - 10.0); 3])[0]).collect();
        assert!(ramp.is_sorted() && ramp.iter().all(|&value| (0.0..1.0).contains(&value)));
        // A strong red goes towards white, but slowly.
        let red = neutral([4.0, 0.1, 0.1]);
        assert!(red[0] < 1.0 && red[1] > 0.2 && red[1] < red[0]);
    }

    #[test]
    fn nothing_breaks_the_encoder() {
        for tone in [Tone::Clip, Tone::Neutral] {
            for exposure_stops in [-2000.0, -32.0, 0.0, 32.0, 2000.0] {
                let display = Display { exposure_stops, tone };
                assert_eq!(display.encode([f32::NAN; 3]), [0; 3]);
                assert_eq!(display.encode([f32::NEG_INFINITY, -1.0, -0.0]), [0; 3]);
            }
            let display = Display { exposure_stops: 0.0, tone };
            assert_eq!(display.encode([f32::INFINITY; 3]), [255; 3]);
            assert_eq!(display.encode([f32::MAX; 3]), [255; 3]);
        }
        let red = [f32::INFINITY, 0.0, f32::NAN];
        assert_eq!(Display::default().encode(red), [255, 0, 0]);
        assert_eq!(Display { tone: Tone::Neutral, ..Display::default() }.encode(red), [255; 3]);
    }
}
