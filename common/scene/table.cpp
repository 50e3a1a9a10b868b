#include "common/scene/table.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace drogue::scene {

Key& Key::unit(std::string unit) {
  _unit = std::move(unit);
  return *this;
}

Key& Key::required() {
  _required = true;
  return *this;
}

Key& Key::when(std::function<bool()> applies, std::string condition, std::string decided_by) {
  _applies = std::move(applies);
  _condition = std::move(condition);
  _decided_by = std::move(decided_by);
  return *this;
}

Key& Key::above(double low) {
  _limits.low = low;
  _limits.low_excluded = true;
  return *this;
}

Key& Key::at_least(double low) {
  _limits.low = low;
  return *this;
}

Key& Key::at_most(double high) {
  _limits.high = high;
  return *this;
}

Key& Key::below(double high) {
  _limits.high = high;
  _limits.high_excluded = true;
  return *this;
}

Key& Key::range(double low, double high) { return at_least(low).at_most(high); }

Key& Key::default_text(std::string text) {
  _default_text = std::move(text);
  return *this;
}

Key& Key::decisive() {
  _decisive = true;
  return *this;
}

Key& Table::add(Key::Kind kind, const std::string& name, std::string help) {
  _keys.push_back(std::make_unique<Key>(kind, name, std::move(help)));
  return *_keys.back();
}

Key& Table::value(std::string name, Codec codec, std::string help) {
  Key& key = add(Key::Kind::value, name, std::move(help));
  key._codec = std::move(codec);
  return key;
}

Key& Table::table(const std::string& name, const std::function<void(Table&)>& describe, std::string help) {
  Key& key = add(Key::Kind::table, name, std::move(help));
  key._tables.push_back(std::make_unique<Table>(path_of(name)));
  describe(*key._tables.back());
  return key;
}

Key& Table::at(const std::string& name) {
  for (const auto& key : _keys)
    if (key->_name == name) return *key;
  throw std::out_of_range("no key \"" + path_of(name) + "\" is declared");
}

Table& Table::exactly_one_of(std::vector<std::string> names) {
  _alternatives = std::move(names);
  return *this;
}

const Key* Table::find(const std::string& name) const {
  for (const auto& key : _keys) {
    if (key->_name == name) return key.get();
  }
  return nullptr;
}

const Key* Table::locate(const std::string& path, std::string& origin) const {
  if (!_origin.empty()) origin = _origin;
  const auto dot = path.find('.');
  std::string name = path.substr(0, dot);
  std::size_t index = 0;
  if (const auto bracket = name.find('['); bracket != std::string::npos) {
    std::from_chars(name.data() + bracket + 1, name.data() + name.size(), index);
    name.resize(bracket);
  }
  const Key* key = find(name);
  if (key == nullptr) return nullptr;
  if (key->given()) origin = key->_origin;
  if (dot == std::string::npos) return key;
  if (index >= key->_tables.size()) return nullptr;
  return key->_tables[index]->locate(path.substr(dot + 1), origin);
}

std::string Table::origin(const std::string& path) const {
  std::string origin;
  static_cast<void>(locate(path, origin));
  return origin;
}

bool Table::given(const std::string& path) const {
  std::string ignored;
  const Key* key = locate(path, ignored);
  return key != nullptr && key->given();
}

}  // namespace drogue::scene
