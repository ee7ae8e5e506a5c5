//! From a scene to the bytes of a PNG or SVG file. Apart from [`super::font`], the only place that
//! uses plotters.

use plotters::backend::{BitMapBackend, DrawingBackend, RGBPixel, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, RGBAColor, RGBColor, TextStyle};

use super::error::PictureError;
use super::font;
use super::print::Print;
use super::rectangles::{Rectangle, rectangles};
use super::scene::{Mark, Point, Scene};
use crate::meaning::colour::Rgb;
use crate::report::numbers::rounded;

/// Bitmaps are drawn larger by this factor and averaged, for smooth edges.
const OVERSAMPLING: u32 = 3;
/// Units of an SVG picture per pixel, since the backend uses whole units.
const SVG_UNITS: u32 = 10;
/// The factor by which the SVG backend divides font sizes.
const SVG_FONT_FACTOR: f64 = 1.24;

/// The picture as a PNG file. `texts`: keywords and their texts in the file.
pub(super) fn png(scene: &Scene, texts: &[(&str, &str)]) -> Result<Vec<u8>, PictureError> {
    let (width, height) = scene.size;
    let (fine_width, fine_height) = (width * OVERSAMPLING, height * OVERSAMPLING);
    let mut fine = vec![255; fine_width as usize * fine_height as usize * 3];
    {
        let size = (fine_width, fine_height);
        let backend = BitMapBackend::<RGBPixel>::with_buffer_and_format(&mut fine, size);
        let backend = backend.map_err(refused)?;
        let mut pen = Pen {
            backend,
            units: f64::from(OVERSAMPLING),
            bitmap: true,
        };
        pen.paint(scene)?;
        pen.backend.present().map_err(refused)?;
    }
    let pixels = averaged(&fine, width as usize, height as usize);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Default);
    encoder.set_pixel_dims(scene.print.map(|print| png::PixelDimensions {
        xppu: print.per_metre(),
        yppu: print.per_metre(),
        unit: png::Unit::Meter,
    }));
    for (keyword, text) in texts {
        let added = encoder.add_itxt_chunk((*keyword).into(), (*text).into());
        added.map_err(refused)?;
    }
    let mut writer = encoder.write_header().map_err(refused)?;
    writer.write_image_data(&pixels).map_err(refused)?;
    writer.finish().map_err(refused)?;
    Ok(bytes)
}

/// The picture as an SVG file, whose sides are told in pixels, or in millimetres of print.
pub(super) fn svg(scene: &Scene, print: Option<Print>) -> Result<Vec<u8>, PictureError> {
    let sides = match print.map(|print| print.millimetres(scene.size)) {
        Some(sides) => sides.map(|side| format!("{}mm", rounded(side, 5))),
        None => [scene.size.0, scene.size.1].map(|side| side.to_string()),
    };
    let (width, height) = (scene.size.0 * SVG_UNITS, scene.size.1 * SVG_UNITS);
    let mut text = String::new();
    {
        let mut pen = Pen {
            backend: SVGBackend::with_string(&mut text, (width, height)),
            units: f64::from(SVG_UNITS),
            bitmap: false,
        };
        pen.paint(scene)?;
        pen.backend.present().map_err(refused)?;
    }
    let Some((_, body)) = text.split_once('\n') else {
        return Err(PictureError::Render("the SVG is empty".into()));
    };
    let head = format!(
        "<svg width=\"{}\" height=\"{}\" viewBox=\"0 0 {width} {height}\" \
        stroke-linejoin=\"round\" \
         stroke-linecap=\"round\" xmlns=\"http://www.w3.org/2000/svg\">\n",
        sides[0], sides[1],
    );
    Ok((head + body).into_bytes())
}

fn refused(error: impl std::fmt::Display) -> PictureError {
    PictureError::Render(error.to_string())
}

fn averaged(fine: &[u8], width: usize, height: usize) -> Vec<u8> {
    let n = OVERSAMPLING as usize;
    let row_bytes = width * n * 3;
    let mut pixels = Vec::with_capacity(width * height * 3);
    let mut sums = vec![0u32; width * 3];
    for rows in fine.chunks_exact(row_bytes * n) {
        sums.fill(0);
        for row in rows.chunks_exact(row_bytes) {
            for (sum, samples) in sums.chunks_exact_mut(3).zip(row.chunks_exact(3 * n)) {
                for sample in samples.chunks_exact(3) {
                    for (channel, &value) in sum.iter_mut().zip(sample) {
                        *channel += u32::from(value);
                    }
                }
            }
        }
        let samples = (n * n) as u32;
        pixels.extend(sums.iter().map(|s| ((s + samples / 2) / samples) as u8));
    }
    pixels
}

/// Draws marks in the units of a backend.
struct Pen<B> {
    backend: B,
    units: f64,
    bitmap: bool,
}

type Drawn = Result<(), PictureError>;

