#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue::scene {

struct ShippedScene {
  std::string name;  ///< the file's name without `.toml`
  std::string description;
  std::filesystem::path file;
};

/// The scenes in a folder, by name; none where the folder is missing. A file that is not TOML has no
/// description.
std::vector<ShippedScene> list_scenes(const std::filesystem::path& folder);

/// One line a scene: its name, then its description.
std::string list_text(const std::vector<ShippedScene>& scenes);

/// The file that the SCENE argument means: a file of that name, else the shipped scene of that name.
/// Throws Failure(usage) with the nearest shipped name where there is neither.
std::filesystem::path find_scene(const std::string& argument, const std::filesystem::path& folder);

}  // namespace drogue::scene
