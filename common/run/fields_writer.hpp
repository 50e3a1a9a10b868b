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

#include "common/run/dataset_spec.hpp"

namespace drogue::run {

/// Fills `values` with the entries [first, first + values.size()) of a dataset, row-major.
using Source = std::function<void(std::uint64_t first, std::span<double> values)>;
using IntegerSource = std::function<void(std::uint64_t first, std::span<std::int64_t> values)>;

/// A solution that a run is compared with at its end time, on a line of its own.
struct ReferenceSolution {
  std::string scheme;  ///< how it was computed, as a scene names it
  std::vector<std::pair<DatasetSpec, std::span<const double>>> datasets;  ///< `x` and fields
};

/// fields.h5 and fields.xdmf of a run: `/mesh/<name>` and `/steps/000000/<field>`, sometimes
/// `/reference/<field>`.
///
/// Between steps the file is closed and on disk. A step is written where nothing leads to it and appears by
/// one write of one page in end_step(), so a kill at any moment leaves a file with whole steps; a full disk
/// is met before. Only beyond 190 steps, whose names fill that page, is it a longer write, which the system
/// may stop at the end of a page: a kill within those microseconds can make the file unreadable. The space of
/// steps that a restart drops stays in the file. ParaView may read along. All calls throw Failure(io_error).
/// They may come from another thread than the constructor, one at a time.
class FieldsWriter {
 public:
  /// Begins new files in `directory`; with `resume_time` continues existing ones, steps after that time
  /// removed. `title` names the grid in ParaView.
  FieldsWriter(const std::filesystem::path& directory, std::string title, std::vector<DatasetSpec> fields,
               std::optional<double> resume_time = std::nullopt);

  ~FieldsWriter();
  FieldsWriter(const FieldsWriter&) = delete;
  FieldsWriter& operator=(const FieldsWriter&) = delete;

  /// Adds `/mesh/<name>`, written in pieces that `source` fills, so that the host need not hold all of it. A
  /// dataset that a resumed file already has stays.
  void add_mesh(const DatasetSpec& spec, const Source& source);
  void add_mesh(const DatasetSpec& spec, const IntegerSource& source);
  void add_mesh(const DatasetSpec& spec, const std::vector<double>& values);

  /// Starts the group of an output at simulated `time` (s), reached after `step` steps. The disk space of all
  /// fields is reserved here, so that a full disk is met before anything is written.
  void begin_step(double time, std::int64_t step);

  /// Writes entries [first, first + values.size()) of a field, row-major, whole rows of its first dimension;
  /// pieces in any order.
  void write(std::string_view field, std::uint64_t first, std::span<const double> values);

  /// Completes the output: on disk, and listed in fields.xdmf.
  void end_step();

  /// Adds `/reference`, with the attributes `scheme` and `cells`, or replaces it.
  void add_reference(const ReferenceSolution& solution);

  /// Outputs complete so far, those of a resumed file included.
  [[nodiscard]] std::size_t steps() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace drogue::run
