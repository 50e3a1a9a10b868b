#include "miniapps/springs/simulation/history.hpp"

#include <string>

namespace drogue::springs_app {

std::vector<run::Column> history_columns(const SpringsScene& scene) {
  std::vector<run::Column> columns = {
      {"step", ""}, {"kinetic", "J"}, {"elastic", "J"}, {"potential", "J"}, {"energy", "J"}};
  for (const char* axis : {"x", "y", "z"}) columns.push_back({std::string("momentum_") + axis, "kg m/s"});
  for (const char* axis : {"x", "y", "z"})
    columns.push_back({std::string("angular_momentum_") + axis, "kg m^2/s"});
  if (scene.contact.is_enabled())
    columns.insert(columns.end(), {{"contact_work", "J"}, {"friction_work", "J"}});
  if (scene.verify.intersections) columns.push_back({"intersections", ""});
  for (std::size_t k = 0; k < scene.output.probes.size(); ++k)
    for (const char* axis : {"x", "y", "z"})
      columns.push_back({"probe_" + std::to_string(k) + "_" + axis, "m"});
  return columns;
}

}  // namespace drogue::springs_app
