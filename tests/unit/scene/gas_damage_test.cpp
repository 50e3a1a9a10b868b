#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "miniapps/gas/scene/scene.hpp"
#include "tests/support/damaged.hpp"

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

class DamagedGasScene : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file); }

  /// True if the scene is refused. Only a scene error with file and line is allowed.
  bool is_refused(const std::string& text) const {
    std::ofstream(file, std::ios::binary) << text;
    try {
      static_cast<void>(read_gas_scene(file, {}, SchemeSource::scene));
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::invalid_scene) << text;
      EXPECT_TRUE(std::string(failure.what()).starts_with(file.string() + ":")) << failure.what();
      return true;
    }
    return false;
  }

  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("drogue-damaged-" + std::to_string(::getpid()) + ".toml");
};

TEST_F(DamagedGasScene, IsRejectedWithFileAndLineUnlessStillValid) {
  constexpr unsigned mutations = 2000;
  const std::vector<std::string> sound = sound_scenes();
  unsigned refused = 0;
  for (unsigned seed = 0; seed < mutations; ++seed)
    refused += is_refused(testing::damaged(sound[seed % sound.size()], seed)) ? 1U : 0U;
  EXPECT_GT(refused, mutations / 2);
  EXPECT_LT(refused, mutations);
}

TEST_F(DamagedGasScene, UndamagedSceneIsValid) {
  for (const std::string& text : sound_scenes()) EXPECT_FALSE(is_refused(text)) << text;
}

}  // namespace
}  // namespace drogue::gas_app
