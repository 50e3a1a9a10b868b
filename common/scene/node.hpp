#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace drogue::scene {

struct Member;

/// A date or a time of day: TOML has them, no scene does.
struct Date {};

/// One value of a TOML document and where it stands. Free of toml++, so that only the parser needs it.
struct Node {
  using Array = std::vector<Node>;
  using Table = std::vector<Member>;  ///< in the order of the document

  std::variant<Table, Array, bool, std::int64_t, double, std::string, Date> value;
  std::string origin;  ///< `FILE:LINE` or `--set key.path=value`

  template <class T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  template <class T>
  [[nodiscard]] T* as() {
    return std::get_if<T>(&value);
  }

  /// The member of a table; null if it has none of that name or is no table.
  [[nodiscard]] const Node* find(std::string_view name) const;
};

struct Member {
  std::string name;
  std::string origin;  ///< of the key; the value may stand on a later line
  Node node;
};

/// A node in words for an error: `the string "abc"`, `1.5`, `an array`.
std::string describe(const Node& node);

/// A TOML basic string, quoted and escaped.
std::string toml_string(std::string_view text);

/// The shortest TOML float that reads back to the same double.
std::string real_text(double value);

}  // namespace drogue::scene
