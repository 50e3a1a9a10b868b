#include "miniapps/options/input/columns.hpp"

#include <algorithm>

namespace drogue::options_app {

std::vector<std::string> input_columns() {
  std::vector<std::string> names = {"id", "model", "style", "type"};
  for (const NumberColumn& column : number_columns) names.emplace_back(column.name);
  for (const ModelParameter& parameter : model_parameters)
    if (std::find(names.begin(), names.end(), parameter.name) == names.end())
      names.emplace_back(parameter.name);
  return names;
}

}  // namespace drogue::options_app
