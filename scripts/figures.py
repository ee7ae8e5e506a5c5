"""What the figures for print have in common: their style, the files they are drawn from, and the command line."""

import argparse
import sys
from pathlib import Path

import matplotlib as mpl
import xarray as xr

# For each kind of file: the attribute that marks it, and the format versions that are read.
KINDS = {"map": ("slipmap_format_version", (1, 2, 3, 4, 5, 6)), "trace": ("slipmap_trace_format_version", (1, 2))}
SUFFIXES = (".pdf", ".png", ".svg")

STYLE = {
    "font.family": "serif",
    "font.serif": ["STIX Two Text", "STIXGeneral", "Times New Roman", "DejaVu Serif"],
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.labelsize": 10,
    "axes.linewidth": 0.6,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 0.9,
    "pdf.fonttype": 42,
    "svg.fonttype": "path",
    "savefig.dpi": 400,
}


class NoFigure(Exception):
    """A file that a figure cannot be drawn from, with the reason."""


def read(path, kind):
    """The variables of a map or trace, in memory."""
    if not Path(path).is_file():
        raise NoFigure(f"{path}: there is no such file")
    attribute, versions = KINDS[kind]
    try:
        contents = load(path)
    except (OSError, ValueError) as error:
        raise NoFigure(f"{path}: not a {kind} of slipmap ({error})") from error
    version = contents.attrs.get(attribute)
    if version is None:
        raise NoFigure(f"{path}: not a {kind} of slipmap")
    if int(version) not in versions:
        raise NoFigure(f"{path}: format {version} of a {kind}; this program reads {versions[0]} to {versions[-1]}")
    return contents


def load(path, group=None):
    """A group of a file, in memory."""
    with xr.open_dataset(path, group=group, engine="netcdf4", mask_and_scale=False) as contents:
        return contents.load()


def main(description, style, figure, files, output):
    """Runs a script: `figure` makes a figure of the files, as many as `files` says what they are. Gives the exit code."""
    parser = argparse.ArgumentParser(description=description.splitlines()[0])
    parser.add_argument("files", nargs=len(files), metavar="FILE.h5", help=", then ".join(files))
    parser.add_argument("-o", "--output", default=output, metavar="FILE", help="pdf, png or svg [%(default)s]")
    given = parser.parse_args()
    if Path(given.output).suffix not in SUFFIXES:
        parser.error(f"{given.output}: the name must end in .pdf, .png or .svg")
    try:
        drawn = figure(given.files)
    except NoFigure as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    with mpl.rc_context(style):
        drawn.savefig(given.output)
    print(given.output)
    return 0
