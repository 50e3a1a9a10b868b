#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/scene/node.hpp"

namespace drogue::scene {

/// Reads a TOML file. Throws Failure: usage where there is no readable file, invalid_scene (`FILE:LINE: ...`)
/// where it is not TOML (bad syntax, a key given twice, bytes that are not UTF-8).
Node parse_file(const std::filesystem::path& file);

/// The same for a text; `name` stands for the file in errors.
Node parse_text(std::string_view text, const std::string& name);

/// Puts `key.path=value` into the document, over what is there or beside it; a path may index an array
/// (`initial.regions.0.rho`). The value is TOML; a bare word is taken as a string.
/// Throws Failure(invalid_scene) that starts `--set key.path=value: `.
void apply_set(Node& document, const std::string& assignment);

}  // namespace drogue::scene
