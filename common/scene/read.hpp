#pragma once

#include <string>

#include "common/scene/node.hpp"
#include "common/scene/table.hpp"

namespace drogue::scene {

/// Reads a document into the struct that `root` is bound to. Throws Failure(invalid_scene) with the one error
/// that matters most: a decisive key, then unknown keys, wrong values, missing keys, contradictions; among
/// equals the first in the document.
void read(Table& root, const Node& document);

/// Throws Failure(invalid_scene) `FILE:LINE: sentence`, at the key of this path: a contradiction that only
/// the app can see.
[[noreturn]] void contradict(const Table& root, const std::string& path, const std::string& sentence);

}  // namespace drogue::scene
