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

/// fields.xdmf of cloth: temporal collections of meshes of the datasets `vertices` (n,3), `triangles` (m,3)
/// and `strings` (k,2) of `mesh`, one of each that has any: a mesh of both would ask of fields at triangles
/// for values at strings too, and of one collection of pairs ParaView names every pair otherwise. Vertices
/// lie where the field `position` says, if it is written. Fields at vertices or triangles; those of shape
/// (n,3) are vectors, of shape (n,6) symmetric tensors (xx, xy, xz, yy, yz, zz).
std::string xdmf_cloth_document(const std::string& title, const std::vector<DatasetSpec>& mesh,
                                const std::vector<DatasetSpec>& fields,
                                const std::vector<OutputStep>& outputs);

}  // namespace drogue::run
