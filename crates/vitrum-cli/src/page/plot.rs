//! Error against seconds, and seconds against what makes them grow, in powers of ten, as SVG.

use super::figures::{Figures, Point};
use crate::failure::Failure;
use plotters::prelude::*;

const SIZE: (u32, u32) = (560, 420);
const SMALL: (u32, u32) = (420, 300);

/// Colours that most eyes tell apart (Okabe and Ito 2008).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
];

/// The curves of a scene; each program has the colour of its place among all programs.
pub(super) fn svg(figures: &[&Figures], programs: &[&str]) -> Result<String, Failure> {
    let mut text = String::new();
    draw(figures, programs, &mut text)
        .map_err(|e| Failure::running(format!("a plot could not be drawn ({e})")))?;
    Ok(text)
}

fn draw(
    figures: &[&Figures],
    programs: &[&str],
    text: &mut String,
) -> Result<(), Box<dyn std::error::Error>> {
    let points = || figures.iter().flat_map(|f| &f.points);
    let seconds = powers(points().map(|p| p.seconds));
    let errors = powers(points().flat_map(|p| p.range));
    let root = SVGBackend::with_string(text, SIZE).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d((seconds[0]..seconds[1]).log_scale(), (errors[0]..errors[1]).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("seconds")
        .y_desc("relMSE")
        .x_label_formatter(&|v| power(*v))
        .y_label_formatter(&|v| power(*v))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    for figures in figures {
        let place = programs.iter().position(|name| *name == figures.program).unwrap_or(0);
        let colour = COLOURS[place % COLOURS.len()];
        let line: Vec<(f64, f64)> = figures.points.iter().map(|p| (p.seconds, p.error)).collect();
        chart.draw_series([Polygon::new(band(&figures.points), colour.mix(0.2))])?;
        chart
            .draw_series(LineSeries::new(line.clone(), colour.stroke_width(2)))?
            .label(&figures.program)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
        chart.draw_series(line.into_iter().map(|at| Circle::new(at, 3, colour.filled())))?;
    }
    chart
        .configure_series_labels()
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.2))
        .position(SeriesLabelPosition::LowerLeft)
        .draw()?;
    root.present()?;
    Ok(())
}

/// Seconds against a number of things.
pub(super) fn growth(of: &str, points: &[[f64; 2]]) -> Result<String, Failure> {
    let mut text = String::new();
    draw_growth(of, points, &mut text)
        .map_err(|e| Failure::running(format!("a plot could not be drawn ({e})")))?;
    Ok(text)
}

fn draw_growth(of: &str, points: &[[f64; 2]], text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let [numbers, seconds] = [0, 1].map(|axis| powers(points.iter().map(|p| p[axis])));
    let root = SVGBackend::with_string(text, SMALL).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin(8)
        .x_label_area_size(36)
        .y_label_area_size(56)
        .build_cartesian_2d((numbers[0]..numbers[1]).log_scale(), (seconds[0]..seconds[1]).log_scale())?;
    chart
        .configure_mesh()
        .x_desc(of)
        .y_desc("seconds of rendering")
        .x_label_formatter(&|v| power(*v))
        .y_label_formatter(&|v| power(*v))
        .light_line_style(BLACK.mix(0.05))
        .bold_line_style(BLACK.mix(0.15))
        .draw()?;
    let line: Vec<(f64, f64)> = points.iter().map(|[number, seconds]| (*number, *seconds)).collect();
    chart.draw_series(LineSeries::new(line.clone(), COLOURS[0].stroke_width(2)))?;
    chart.draw_series(line.into_iter().map(|at| Circle::new(at, 3, COLOURS[0].filled())))?;
    root.present()?;
    Ok(())
}

/// From the worst seed to the best, around.
fn band(points: &[Point]) -> Vec<(f64, f64)> {
    let worst = points.iter().map(|p| (p.seconds, p.range[1]));
    let best = points.iter().rev().map(|p| (p.seconds, p.range[0]));
    worst.chain(best).collect()
}

/// Powers of ten around all values, at least one apart.
fn powers(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let logs: Vec<f64> = values.map(f64::log10).collect();
    let low = logs.iter().copied().fold(f64::INFINITY, f64::min).min(f64::MAX).floor();
    let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(low + 1.0);
    if logs.is_empty() { [0.1, 1.0] } else { [low, high].map(|power| 10f64.powf(power)) }
}

/// A label of an axis.
fn power(value: f64) -> String {
    if (0.009..1001.0).contains(&value) { format!("{value}") } else { format!("{value:.0e}") }
}
