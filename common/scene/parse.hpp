#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/scene/node.hpp"

namespace drogue::scene {

/// Parses a TOML file. Throws `Failure`: usage if there is no readable file, invalid_scene (`FILE:LINE: ...`)
/// for invalid TOML.
Node parse_file(const std::filesystem::path& file);

/// Parses a text; `name` replaces the file name in errors.
Node parse_text(std::string_view text, const std::string& name);

/// Applies `key.path=value` to the document; a path may index an array (`part[0].radius` or
/// `part.0.radius`). The value is TOML; a bare word is a string. Throws `Failure` (invalid_scene) with `--set
/// key.path=value: ...`.
void apply_set(Node& document, const std::string& assignment);

}  // namespace drogue::scene
