//! PNG for looking at: 8 bits of sRGB after exposure and tone curve, which its text chunks name.

use ::png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent};

use super::{Display, ImageView};

/// The bytes of a PNG file. Keys and values were checked before.
pub(super) fn encode(
    image: ImageView<'_>,
    metadata: &[(String, String)],
    display: Display,
) -> Result<Vec<u8>, ::png::EncodingError> {
    let to_srgb = display.encoder();
    let pixels: Vec<u8> = image.pixels.iter().flat_map(|&pixel| to_srgb(pixel)).collect();
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, image.width, image.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let exposure = ("exposure".to_owned(), format!("{} stops", display.exposure_stops));
    let tone = ("tone".to_owned(), display.tone.name().to_owned());
    for (key, value) in metadata.iter().chain([&exposure, &tone]) {
        let (key, value) = (super::stored_key(key), value.clone());
        // Plain text chunks hold Latin-1 only.
        if value.chars().all(|letter| u32::from(letter) < 256) {
            encoder.add_text_chunk(key, value)?;
        } else {
            encoder.add_itxt_chunk(key, value)?;
        }
    }
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(bytes)
}
