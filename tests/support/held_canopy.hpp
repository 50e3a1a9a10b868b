#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// A C-9 that is held in a stream of 10 m/s.
inline const char* const held = R"(app = "parachute"
[fluid]
density = 1.25
velocity = [0, 0, 10]
[grid]
cells = [90, 90, 90]
domain = [[-18, 18], [-18, 18], [-18, 18]]
boundary = { x = "slip", y = "slip", z = ["inflow", "outflow"] }
[[canopy]]
kind = "flat-circular"
edge_length = 0.2
payload = { fixed = true }
[run]
end_time = 4
)";

/// A scene in a temporary file.
class SceneFile {
 public:
  explicit SceneFile(const std::string& text = held) { std::ofstream(_path) << text; }
  ~SceneFile() { std::filesystem::remove(_path); }
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return _path; }
  [[nodiscard]] FlowScene read(const std::vector<std::string>& sets = {}) const {
    return read_flow_scene(_path, sets);
  }
  [[nodiscard]] std::string refusal(const std::vector<std::string>& sets) const {
    try {
      (void)read(sets);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::invalid_scene);
      return failure.what();
    }
    return "none";
  }

 private:
  std::filesystem::path _path =
      std::filesystem::temp_directory_path() / ("flight" + std::to_string(::getpid()) + ".toml");
};

}  // namespace drogue::parachute_app
