// SPDX-License-Identifier: GPL-3.0-or-later
// Unions beside CGAL's corefine_and_compute_union, in one run: bench_merge [--quick]
// Random pairs before an independent judge: bench_merge --stress [N [FIRST_SEED]]
// Sequences of 100 random drops united one after another: bench_merge --sequences [N [FIRST_SEED]]
#include "../tests/support/random_pairs.h"
#include "meniscus/topology/merge_meshes.h"

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <sys/resource.h>

#include <cstdlib>
#include <cstring>

namespace {

using namespace meniscus;

/// User CPU milliseconds of this process so far.
double cpu_milliseconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1e3 * static_cast<double>(usage.ru_utime.tv_sec) + 1e-3 * static_cast<double>(usage.ru_utime.tv_usec);
}

template <class Work>
double median_time(int repeats, Work work) {
  std::vector<double> times;
  for (int k = 0; k < repeats; ++k) {
    const double start = cpu_milliseconds();
    work();
    times.push_back(cpu_milliseconds() - start);
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

void time_pair(int frequency, double distance, int repeats) {
  const Eigen::Vector3d way = Eigen::Vector3d(0.6, 0.5, 0.62).normalized();
  const Mesh mesh_a = make_icosphere({0, 0, 0}, 1, frequency), mesh_b = make_icosphere(distance * way, 1, frequency);
  const MeshData a = to_mesh_data(mesh_a), b = to_mesh_data(mesh_b);
  BooleanOptions trusting;
  trusting.inputs_are_sound = true;
  BooleanResult result;
  const double ours =
      median_time(repeats, [&] { result = boolean(view_of(a), view_of(b), BooleanOperation::unite, trusting); });
  const double meet = median_time(repeats, [&] { surfaces_meet(view_of(a), view_of(b)); });
  Mesh united;
  const double copies = median_time(repeats, [&] { Mesh x = mesh_a, y = mesh_b; });
  const double cgal = median_time(repeats,
                                  [&] {
                                    Mesh x = mesh_a, y = mesh_b;
                                    united.clear();
                                    CGAL::Polygon_mesh_processing::corefine_and_compute_union(x, y, united);
                                  }) -
                      copies;
  fmt::print("{:>9} {:>8.2f} {:>5} {:>9.2f} {:>9.2f} {:>7.3f} {:>9.3f} {:>10.1e}\n", a.triangles.size(), distance,
             result.seam.size(), ours, cgal, ours / cgal, meet,
             result.volume / boolean_cases::volume(to_mesh_data(united)) - 1);
}

void time_batch(int count) {
  random_pairs::Numbers numbers(7);
  std::vector<MeshData> drops;
  const double half = 0.5 * std::cbrt(count * 2.5);  // so that most touch others
  for (int k = 0; k < count; ++k)
    drops.push_back(boolean_cases::rotated(boolean_cases::ball(5), numbers.between(0, 6), numbers.vector(1)));
  for (auto& drop : drops) drop = boolean_cases::moved(drop, numbers.vector(half));
  MeshMergeReport report;
  std::optional<MeshData> all;
  const double ours =
      median_time(3, [&] { all = merge_meshes(drops, BooleanOperation::unite, BooleanOptions{}, report); });
  fmt::print(
      "\n{} drops of {} triangles, checked before and after: {:.0f} ms, {} of {} joins of surfaces that meet, "
      "{} faces, {} retries{}\n",
      count, drops[0].triangles.size(), ours, report.crossings, report.joins, all ? all->triangles.size() : 0,
      report.retries, all ? "" : ", refused: " + report.message);
}

void time_all(bool quick) {
  fmt::print("union of two icospheres of radius 1, user ms; `meet` is surfaces_meet\n");
  fmt::print("triangles distance  seam      ours      CGAL   ratio      meet     volume\n");
  const std::vector<int> frequencies = quick ? std::vector<int>{7} : std::vector<int>{7, 16, 32, 71};
  for (const double distance : {1.1, 1.95})
    for (const int frequency : frequencies)
      time_pair(frequency, distance, frequency > 40 ? 3 : frequency > 20 ? 7 : 15);
  time_batch(quick ? 10 : 100);
}

/// Judges cases `first` to `first + count - 1`; returns how many failed.
template <class Judge>
int stress(const char* what, unsigned first, int count, Judge judge) {
  int failed = 0, refused = 0, slow = 0;
  for (unsigned seed = first; seed < first + static_cast<unsigned>(count); ++seed) {
    const random_pairs::Verdict verdict = judge(seed);
    refused += verdict.refused;
    slow += verdict.slow_steps;
    if (verdict.failure.empty()) continue;
    ++failed;
    fmt::print("{}\n", verdict.failure);
    std::fflush(stdout);
  }
  fmt::print("{} {}: {} with something wrong or refused, {} refusals, {} results by later steps\n", count, what, failed,
             refused, slow);
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int k, int otherwise) { return argc > k ? std::atoi(argv[k]) : otherwise; };
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "--stress")
    return stress("pairs", static_cast<unsigned>(number(3, 1)), number(2, 1000),
                  [](unsigned seed) { return random_pairs::judge_pair(random_pairs::pair(seed)); }) > 0;
  if (mode == "--sequences")
    return stress("sequences of 100 drops", static_cast<unsigned>(number(3, 1)), number(2, 10),
                  [](unsigned seed) { return random_pairs::judge_sequence(seed, 100); }) > 0;
  if (!mode.empty() && mode != "--quick") {
    fmt::print(stderr, "usage: bench_merge [--quick | --stress [N [SEED]] | --sequences [N [SEED]]]\n");
    return 2;
  }
  time_all(mode == "--quick");
  return 0;
}
