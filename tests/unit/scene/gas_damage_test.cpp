#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {
namespace {

/// Every way a scene is written.
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

/// `text` after one to four small accidents, which follow from `seed`.
std::string damaged(std::string text, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const auto byte = [&] { return static_cast<char>(random() & 0xffU); };
  const std::string printable = " \n\t\"'[]{}=.,#+-0123456789eE_abcxyz^*/()<>&|?:";
  const std::string numbers[] = {"0", "-1", "9999999999", "1e308", "1e-320", "nan", "inf", "0x7f", "7"};
  for (std::size_t accidents = 1 + below(4); accidents > 0; --accidents) {
    if (text.empty()) text = "a";
    const std::size_t place = below(text.size());
    switch (below(8)) {
      case 0:
        text[place] = byte();
        break;
      case 1:
        text[place] = printable[below(printable.size())];
        break;
      case 2:
        text[place] = static_cast<char>(text[place] ^ (1 << below(8)));
        break;
      case 3:
        text.insert(place, std::string(1 + below(4), byte()));
        break;
      case 4:
        text.erase(place, 1 + below(8));
        break;
      case 5:
        text.resize(place);
        break;
      case 6: {
        const std::string piece = text.substr(place, 1 + below(40));
        for (std::size_t times = 1 + below(20); times > 0; --times) text.insert(place, piece);
        break;
      }
      default:
        if (const std::size_t digit = text.find_first_of("0123456789", place); digit != std::string::npos)
          text.replace(digit, 1, numbers[below(std::size(numbers))]);
    }
  }
  return text;
}

class DamagedGasScene : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file); }

  /// Whether it is refused; nothing but a scene error with file and line may come of it.
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

TEST_F(DamagedGasScene, IsRefusedWithItsPlaceOrSound) {
  constexpr unsigned mutations = 2000;
  const std::vector<std::string> sound = sound_scenes();
  unsigned refused = 0;
  for (unsigned seed = 0; seed < mutations; ++seed)
    refused += is_refused(damaged(sound[seed % sound.size()], seed)) ? 1U : 0U;
  EXPECT_GT(refused, mutations / 2);
  EXPECT_LT(refused, mutations);
}

TEST_F(DamagedGasScene, IsSoundBefore) {
  for (const std::string& text : sound_scenes()) EXPECT_FALSE(is_refused(text)) << text;
}

}  // namespace
}  // namespace drogue::gas_app
