#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

#include "miniapps/gas/study.hpp"

namespace drogue::gas_app {

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
    refuse("'" + value + "' is none of " + listed(names));
}

std::vector<std::int64_t> meshes(const std::vector<std::string>& values) {
  std::vector<std::int64_t> cells;
  for (const std::string& value : values) {
    std::int64_t n = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
    if (error != std::errc() || end != value.data() + value.size() || n < 8 || n > (std::int64_t{1} << 28))
      refuse("'" + value + "' is no number of cells between 8 and 2^28");
    cells.push_back(n);
  }
  if (cells.size() != 2 || cells[1] < cells[0]) return cells;
  std::vector<std::int64_t> doubled;
  for (std::int64_t n = cells[0]; n < cells[1]; n *= 2) doubled.push_back(n);
  doubled.push_back(cells[1]);
  return doubled;
}

StudyScheme scheme(const std::string& name) {
  require_one_of(name, {"js", "z", "z2", "m", "teno5"});
  if (name == "js") return {name, gas::Weno::js, 1};
  if (name == "m") return {name, gas::Weno::m, 1};
  if (name == "teno5") return {name, gas::Weno::teno5, 1};
  return {name, gas::Weno::z, name == "z2" ? 2 : 1};
}

}  // namespace

StudyAxes parse_study(const std::string& text) {
  StudyAxes axes;
  std::set<std::string> named;
  for (const std::string& axis : split(text, ',')) {
    const auto equals = axis.find('=');
    const std::string key = axis.substr(0, equals);
    require_one_of(key, {"meshes", "schemes", "splittings", "times", "precisions"});
    if (equals == std::string::npos || equals + 1 == axis.size())
      refuse("an axis needs values: " + key + "=...");
    if (!named.insert(key).second) refuse("the axis " + key + " is named twice");
    const std::vector<std::string> values = split(axis.substr(equals + 1), ':');
    if (key == "meshes")
      axes.meshes = meshes(values);
    else if (key == "schemes")
      for (const auto& value : values) axes.schemes.push_back(scheme(value));
    else if (key == "splittings")
      axes.splittings = values;
    else if (key == "times")
      axes.times = values;
    else
      axes.precisions = values;
  }
  for (const auto& value : axes.splittings) require_one_of(value, {"lf-global", "lf-single", "lf-stencil"});
  for (const auto& value : axes.times) require_one_of(value, {"ssprk3", "ssprk43"});
  for (const auto& value : axes.precisions) require_one_of(value, {"double", "split"});
  return axes;
}

}  // namespace drogue::gas_app
