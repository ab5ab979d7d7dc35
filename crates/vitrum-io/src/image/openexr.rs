//! OpenEXR for further work: linear float32, nothing lost.
//!
//! One layer of R, G and B, and of whatever channels are asked for beside them, scanlines from top to bottom, ZIP compression (16 lines at a time), chromaticities of
//! Rec.709 with white D65, metadata as text attributes. The same image gives the same bytes: the library keeps
//! attributes in a hash map of random order, so the header is sorted by name afterwards, as the format's own library
//! has it.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::Path;

use ::exr::image::write::layers::WritableLayers;
use ::exr::meta::attribute::{AttributeValue, Chromaticities, Compression, LineOrder, Text};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, ImageAttributes, Layer, LayerAttributes, MetaData,
    ReadChannels, ReadLayers, SpecificChannels, Vec2, WritableImage,
};

use super::{Channel, ImageError, ImageRgb, ImageView, MOST_PIXELS};

/// Primaries and white of ITU-R BT.709.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// The bytes of an EXR file. Keys and values were checked before.
pub(super) fn encode(
    image: ImageView<'_>,
    channels: &[Channel],
    metadata: &[(String, String)],
) -> ::exr::error::Result<Vec<u8>> {
    let width = image.width as usize;
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: ::exr::image::Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = Vec2(width, image.height as usize);
    if channels.is_empty() {
        let pixel = |at: Vec2<usize>| {
            let [r, g, b] = image.pixels[at.y() * width + at.x()];
            (r, g, b)
        };
        let layer = Layer::new(size, LayerAttributes::default(), encoding, SpecificChannels::rgb(pixel));
        let mut file = Image::from_layer(layer);
        describe(&mut file.attributes, metadata);
        return bytes_of(&file);
    }
    let of_image = |name: &str, c: usize| {
        AnyChannel::new(name, FlatSamples::F32(image.pixels.iter().map(|pixel| pixel[c]).collect()))
    };
    let mut all: Vec<_> = ["R", "G", "B"].iter().enumerate().map(|(c, name)| of_image(name, c)).collect();
    all.extend(
        channels
            .iter()
            .map(|channel| AnyChannel::new(channel.name.as_str(), FlatSamples::F32(channel.values.clone()))),
    );
    let all = AnyChannels::sort(all.into_iter().collect());
    let mut file = Image::from_layer(Layer::new(size, LayerAttributes::default(), encoding, all));
    describe(&mut file.attributes, metadata);
    bytes_of(&file)
}

fn describe(attributes: &mut ImageAttributes, metadata: &[(String, String)]) {
    attributes.chromaticities = Some(REC709);
    attributes.other = metadata
        .iter()
        .map(|(key, value)| {
            let text = |text: &str| Text::from_slice_unchecked(text.as_bytes());
            (text(&super::stored_key(key)), AttributeValue::Text(text(value)))
        })
        .collect();
}

fn bytes_of<'l, L: WritableLayers<'l>>(file: &'l Image<L>) -> ::exr::error::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    file.write().non_parallel().to_buffered(&mut bytes)?;
    sort_attributes(bytes.get_mut()).ok_or(::exr::error::Error::Invalid("header".into()))?;
    Ok(bytes.into_inner())
}

/// Sorts the header's attributes by name. None: this is not the header of a file with one layer.
///
/// A header is a magic number and a version (4 bytes each), then for each attribute a name and a type, both ended by
/// NUL, the size of its value (4 bytes, little-endian) and the value, and a NUL at the end.
fn sort_attributes(bytes: &mut [u8]) -> Option<()> {
    const START: usize = 8;
    let mut end = START;
    let mut attributes = Vec::new();
    while *bytes.get(end)? != 0 {
        let rest = &bytes[end..];
        let name = rest.iter().position(|&byte| byte == 0)?;
        let kind = rest[name + 1..].iter().position(|&byte| byte == 0)?;
        let size = name + 1 + kind + 1;
        let value = u32::from_le_bytes(rest.get(size..size + 4)?.try_into().ok()?);
        let length = size + 4 + usize::try_from(value).ok()?;
        attributes.push((rest[..name].to_vec(), rest.get(..length)?.to_vec()));
        end += length;
    }
    attributes.sort();
    let sorted = attributes.into_iter().flat_map(|(_, attribute)| attribute);
    for (byte, sorted) in bytes[START..end].iter_mut().zip(sorted) {
        *byte = sorted;
    }
    Some(())
}

