#include "common/scene/document.hpp"

namespace drogue::scene {
namespace {

/// Escapes vertical bars, which would end a cell.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + cell(text) + "`"; }

}  // namespace

class Documenter {
 public:
  static void sections(const Table& table, const Key* self, std::string& text) {
    text += self == nullptr ? "## Top level\n\n" : "## `" + heading(*self, table._path) + "`\n\n";
    if (self != nullptr) text += self->_help + "." + remark(*self) + "\n\n";
    if (!table._alternatives.empty()) text += alternatives(table) + "\n\n";
    std::string rows;
    for (const auto& key : table._keys) {
      if (key->_kind == Key::Kind::value) rows += row(*key);
    }
    if (!rows.empty())
      text += "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n" + rows + "\n";
    each_child(table, [&text](const Table& child, const Key& key) { sections(child, &key, text); });
  }

  static void paths(const Table& table, std::vector<std::string>& result) {
    for (const auto& key : table._keys) result.push_back(table.path_of(key->_name));
    each_child(table, [&result](const Table& child, const Key&) { paths(child, result); });
  }

 private:
  static std::string heading(const Key& key, const std::string& path) {
    if (key._kind != Key::Kind::tables) return "[" + path + "]";
    return "[[" + path.substr(0, path.size() - 2) + "]]";
  }

  template <class Visit>
  static void each_child(const Table& table, Visit visit) {
    for (const auto& key : table._keys) {
      if (key->_prototype) {
        visit(*key->_prototype(), *key);
      } else if (key->_kind == Key::Kind::table) {
        visit(*key->_tables.front(), *key);
      }
    }
  }

  static std::string alternatives(const Table& table) {
    if (table._alternatives.size() == table._keys.size()) return "Exactly one of its keys is given.";
    std::string names;
    for (const std::string& name : table._alternatives) names += (names.empty() ? "" : ", ") + code(name);
    return "Exactly one of " + names + " is given.";
  }

  static std::string remark(const Key& key) {
    std::string text;
    if (!key._rules.when.text.empty()) text += " Only " + cell(key._rules.when.text) + ".";
    if (key._kind != Key::Kind::value && key._rules.required) text += " Required.";
    return text;
  }

  static std::string row(const Key& key) {
    std::string standard = key._rules.default_text;
    if (standard.empty() && key._rules.required) standard = "required";
    if (standard.empty()) standard = code(key._codec.print().value_or(""));
    if (standard.empty()) standard = "none";
    return "| `" + key._name + "` | " + cell(key._codec.type) + " | " + key._rules.unit + " | " + standard +
           " | " + cell(key._rules.range.text()) + " | " + key._help + "." + remark(key) + " |\n";
  }
};

std::string document(const Table& root) {
  std::string text;
  Documenter::sections(root, nullptr, text);
  return text;
}

std::vector<std::string> all_paths(const Table& root) {
  std::vector<std::string> result;
  Documenter::paths(root, result);
  return result;
}

}  // namespace drogue::scene
