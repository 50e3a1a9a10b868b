#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "common/program/failure.hpp"
#include "miniapps/gas/scene.hpp"

namespace drogue::gas_app {
namespace {

/// Every way a scene is written: expressions, regions and tables beside inline tables.
const std::string sound_scenes[] = {
    R"scene(app = "gas"
description = "A shock tube."
[gas]
gamma = 1.4
[mesh]
cells = 100
domain = [-1.0, 1.0]
[initial]
riemann = { x0 = 0.0, left = { rho = 1.0, u = 0.0, p = 1.0 }, right = { rho = 0.125, u = 0.0, p = 0.1 } }
[scheme]
weno = "z"
weno_power = 1
cfl = 0.6
[run]
end_time = 0.1
max_steps = 10000
[output]
fields = ["rho", "u", "p"]
times = [0.05, 0.1]
[verify]
exact = "riemann"
l1_density = 0.1
)scene",
    R"scene(app = "gas"
[mesh]
cells = 40
domain = [-1, 1]
[gas]
gamma = 1.4
[initial.expression]
rho = "1 + 0.2*sin(pi*x)^2 + (x < 0 ? 0.1 : besselj(0, x))"
u = "1"
p = "max(1, 2, exp(-x^2/dx))"
[boundary]
left = "periodic"
right = "periodic"
[run]
end_time = 0.02
)scene",
    R"scene(app = "gas"
description = '''
Three states.'''
gas.gamma = 1.4
mesh = { cells = 40, domain = [0.0, 1.0] }
[run]
end_time = 1_0.0e-3
[boundary]
left = "reflecting"
[[initial.regions]]
until = 0.1
rho = 1
p = 1000.0
[[initial.regions]] # the last
rho = 1.0
u = -0.5
p = 1e-2
[scheme]
weno = "teno5"
positivity = "on"
)scene"};

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
  unsigned refused = 0;
  for (unsigned seed = 0; seed < mutations; ++seed)
    refused += is_refused(damaged(sound_scenes[seed % std::size(sound_scenes)], seed)) ? 1U : 0U;
  EXPECT_GT(refused, mutations / 2);
  EXPECT_LT(refused, mutations);
}

TEST_F(DamagedGasScene, IsSoundBefore) {
  for (const std::string& text : sound_scenes) EXPECT_FALSE(is_refused(text)) << text;
}

}  // namespace
}  // namespace drogue::gas_app
