// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/scene/read_scene.h"

#include "scene/scene_test_helpers.h"

namespace meniscus::test {
namespace {

TEST(SceneSettings, ChangeAddAndAppend) {
  const std::string text = with_drop(R"("liquid": {"density": 1})");
  const Scene scene =
      parse(text, {"liquid.viscosity=0.1", "drops.0.radius=0.3", "/drops/0/velocity=[1, 2, 3]", "model=paper",
                   "mesh={\"edge_min\": 0.02, \"edge_max\": 0.06}", "solids.0.shape=plane", "solids.0.name=a=b",
                   "topology.split=false", "drops.1={\"shape\": \"box\", \"size\": [1,1,1]}", "gravity=[0,0,0]",
                   "gravity.2=-1", "frames=1", "frames=2"});
  EXPECT_EQ(scene.liquid.viscosity, 0.1);
  EXPECT_EQ(scene.drops[0].radius, 0.3);
  EXPECT_EQ(scene.drops[0].velocity, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(scene.model, Level::paper);
  EXPECT_EQ(scene.mesh.edge_max, 0.06);
  ASSERT_EQ(scene.solids.size(), 1u);
  EXPECT_EQ(scene.solids[0].name, "a=b");
  EXPECT_FALSE(scene.topology.split);
  ASSERT_EQ(scene.drops.size(), 2u);
  EXPECT_EQ(scene.drops[1].shape, DropShape::box);
  EXPECT_EQ(scene.gravity, Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(scene.frames, 2);
}

TEST(SceneSettings, Errors) {
  const auto refuse = [](const std::string& setting, const std::string& message) {
    expect_messages(with_drop(""), {message}, {setting});
  };
  refuse("liquid.visc=1", "--set liquid.visc=1: unknown key; did you mean \"viscosity\"? (cm^2/s, >= 0)");
  refuse("liquid={\"visc\": 1}",
         "--set liquid={\"visc\": 1} /liquid/visc: unknown key; did you mean \"viscosity\"? (cm^2/s, >= 0)");
  refuse("frames=lots", "--set frames=lots: expected a whole number, found a string");
  refuse("frames=", "--set frames=: expected a whole number, found a string");
  refuse("drops.0.radius=-1", "--set drops.0.radius=-1: -1 is out of range; it must be > 0 cm");
  refuse("drops.2.radius=1", "--set drops.2.radius=1: /drops has 1 items in the scene; the next to add is number 1");
  refuse("drops.x.radius=1", "--set drops.x.radius=1: /drops is a list, so \"x\" should be an index from 0");
  refuse("drops.0.radius.x=1", "--set drops.0.radius.x=1: /drops/0/radius is a number, which has no \"x\"");
  refuse("frames", "--set frames: expected path=value, as in liquid.viscosity=0.1");
  refuse("=1", "--set =1: expected a path before the =, as in drops.0.radius or /drops/0/radius");
  refuse("a..b=1", "--set a..b=1: expected a path before the =, as in drops.0.radius or /drops/0/radius");
  refuse("/a~b=1", "--set /a~b=1: expected a path before the =, as in drops.0.radius or /drops/0/radius");
  refuse("time_step=1e999", "--set time_step=1e999: the number 1e999 is too large");
  refuse("name=\xff", "--set name=\xff: this is not UTF-8 text");
  refuse("mesh.edge_max=0.05",
         "--set mesh.edge_max=0.05: edge_min 0.04 must be less than half of edge_max 0.05, or every split "
         "would be undone");
}

TEST(SceneSettings, ComeAfterTheFileInMessages) {
  expect_messages("{\"frames\": -1}",
                  {"s.json:1:1: missing \"drops\" (a list of objects), and there are no \"sources\"",
                   "s.json:1:12 /frames: -1 is out of range; it must be >= 0, <= 10000000",
                   "--set time_step=0: 0 is out of range; it must be > 0, <= 1 s"},
                  {"time_step=0"});
}

}  // namespace
}  // namespace meniscus::test