/// Reads R, G and B of the first layer that has them, in the file's display window, with all text attributes, sorted.
pub(super) fn read(path: &Path) -> Result<ImageRgb, ImageError> {
    let unreadable = |source| ImageError::Unreadable { path: path.to_owned(), source };
    let damaged = |message: String| ImageError::Decode {
        path: path.to_owned(),
        format: "an OpenEXR image with R, G and B",
        message,
    };
    let open = || {
        let file = File::open(path).map_err(unreadable)?;
        if !file.metadata().map_err(unreadable)?.is_file() {
            return Err(unreadable(std::io::Error::other("this is not a file")));
        }
        Ok(BufReader::new(file))
    };
    let headers =
        MetaData::read_from_buffered(open()?, false).map_err(|error| damaged(error.to_string()))?.headers;
    for header in &headers {
        for Vec2(width, height) in [header.layer_size, header.shared_attributes.display_window.size] {
            if width.checked_mul(height).is_none_or(|pixels| pixels as u64 > MOST_PIXELS) {
                return Err(damaged(format!("{width} x {height} pixels, more than {MOST_PIXELS}")));
            }
        }
    }
    let image = ::exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |Vec2(width, height), _| (width, vec![[0_f32; 3]; width * height]),
            |(width, pixels), at, (r, g, b): (f32, f32, f32)| pixels[at.y() * *width + at.x()] = [r, g, b],
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(open()?)
        .map_err(|error| damaged(error.to_string()))?;
    let layer = image.layer_data;
    let attributes = image.attributes.other.iter().chain(&layer.attributes.other);
    let mut metadata: Vec<(String, String)> = attributes
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => {
                let readable = |text: &Text| String::from_utf8_lossy(text.as_slice()).into_owned();
                Some((readable(name), readable(text)))
            }
            _ => None,
        })
        .collect();
    metadata.sort();
    let side = |side: usize| u32::try_from(side).map_err(|_| damaged(format!("a side of {side} pixels")));
    let window = image.attributes.display_window;
    let Vec2(left, top) = layer.attributes.layer_position - window.position;
    let pixels = in_window(layer.channel_data.pixels.1, layer.size, (left, top), window.size);
    let Vec2(width, height) = window.size;
    Ok(ImageRgb { width: side(width)?, height: side(height)?, pixels, metadata })
}

/// The picture that a file means: what it holds, in its place in the window that is to be shown, which is black elsewhere.
fn in_window(
    pixels: Vec<[f32; 3]>,
    held: Vec2<usize>,
    (left, top): (i32, i32),
    window: Vec2<usize>,
) -> Vec<[f32; 3]> {
    if held == window && (left, top) == (0, 0) {
        return pixels;
    }
    let mut shown = vec![[0.0; 3]; window.0 * window.1];
    let place = |at: usize, offset: i32, size: usize| {
        let at = i64::try_from(at).ok()? + i64::from(offset);
        usize::try_from(at).ok().filter(|at| *at < size)
    };
    for (row, line) in pixels.chunks_exact(held.0.max(1)).enumerate() {
        let Some(y) = place(row, top, window.1) else { continue };
        for (column, pixel) in line.iter().enumerate() {
            if let Some(x) = place(column, left, window.0) {
                shown[y * window.0 + x] = *pixel;
            }
        }
    }
    shown
}
