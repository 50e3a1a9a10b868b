#include <gtest/gtest.h>

#include <string>

#include "miniapps/framework/scene_identity.hpp"

namespace drogue::framework {
namespace {

constexpr const char* scene =
    "app = \"parachute\"\n\n[flow]\ntime = \"rk3\"\nweno = \"z\"\n\n"
    "[[canopy]]\ngores = 28\nbands = [\n  { width = 1 },\n  { width = 2 },\n]\n\n[[canopy]]\ngores = 28\n";

/// Difference after one text in the scene is replaced.
std::string difference(const std::string& old_text, const std::string& new_text) {
  std::string other = scene;
  other.replace(other.rfind(old_text), old_text.size(), new_text);
  return first_difference({scene, {}}, {other, {}});
}

TEST(SceneIdentity, DifferenceNamesTheKeyAndItsValues) {
  EXPECT_EQ(difference("\"rk3\"", "\"ab2\""), "flow.time was \"rk3\" and is \"ab2\"");
  EXPECT_EQ(difference("\"parachute\"", "\"gas\""), "app was \"parachute\" and is \"gas\"");
  EXPECT_EQ(difference("28", "30"), "canopy[1].gores was 28 and is 30");
  EXPECT_EQ(
      difference("{ width = 2 }", "{ width = 3 }"),
      "canopy[0].bands was [  { width = 1 },  { width = 2 },] and is [  { width = 1 },  { width = 3 },]");
}

TEST(SceneIdentity, DifferenceNamesKeysThatOneSceneLacks) {
  EXPECT_EQ(difference("weno = \"z\"\n", ""), "flow.weno was \"z\" and is not set");
  EXPECT_EQ(difference("weno", "pressure = \"fft\"\nweno"), "flow.pressure was not set and is \"fft\"");
}

TEST(SceneIdentity, DifferenceCountsTheOtherKeys) {
  EXPECT_EQ(difference("time = \"rk3\"\nweno = \"z\"", "time = \"ab2\"\nweno = \"js\""),
            "flow.time was \"rk3\" and is \"ab2\", and another key differs");
  EXPECT_EQ(
      difference("\n[[canopy]]\ngores = 28\n", "\n[[canopy]]\ngores = 30\nvent = 1\n[fluid]\ndensity = 1\n"),
      "canopy[1].gores was 28 and is 30, and 2 other keys differ");
}

TEST(SceneIdentity, DifferenceLeavesOutLongValues) {
  EXPECT_EQ(difference("\"rk3\"", "\"" + std::string(80, 'x') + "\""), "flow.time has changed");
}

TEST(SceneIdentity, MeshFilesCount) {
  EXPECT_EQ(first_difference({scene, "v 0"}, {scene, "v 1"}), "a mesh file has changed");
  EXPECT_EQ(first_difference({scene, "v 0"}, {scene, "v 0"}), "");
  EXPECT_NE(fingerprint({scene, "v 0"}), fingerprint({scene, "v 1"}));
}

}  // namespace
}  // namespace drogue::framework
