#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "miniapps/gas/scene/scene.hpp"
#include "tests/support/damaged.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

namespace drogue::gas_app {
namespace {

/// Scenes that cover every syntax.
std::vector<std::string> sound_scenes() {
  const std::filesystem::path folder =
      std::filesystem::path(DROGUE_SOURCE_DIR) / "tests/negative/sound_scenes";
  std::vector<std::string> texts;
  for (const char* name : {"riemann.toml", "expressions.toml", "regions.toml"}) {
    std::ostringstream text;
    text << std::ifstream(folder / name, std::ios::binary).rdbuf();
    texts.push_back(text.str());
  }
  return texts;
}

/// True if the scene is refused. Only a scene error with file and line is allowed.
bool is_refused(const std::string& text) {
  const testing::TemporaryFile file(text);
  const std::string refusal =
      testing::refusal_of([&] { return read_gas_scene(file.path(), {}, SchemeSource::scene); });
  EXPECT_TRUE(refusal.empty() || refusal.starts_with(file.path().string() + ":")) << refusal << text;
  return !refusal.empty();
}

TEST(DamagedGasScene, IsRejectedWithFileAndLineUnlessStillValid) {
  constexpr unsigned mutations = 2000;
  const std::vector<std::string> sound = sound_scenes();
  unsigned refused = 0;
  for (unsigned seed = 0; seed < mutations; ++seed)
    refused += is_refused(testing::damaged(sound[seed % sound.size()], seed)) ? 1U : 0U;
  EXPECT_GT(refused, mutations / 2);
  EXPECT_LT(refused, mutations);
}

TEST(DamagedGasScene, UndamagedSceneIsValid) {
  for (const std::string& text : sound_scenes()) EXPECT_FALSE(is_refused(text)) << text;
}

}  // namespace
}  // namespace drogue::gas_app
