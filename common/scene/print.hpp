#pragma once

#include <string>

#include "common/scene/table.hpp"

namespace drogue::scene {

/// Prints the scene that `root` is bound to as TOML: every value that is set and applies, in the order of
/// declaration.
std::string print(const Table& root);

}  // namespace drogue::scene
