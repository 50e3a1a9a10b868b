#include "common/scene/print.hpp"

namespace drogue::scene {

class Printer {
 public:
  static std::string document(const Table& root) {
    std::string text = lines(root, true);
    for (const auto& key : root._keys) {
      if (key->_kind == Key::Kind::value || !key->applies()) continue;
      const bool array = key->_kind == Key::Kind::tables;
      const std::string header = array ? "[[" + key->_name + "]]\n" : "[" + key->_name + "]\n";
      for (const auto& table : key->_tables) {
        const std::string body = lines(*table, false);
        if (body.empty() && !array && !key->_rules.required) continue;
        text += (text.empty() ? "" : "\n") + header + body;
      }
    }
    return text;
  }

 private:
  static std::string lines(const Table& table, bool values_only) {
    std::string text;
    for (const auto& key : table._keys) {
      if (!key->applies() || (values_only && key->_kind != Key::Kind::value)) continue;
      const std::string value = key->_kind == Key::Kind::tables ? long_array(*key) : inline_text(*key);
      if (!value.empty()) text += key->_name + " = " + value + "\n";
    }
    return text;
  }

  static std::string inline_text(const Key& key) {
    if (key._kind == Key::Kind::value) return key._codec.print().value_or("");
    if (key._tables.empty()) return {};
    if (key._kind != Key::Kind::tables) return inline_table(*key._tables.front());
    std::string text;
    for (const auto& table : key._tables) text += (text.empty() ? "" : ", ") + inline_table(*table);
    return "[" + text + "]";
  }

  static std::string inline_table(const Table& table) {
    std::string text;
    for (const auto& key : table._keys) {
      if (!key->applies()) continue;
      const std::string value = inline_text(*key);
      if (!value.empty()) text += (text.empty() ? "" : ", ") + key->_name + " = " + value;
    }
    return text.empty() ? "" : "{ " + text + " }";
  }

  static std::string long_array(const Key& key) {
    if (key._tables.empty()) return {};
    std::string text;
    for (const auto& table : key._tables) text += "  " + inline_table(*table) + ",\n";
    return "[\n" + text + "]";
  }
};

std::string print(const Table& root) { return Printer::document(root); }

}  // namespace drogue::scene
