#include "common/program/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "common/program/mpi_guard.hpp"

namespace drogue {
namespace {

constexpr auto interval = std::chrono::milliseconds(100);

/// Duration as `0:07`, `12:30`, `3:05:00`; `-` if unknown or longer than four days.
std::string clock_text(double seconds) {
  if (!(seconds >= 0.0) || seconds > 345600.0) return "-";
  const long total = std::lround(seconds);
  char text[32];
  if (total >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", total / 60, total % 60);
  }
  return text;
}

}  // namespace

std::string progress_text(std::int64_t step, std::int64_t steps_done, double time, double begin, double end,
                          double elapsed) {
  const double rate = elapsed > 0.0 ? static_cast<double>(steps_done) / elapsed : 0.0;
  const double share = end > 0.0 ? std::clamp(time / end, 0.0, 1.0) : 0.0;
  const double eta = time > begin ? elapsed * (end - time) / (time - begin) : -1.0;
  char text[160];
  std::snprintf(text, sizeof text, "step %lld  t %.4g/%.4g (%.0f %%)  %.4g steps/s  ETA %s",
                static_cast<long long>(step), time, end, 100.0 * share, rate, clock_text(eta).c_str());
  return text;
}

std::string rows_text(std::int64_t rows, double share, double elapsed) {
  const double rate = elapsed > 0.0 ? static_cast<double>(rows) / elapsed : 0.0;
  const double eta = share > 0.0 ? elapsed * (1.0 - share) / share : -1.0;
  char text[160];
  std::snprintf(text, sizeof text, "%lld rows (%.0f %%)  %.4g rows/s  ETA %s", static_cast<long long>(rows),
                100.0 * share, rate, clock_text(eta).c_str());
  return text;
}

ProgressLine::ProgressLine(bool quiet, std::FILE* stream)
    : _stream(stream), _active(!quiet && isatty(fileno(stream)) == 1 && launched_rank().rank == 0) {}

ProgressLine::~ProgressLine() { finish(); }

void ProgressLine::update(std::int64_t step, double time, double end_time) {
  if (!_active) return;
  const SteadyClock::time_point now = SteadyClock::now();
  if (!_started) {
    _started = true;
    _first_step = step;
    _first_time = time;
    _start = now;
    _last = now - interval;
  }
  if (now - _last < interval) return;
  _last = now;
  const double elapsed = std::chrono::duration<double>(now - _start).count();
  show(progress_text(step, step - _first_step, time, _first_time, end_time, elapsed));
}

void ProgressLine::update_rows(std::int64_t rows, double share) {
  if (!_active) return;
  const SteadyClock::time_point now = SteadyClock::now();
  if (now - _last < interval) return;
  _last = now;
  show(rows_text(rows, share, std::chrono::duration<double>(now - _start).count()));
}

void ProgressLine::show(const std::string& text) {
  // Return to the left margin, write, and clear the rest of a longer line.
  std::fprintf(_stream, "\r%s\x1b[K", text.c_str());
  std::fflush(_stream);
  _shown = true;
}

void ProgressLine::finish() {
  if (!_shown) return;
  std::fputs("\r\x1b[K", _stream);
  std::fflush(_stream);
  _shown = false;
}

}  // namespace drogue
