#include "common/scene/parse.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/program/failure.hpp"

namespace drogue::scene {
namespace {

/// Names the place of a TOML node: a line of a file, or one and the same text for all of a `--set`.
class Place {
 public:
  static Place in_file(std::string name) { return Place(std::move(name), true); }
  static Place of_set(std::string assignment) { return Place("--set " + std::move(assignment), false); }

  [[nodiscard]] std::string at(const toml::source_position& position) const {
    if (!_has_lines) return _name;
    return _name + ":" + std::to_string(std::max<std::uint32_t>(position.line, 1));
  }

 private:
  Place(std::string name, bool has_lines) : _name(std::move(name)), _has_lines(has_lines) {}

  std::string _name;
  bool _has_lines;
};

Node convert(const toml::node& source, const Place& place);

Node::Table convert_table(const toml::table& source, const Place& place) {
  Node::Table table;
  for (const auto& [key, value] : source) {
    table.push_back({std::string(key.str()), place.at(key.source().begin), convert(value, place)});
  }
  // toml++ sorts by name; the user reads from top to bottom
  std::vector<std::pair<toml::source_position, std::size_t>> order;
  for (const auto& [key, value] : source) order.emplace_back(key.source().begin, order.size());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Node::Table sorted;
  for (const auto& [position, index] : order) sorted.push_back(std::move(table[index]));
  return sorted;
}

Node convert(const toml::node& source, const Place& place) {
  Node node;
  node.origin = place.at(source.source().begin);
  if (const auto* table = source.as_table()) {
    node.value = convert_table(*table, place);
  } else if (const auto* array = source.as_array()) {
    Node::Array elements;
    for (const toml::node& element : *array) elements.push_back(convert(element, place));
    node.value = std::move(elements);
  } else if (const auto* boolean = source.as_boolean()) {
    node.value = boolean->get();
  } else if (const auto* integer = source.as_integer()) {
    node.value = integer->get();
  } else if (const auto* real = source.as_floating_point()) {
    node.value = real->get();
  } else if (const auto* text = source.as_string()) {
    node.value = text->get();
  } else {
    node.value = Date{};
  }
  return node;
}

Node parse(std::string_view text, const Place& place) {
  try {
    return convert(toml::parse(text), place);
  } catch (const toml::parse_error& error) {
    const auto& position = error.source().begin;
    std::string where = place.at(position) + ": ";
    if (position.column > 0) where += "column " + std::to_string(position.column) + ": ";
    throw Failure(ExitCode::invalid_scene, where + std::string(error.description()));
  }
}

std::vector<std::string> split_path(const std::string& path, const std::string& place) {
  std::vector<std::string> parts;
  std::istringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  const bool empty_part =
      std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.empty(); });
  if (parts.empty() || empty_part || path.back() == '.') {
    throw Failure(ExitCode::invalid_scene, place + ": the key is not of the form table.key");
  }
  return parts;
}

/// A value in TOML, or a bare word: a shell eats the quotes of --set scheme.weno="js".
Node parse_value(const std::string& text, const Place& place) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos || text.find('\n') != std::string::npos) {
    throw Failure(ExitCode::invalid_scene, place.at({}) + ": the value is missing or holds a line break");
  }
  const bool bare = text.find_first_of("\"'[]{}=#") == std::string::npos;
  try {
    return parse("value = " + text, place).as<Node::Table>()->front().node;
  } catch (const Failure& failure) {
    if (!bare) throw Failure(ExitCode::invalid_scene, place.at({}) + ": the value is not TOML: " + text);
    return Node{text, place.at({})};
  }
}

Node* element_of(Node::Array& array, const std::string& index) {
  if (index.size() > 9 || index.find_first_not_of("0123456789") != std::string::npos) return nullptr;
  const auto position = static_cast<std::size_t>(std::stoul(index));
  return position < array.size() ? &array[position] : nullptr;
}

/// The node a path part leads to, made an empty table where there is none. `origin` becomes that of its key.
Node& step_into(Node& node, const std::string& part, const std::string& place, const std::string& walked,
                std::string*& origin) {
  if (auto* array = node.as<Node::Array>()) {
    if (Node* element = element_of(*array, part)) return *element;
    throw Failure(ExitCode::invalid_scene, place + ": " + walked + " has " + std::to_string(array->size()) +
                                               " elements, counted from 0, and none is \"" + part + "\"");
  }
  auto* table = node.as<Node::Table>();
  if (table == nullptr) {
    throw Failure(ExitCode::invalid_scene, place + ": " + walked + " is " + describe(node) + ", not a table");
  }
  for (Member& member : *table) {
    if (member.name != part) continue;
    origin = &member.origin;
    return member.node;
  }
  table->push_back({part, place, Node{Node::Table{}, place}});
  origin = &table->back().origin;
  return table->back().node;
}

}  // namespace

Node parse_text(std::string_view text, const std::string& name) { return parse(text, Place::in_file(name)); }

Node parse_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw Failure(ExitCode::usage, file.string() + " is a folder, not a scene file");
  }
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "unknown error";
    throw Failure(ExitCode::usage, "cannot read the scene file " + file.string() + ": " + reason);
  }
  return parse_text(text.str(), file.string());
}

void apply_set(Node& document, const std::string& assignment) {
  const Place place = Place::of_set(assignment);
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) {
    throw Failure(ExitCode::invalid_scene, place.at({}) + ": expected key.path=value");
  }
  std::string path = assignment.substr(0, equals);
  path.erase(path.find_last_not_of(" \t") + 1);
  const auto parts = split_path(path, place.at({}));
  Node value = parse_value(assignment.substr(equals + 1), place);
  Node* node = &document;
  std::string walked = "the scene";
  std::string* origin = nullptr;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    node = &step_into(*node, parts[i], place.at({}), walked, origin);
    walked = i == 0 ? parts[i] : walked + "." + parts[i];
  }
  *node = std::move(value);
  *origin = place.at({});  // what is wrong with the key is now the assignment's fault
}

}  // namespace drogue::scene
