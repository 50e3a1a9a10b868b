#include "miniapps/springs/simulation/stress_fields.hpp"

#include <map>

namespace drogue::springs_app {
namespace {

using fabric::Stress;
using fabric::StressMeasure;

/// Component or invariant of a stress that is a field.
struct StressPart {
  std::string name;
  std::uint64_t columns;
  std::string unit, description;
  void (*append)(const Stress& stress, std::vector<double>& to);
};

template <std::size_t n>
void append(const std::array<double, n>& values, std::vector<double>& to) {
  to.insert(to.end(), values.begin(), values.end());
}

const std::vector<StressPart>& stress_parts() {
  static const std::vector<StressPart> parts = {
      {"stress", 6, "N/m", "components xx, xy, xz, yy, yz, zz in space",
       [](const Stress& s, std::vector<double>& to) { append(s.tensor(), to); }},
      {"major_stress", 1, "N/m", "the larger principal value",
       [](const Stress& s, std::vector<double>& to) { to.push_back(s.major); }},
      {"minor_stress", 1, "N/m", "the smaller principal value",
       [](const Stress& s, std::vector<double>& to) { to.push_back(s.minor); }},
      {"major_direction", 3, "1", "unit vector along the larger principal value",
       [](const Stress& s, std::vector<double>& to) { append(s.direction, to); }},
      {"minor_direction", 3, "1", "unit vector along the smaller principal value",
       [](const Stress& s, std::vector<double>& to) { append(s.across, to); }},
      {"von_mises", 1, "N/m", "von Mises stress",
       [](const Stress& s, std::vector<double>& to) { to.push_back(s.von_mises()); }},
  };
  return parts;
}

struct StressField {
  StressKind kind;
  const StressPart& part;
};

std::map<std::string, StressField> all_stress_fields() {
  std::map<std::string, StressField> fields;
  for (const bool at_vertices : {false, true})
    for (const StressMeasure measure : {StressMeasure::cauchy, StressMeasure::nominal})
      for (const StressPart& part : stress_parts())
        fields.emplace((at_vertices ? "vertex_" : "") +
                           std::string(measure == StressMeasure::nominal ? "nominal_" : "") + part.name,
                       StressField{{at_vertices, measure}, part});
  return fields;
}

const std::map<std::string, StressField>& stress_fields() {
  static const std::map<std::string, StressField> fields = all_stress_fields();
  return fields;
}

}  // namespace

std::vector<std::string> stress_field_names() {
  std::vector<std::string> names;
  for (const auto& [name, field] : stress_fields()) names.push_back(name);
  return names;
}

std::optional<StressKind> stress_kind(const std::string& field) {
  const auto found = stress_fields().find(field);
  return found == stress_fields().end() ? std::nullopt : std::optional(found->second.kind);
}

run::DatasetSpec stress_spec(const std::string& field, const fabric::Mesh& mesh) {
  const auto& [kind, part] = stress_fields().at(field);
  const std::uint64_t rows = kind.at_vertices ? mesh.rest.size() : mesh.triangles.size();
  const std::string measure = kind.measure == StressMeasure::cauchy
                                  ? "Cauchy stress times thickness"
                                  : "nominal stress, force per length at rest, turned to where the cloth is";
  return {.name = field,
          .shape = part.columns == 1 ? std::vector{rows} : std::vector{rows, part.columns},
          .units = part.unit,
          .centering = kind.at_vertices ? "vertex" : "face",
          .description =
              part.description + " of the " + (kind.at_vertices ? "vertices" : "triangles") + ", " + measure};
}

std::vector<double> stress_values(const std::string& field, const std::vector<Stress>& stress) {
  const StressPart& part = stress_fields().at(field).part;
  std::vector<double> values;
  values.reserve(part.columns * stress.size());
  for (const Stress& s : stress) part.append(s, values);
  return values;
}

}  // namespace drogue::springs_app
