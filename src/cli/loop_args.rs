//! The flags `--nyquist` and `--bode`: pictures of the loop of a setting.

use std::path::{Path, PathBuf};

use crate::explore::loop_response::LoopResponse;
use crate::explore::margins::Margins;
use crate::report::picture::{self, LoopKind, LoopPicture, Picture};

use super::asked::Asked;
use super::failure::Failure;
use super::output::check_picture;
use super::say;

#[derive(Debug, clap::Args)]
pub(super) struct LoopArgs {
    /// Draw the loop in the complex plane, with its margins, as .png, .svg or .pdf
    #[arg(long, value_name = "PICTURE")]
    nyquist: Option<PathBuf>,
    /// Draw size and angle of the loop over the frequency, with its margins
    #[arg(long, value_name = "PICTURE")]
    bode: Option<PathBuf>,
}

impl LoopArgs {
    /// The pictures that are asked for, by their flags.
    fn pictures(&self) -> impl Iterator<Item = (&'static str, LoopKind, &Path)> {
        let all = [
            ("--nyquist", LoopKind::Nyquist, &self.nyquist),
            ("--bode", LoopKind::Bode, &self.bode),
        ];
        all.into_iter()
            .filter_map(|(flag, kind, path)| Some((flag, kind, path.as_deref()?)))
    }

    /// Checks the names of the pictures, which may not be that of the `map`.
    pub(super) fn check(&self, map: Option<&Path>) -> Result<(), Failure> {
        for (flag, _, path) in self.pictures() {
            check_picture(flag, path, map)?;
        }
        if self.nyquist.is_some() && self.nyquist == self.bode {
            let message = "--nyquist and --bode have the same file";
            return Err(Failure::bad_input_with_help(message, "give each its own"));
        }
        Ok(())
    }

    /// Draws the loop, and names its pictures unless there is JSON.
    pub(super) fn draw(&self, asked: &Asked, margins: &Margins, json: bool) -> Result<(), Failure> {
        let (setting, mut pictures) = (&asked.setting, self.pictures().peekable());
        let Some((flag, ..)) = pictures.peek() else {
            return Ok(());
        };
        if margins.required_decay > 0.0 {
            let message =
                format!("{flag}: the loop is drawn on the imaginary axis, without --decay");
            return Err(Failure::bad_input_with_help(
                message,
                "leave one of them out",
            ));
        }
        let of = &margins.crossing_frequencies;
        let ends = [of.gain_margin.lower, of.gain_margin.upper];
        let of_interest = [ends[0], ends[1], of.phase_margin, of.modulus_margin];
        let Some(response) = LoopResponse::of(setting, &of_interest)? else {
            return Err(Failure::failed_with_help(
                format!("{flag}: there is no loop to draw"),
                "it needs a feedback that acts, of the block without readings or of a system of P \
                 and Q or B and A",
            ));
        };
        for (_, kind, path) in pictures {
            let drawn = LoopPicture {
                setting,
                response: &response,
                margins,
                units: &asked.units,
                kind,
            };
            let saved = picture::draw_loop(&drawn, path).and_then(Picture::save);
            saved.map_err(|error| Failure::failed(error.to_string()))?;
            if !json {
                say::result(path.display())?;
            }
        }
        Ok(())
    }
}
