#!/usr/bin/env python3
"""Prints the tables of doc/guide/figures.md from what the benches printed.

    scripts/figures_table.py FOLDER

scripts/figures_of_merit.sh fills FOLDER, one text a bench, and calls this. A bench that was not run has no rows. One that was run
and has no such figure is an error: its words have changed, and a row here has to follow.
"""

import math
import re
import sys
from pathlib import Path

NUMBER = r"([0-9.]+)"
TIME = r"([0-9.]+)(ns|µs|ms|s)\b"
LOAD, VELOCITY = "load control:", "velocity control:"

# What the figure is, the bench, the heading that it comes after, a pattern with it, how it is told.
ROWS = [
    ("counting cells against filling the same buffers, one thread", "throughput", "", f"count against fill, 1 threads.* = {NUMBER}", "{} times as long"),
    ("the same, all threads", "throughput", "", f"count against fill, (?!1 ).* = {NUMBER}", "{} times as long"),
    ("counting, one thread against all", "throughput", "", f"count, 1 thread against .* = {NUMBER}", "{} times as long"),
    ("a whole run, one thread against all", "throughput", "", f"run, 1 thread against .* = {NUMBER}", "{} times as long"),
    ("a whole run against writing its bytes uncompressed", "throughput", "", f"run against raw write.* = {NUMBER}", "{} of the time"),
    ("tiles on disk against tiles in memory, a map of decay rates", "throughput", "", f"tiles on disk .*decay-rate map.* = {NUMBER}", "{} times as long"),
    ("the rightmost root of a cell with its certificate, velocity control", "roots", VELOCITY, f"tracked and certified +{NUMBER}", "{} µs"),
    ("the same, load control", "roots", LOAD, f"tracked and certified +{NUMBER}", "{} µs"),
    ("roots by collocation, cell by cell, against that, velocity control", "roots", VELOCITY, f"ratio +{NUMBER}", "{} times as long"),
    ("the same, load control", "roots", LOAD, f"ratio +{NUMBER}", "{} times as long"),
    ("all gain limits of a stable setting", "margins", "", f"^ +gain: mean +{TIME}", "{} {}"),
    ("its limits by bisection", "margins", "", f"gain, by bisection: mean +{TIME}", "{} {}"),
    ("its proved stability radius", "margins", "", f"^ +stability radius: mean +{TIME}", "{} {}"),
    ("v_c of a cell", "critical", "", f"all, as in a map .*cells +{NUMBER} +{NUMBER}", "{} µs in the median, {} in the mean"),
    ("v_c by one slip", "critical", "", f"^graze-slip .*cells +{NUMBER} +{NUMBER}", "{} µs in the median, {} in the mean"),
    ("v_c by the orbit", "critical", "", f"^graze-orbit .*cells +{NUMBER} +{NUMBER}", "{} µs in the median, {} in the mean"),
    ("v_c by simulation, all cells", "critical", "", f"^all by simulation .*cells +{NUMBER} +{NUMBER}", "{} µs in the median, {} in the mean"),
    ("a chart of 800×600 cells in the browser", "browser", "slipmap, live chart", f"charts a second, median +{NUMBER}", "{} a second"),
    ("plotly.js with the same charts", "browser", "plotly.js heat map", f"charts a second, median +{NUMBER}", "{} a second"),
    ("h5web with the same charts", "browser", "h5web HeatmapVis", f"charts a second, median +{NUMBER}", "{} a second"),
]

# Systems of bench `general` beside the letter.
SYSTEMS = ["n = 2", "n = 3", "n = 4", "n = 8", "memory", "latency"]
WORK = {"counts, 1000 lines": "counts, 1,000 delays a line", "counts, 100 lines": "counts, 10,000 delays a line", "certified": "rightmost roots"}

# Motions are compared at about this error of a.
ERROR = 3e-8
PEERS = {"crate": "crate differential-equations", "jitcdde": "JiTCDDE"}
PROBLEMS = {"smooth": "smooth", "hybrid-3a": "Fig. 3(a)", "hybrid-3b": "Fig. 3(b)"}

