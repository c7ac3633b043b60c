#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Two revisions side by side on one benchmark:

    bench/compare.py main HEAD step -- free_20k window --threads 1
    bench/compare.py main HEAD operators -- --benchmark_filter=flow

Builds bench_NAME of both in worktrees under build/compare, then runs them in turn (A B, B A, A B, ...), so that what
else the machine does meets both alike. Prints medians over the pairs and the median of the ratios B/A pair by pair:
below 1, B is faster. `step` and `operators` are compared row by row, in CPU time; any other program as a
whole, by its user CPU time. Nothing is a pass or a failure.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import sys

ROOT = subprocess.check_output(["git", "rev-parse", "--show-toplevel"], text=True,
                               cwd=os.path.dirname(os.path.abspath(__file__))).strip()

GOOGLE_BENCHMARKS = {"operators"}


def git(*arguments, cwd=ROOT):
    return subprocess.check_output(["git", *arguments], text=True, cwd=cwd).strip()


def build(revision, name, bench_of):
    """Builds bench_NAME of a revision; returns the program."""
    commit = git("rev-parse", "--short=12", revision + "^{commit}")
    directory = os.path.join(ROOT, "build", "compare", commit)
    if not os.path.isdir(directory):
        git("worktree", "prune")
        git("worktree", "add", "--detach", directory, commit)
    if bench_of:  # for a revision that has no such benchmark yet
        git("checkout", git("rev-parse", bench_of), "--", "bench", cwd=directory)
    target = "bench_" + name
    with open(os.path.join(directory, "compare.log"), "w") as log:
        for command in (["cmake", "--preset", "release", "-DMENISCUS_TESTS=OFF", "-DMENISCUS_TOOLS=OFF"],
                        ["cmake", "--build", "build/release", "--target", target, "-j2"]):
            if subprocess.run(command, cwd=directory, stdout=log, stderr=log).returncode != 0:
                sys.exit(f"{revision}: {target} cannot be built; see {log.name}")
    return os.path.join(directory, "build", "release", "bench", target)


def run(program, name, arguments):
    """One run: {row: milliseconds of CPU time}."""
    report = os.path.join(os.path.dirname(program), "compare.json")
    if os.path.exists(report):
        os.remove(report)
    if name == "step":
        arguments = [*arguments, "--json", report]
    elif name in GOOGLE_BENCHMARKS:
        arguments = [*arguments, "--benchmark_out=" + report, "--benchmark_out_format=json"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program, *arguments], stdout=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"{program} ended with {done.returncode}")
    if not os.path.exists(report):
        return {name: 1e3 * (resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)}
    with open(report) as file:
        data = json.load(file)
    if name == "step":
        return {f"{r['name']}, {r['threads']} threads": r["cpu_ms"] for r in data["results"] if "failure" not in r}
    to_ms = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}
    return {b["name"]: b["cpu_time"] * to_ms[b["time_unit"]] for b in data["benchmarks"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("a", help="a git revision")
    parser.add_argument("b", help="another one")
    parser.add_argument("name", help="step, remesh, ...: bench/NAME.cpp")
    parser.add_argument("--pairs", type=int, default=5)
    parser.add_argument("--bench-of", metavar="REVISION", help="take bench/ from this revision for both")
    parser.usage = "%(prog)s [options] a b name [-- what the program is to be given]"
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:end])
    options.arguments = sys.argv[end + 1:]
    programs = [build(revision, options.name, options.bench_of) for revision in (options.a, options.b)]
    pairs = []
    for k in range(options.pairs):
        pair = [None, None]
        for side in ((0, 1) if k % 2 == 0 else (1, 0)):
            pair[side] = run(programs[side], options.name, options.arguments)
        pairs.append(pair)
    print(f"A = {options.a}, B = {options.b}, {options.pairs} pairs; CPU ms")
    print(f"{'':40} {'A':>10} {'B':>10} {'B/A':>7} {'least':>7} {'most':>7}")
    for row in pairs[0][0]:
        both = [(a[row], b[row]) for a, b in pairs if row in a and row in b and a[row] > 0]
        if not both:
            continue
        ratios = [b / a for a, b in both]
        print(f"{row:40} {statistics.median(a for a, _ in both):10.3f} {statistics.median(b for _, b in both):10.3f} "
              f"{statistics.median(ratios):7.3f} {min(ratios):7.3f} {max(ratios):7.3f}")


if __name__ == "__main__":
    main()
