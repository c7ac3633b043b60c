// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace meniscus::bench {

/// Runs `trials` random drops, each of 8 steps: level, size, mesh quality, edges, liquid, speed, solid and time step
/// are random; the last inside the safe region (safe_time_step), or up to 30 times outside of it. Prints each run that
/// went wrong, with the seed that repeats it, and sums. Returns 0 if, inside, all held and, outside, all held or ended
/// with a clear error; 5 otherwise. A run that has used `limit` seconds of processor time after a step is given up: it
/// is printed and counted apart, and changes nothing of that.
int run_stress(int trials, unsigned seed, bool outside, double limit);

}  // namespace meniscus::bench
