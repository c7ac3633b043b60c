// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/core/error.h"
#include "meniscus/geometry/inspect.h"
#include "meniscus/topology/merge_meshes.h"
#include "support/boolean_cases.h"
#include "support/random_pairs.h"

#include <gtest/gtest.h>

#include <set>

namespace meniscus {
namespace {

using boolean_cases::Case;

constexpr BooleanOperation operations[] = {BooleanOperation::unite, BooleanOperation::intersect,
                                           BooleanOperation::subtract};

double expected_volume(BooleanOperation operation, double a, double b, double common) {
  return operation == BooleanOperation::unite       ? a + b - common
         : operation == BooleanOperation::intersect ? common
                                                    : a - common;
}

/// Needles whose volume is all rounding: `check` cannot tell their inside, so they are refused.
bool may_be_refused(const Case& c) { return c.name.rfind("a needle of 1e-", 0) == 0 && c.name != "a needle of 1e-3"; }

/// Every eighth case, so that they run side by side.
class EighthOfBooleanBattery : public testing::TestWithParam<std::size_t> {};
constexpr std::size_t eighths = 8;

TEST_P(EighthOfBooleanBattery, IsSoundAndOfTheExactVolumeOrRefusedWithAReason) {
  const auto cases = boolean_cases::valid_cases();
  EXPECT_GE(cases.size(), 60u);
  for (std::size_t k = GetParam(); k < cases.size(); k += eighths) {
    const Case& c = cases[k];
    SCOPED_TRACE(c.name);
    const double a = boolean_cases::volume(c.a), b = boolean_cases::volume(c.b);
    const double common = boolean_cases::common_volume(c.a, c.b);
    for (const auto operation : operations) {
      const BooleanResult result = boolean(view_of(c.a), view_of(c.b), operation);
      if (!result.ok()) {
        EXPECT_TRUE(may_be_refused(c)) << name(result.refusal) << ": " << result.message;
        EXPECT_NE(result.refusal, BooleanRefusal::none);
        EXPECT_FALSE(result.message.empty());
        continue;
      }
      EXPECT_EQ(random_pairs::defect(result), "");
      EXPECT_TRUE(result.triangles.empty() || inspect(random_pairs::data_of(result)).sound);
      EXPECT_NEAR(result.volume, expected_volume(operation, a, b, common), 1e-9 * (a + b));
      EXPECT_LE(result.shift.norm(), 2e-10 * std::cbrt(a + b) * 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BooleanBattery, EighthOfBooleanBattery, testing::Range(std::size_t{0}, eighths));

TEST(BooleanBattery, ContactsHaveTheOutcomesOfTheTable) {
  const std::map<std::string, BooleanOutcome> expected = {{"identical cubes", BooleanOutcome::equal},
                                                          {"identical cubes, other diagonals", BooleanOutcome::equal},
                                                          {"identical tori", BooleanOutcome::equal},
                                                          {"touching at a face", BooleanOutcome::touching},
                                                          {"touching at part of a face", BooleanOutcome::touching},
                                                          {"touching at an edge", BooleanOutcome::touching},
                                                          {"touching at part of an edge", BooleanOutcome::touching},
                                                          {"touching at a vertex", BooleanOutcome::touching},
                                                          {"inside with a common face", BooleanOutcome::b_inside_a},
                                                          {"inside with a common edge", BooleanOutcome::b_inside_a},
                                                          {"inside with a common corner", BooleanOutcome::b_inside_a},
                                                          {"nested", BooleanOutcome::b_inside_a},
                                                          {"nested, touching at a vertex", BooleanOutcome::b_inside_a},
                                                          {"disjoint", BooleanOutcome::disjoint},
                                                          {"linked tori", BooleanOutcome::disjoint},
                                                          {"a ball in a cavity", BooleanOutcome::disjoint},
                                                          {"four coplanar faces", BooleanOutcome::crossing},
                                                          {"deep overlap", BooleanOutcome::crossing},
                                                          {"one bar through many", BooleanOutcome::crossing}};
  std::size_t found = 0;
  for (const Case& c : boolean_cases::valid_cases()) {
    const auto outcome = expected.find(c.name);
    if (outcome == expected.end()) continue;
    ++found;
    const BooleanResult result = boolean(view_of(c.a), view_of(c.b), BooleanOperation::unite);
    EXPECT_STREQ(name(result.outcome), name(outcome->second)) << c.name;
  }
  EXPECT_EQ(found, expected.size());
}

TEST(BooleanBattery, BadMeshesAreRefusedOrRepaired) {
  const std::set<std::string> harmless = {"a point without faces"};
  const std::set<std::string> beyond_repair = {"nan", "infinity", "1e300", "empty", "points without faces", "a fin"};
  const auto cases = boolean_cases::bad_cases();
  EXPECT_GE(cases.size(), 14u);
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const BooleanResult result = boolean(view_of(c.a), view_of(c.b), BooleanOperation::unite);
    if (harmless.count(c.name) > 0) {
      EXPECT_EQ(random_pairs::defect(result), "");
    } else {
      EXPECT_EQ(result.refusal, BooleanRefusal::unsound_input);
      EXPECT_FALSE(result.message.empty());
      EXPECT_TRUE(result.triangles.empty());
    }
    MeshMergeReport report;
    try {
      const MeshData mended = repair_soup(c.a);
      const auto merged = merge_meshes({mended, c.b}, BooleanOperation::unite, {}, report);
      if (!merged) {
        EXPECT_EQ(c.name, "1e300") << report.message;
        continue;
      }
      EXPECT_TRUE(inspect(*merged).sound);
      const double a = boolean_cases::volume(mended), b = boolean_cases::volume(c.b);
      EXPECT_NEAR(boolean_cases::volume(*merged), a + b - boolean_cases::common_volume(mended, c.b), 1e-9 * (a + b));
    } catch (const GeometryError& error) {
      EXPECT_EQ(beyond_repair.count(c.name), 1u) << error.what();
    }
  }
}

TEST(BooleanBattery, RandomPairsAreSoundAndObeyInclusionAndExclusion) {
  for (unsigned seed = 1; seed <= 60; ++seed) EXPECT_EQ(random_pairs::judge_pair(random_pairs::pair(seed)).failure, "");
}

TEST(BooleanBattery, DropsUnitedOneAfterAnotherStaySound) {
  for (unsigned seed = 1; seed <= 2; ++seed) EXPECT_EQ(random_pairs::judge_sequence(seed, 40).failure, "");
}

}  // namespace
}  // namespace meniscus
