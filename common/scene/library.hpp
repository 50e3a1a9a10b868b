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

/// Scenes of a folder, sorted by name; empty if the folder is missing. A file that is not TOML has no
/// description.
std::vector<ShippedScene> list_scenes(const std::filesystem::path& folder);

/// One line per scene: its name, then its description.
std::string list_text(const std::vector<ShippedScene>& scenes);

/// File for the argument SCENE: a file of that path, else the shipped scene of that name. Throws `Failure`
/// (usage), with the nearest shipped name, if neither exists.
std::filesystem::path find_scene(const std::string& argument, const std::filesystem::path& folder);

}  // namespace drogue::scene
