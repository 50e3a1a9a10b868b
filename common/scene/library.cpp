#include "common/scene/library.hpp"

#include <algorithm>

#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/parse.hpp"

namespace drogue::scene {
namespace {

std::string description_of(const std::filesystem::path& file) {
  try {
    const Node document = parse_file(file);
    const Node* description = document.find("description");
    if (description == nullptr || description->as<std::string>() == nullptr) return {};
    std::string text = *description->as<std::string>();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  } catch (const Failure&) {
    return {};  // running the scene names the error
  }
}

}  // namespace

std::vector<ShippedScene> list_scenes(const std::filesystem::path& folder) {
  std::vector<ShippedScene> scenes;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
    if (entry.path().extension() != ".toml") continue;
    scenes.push_back({entry.path().stem().string(), description_of(entry.path()), entry.path()});
  }
  std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return scenes;
}

std::string list_text(const std::vector<ShippedScene>& scenes) {
  std::size_t width = 0;
  for (const ShippedScene& scene : scenes) width = std::max(width, scene.name.size());
  std::string text;
  for (const ShippedScene& scene : scenes) {
    const std::string gap(width - scene.name.size() + 2, ' ');
    text += scene.name + (scene.description.empty() ? "" : gap + scene.description) + "\n";
  }
  return text;
}

std::filesystem::path find_scene(const std::string& argument, const std::filesystem::path& folder) {
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(argument, unreadable)) return argument;
  std::vector<std::string> names;
  for (const ShippedScene& scene : list_scenes(folder)) {
    if (scene.name == argument) return scene.file;
    names.push_back(scene.name);
  }
  if (std::filesystem::is_directory(argument, unreadable))
    throw Failure(ExitCode::usage, argument + " is a folder, not a scene file");
  if (std::filesystem::exists(argument, unreadable)) return argument;  // say a pipe
  const std::string hint =
      names.empty() ? "" : "; " + suggestion(std::filesystem::path(argument).stem().string(), names);
  throw Failure(ExitCode::usage,
                "there is no scene file " + argument + " and no shipped scene of that name" + hint);
}

}  // namespace drogue::scene
