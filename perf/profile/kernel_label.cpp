#include <cctype>

#include "perf/profile/kernel_profile.hpp"

namespace drogue::perf {
namespace {

constexpr std::string_view ours = "drogue::";

/// The qualified name at `begin`, up to template arguments or parameters.
std::string_view qualified_name(std::string_view text, std::size_t begin) {
  std::size_t end = begin;
  while (end < text.size() &&
         (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_' || text[end] == ':'))
    ++end;
  return text.substr(begin, end - begin);
}

}  // namespace

std::string kernel_label(std::string_view demangled) {
  for (std::size_t at = demangled.find(ours); at != std::string_view::npos;
       at = demangled.find(ours, at + ours.size())) {
    const std::string_view name = qualified_name(demangled, at);
    // The kernel of a cooperative launch has the functor as its template argument.
    if (name != "drogue::device::persistent_kernel") return std::string(name);
  }
  const std::string_view head = demangled.substr(0, demangled.find_first_of("<("));
  const std::size_t blank = head.rfind(' ');
  return std::string(blank == std::string_view::npos ? head : head.substr(blank + 1));
}

}  // namespace drogue::perf
