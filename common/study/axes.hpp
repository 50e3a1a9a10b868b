#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace drogue::study {

/// Axis of `--study` with its valid words.
struct WordAxis {
  std::string name;
  std::vector<std::string> words;
};

/// Unit and range of mesh sizes.
struct MeshAxis {
  std::string unit;  ///< in the plural, say cells
  std::int64_t least;
  int most_exponent;  ///< at most two to this power
};

/// Values to vary. An axis that `--study` does not name is empty and keeps the value of the scene.
struct Axes {
  std::vector<std::int64_t> meshes;
  std::map<std::string, std::vector<std::string>> words;

  /// Values of an axis. For an unnamed axis one empty text, which sets nothing.
  [[nodiscard]] std::vector<std::string> of(const std::string& name) const;
};

/// Names of the axes of `parse_axes`. Throws only std::bad_alloc.
[[nodiscard]] std::vector<std::string> names_of(const std::vector<WordAxis>& words);

/// Parses `meshes=100:800,schemes=js:z,...`. Two meshes are the ends of a doubling sequence; three or more
/// are taken literally. Throws `Failure` (usage).
Axes parse_axes(const std::string& text, const MeshAxis& mesh, const std::vector<WordAxis>& words);

}  // namespace drogue::study
