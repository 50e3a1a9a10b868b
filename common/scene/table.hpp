#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/scene/codec.hpp"
#include "common/scene/node.hpp"

/// Declarations of the keys of a scene, each bound to a variable. One declaration serves reading, checking,
/// printing, documentation and error messages; the initial value of the variable is the default.
namespace drogue::scene {

class Table;

/// Where a key is allowed. `text` names the condition: `with kind = "disk"`. A `--set` of the sibling key
/// `decided_by` drops the key from the file where it no longer applies.
struct Condition {
  std::function<bool()> applies = {};  ///< empty: everywhere
  std::string text = {}, decided_by = {};
};

/// Both, with a clause on each: `with [fluid] and kind = "disk"`. That of the second key counts.
Condition operator&&(const Condition& first, const Condition& second);

/// Key whose value is one of several names, on which other keys depend.
template <class T, class Variable>
class ChoiceKey {
 public:
  /// Keeps references to the value and the choices.
  ChoiceKey(std::string name, Variable& place, const Choices<T>& choices)
      : _name(std::move(name)), _place(place), _choices(choices) {}

  /// Condition that the key has one of several values: `with kind = "disk" or "sphere"`.
  [[nodiscard]] Condition is(const std::vector<T>& values) const {
    std::string names;
    for (const auto& [text, value] : _choices)
      if (std::ranges::find(values, value) != values.end())
        names += (names.empty() ? "" : " or ") + toml_string(text);
    return {[&place = _place, values] { return std::ranges::find(values, place) != values.end(); },
            "with " + _name + " = " + names, _name};
  }

 private:
  friend class Table;

  std::string _name;
  Variable& _place;
  const Choices<T>& _choices;
};

/// Condition that the key `name`, which may be absent or empty, has a value.
template <class T>
Condition with_given(const std::string& name, const T& place) {
  const auto has_value = [&place] {
    if constexpr (requires { place.has_value(); })
      return place.has_value();
    else
      return !place.empty();
  };
  return {has_value, "with " + name, name};
}

inline Condition with_true(const std::string& name, const bool& place) {
  return {[&place] { return place; }, "with " + name + " = true", name};
}

/// What a declaration says of a key beside its name, its value and its meaning.
struct KeyRules {
  std::string unit = {};
  Limits range = {};
  Condition when = {};
  bool required = false;
  std::string default_text = {};  ///< documentation of a default that the variable cannot show
  /// An invalid value is reported before any other error: the rest of the scene is meaningless then.
  bool decisive = false;
};

/// One declared key: a value, a table, or an array of tables.
class Key {
 public:
  enum class Kind { value, table, optional_table, tables };

  Key(Kind kind, std::string name, std::string help, KeyRules rules)
      : _kind(kind), _name(std::move(name)), _help(std::move(help)), _rules(std::move(rules)) {}

  [[nodiscard]] bool given() const { return !_origin.empty(); }
  [[nodiscard]] bool applies() const { return !_rules.when.applies || _rules.when.applies(); }

 private:
  friend class Table;
  friend class Reader;
  friend class Printer;
  friend class Documenter;

  Kind _kind;
  std::string _name;
  std::string _help;
  KeyRules _rules;
  Codec _codec;
  std::string _origin;                          ///< of the key in the scene
  std::vector<std::unique_ptr<Table>> _tables;  ///< one, or one an element
  std::function<void(std::size_t)>
      _resize;  ///< makes the optional value or the elements and their tables, or none
  std::function<std::unique_ptr<Table>()> _prototype;  ///< a table bound to a default value, for the docs
};

class Table {
 public:
  explicit Table(std::string path = "") : _path(std::move(path)) {}

