#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace drogue {

/// The text of the line: `step 1200  t 0.131/0.4 (33 %)  5210 steps/s  ETA 0:12`. `elapsed` in seconds of
/// wall clock since the start at time `begin`; the ETA supposes that simulated time goes on at its mean rate.
std::string progress_text(std::int64_t step, std::int64_t steps_done, double time, double begin, double end,
                          double elapsed);

/// The text of the line of a batch: `1200 rows (33 %)  5210 rows/s  ETA 0:12`. `share` of the whole is done
/// after `elapsed` seconds.
std::string rows_text(std::int64_t rows, double share, double elapsed);

/// One line on a terminal, rewritten ten times a second at most; silent if `stream` is not a terminal, if
/// quiet, or on any rank but 0.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet, std::FILE* stream = stderr);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows where the run is. The first call sets where the rate is counted from.
  void update(std::int64_t step, double time, double end_time);

  /// Shows how much of a batch is done, `share` of all of it. The clock starts with the object.
  void update_rows(std::int64_t rows, double share);

  /// Removes the line, so that what is printed next starts at the left margin.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void show(const std::string& text);

  std::FILE* _stream;
  bool _active;
  bool _started = false;
  bool _shown = false;
  std::int64_t _first_step = 0;
  double _first_time = 0.0;
  Clock::time_point _start = Clock::now();
  Clock::time_point _last;
};

}  // namespace drogue
