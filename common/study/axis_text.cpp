#include "common/study/axis_text.hpp"

#include <algorithm>
#include "common/program/failure.hpp"
#include "common/scene/nearest.hpp"

namespace drogue::study {

void refuse(const std::string& what) { throw Failure(ExitCode::usage, "--study: " + what); }

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts = {""};
  for (const char character : text)
    if (character == separator)
      parts.emplace_back();
    else
      parts.back() += character;
  return parts;
}

void require_one_of(const std::string& value, const std::vector<std::string>& names) {
  if (std::ranges::find(names, value) != names.end()) return;
  refuse((value.empty() ? "a part is empty" : "unknown name '" + value + "'") + "; " +
         scene::suggestion(value, names));
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
