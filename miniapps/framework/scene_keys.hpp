#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/scene/read.hpp"

namespace drogue::framework {

/// The table [output] of a scene.
struct OutputRequest {
  std::vector<std::string> fields;  ///< names of the fields of fields.h5; empty: no such file
  std::vector<double> times;        ///< s, increasing, within the run; empty exactly if `fields` is
  int history_every = 10;           ///< steps between rows of history.csv; 0: none
  /// Steps between restart files; 0: none, not even at the end; none: one at the end.
  std::optional<int> restart_every;
};

/// End of a run and the key of the scene that sets it.
struct EndTime {
  double time = 0.0;     ///< s
  const char* key = "";  ///< say run.end_time
};

/// First output time after `time`, at most `end_time`; all in s. Does not throw.
[[nodiscard]] double next_stop(const OutputRequest& output, double time, double end_time);

/// True if fields are written at exactly `time`, s. Does not throw.
[[nodiscard]] bool is_output_time(const OutputRequest& output, double time);

/// Declares `app`, which must be `name`, and `description`: the first keys of every scene.
void declare_app(scene::Table& root, const std::string& name, std::string& description);

/// Declares `times` of [output]. `fields` is the key of the field names.
void declare_output_times(scene::Table& table, OutputRequest& output, const scene::Key& fields);

/// Declares `history_every` and `restart_every` of [output].
void declare_output_intervals(scene::Table& table, OutputRequest& output);

/// Declares a whole table [output] whose fields are any of `names`.
void declare_output(scene::Table& table, OutputRequest& output, const std::vector<std::string>& names);

/// Fills in the defaults of [output]: `default_fields` where only times are given, the end time where only
/// fields are given. Throws `Failure` (invalid_scene) for fields without times and for times after `end`.
void complete_output(const scene::Place& root, OutputRequest& output,
                     const std::vector<std::string>& default_fields, const EndTime& end);

/// Sentence that begins with `what` sets steps of `dt`, s, where a run until run.end_time takes more of them
/// than run.max_steps = `most` and the scene leaves that at its default; else empty. Throws only
/// std::bad_alloc.
[[nodiscard]] std::string too_many_steps(const scene::Place& root, const std::string& what, double dt,
                                         double end_time, std::int64_t most);

}  // namespace drogue::framework
