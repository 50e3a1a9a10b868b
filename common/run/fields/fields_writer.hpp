#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/fields/dataset_spec.hpp"

namespace drogue::run {

/// Fills `values` with the entries [first, first + values.size()) of a dataset, row-major.
using Source = std::function<void(std::uint64_t first, std::span<double> values)>;
using IntegerSource = std::function<void(std::uint64_t first, std::span<std::int64_t> values)>;

/// Reference solution of a run at its end time, on a line mesh of its own.
struct ReferenceSolution {
  std::string scheme;  ///< how it was computed, as a scene names it
  std::vector<std::pair<DatasetSpec, std::span<const double>>> datasets;  ///< `x` and fields
};

/// Writes fields.h5 and fields.xdmf of a run: `/mesh/<name>`, `/steps/000000/<field>`, and optionally
/// `/reference/<field>`. Datasets of a named grid lie in a group of its name: `/mesh/<grid>/<name>`,
/// `/steps/000000/<grid>/<field>`.
///
/// Between steps the file is closed and on disk. A step is written unreachable and becomes visible by one
/// write of one page in end_step(), so a kill leaves a file with whole steps; disk space is reserved in
/// advance. Beyond 190 steps, whose names fill that page, the write is longer and a kill within its
/// microseconds can make the file unreadable. The space of steps that a restart drops stays in the file.
/// ParaView may read along. All functions throw `Failure` (io_error). One thread at a time may call them,
/// also another thread than the constructor's.
class FieldsWriter {
 public:
  /// Begins new files in `directory`; with `resume_time` continues existing ones without the steps after that
  /// time, s. `title` names the grids in ParaView.
  FieldsWriter(const std::filesystem::path& directory, std::string title, std::vector<DatasetSpec> fields,
               std::optional<double> resume_time = std::nullopt);

  ~FieldsWriter();
  FieldsWriter(const FieldsWriter&) = delete;
  FieldsWriter& operator=(const FieldsWriter&) = delete;

  /// Adds a mesh dataset in pieces that `source` fills, so that the host need not hold all of it. Keeps the
  /// dataset of a continued file.
  void add_mesh(const DatasetSpec& spec, const Source& source);
  void add_mesh(const DatasetSpec& spec, const IntegerSource& source);
  void add_mesh(const DatasetSpec& spec, const std::vector<double>& values);

  /// Begins an output at simulated `time`, s, reached after `step` steps. Reserves the disk space of all
  /// fields, so that a full disk is detected before anything is written.
  void begin_step(double time, std::int64_t step);

  /// Writes entries [first, first + values.size()) of the field with path `field` (`path_of`): row-major,
  /// whole rows of the first dimension, in any order.
  void write(std::string_view field, std::uint64_t first, std::span<const double> values);

  /// Place of a field of the step in `file`, bytes, for `write_parts`; its array is row-major. Between
  /// begin_step() and end_step() only.
  [[nodiscard]] std::uint64_t offset(std::string_view field) const;

  /// Path of fields.h5. Does not throw.
  [[nodiscard]] const std::filesystem::path& file() const noexcept;

  /// Completes the output: syncs it to disk and lists it in fields.xdmf. Throws std::invalid_argument if the
  /// fields do not fit the mesh.
  void end_step();

  /// Adds or replaces `/reference`, with the attributes `scheme` and `cells`.
  void add_reference(const ReferenceSolution& solution);

  /// Number of complete outputs, including those of a continued file.
  [[nodiscard]] std::size_t steps() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace drogue::run
