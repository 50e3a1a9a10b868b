#pragma once

#include <filesystem>
#include <string>
#include <utility>
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

/// Table of a scene that has been read, by its path, for what an application checks. Keys are relative to it;
/// the empty key is the table itself.
class Place {
 public:
  /// The whole scene. Keeps a reference to `root`.
  Place(const Table& root) : _root(root) {}  // NOLINT(google-explicit-constructor): a root is a place
  [[nodiscard]] Place at(const std::string& key) const { return {_root, path(key)}; }
  [[nodiscard]] Place at(const std::string& array, std::size_t index) const {
    return at(element(array, index));
  }
  /// Elements of an array of tables with their places: `for (const auto& [at, body] : root.each("body",
  /// bodies))`.
  template <class List>
  [[nodiscard]] auto each(const std::string& array, List& elements) const {
    std::vector<std::pair<Place, decltype(*elements.data())>> places;
    for (auto& element : elements) places.emplace_back(at(array, places.size()), element);
    return places;
  }

  /// Dotted path of a key from the root.
  [[nodiscard]] std::string path(const std::string& key = "") const {
    return _path.empty() || key.empty() ? _path + key : _path + "." + key;
  }
  [[nodiscard]] bool given(const std::string& key) const { return _root.given(path(key)); }

  /// Refuses the value of a key: `FILE:LINE: PATH PARTS`, with `sentence` of the parts. Throws `Failure`
  /// (invalid_scene).
  template <class... Parts>
  [[noreturn]] void refuse(const std::string& key, const Parts&... parts) const {
    contradict(key, path(key), parts...);
  }
  /// `refuse` where a condition holds. The parts are evaluated in any case.
  template <class... Parts>
  void refuse_if(bool is_wrong, const std::string& key, const Parts&... parts) const {
    if (is_wrong) refuse(key, parts...);
  }

  /// `refuse` with a sentence that does not begin with the path.
  template <class... Parts>
  [[noreturn]] void contradict(const std::string& key, const Parts&... parts) const {
    fail(path(key), sentence(parts...));
  }

 private:
  Place(const Table& root, std::string path) : _root(root), _path(std::move(path)) {}
  /// Throws `FILE:LINE: sentence` for the key with a path from the root.
  [[noreturn]] void fail(const std::string& path, const std::string& sentence) const;

  const Table& _root;
  std::string _path;
};

}  // namespace drogue::scene
