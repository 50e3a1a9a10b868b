#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace drogue::study {

/// An axis of words that `--study` may name, and the words it may have.
struct WordAxis {
  std::string name;
  std::vector<std::string> words;
};

/// What a mesh is counted in, and how many of them there may be.
struct MeshAxis {
  std::string unit;  ///< in the plural, say cells
  std::int64_t least;
  int most_exponent;  ///< at most two to this power
};

/// What `--study` asks to vary; an axis that it does not name is empty, and keeps the scene's own value.
struct Axes {
  std::vector<std::int64_t> meshes;
  std::map<std::string, std::vector<std::string>> words;

  /// Values of an axis; for one that is not named an empty text alone, which sets nothing.
  [[nodiscard]] std::vector<std::string> of(const std::string& name) const;
};

/// Reads `meshes=100:800,schemes=js:z,...`. Two meshes are the ends of a doubling sequence; three or more are
/// taken as they stand. Throws Failure(usage).
Axes parse_axes(const std::string& text, const MeshAxis& mesh, const std::vector<WordAxis>& words);

}  // namespace drogue::study
