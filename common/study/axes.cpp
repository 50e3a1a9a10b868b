#include "common/study/axes.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "common/program/failure.hpp"

namespace drogue::study {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

[[noreturn]] void refuse(const std::string& what) { throw Failure(ExitCode::usage, "--study: " + what); }

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void require_one_of(const std::string& value, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), value) == names.end())
    refuse("'" + value + "' is not one of " + listed(names));
}

std::vector<std::int64_t> meshes(const std::vector<std::string>& values, const MeshAxis& axis) {
  std::vector<std::int64_t> numbers;
  for (const std::string& value : values) {
    std::int64_t n = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
    if (error != std::errc() || end != value.data() + value.size() || n < axis.least ||
        n > (std::int64_t{1} << axis.most_exponent))
      refuse("'" + value + "' is not an integer number of " + axis.unit + " between " +
             std::to_string(axis.least) + " and 2^" + std::to_string(axis.most_exponent));
    numbers.push_back(n);
  }
  if (numbers.size() != 2) return numbers;
  if (numbers[1] < numbers[0])
    refuse("two meshes stand for all doublings from the one to the other; the smaller comes first: meshes=" +
           values[1] + ":" + values[0]);
  std::vector<std::int64_t> doubled;
  for (std::int64_t n = numbers[0]; n < numbers[1]; n *= 2) doubled.push_back(n);
  doubled.push_back(numbers[1]);
  return doubled;
}

}  // namespace

std::vector<std::string> Axes::of(const std::string& name) const {
  const auto found = words.find(name);
  return found == words.end() ? std::vector<std::string>{""} : found->second;
}

Axes parse_axes(const std::string& text, const MeshAxis& mesh, const std::vector<WordAxis>& words) {
  std::vector<std::string> names = {"meshes"};
  for (const WordAxis& axis : words) names.push_back(axis.name);
  Axes axes;
  std::set<std::string> named;
  for (const std::string& part : split(text, ',')) {
    const auto equals = part.find('=');
    const std::string key = part.substr(0, equals);
    require_one_of(key, names);
    if (equals == std::string::npos || equals + 1 == part.size())
      refuse("an axis needs values: " + key + "=...");
    if (!named.insert(key).second) refuse("the axis " + key + " is named twice");
    const std::vector<std::string> values = split(part.substr(equals + 1), ':');
    if (key == "meshes")
      axes.meshes = meshes(values, mesh);
    else
      axes.words[key] = values;
  }
  for (const WordAxis& axis : words)
    if (const auto found = axes.words.find(axis.name); found != axes.words.end())
      for (const std::string& value : found->second) require_one_of(value, axis.words);
  return axes;
}

}  // namespace drogue::study
