#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How the stream of a tap breaks up, from runs of data/scenes/tap_*.json:

    bench/tap.py DIR...

A line a run: when the first drop breaks off, how many drops there are at the end, the mean length of the stream that
one holds (as it leaves the source) and their mean radius, both in radii of the source. Since drops move apart as they
fall, that length and not their distance is to be set beside Rayleigh's fastest wave, 9.01 radii; a drop of one such
wave has 1.89. Drops whose radius is less than that of the source do not count: necks leave them.
"""
import csv
import json
import math
import os
import sys


def radius(row):
    return (3 * float(row["volume"]) / (4 * math.pi)) ** (1 / 3)


def frames_of(directory):
    frames = {}
    with open(os.path.join(directory, "measures.csv")) as file:
        for row in csv.DictReader(file):
            frames.setdefault(float(row["time"]), []).append(row)
    return sorted(frames.items())


def measure(directory):
    with open(os.path.join(directory, "run.json")) as file:
        source = json.load(file)["resolved_scene"]["sources"][0]["radius"]
    frames = frames_of(directory)
    free = {time: [row for row in rows if float(row["wetted_area"]) == 0] for time, rows in frames}
    drops = {time: [row for row in rows if radius(row) >= source] for time, rows in free.items()}
    first = next((time for time, rows in frames if drops[time]), None)
    last = frames[-1][0]
    count, specks = len(drops[last]), len(free[last]) - len(drops[last])
    if count == 0:
        return first, 0, specks, None, None
    spacing = sum(float(row["volume"]) for row in drops[last]) / count / (math.pi * source**3)
    return first, count, specks, spacing, sum(radius(row) for row in drops[last]) / count / source


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    show = lambda value, form: "-" if value is None else format(value, form)
    print(f"{'run':<44} {'breaks at, s':>12} {'drops':>6} {'specks':>6} {'length/r':>10} {'radius/r':>9}")
    for directory in sys.argv[1:]:
        first, count, small, spacing, size = measure(directory)
        name = os.path.basename(os.path.normpath(directory))
        print(f"{name:<44} {show(first, '.4f'):>12} {count:>6} {small:>6} {show(spacing, '.2f'):>10} {show(size, '.2f'):>9}")


if __name__ == "__main__":
    main()
