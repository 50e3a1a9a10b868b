#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace drogue::scene {

struct Member;

/// Date or time of day: valid TOML that no scene uses.
struct Date {};

/// Value of a TOML document with its origin. Independent of toml++.
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

  /// Member of a table; null if there is none or if the node is no table.
  [[nodiscard]] const Node* find(std::string_view name) const;
};

struct Member {
  std::string name;
  std::string origin;  ///< origin of the key; the value may be on a later line
  Node node;
};

/// Text for messages: its first characters, and dots, if it is longer. Throws only std::bad_alloc.
std::string shortened(const std::string& text, std::size_t longest = 60);

/// The first 60 characters as a TOML string. Throws only std::bad_alloc.
std::string short_toml_string(const std::string& text);

/// Description of a node for messages: `the string "abc"`, `1.5`, `an array`.
std::string describe(const Node& node);

/// A TOML basic string, quoted and escaped.
std::string toml_string(std::string_view text);

/// Shortest TOML float that reads back as the same double.
std::string real_text(double value);

/// `real_text` of the value rounded to 12 digits: a computed number without its round-off, for sentences.
std::string rounded_text(double value);

/// Three digits of a value, without a point where they need none, for sentences.
std::string rough_text(double value);

/// A sentence of parts: texts, integers, and real numbers by `real_text`. Throws only std::bad_alloc.
template <class... Parts>
std::string sentence(const Parts&... parts) {
  const auto text = [](const auto& part) {
    using Part = std::remove_cvref_t<decltype(part)>;
    if constexpr (std::is_floating_point_v<Part>)
      return real_text(part);
    else if constexpr (std::is_integral_v<Part>)
      return std::to_string(part);
    else
      return std::string(part);
  };
  return (std::string() + ... + text(parts));
}

/// Name of an element of an array: `body[0]`.
std::string element(const std::string& array, std::size_t index);

}  // namespace drogue::scene