impl<B: DrawingBackend> Pen<B> {
    fn paint(&mut self, scene: &Scene) -> Drawn {
        let size = scene.size;
        let paper = (f64::from(size.0), f64::from(size.1));
        self.rect((0.0, 0.0), paper, crate::meaning::colour::PAPER, 1.0)?;
        for mark in &scene.marks {
            match mark {
                Mark::Rect {
                    from,
                    to,
                    colour,
                    opacity,
                } => self.rect(*from, *to, *colour, *opacity)?,
                Mark::Path {
                    points,
                    colour,
                    width,
                } => self.path(points, *colour, *width)?,
                Mark::Band {
                    slices,
                    colour,
                    opacity,
                } => self.band(slices, *colour, *opacity)?,
                Mark::Cells {
                    columns,
                    rows,
                    colours,
                } => self.cells(columns, rows, colours)?,
                Mark::Text {
                    at,
                    size,
                    text,
                    colour,
                    upward,
                } => self.text(*at, *size, text, *colour, *upward)?,
            }
        }
        Ok(())
    }

    fn units(&self, (x, y): Point) -> (i32, i32) {
        (
            (x * self.units).round() as i32,
            (y * self.units).round() as i32,
        )
    }

    fn rect(&mut self, from: Point, to: Point, colour: Rgb, opacity: f64) -> Drawn {
        let (from, to) = (self.units(from), self.units(to));
        let drawn = self
            .backend
            .draw_rect(from, to, &ink(colour, opacity), true);
        drawn.map_err(refused)
    }

    fn path(&mut self, points: &[Point], colour: Rgb, width: f64) -> Drawn {
        if self.bitmap {
            return self.brush(points, colour, width);
        }
        let style = ink(colour, 1.0).stroke_width((width * self.units).round() as u32);
        let mut places: Vec<(i32, i32)> = points.iter().map(|p| self.units(*p)).collect();
        places.dedup();
        self.backend.draw_path(places, &style).map_err(refused)
    }

    /// A line as a row of discs, with even width and round joints, which the backend's wide lines
    /// lack.
    fn brush(&mut self, points: &[Point], colour: Rgb, width: f64) -> Drawn {
        let radius = 0.5 * width * self.units;
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|(x, y)| (x * self.units, y * self.units));
            let steps = (b.0 - a.0).hypot(b.1 - a.1).ceil().clamp(1.0, 1e5);
            for i in 0..=steps as usize {
                let part = i as f64 / steps;
                let centre = (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1));
                self.disc(centre, radius, colour)?;
            }
        }
        Ok(())
    }

    fn disc(&mut self, (x, y): Point, radius: f64, colour: Rgb) -> Drawn {
        let (first, last) = ((y - radius).round() as i32, (y + radius).round() as i32);
        for row in first..last {
            let off = f64::from(row) + 0.5 - y;
            let half = (radius * radius - off * off).max(0.0).sqrt();
            let (from, to) = ((x - half).round() as i32, (x + half).round() as i32);
            if to > from {
                let drawn =
                    self.backend
                        .draw_rect((from, row), (to, row + 1), &ink(colour, 1.0), true);
                drawn.map_err(refused)?;
            }
        }
        Ok(())
    }

    fn band(&mut self, slices: &[(f64, f64, f64)], colour: Rgb, opacity: f64) -> Drawn {
        if !self.bitmap {
            let there = slices.iter().map(|&(x, low, _)| (x, low));
            let back = slices.iter().rev().map(|&(x, _, high)| (x, high));
            let mut outline: Vec<(i32, i32)> = there.chain(back).map(|p| self.units(p)).collect();
            outline.dedup();
            let drawn = self.backend.fill_polygon(outline, &ink(colour, opacity));
            return drawn.map_err(refused);
        }
        for pair in slices.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let [from, to] = [a.0, b.0].map(|x| (x * self.units).round() as i32);
            for column in from..to {
                let part =
                    (f64::from(column) + 0.5 - a.0 * self.units) / ((b.0 - a.0) * self.units);
                let between = |a: f64, b: f64| ((a + part * (b - a)) * self.units).round() as i32;
                let (low, high) = (between(a.1, b.1), between(a.2, b.2));
                let (top, bottom) = (low.min(high), low.max(high));
                if bottom > top {
                    let corners = ((column, top), (column + 1, bottom));
                    let drawn =
                        self.backend
                            .draw_rect(corners.0, corners.1, &ink(colour, opacity), true);
                    drawn.map_err(refused)?;
                }
            }
        }
        Ok(())
    }

    /// Draws cells as few rectangles.
    fn cells(&mut self, columns: &[f64], rows: &[f64], colours: &[Rgb]) -> Drawn {
        let width = columns.len().saturating_sub(1);
        for Rectangle {
            rows: (top, bottom),
            columns: (from, to),
            key: colour,
        } in rectangles(colours, width)
        {
            let [(x0, y0), (x1, y1)] =
                [(from, top), (to, bottom)].map(|(c, r)| self.units((columns[c], rows[r])));
            // Where SVG shapes only touch, viewers let the paper shine through; so each reaches
            // below the next one.
            let overlap = |here: i32, next: i32, last: bool| match last || self.bitmap {
                true => next,
                false => next + (next - here).signum() * (self.units / 2.0) as i32,
            };
            let x1 = overlap(x0, x1, to + 1 == columns.len());
            let y1 = overlap(y0, y1, bottom + 1 == rows.len());
            let (near, far) = ((x0.min(x1), y0.min(y1)), (x0.max(x1), y0.max(y1)));
            let drawn = self.backend.draw_rect(near, far, &ink(colour, 1.0), true);
            drawn.map_err(refused)?;
        }
        Ok(())
    }

    fn text(&mut self, at: Point, size: f64, text: &str, colour: Rgb, upward: bool) -> Drawn {
        let size = size * self.units;
        // Where the backend puts the baseline of a text whose upper edge is given.
        let (size, baseline) = if self.bitmap {
            (size, 0.5 * size)
        } else {
            (
                size * SVG_FONT_FACTOR / font::HEIGHT,
                0.76 * size / font::HEIGHT,
            )
        };
        let (x, y) = (at.0 * self.units, at.1 * self.units);
        let (x, y) = if upward {
            (x - baseline, y)
        } else {
            (x, y - baseline)
        };
        let Some(font) = font::sized(size) else {
            return Err(PictureError::Render("the font cannot be used".into()));
        };
        let font = if upward {
            font.transform(FontTransform::Rotate270)
        } else {
            font
        };
        let style = TextStyle {
            font,
            color: ink(colour, 1.0).to_backend_color(),
            pos: Pos::new(HPos::Left, VPos::Top),
        };
        let place = (x.round() as i32, y.round() as i32);
        let kept = if self.bitmap {
            text.to_owned()
        } else {
            with_kept_spaces(text)
        };
        self.backend
            .draw_text(&kept, &style, place)
            .map_err(refused)
    }
}

