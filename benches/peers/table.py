# /// script
# requires-python = ">=3.11"
# dependencies = []
# ///
"""Tables from the lines of benches/peers/run.sh: `program problem setting us-per-unit error-of-a`, once a round."""

import sys
from statistics import median

PROBLEMS = ("smooth", "hybrid-3a", "hybrid-3b")


def read(lines):
    """{(program, problem): [(setting, median, minimum, error)]}, in the order of the lines."""
    times, errors = {}, {}
    for line in lines:
        program, problem, setting, time, error = line.split()
        key = program, problem, setting
        times.setdefault(key, []).append(float(time))
        errors[key] = float(error)
    found = {}
    for key, values in times.items():
        program, problem, setting = key
        row = setting, median(values), min(values), errors[key]
        found.setdefault((program, problem), []).append(row)
    return found


def best(rows):
    """The rows that no other one beats in both time (minimum, where noise is least) and error, from the fastest on."""
    kept = []
    for row in sorted(rows, key=lambda r: (r[2], r[3])):
        if not kept or row[3] < kept[-1][3]:
            kept.append(row)
    return kept


def as_exact(rows, error):
    """The fastest row with no greater error."""
    rows = [r for r in rows if r[3] <= error]
    return min(rows, key=lambda r: r[2], default=None)


def print_tolerances(found, program):
    print(f"\n{program}: us per unit, median (minimum) of rounds; largest error of a\n")
    print(f"{'problem':<10} {'setting':<14} {'median':>8} {'minimum':>9} {'error':>9}")
    for problem in PROBLEMS:
        for setting, middle, least, error in found.get((program, problem), []):
            print(f"{problem:<10} {setting:<14} {middle:8.3f} {least:9.3f} {error:9.1e}")


def print_ratios(found):
    print("\nEach peer where nothing of its own is both faster and more exact, and slipmap at no greater error\n")
    print(f"{'problem':<10} {'peer':<8} {'setting':<14} {'median':>8} {'error':>8}", end="   ")
    print(f"{'slipmap':<7} {'median':>7} {'error':>8}  times faster: of medians, of minima")
    for (program, problem), rows in found.items():
        if program == "slipmap":
            continue
        for setting, middle, least, error in best(rows):
            print(f"{problem:<10} {program:<8} {setting:<14} {middle:8.3f} {error:8.1e}", end="   ")
            ours = as_exact(found["slipmap", problem], error)
            if ours is None:
                print("none as exact")
                continue
            ratios = f"{middle / ours[1]:.1f}, {least / ours[2]:.1f}"
            print(f"{ours[0]:<7} {ours[1]:7.3f} {ours[3]:8.1e}  {ratios}")


if __name__ == "__main__":
    found = read(sys.stdin)
    for program in dict.fromkeys(program for program, _ in found):
        print_tolerances(found, program)
    print_ratios(found)
