#pragma once

#include <string>
#include <vector>

#include "common/scene/table.hpp"

namespace drogue::scene {

/// Markdown tables of all keys, one per table of the scene: key, type, unit, default, range, meaning.
std::string document(const Table& root);

/// Paths of all keys that can be declared below `root`; array elements as `[]`.
std::vector<std::string> all_paths(const Table& root);

}  // namespace drogue::scene
