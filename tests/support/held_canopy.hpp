#pragma once

#include <string>
#include <vector>

#include "miniapps/parachute/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_file.hpp"

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
struct SceneFile : testing::TemporaryFile {
  explicit SceneFile(const std::string& text = held) : TemporaryFile(text) {}

  [[nodiscard]] FlowScene read(const std::vector<std::string>& sets = {}) const {
    return read_flow_scene(path(), sets);
  }
  [[nodiscard]] std::string refusal(const std::vector<std::string>& sets) const {
    return testing::refusal_of([&] { return read(sets); });
  }
};

}  // namespace drogue::parachute_app