  Key& value(const std::string& name, Codec codec, std::string help, KeyRules rules = {});
  /// Value of a type that `codec_of` knows.
  template <class T>
  requires(!std::convertible_to<T, Codec>) Key& value(const std::string& name, T& place, std::string help,
                                                      KeyRules rules = {}) {
    return value(name, codec_of(place), std::move(help), std::move(rules));
  }
  /// One of several names.
  template <class T, class Variable>
  Key& value(const std::string& name, Variable& place, const Choices<T>& choices, std::string help,
             KeyRules rules = {}) {
    return value(name, choice_codec(place, choices), std::move(help), std::move(rules));
  }
  template <class T, class Variable>
  Key& value(const ChoiceKey<T, Variable>& key, std::string help, KeyRules rules = {}) {
    return value(key._name, key._place, key._choices, std::move(help), std::move(rules));
  }
  /// Table that always exists in the struct. `describe(Table&)` declares its keys.
  Key& table(const std::string& name, const std::function<void(Table&)>& describe, std::string help,
             KeyRules rules = {});
  /// The same with `describe(Table&, T&)`.
  template <class T, class Describe>
  Key& table(const std::string& name, T& place, Describe describe, std::string help, KeyRules rules = {}) {
    return table(
        name, [&](Table& keys) { describe(keys, place); }, std::move(help), std::move(rules));
  }
  /// Optional table. `describe(Table&, T&)` declares its keys.
  template <class T, class Describe>
  Key& optional_table(const std::string& name, std::optional<T>& place, Describe describe, std::string help,
                      KeyRules rules = {});
  /// An array of tables.
  template <class T, class Describe>
  Key& tables(const std::string& name, std::vector<T>& place, Describe describe, std::string help,
              KeyRules rules = {});

  /// Names a former key, which is refused with the words that replace it.
  void former(const std::string& name, const std::string& replacement) { _former[name] = replacement; }

  /// Requires exactly one of the keys `names`.
  Table& exactly_one_of(std::vector<std::string> names);

  /// Origin (`FILE:LINE`) of the key with this dotted path, else of the enclosing table.
  [[nodiscard]] std::string origin(const std::string& path) const;
  [[nodiscard]] bool given(const std::string& path) const;
  [[nodiscard]] const std::string& path() const { return _path; }

 private:
  friend class Reader;
  friend class Printer;
  friend class Documenter;

  Key& add(Key::Kind kind, const std::string& name, std::string help, KeyRules rules);
  [[nodiscard]] std::string path_of(const std::string& name) const {
    return _path.empty() ? name : _path + "." + name;
  }
  /// A table bound to a default value, for the documentation.
  template <class T, class Describe>
  static std::unique_ptr<Table> prototype(const std::string& path, const Describe& describe) {
    auto table = std::make_unique<Table>(path);
    const auto value = std::make_shared<T>();
    describe(*table, *value);
    table->_keep = value;
    return table;
  }
  [[nodiscard]] const Key* find(const std::string& name) const;
  [[nodiscard]] const Key* locate(const std::string& path, std::string& origin) const;

  std::string _path;
  std::string _origin;
  std::vector<std::unique_ptr<Key>> _keys;
  std::vector<std::string> _alternatives;
  std::map<std::string, std::string> _former;
  std::shared_ptr<void> _keep;  ///< the default value a prototype is bound to
};

template <class T, class Describe>
Key& Table::optional_table(const std::string& name, std::optional<T>& place, Describe describe,
                           std::string help, KeyRules rules) {
  Key& key = add(Key::Kind::optional_table, name, std::move(help), std::move(rules));
  const std::string path = path_of(name);
  const auto attach = [&key, &place, describe, path] {
    key._tables.clear();
    key._tables.push_back(std::make_unique<Table>(path));
    describe(*key._tables.back(), *place);
  };
  key._resize = [&key, &place, attach](std::size_t size) {
    key._tables.clear();
    place.reset();
    if (size == 0) return;
    place.emplace();
    attach();
  };
  key._prototype = [describe, path] { return prototype<T>(path, describe); };
  if (place) attach();
  return key;
}

template <class T, class Describe>
Key& Table::tables(const std::string& name, std::vector<T>& place, Describe describe, std::string help,
                   KeyRules rules) {
  Key& key = add(Key::Kind::tables, name, std::move(help), std::move(rules));
  const std::string path = path_of(name);
  const auto attach = [&key, &place, describe, path] {
    key._tables.clear();
    for (std::size_t i = 0; i < place.size(); ++i) {
      key._tables.push_back(std::make_unique<Table>(path + "[" + std::to_string(i) + "]"));
      describe(*key._tables.back(), place[i]);
    }
  };
  key._resize = [&place, attach](std::size_t size) {
    place.assign(size, T{});
    attach();
  };
  key._prototype = [describe, path] { return prototype<T>(path + "[]", describe); };
  attach();
  return key;
}

}  // namespace drogue::scene
