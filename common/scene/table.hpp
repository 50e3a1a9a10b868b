#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/scene/codec.hpp"
#include "common/scene/node.hpp"

/// Declarations of a scene's keys, each bound to the place in a struct that holds its value. One declaration
/// gives reading, checking, printing, documentation and the texts of errors; a default is what the struct
/// holds.
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
  /// The key may stand in the scene only where this holds; `condition` says so: `with weno = "z"`. A `--set`
  /// of the sibling key `decided_by` drops this key from the file where it no longer applies.
  Key& when(std::function<bool()> applies, std::string condition, std::string decided_by);
  Key& above(double low);
  Key& at_least(double low);
  Key& at_most(double high);
  Key& range(double low, double high);
  /// What the docs say of a default that the struct cannot show.
  Key& default_text(std::string text);
  /// A wrong value here is reported before any other error: it makes the rest of the scene meaningless.
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
  std::string _origin;                          ///< where the scene gives it
  std::vector<std::unique_ptr<Table>> _tables;  ///< one, or one an element
  std::function<void(std::size_t)>
      _resize;  ///< makes the optional value or the elements and their tables, or none
  std::function<std::unique_ptr<Table>()> _prototype;  ///< a table bound to a default value, for the docs
};

class Table {
 public:
  explicit Table(std::string path = "") : _path(std::move(path)) {}

  Key& value(std::string name, Codec codec, std::string help);
  /// A table whose values stand in the struct whether the scene has the table or not. `describe(Table&)`
  /// declares its keys.
  Key& table(const std::string& name, const std::function<void(Table&)>& describe, std::string help);
  /// A table that is there or not. `describe(Table&, T&)` declares its keys.
  template <class T, class Describe>
  Key& optional_table(const std::string& name, std::optional<T>& place, Describe describe, std::string help);
  /// An array of tables.
  template <class T, class Describe>
  Key& tables(const std::string& name, std::vector<T>& place, Describe describe, std::string help);

  /// Of its keys a scene has one and no more.
  Table& exactly_one_of(std::vector<std::string> names);

  /// Where the scene gives the key of this dotted path, else where the table around it starts.
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
