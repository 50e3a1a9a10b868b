#include "miniapps/framework/scene_identity.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "common/run/restart/restart_file.hpp"

namespace drogue::framework {
namespace {

using Values = std::vector<std::pair<std::string, std::string>>;

/// Dotted keys and values of a printed scene in its order; elements of arrays of tables are numbered.
Values values_of(const std::string& keys) {
  Values values;
  std::map<std::string, int> elements;
  std::string table, line;
  std::istringstream lines(keys);
  while (std::getline(lines, line)) {
    if (line.starts_with("[[")) {
      const std::string name = line.substr(2, line.size() - 4);
      table = name + "[" + std::to_string(elements[name]++) + "].";
    } else if (line.starts_with("[")) {
      table = line.substr(1, line.size() - 2) + ".";
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      const std::string key = table + line.substr(0, equals);
      std::string value = line.substr(equals + 3);
      // An array of tables has a line for each.
      if (value == "[") {
        while (std::getline(lines, line) && line != "]") value += line;
        value += "]";
      }
      values.emplace_back(key, value);
    }
  }
  return values;
}

/// Value of a key; null if the key is absent.
const std::string* find(const Values& values, const std::string& key) {
  const auto at = std::ranges::find(values, key, &Values::value_type::first);
  return at == values.end() ? nullptr : &at->second;
}

/// Keys that are in one of the lists alone, or whose values differ.
std::vector<std::string> differing_keys(const Values& earlier, const Values& present) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : present)
    if (const std::string* other = find(earlier, key); other == nullptr || *other != value)
      keys.push_back(key);
  for (const auto& entry : earlier)
    if (find(present, entry.first) == nullptr) keys.push_back(entry.first);
  return keys;
}

std::string clause(const std::string& key, const std::string* earlier, const std::string* present) {
  constexpr std::size_t longest = 60;  // of a value that is worth a place in a sentence
  const auto is_long = [](const std::string* value) { return value != nullptr && value->size() > longest; };
  if (is_long(earlier) || is_long(present)) return key + " has changed";
  const auto text = [](const std::string* value) { return value == nullptr ? "not set" : *value; };
  return key + " was " + text(earlier) + " and is " + text(present);
}

}  // namespace

std::string fingerprint(const SceneIdentity& identity) {
  return run::fingerprint(identity.keys + identity.meshes);
}

std::string first_difference(const SceneIdentity& earlier, const SceneIdentity& present) {
  const Values values[] = {values_of(earlier.keys), values_of(present.keys)};
  const std::vector<std::string> keys = differing_keys(values[0], values[1]);
  if (keys.empty()) return earlier.meshes == present.meshes ? "" : "a mesh file has changed";
  const std::string& first = keys.front();
  std::string text = clause(first, find(values[0], first), find(values[1], first));
  const std::size_t others = keys.size() - 1;
  if (others == 1) text += ", and another key differs";
  if (others > 1) text += ", and " + std::to_string(others) + " other keys differ";
  return text;
}

}  // namespace drogue::framework
