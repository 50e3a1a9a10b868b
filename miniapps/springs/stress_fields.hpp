#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/run/dataset_spec.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/state.hpp"

namespace drogue::springs_app {

/// Which stresses a field is made of.
struct StressKind {
  bool at_vertices = false;  ///< else of triangles
  fabric::StressMeasure measure = fabric::StressMeasure::cauchy;
  auto operator<=>(const StressKind&) const = default;
};

/// Every name that output.fields may hold for a stress: `von_mises` and others of triangles and of Cauchy,
/// `vertex_` before it for vertices, `nominal_` before that for the nominal one.
std::vector<std::string> stress_field_names();

/// None for a field that is no stress.
std::optional<StressKind> stress_kind(const std::string& field);

/// The dataset of a field of stress.
run::DatasetSpec stress_spec(const std::string& field, const fabric::Mesh& mesh);

/// Its values, row by row, from stresses of its kind.
std::vector<double> stress_values(const std::string& field, const std::vector<fabric::Stress>& stress);

}  // namespace drogue::springs_app
