#pragma once

#include <string>
#include <vector>

#include "common/run/dataset_spec.hpp"

namespace drogue::run {

/// One output of a run: its group below /steps and its time, s.
struct OutputStep {
  std::string group;
  double time = 0.0;
};

/// fields.xdmf: a temporal collection of line meshes over the one-dimensional dataset `x` of `mesh`, the data
/// of `fields` at its points. ParaView draws values at cells of a line only as steps, so cell centres become
/// points.
std::string xdmf_document(const std::string& title, const DatasetSpec& x,
                          const std::vector<DatasetSpec>& fields, const std::vector<OutputStep>& outputs);

}  // namespace drogue::run
