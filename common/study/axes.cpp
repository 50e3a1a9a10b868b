#include "common/study/axes.hpp"

#include "common/study/axis_text.hpp"

namespace drogue::study {
namespace {

std::vector<std::int64_t> meshes(const std::vector<std::string>& values, const MeshAxis& axis) {
  std::vector<std::int64_t> numbers;
  for (const std::string& value : values) {
    const auto n = number_of<std::int64_t>(value);
    if (!n || *n < axis.least || *n > (std::int64_t{1} << axis.most_exponent))
      refuse("'" + value + "' is not an integer number of " + axis.unit + " between " +
             std::to_string(axis.least) + " and 2^" + std::to_string(axis.most_exponent));
    numbers.push_back(*n);
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

std::vector<std::string> names_of(const std::vector<WordAxis>& words) {
  std::vector<std::string> names = {"meshes"};
  for (const WordAxis& axis : words) names.push_back(axis.name);
  return names;
}

Axes parse_axes(const std::string& text, const MeshAxis& mesh, const std::vector<WordAxis>& words) {
  Axes axes;
  for (const AxisText& axis : axis_texts(text, names_of(words))) {
    const std::vector<std::string> values = split(axis.values, ':');
    if (axis.name == "meshes")
      axes.meshes = meshes(values, mesh);
    else
      axes.words[axis.name] = values;
  }
  for (const WordAxis& axis : words)
    if (const auto found = axes.words.find(axis.name); found != axes.words.end())
      for (const std::string& value : found->second) require_one_of(value, axis.words);
  return axes;
}

}  // namespace drogue::study
