// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace meniscus::bench {

/// Runs `trials` random drops, each of 8 steps at a time step inside the safe region: level, size, mesh quality, edges,
/// liquid, speed and solid are random. Prints what blew up (a number not finite, volume lost, an unsound mesh at the
/// end) or gave up (exit code 5), with the seed that repeats it, and sums. Returns 0 if nothing did, 5 otherwise.
int run_stress(int trials, unsigned seed);

}  // namespace meniscus::bench
