//! `vitrum compare`: how far a picture is from its reference.

use crate::args::Compare;
use crate::errors::{self, Errors};
use crate::failure::Failure;
use crate::terminal;
use std::process::ExitCode;
use vitrum_io::image::{self, Display, ImageRgb};

pub(crate) fn run(arguments: &Compare) -> Result<ExitCode, Failure> {
    if let Some(output) = &arguments.output {
        image::check_writable(output)?;
    }
    let [picture, reference] = errors::read_pair(&arguments.image, &arguments.reference)?;
    let (found, map) = errors::between(&picture, &reference, arguments.exposure);
    if let Some(output) = &arguments.output {
        let shown = if image::holds_channels(output) {
            difference(&picture, &reference)
        } else {
            errors::picture_of(&map, picture.width, picture.height)
        };
        image::write(output, shown.view(), &[], &[], Display::default())?;
    }
    let answer = if arguments.json {
        serde_json::to_string(&found).map_err(|e| Failure::running(e.to_string()))? + "\n"
    } else {
        report(&found)
    };
    terminal::answer(&answer)?;
    Ok(ExitCode::SUCCESS)
}

/// Image minus reference.
fn difference(picture: &ImageRgb, reference: &ImageRgb) -> ImageRgb {
    let pairs = picture.pixels.iter().zip(&reference.pixels);
    let pixels = pairs.map(|(x, r)| [0, 1, 2].map(|c| x[c] - r[c])).collect();
    ImageRgb { pixels, metadata: Vec::new(), ..*picture }
}

fn report(found: &Errors) -> String {
    let Errors { rmse, rel_mse, rel_mse_trimmed, mape, flip, bias, bias_error, max_abs } = found;
    format!(
        "RMSE       {rmse:.4e}\n\
         relMSE     {rel_mse:.4e} ({rel_mse_trimmed:.4e} without the worst 0.1 %)\n\
         MAPE       {mape:.4e}\n\
         FLIP       {flip:.4}\n\
         bias       {:+.3} % ± {:.3} %\n\
         largest    {max_abs:.4e}\n",
        100.0 * bias,
        100.0 * bias_error
    )
}
