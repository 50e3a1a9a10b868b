#pragma once

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

/// One declared key: a value, a table, or an array of tables.
class Key {
 public:
  enum class Kind { value, table, optional_table, tables };

  Key(Kind kind, std::string name, std::string help)
      : _kind(kind), _name(std::move(name)), _help(std::move(help)) {}

  Key& unit(std::string unit);
  Key& required();
  /// Allows the key only where `applies` returns true; `condition` names the condition: `with kind = "disk"`.
  /// A
  /// `--set` of the sibling key `decided_by` drops this key from the file where it no longer applies.
  Key& when(std::function<bool()> applies, std::string condition, std::string decided_by);
  Key& above(double low);
  Key& at_least(double low);
  Key& at_most(double high);
  Key& below(double high);
  Key& range(double low, double high);
  /// Documentation of a default that the variable cannot show.
  Key& default_text(std::string text);
  /// Reports an invalid value of this key before any other error: the rest of the scene is meaningless then.
  Key& decisive();

  [[nodiscard]] bool given() const { return !_origin.empty(); }

 private:
  friend class Table;
  friend class Reader;
  friend class Printer;
  friend class Documenter;

  Kind _kind;
  std::string _name;
  std::string _help;
  std::string _unit;
  std::string _default_text;
  bool _required = false;
  bool _decisive = false;
  Limits _limits;
  Codec _codec;
  std::function<bool()> _applies = [] { return true; };
  std::string _condition;
  std::string _decided_by;
  std::string _origin;                          ///< origin of the key in the scene
  std::vector<std::unique_ptr<Table>> _tables;  ///< one, or one an element
  std::function<void(std::size_t)>
      _resize;  ///< makes the optional value or the elements and their tables, or none
  std::function<std::unique_ptr<Table>()> _prototype;  ///< a table bound to a default value, for the docs
};

class Table {
 public:
  explicit Table(std::string path = "") : _path(std::move(path)) {}

  Key& value(std::string name, Codec codec, std::string help);
  /// Table that always exists in the struct. `describe(Table&)` declares its keys.
  Key& table(const std::string& name, const std::function<void(Table&)>& describe, std::string help);
  /// Optional table. `describe(Table&, T&)` declares its keys.
  template <class T, class Describe>
  Key& optional_table(const std::string& name, std::optional<T>& place, Describe describe, std::string help);
  /// An array of tables.
  template <class T, class Describe>
  Key& tables(const std::string& name, std::vector<T>& place, Describe describe, std::string help);

  /// Key that has been declared. Throws std::out_of_range for another name.
  [[nodiscard]] Key& at(const std::string& name);

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

  Key& add(Key::Kind kind, const std::string& name, std::string help);
  [[nodiscard]] std::string path_of(const std::string& name) const {
    return _path.empty() ? name : _path + "." + name;
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
                           std::string help) {
  Key& key = add(Key::Kind::optional_table, name, std::move(help));
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
  key._prototype = [describe, path] {
    auto table = std::make_unique<Table>(path);
    const auto value = std::make_shared<T>();
    describe(*table, *value);
    table->_keep = value;
    return table;
  };
  if (place) attach();
  return key;
}

template <class T, class Describe>
Key& Table::tables(const std::string& name, std::vector<T>& place, Describe describe, std::string help) {
  Key& key = add(Key::Kind::tables, name, std::move(help));
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
  key._prototype = [describe, path] {
    auto table = std::make_unique<Table>(path + "[]");
    const auto value = std::make_shared<T>();
    describe(*table, *value);
    table->_keep = value;
    return table;
  };
  attach();
  return key;
}

}  // namespace drogue::scene