CHARTS = {"lobes": "The lobes, w from 0 to 0.6 and τ from 1 to 16", "long": "Long delays, w from 0.08 to 0.13 and τ from 16 to 200"}


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def after(text, heading):
    """The text after the line that begins with the heading, up to the next line without indentation."""
    if not heading:
        return text
    found = re.search(rf"^{re.escape(heading)}.*\n((?:[ \t].*\n?)*)", text, re.MULTILINE)
    return found[1] if found else ""


def figures(texts):
    for what, bench, heading, pattern, told in ROWS:
        if bench not in texts:
            continue
        found = re.search(pattern, after(texts[bench], heading), re.MULTILINE)
        if not found:
            sys.exit(f"{sys.argv[0]}: {bench} printed no figure for “{what}”")
        yield what, told.format(*found.groups())


def systems(text):
    for heading, work in WORK.items():
        part = after(text, heading)
        ratios = {name: re.search(rf"^ +{name} .* {NUMBER}$", part, re.MULTILINE) for name in SYSTEMS}
        if None in ratios.values():
            sys.exit(f"{sys.argv[0]}: general printed no ratios for “{work}”")
        yield [work, *(found[1] for found in ratios.values())]


def motions(text):
    """Of each peer and problem the setting with the error nearest to ERROR."""
    row = re.compile(rf"^(\S+) +(crate|jitcdde) +(\S+) +{NUMBER} +(\S+) +\S+ +{NUMBER} +(\S+) +{NUMBER}, {NUMBER}$", re.MULTILINE)
    nearest = {}
    for problem, peer, setting, _, error, _, ours, times, _ in row.findall(text):
        error, ours = (text.replace("e-0", "e-") for text in (error, ours))
        apart = abs(math.log(float(error) / ERROR))
        key = problem, peer
        if key not in nearest or apart < nearest[key][0]:
            nearest[key] = apart, [PROBLEMS[problem], f"{PEERS[peer]}, {setting.replace('/', ' at ')}", error, ours, times]
    if not nearest:
        sys.exit(f"{sys.argv[0]}: peers printed no ratios")
    return [row for _, row in nearest.values()]


def charts(text):
    row = re.compile(
        r"^(\S+) +(.+?) +([0-9]+) cells; start .*?; +([0-9.,]+) µs a cell \( *([0-9.,]+)\); +([0-9]+) wrong, +([0-9]+) no answer; "
        r"+([0-9.,]+) times slipmap's, +([0-9.,]+) with start-up$",
        re.MULTILINE,
    )
    found = {chart: [] for chart in CHARTS}
    for chart, name, cells, clock, processor, wrong, *others in row.findall(text):
        name = name.replace("collocation, ", "collocation, N = ").replace("discretization, ", "discretization, k = ")
        cells, wrong = (f"{int(number):,}" for number in (cells, wrong))
        found[chart].append([name, cells, clock, processor, wrong, *others])
    if not all(found.values()):
        sys.exit(f"{sys.argv[0]}: lobes printed no rows")
    return found


def main(folder):
    texts = {file.stem: file.read_text() for file in sorted(Path(folder).glob("*.txt"))}
    table(["what", "figure"], figures(texts))
    if "general" in texts:
        print("\nSystems beyond the letter, times those of the letter:\n")
        table(["what", *SYSTEMS], systems(texts["general"]))
    if "peers" in texts:
        print("\nMotions, beside other programs at about the same error:\n")
        table(["problem", "program, setting", "its error", "slipmap's error", "times slower than slipmap"], motions(texts["peers"]))
    if "lobes" in texts:
        head = ["method", "cells", "µs a cell", "of the processor", "wrong", "no answer", "times slipmap's", "with start-up"]
        for chart, rows in charts(texts["lobes"]).items():
            print(f"\n{CHARTS[chart]}:\n")
            table(head, rows)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
