//! When text has colours: `--color`, for all commands.

use clap::{ColorChoice, ValueEnum};

/// When text has colours.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Colours {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

impl Colours {
    /// The choice in the arguments, found before they are parsed, so that errors in them have the
    /// same colours.
    pub(super) fn asked() -> Self {
        let args: Vec<_> = std::env::args_os().skip(1).collect();
        let named = |name: &std::ffi::OsStr| Self::from_str(name.to_str()?, true).ok();
        let of = |i: usize| match args[i].to_str()?.strip_prefix("--color")? {
            "" => named(args.get(i + 1)?),
            joined => named(joined.strip_prefix('=')?.as_ref()),
        };
        (0..args.len()).find_map(of).unwrap_or(Self::Auto)
    }

    pub(super) const fn choice(self) -> ColorChoice {
        match self {
            Self::Auto => ColorChoice::Auto,
            Self::Always => ColorChoice::Always,
            Self::Never => ColorChoice::Never,
        }
    }

    /// Applies the choice to errors and warnings.
    pub(super) fn apply(self) {
        if self == Self::Auto {
            return;
        }
        let colour = self == Self::Always;
        // This fails only if a hook is already set, and none is.
        let _ = miette::set_hook(Box::new(move |_| {
            Box::new(miette::MietteHandlerOpts::new().color(colour).build())
        }));
    }

    /// Whether text for people on a terminal has colours.
    pub(super) fn of_terminal(self) -> bool {
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        match self {
            Self::Auto => !no_colour,
            Self::Always => true,
            Self::Never => false,
        }
    }
}
