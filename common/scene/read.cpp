#include "common/scene/read.hpp"

#include <algorithm>

#include "common/program/failure.hpp"
#include "common/scene/document.hpp"
#include "common/scene/nearest.hpp"
#include "common/scene/parse.hpp"

namespace drogue::scene {

class Reader {
 public:
  explicit Reader(Table& root) : _root(root) {}

  void run(const Node& document) {
    bind(_root, document);
    drop_overridden(_root);
    check(_root);
    const auto worst =
        std::min_element(_errors.begin(), _errors.end(),
                         [](const SceneError& a, const SceneError& b) { return a.rank < b.rank; });
    if (worst != _errors.end()) throw Failure(ExitCode::invalid_scene, worst->text);
  }

 private:
  /// Kinds of errors by descending importance.
  enum class Rank { decisive, unknown, value, missing, contradiction };

  struct SceneError {
    Rank rank;
    std::string text;
  };

  void report(Rank rank, const std::string& origin, const std::string& sentence) {
    _errors.push_back({rank, origin + ": " + sentence});
  }

  void bind(Table& table, const Node& node) {
    table._origin = node.origin;
    for (const Member& member : *node.as<Node::Table>()) {
      const auto found = std::find_if(table._keys.begin(), table._keys.end(),
                                      [&](const auto& key) { return key->_name == member.name; });
      if (found == table._keys.end()) {
        report(Rank::unknown, member.origin, unknown(table, member.name));
      } else {
        bind(**found, member, table.path_of(member.name));
      }
    }
  }

  void bind(Key& key, const Member& member, const std::string& path) {
    key._origin = member.origin;
    if (key._kind == Key::Kind::value) {
      const std::string fault = key._codec.read(member.node, key._rules.range);
      const std::string gap = fault.starts_with('[') ? "" : " ";
      const Rank rank = key._rules.decisive ? Rank::decisive : Rank::value;
      if (!fault.empty()) report(rank, member.origin, path + gap + fault);
    } else if (key._kind == Key::Kind::tables) {
      bind_tables(key, member, path);
    } else if (member.node.as<Node::Table>() == nullptr) {
      report(Rank::value, member.origin, path + " must be a table, not " + describe(member.node));
    } else {
      if (key._kind == Key::Kind::optional_table) key._resize(1);
      bind(*key._tables.front(), member.node);
    }
  }

  void bind_tables(Key& key, const Member& member, const std::string& path) {
    const auto* array = member.node.as<Node::Array>();
    const bool all_tables =
        array != nullptr && std::all_of(array->begin(), array->end(), [](const Node& element) {
          return element.as<Node::Table>() != nullptr;
        });
    if (!all_tables || array->empty()) {
      const bool empty = array != nullptr && array->empty();
      const std::string what = empty              ? "an empty array"
                               : array != nullptr ? "an array of other things"
                                                  : describe(member.node);
      return report(Rank::value, member.origin, path + " must be an array of tables, not " + what);
    }
    key._resize(array->size());
    for (std::size_t i = 0; i < array->size(); ++i) bind(*key._tables[i], (*array)[i]);
  }

  /// Former names of keys, and the present ones.
  static constexpr std::pair<std::string_view, std::string_view> renamed_keys[] = {{"bar", "tolerance"}};

  std::string unknown(const Table& table, const std::string& name) const {
    const std::string path = toml_string(table.path_of(name));
    if (const auto found = table._former.find(name); found != table._former.end())
      return path + " is now " + found->second;
    std::string text = "unknown key " + path + "; ";
    // An element of an array is a thing of its own kind, of which a key of another kind says nothing.
    const bool is_element = table._path.find(']') != std::string::npos;
    for (const std::string& other : is_element ? std::vector<std::string>{} : all_paths(_root))
      if (other.ends_with("." + name)) return text + "did you mean \"" + other + "\"?";
    std::vector<std::string> valid;
    for (const auto& key : table._keys) valid.push_back(key->_name);
    for (const auto& [old_name, new_name] : renamed_keys)
      if (name == old_name && std::ranges::find(valid, new_name) != valid.end())
        return text + "it is called " + toml_string(std::string(new_name)) + " now";
    return text + suggestion(name, valid);
  }

