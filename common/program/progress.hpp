#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace drogue {

/// Text `step 1200  t 0.131/0.4 (33 %)  5210 steps/s  ETA 0:12`. Times in s; `elapsed` is wall-clock time
/// since simulated time `begin`. The ETA extrapolates the mean rate.
std::string progress_text(std::int64_t step, std::int64_t steps_done, double time, double begin, double end,
                          double elapsed);

/// Text `1200 rows (33 %)  5210 rows/s  ETA 0:12`. `share` is the finished fraction after `elapsed` seconds.
std::string rows_text(std::int64_t rows, double share, double elapsed);

/// Progress line on a terminal, rewritten at most ten times per second. Silent if `stream` is no terminal, if
/// quiet, and on all ranks but 0.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet, std::FILE* stream = stderr);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows the progress of a run. The rate counts from the first call.
  void update(std::int64_t step, double time, double end_time);

  /// Shows the progress of a batch, `share` of the whole. The rate counts from construction.
  void update_rows(std::int64_t rows, double share);

  /// Removes the line.
  void finish();

 private:
  using SteadyClock = std::chrono::steady_clock;
  void show(const std::string& text);

  std::FILE* _stream;
  bool _active;
  bool _started = false;
  bool _shown = false;
  std::int64_t _first_step = 0;
  double _first_time = 0.0;
  SteadyClock::time_point _start = SteadyClock::now();
  SteadyClock::time_point _last;
};

}  // namespace drogue
