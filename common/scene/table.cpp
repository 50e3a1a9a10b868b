#include "common/scene/table.hpp"

#include <charconv>

namespace drogue::scene {

Condition operator&&(const Condition& first, const Condition& second) {
  const std::string clause = second.text.starts_with("with ") ? second.text.substr(5) : second.text;
  return {[a = first.applies, b = second.applies] { return (!a || a()) && (!b || b()); },
          first.text + " and " + clause, second.decided_by};
}

Key& Table::add(Key::Kind kind, const std::string& name, std::string help, KeyRules rules) {
  _keys.push_back(std::make_unique<Key>(kind, name, std::move(help), std::move(rules)));
  return *_keys.back();
}

Key& Table::value(const std::string& name, Codec codec, std::string help, KeyRules rules) {
  Key& key = add(Key::Kind::value, name, std::move(help), std::move(rules));
  key._codec = std::move(codec);
  return key;
}

Key& Table::table(const std::string& name, const std::function<void(Table&)>& describe, std::string help,
                  KeyRules rules) {
  Key& key = add(Key::Kind::table, name, std::move(help), std::move(rules));
  key._tables.push_back(std::make_unique<Table>(path_of(name)));
  describe(*key._tables.back());
  return key;
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
