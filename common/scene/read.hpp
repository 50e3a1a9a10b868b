#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/scene/node.hpp"
#include "common/scene/table.hpp"

namespace drogue::scene {

/// Reads a document into the struct that `root` is bound to. Throws `Failure` (invalid_scene) with the most
/// important error: a decisive key, then unknown keys, invalid values, missing keys, contradictions; among
/// equals the first in the document.
void read(Table& root, const Node& document);

/// Reads a TOML file with its `--set` assignments, in their order, into the struct that `root` is bound to.
/// Throws `Failure`: usage for an unreadable file, invalid_scene as `read` does.
void read_file(Table& root, const std::filesystem::path& file, const std::vector<std::string>& assignments);

/// Throws `Failure` (invalid_scene) with `FILE:LINE: sentence` for the key `path`: a contradiction that only
/// the application detects.
[[noreturn]] void contradict(const Table& root, const std::string& path, const std::string& sentence);

}  // namespace drogue::scene
