#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/run/fields/dataset_spec.hpp"
#include "kernels/fabric/material.hpp"
#include "kernels/fabric/results.hpp"

namespace drogue::springs_app {

/// Kind of stress that a field is derived from.
struct StressKind {
  bool at_vertices = false;  ///< otherwise of triangles
  fabric::StressMeasure measure = fabric::StressMeasure::cauchy;
  auto operator<=>(const StressKind&) const = default;
};

/// Names of all stress fields: `von_mises` and others for the Cauchy stress of triangles, with prefix
/// `vertex_` for vertices and `nominal_` for the nominal stress.
std::vector<std::string> stress_field_names();

/// Kind of stress of a field; empty if the field is no stress.
std::optional<StressKind> stress_kind(const std::string& field);

/// Dataset of a stress field.
run::DatasetSpec stress_spec(const std::string& field, const fabric::Mesh& mesh);

/// Values of a stress field, row by row, from stresses of its kind, N/m.
std::vector<double> stress_values(const std::string& field, const std::vector<fabric::Stress>& stress);

}  // namespace drogue::springs_app
