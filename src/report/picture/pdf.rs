//! From a picture in SVG to PDF: shapes stay shapes, and text is text in an embedded font.

use std::sync::Arc;

use svg2pdf::usvg::{self, fontdb};
use svg2pdf::{ConversionOptions, PageOptions};

use super::error::PictureError;
use super::print::Print;

/// Points of the page per pixel of a picture of which nothing else is said: 1600 pixels are 7
/// inches, two columns of print.
const POINTS: f32 = 7.0 * 72.0 / 1600.0;

/// The picture as a PDF file, as wide as it is printed.
pub(super) fn of_svg(svg: &[u8], print: Option<Print>) -> Result<Vec<u8>, PictureError> {
    let refused = |error: String| PictureError::Render(error);
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_data(svg, &options).map_err(|e| refused(e.to_string()))?;
    let width = tree.size().width() as u32;
    let points = print.map_or(POINTS, |print| print.points(width) as f32);
    let page = PageOptions { dpi: 72.0 / points };
    svg2pdf::to_pdf(&tree, ConversionOptions::default(), page).map_err(|e| refused(e.to_string()))
}
