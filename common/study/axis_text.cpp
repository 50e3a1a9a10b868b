#include "common/study/axis_text.hpp"

#include <algorithm>
#include <sstream>

#include "common/program/failure.hpp"

namespace drogue::study {

void refuse(const std::string& what) { throw Failure(ExitCode::usage, "--study: " + what); }

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

void require_one_of(const std::string& value, const std::vector<std::string>& names) {
  if (std::ranges::find(names, value) != names.end()) return;
  std::string listed;
  for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
  refuse("'" + value + "' is not one of " + listed);
}

std::vector<AxisText> axis_texts(const std::string& text, const std::vector<std::string>& names) {
  std::vector<AxisText> axes;
  for (const std::string& part : split(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    require_one_of(name, names);
    if (equals == std::string::npos || equals + 1 == part.size())
      refuse("an axis needs values: " + name + "=...");
    if (std::ranges::find(axes, name, &AxisText::name) != axes.end())
      refuse("the axis " + name + " is named twice");
    axes.push_back({name, part.substr(equals + 1)});
  }
  return axes;
}

}  // namespace drogue::study
