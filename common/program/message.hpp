#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace drogue {

/// Serializes values for another process of the same program.
class MessageWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    _bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }

  void put_text(std::string_view text) {
    put(text.size());
    _bytes.append(text);
  }

  template <class Value>
  void put_all(const std::vector<Value>& values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    put_text({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
  }

  [[nodiscard]] std::string take() { return std::move(_bytes); }

 private:
  std::string _bytes;
};

/// Deserializes values in the order in which they were put. The bytes must outlive the reader. Throws
/// std::out_of_range behind the end.
class MessageReader {
 public:
  explicit MessageReader(const std::string& bytes) : _rest(bytes) {}
  explicit MessageReader(std::string&& bytes) = delete;

  template <class Value>
  [[nodiscard]] Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, next(sizeof value).data(), sizeof value);
    return value;
  }

  [[nodiscard]] std::string get_text() { return std::string(next(get<std::size_t>())); }

  template <class Value>
  [[nodiscard]] std::vector<Value> get_all() {
    static_assert(std::is_trivially_copyable_v<Value>);
    const std::string_view bytes = next(get<std::size_t>());
    std::vector<Value> values(bytes.size() / sizeof(Value));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Value));
    return values;
  }

 private:
  std::string_view next(std::size_t count) {
    if (count > _rest.size()) throw std::out_of_range("a message is shorter than what is read from it");
    const std::string_view bytes = _rest.substr(0, count);
    _rest.remove_prefix(count);
    return bytes;
  }

  std::string_view _rest;
};

}  // namespace drogue