  static bool is_set(const Key* key) { return key != nullptr && key->_origin.starts_with("--set "); }

  static void drop(Key& key) {
    key._origin.clear();
    if (key._codec.reset) key._codec.reset();
    if (key._resize) key._resize(0);
  }

  /// Drops keys of the file that a `--set` assignment makes meaningless.
  static void drop_overridden(Table& table) {
    const auto set_alternative =
        std::find_if(table._alternatives.begin(), table._alternatives.end(),
                     [&](const std::string& name) { return is_set(table.find(name)); });
    for (const auto& key : table._keys) {
      const bool from_file = key->given() && !is_set(key.get());
      const bool replaced = set_alternative != table._alternatives.end() &&
                            std::find(table._alternatives.begin(), table._alternatives.end(), key->_name) !=
                                table._alternatives.end();
      const std::string& decides = key->_rules.when.decided_by;
      const bool is_decided = is_set(table.find(decides)) ||
                              (set_alternative != table._alternatives.end() &&
                               std::ranges::find(table._alternatives, decides) != table._alternatives.end());
      const bool meaningless = is_decided && !key->applies();
      if (from_file && (replaced || meaningless)) drop(*key);
      for (const auto& child : key->_tables) drop_overridden(*child);
    }
  }

  /// How to add a missing table all of whose keys have defaults; empty for any other key.
  static std::string remedy(const Key& key, const std::string& path) {
    if (key._kind != Key::Kind::table) return {};
    const auto& keys = key._tables.front()->_keys;
    const bool needs_values =
        !key._tables.front()->_alternatives.empty() ||
        std::ranges::any_of(keys, [](const auto& each) { return each->_rules.required; });
    return needs_values ? "" : "; add the line [" + path + "], its keys have defaults";
  }

  /// Checks that need all values.
  void check(const Table& table) {
    for (const auto& key : table._keys) {
      const bool applies = key->applies();
      const std::string path = table.path_of(key->_name);
      if (key->given() && !applies) {
        report(Rank::contradiction, key->_origin, path + " applies only " + key->_rules.when.text);
      }
      if (key->_rules.required && applies && !key->given()) {
        const std::string condition =
            key->_rules.when.text.empty() ? "" : " (needed " + key->_rules.when.text + ")";
        report(Rank::missing, table._origin.empty() ? _root._origin : table._origin,
               "missing " + std::string(key->_kind == Key::Kind::value ? "key " : "table ") +
                   toml_string(path) + condition + ": " + key->_help + remedy(*key, path));
      }
      for (const auto& child : key->_tables) {
        // a fixed table that is missing is one error, not one for each of its keys
        if (key->given() || !key->_rules.required) check(*child);
      }
    }
    check_alternatives(table);
  }

  void check_alternatives(const Table& table) {
    const Key* first = nullptr;
    std::string all;
    for (const std::string& name : table._alternatives) {
      all += (all.empty() ? "" : ", ") + name;
      const Key* key = table.find(name);
      if (!key->given()) continue;
      if (first != nullptr) {
        report(Rank::contradiction, key->_origin,
               table.path_of(name) + " contradicts " + table.path_of(first->_name) +
                   ": a scene has only one of them");
      }
      first = key;
    }
    if (first == nullptr && !all.empty() && !table._origin.empty()) {
      report(Rank::missing, table._origin, "[" + table._path + "] needs exactly one of " + all);
    }
  }

  Table& _root;
  std::vector<SceneError> _errors;
};

void read(Table& root, const Node& document) { Reader(root).run(document); }

void read_file(Table& root, const std::filesystem::path& file, const std::vector<std::string>& assignments) {
  Node document = parse_file(file);
  for (const std::string& assignment : assignments) apply_set(document, assignment);
  read(root, document);
}

void Place::fail(const std::string& path, const std::string& sentence) const {
  throw Failure(ExitCode::invalid_scene, _root.origin(path) + ": " + sentence);
}

}  // namespace drogue::scene
