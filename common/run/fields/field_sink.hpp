#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "common/run/fields/dataset_spec.hpp"

namespace drogue::run {

/// Fills `values` with the entries [first, first + values.size()) of a dataset, row-major.
using Source = std::function<void(std::uint64_t first, std::span<double> values)>;
using IntegerSource = std::function<void(std::uint64_t first, std::span<std::int64_t> values)>;

/// Place of a field of a step in a file, where processes write their parts of a row-major array of doubles
/// (`write_parts`).
struct FieldPlace {
  std::filesystem::path file;
  std::uint64_t offset = 0;  ///< bytes
};

/// Output format of the fields of a run: a mesh, then steps. All functions throw `Failure` (io_error). One
/// thread at a time may call them, also another thread than the constructor's.
class FieldSink {
 public:
  virtual ~FieldSink() = default;

  /// Adds a mesh dataset in pieces that `source` fills, so that the host need not hold all of it. Keeps the
  /// dataset of a continued file.
  virtual void add_mesh(const DatasetSpec& spec, const Source& source) = 0;
  virtual void add_mesh(const DatasetSpec& spec, const IntegerSource& source) = 0;
  void add_mesh(const DatasetSpec& spec, const std::vector<double>& values);

  /// Begins an output at simulated `time`, s, reached after `step` steps.
  virtual void begin_step(double time, std::int64_t step) = 0;

  /// Writes entries [first, first + values.size()) of the field with path `field` (`path_of`): row-major,
  /// whole rows of the first dimension, in any order.
  virtual void write(std::string_view field, std::uint64_t first, std::span<const double> values) = 0;

  /// Place of a field of the step. Between begin_step() and end_step() only.
  [[nodiscard]] virtual FieldPlace place(std::string_view field) const = 0;

  /// Completes the output. Throws std::invalid_argument if the fields do not fit the mesh.
  virtual void end_step() = 0;
};

}  // namespace drogue::run
