#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/run/fields/field_sink.hpp"

namespace drogue::run {

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
/// advance. A file that a continued run begins states its time in the attribute `begins_after`, s. Beyond 190
/// steps, whose names fill that page, the write is longer and a kill within its microseconds can make the
/// file unreadable. The space of steps that a restart drops stays in the file. ParaView may read along. All
/// functions throw `Failure` (io_error). One thread at a time may call them, also another thread than the
/// constructor's.
class FieldsWriter : public FieldSink {
 public:
  /// Begins new files in `directory`; with `resume_time` continues existing ones without the steps after that
  /// time, s. `title` names the grids in ParaView.
  FieldsWriter(const std::filesystem::path& directory, std::string title, std::vector<DatasetSpec> fields,
               std::optional<double> resume_time = std::nullopt);

  /// Throws unless the constructor could continue the files of `directory` at `resume_time`, s, with these
  /// fields. Changes nothing.
  static void require_same_fields(const std::filesystem::path& directory,
                                  const std::vector<DatasetSpec>& fields, double resume_time);

  /// Times among `times`, s, ascending, up to `resume_time`, at which neither the file of `directory` nor
  /// that of `former`, the directory of the restart file, has an output. Times up to the one at which a
  /// continued run began a file are not missing: a run elsewhere wrote them. None is missing if `former` is
  /// another directory without a file.
  [[nodiscard]] static std::vector<double> missing_times(const std::filesystem::path& directory,
                                                         const std::filesystem::path& former,
                                                         const std::vector<double>& times,
                                                         double resume_time);

  ~FieldsWriter() override;
  FieldsWriter(const FieldsWriter&) = delete;
  FieldsWriter& operator=(const FieldsWriter&) = delete;

  using FieldSink::add_mesh;
  void add_mesh(const DatasetSpec& spec, const Source& source) override;
  void add_mesh(const DatasetSpec& spec, const IntegerSource& source) override;

  /// Reserves the disk space of all fields, so that a full disk is detected before anything is written.
  void begin_step(double time, std::int64_t step) override;
  void write(std::string_view field, std::uint64_t first, std::span<const double> values) override;
  [[nodiscard]] FieldPlace place(std::string_view field) const override;

  /// Syncs the output to disk and lists it in fields.xdmf.
  void end_step() override;

  /// Adds or replaces `/reference`, with the attributes `scheme` and `cells`.
  void add_reference(const ReferenceSolution& solution);

  /// Number of complete outputs, including those of a continued file.
  [[nodiscard]] std::size_t steps() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace drogue::run