fn ink(Rgb(r, g, b): Rgb, opacity: f64) -> RGBAColor {
    RGBColor(r, g, b).mix(opacity)
}

/// `text` with unbreakable spaces where an SVG viewer would drop them: at the ends and beside other
/// spaces.
fn with_kept_spaces(text: &str) -> String {
    let space = |c: Option<char>| c.is_none_or(|c| c == ' ');
    let characters: Vec<char> = text.chars().collect();
    let before = |i: usize| i.checked_sub(1).and_then(|i| characters.get(i).copied());
    let kept = |(i, &c): (usize, &char)| {
        let dropped = c == ' ' && (space(before(i)) || space(characters.get(i + 1).copied()));
        if dropped { '\u{a0}' } else { c }
    };
    characters.iter().enumerate().map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(png_bytes: &[u8], x: usize, y: usize) -> [u8; 3] {
        let mut reader = png::Decoder::new(png_bytes).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let at = (y * info.width as usize + x) * 3;
        [pixels[at], pixels[at + 1], pixels[at + 2]]
    }

    fn scene() -> Scene {
        let mut scene = Scene::new((40, 30));
        let (red, blue) = (Rgb(200, 0, 0), Rgb(0, 0, 200));
        scene.marks.push(Mark::Cells {
            columns: vec![10.0, 20.0, 30.0],
            rows: vec![20.0, 15.0, 10.0],
            colours: vec![red, red, red, blue],
        });
        scene
    }

    #[test]
    fn cells_fill_their_place() {
        let bytes = png(&scene(), &[]).unwrap();
        assert_eq!(pixel(&bytes, 12, 17), [200, 0, 0]);
        assert_eq!(pixel(&bytes, 28, 17), [200, 0, 0]);
        assert_eq!(pixel(&bytes, 28, 12), [0, 0, 200]);
        assert_eq!(pixel(&bytes, 31, 12), [255, 255, 255]);
        assert_eq!(pixel(&bytes, 9, 12), [255, 255, 255]);
    }

    #[test]
    fn lines_are_as_wide_as_asked() {
        let mut scene = Scene::new((40, 30));
        scene.path(vec![(5.0, 15.0), (35.0, 15.0)], Rgb(0, 0, 0), 4.0);
        let bytes = png(&scene, &[]).unwrap();
        assert_eq!(pixel(&bytes, 20, 13), [0, 0, 0]);
        assert_eq!(pixel(&bytes, 20, 16), [0, 0, 0]);
        assert_eq!(pixel(&bytes, 20, 12), [255, 255, 255]);
        assert_eq!(pixel(&bytes, 20, 17), [255, 255, 255]);
    }

    #[test]
    fn svg_keeps_spaces() {
        assert_eq!(with_kept_spaces("a b"), "a b");
        assert_eq!(with_kept_spaces(" a  b "), "\u{a0}a\u{a0}\u{a0}b\u{a0}");
    }

    #[test]
    fn svg_is_one_document_with_merged_cells() {
        let text = String::from_utf8(svg(&scene(), None).unwrap()).unwrap();
        assert!(text.starts_with("<svg width=\"40\" height=\"30\" viewBox=\"0 0 400 300\""));
        assert!(text.trim_end().ends_with("</svg>"));
        assert_eq!(text.matches("<rect").count(), 1 + 3);
    }
}
