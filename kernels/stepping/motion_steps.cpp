#include "kernels/stepping/motion_steps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace drogue::stepping {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Deviation from a straight line, in parts of the range of a value, that an interval may have.
constexpr double largest_deviation = 0.006;
/// Intervals at first.
constexpr int first_intervals = 256;
/// Part of the run that is too short to be resolved: motion that changes there jumps.
constexpr double unresolved = 1e-9;
constexpr int most_depth = 30;  // 2^-30 = 1e-9
constexpr std::size_t most_intervals = 1U << 20U, most_values = 1U << 23U;

/// Values at a time.
struct Sample {
  double time;
  std::vector<double> values;
};

/// Recursive division from the left; accepted parts are joined while they stay straight.
class Division {
 public:
  Division(const PrescribedMotion& motion, double end) : _motion(motion), _end(end) {}

  std::vector<MotionInterval> run() {
    std::vector<double> times = {_end};
    for (int i = 0; i < first_intervals; ++i) times.push_back(_end * i / first_intervals);
    for (const double time : _motion.times)
      if (time > 0.0 && time < _end) times.push_back(time);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::vector<Sample> samples;
    for (const double time : times) samples.push_back(at(time));
    // Equal parts may have a common measure with the period of the motion.
    std::vector<Sample> tried = samples;
    for (std::size_t i = 1; i < times.size(); ++i)
      for (const double place : {0.309, 0.764})
        tried.push_back(at(times[i - 1] + place * (times[i] - times[i - 1])));
    find_scales(tried);
    open(samples.front());
    for (std::size_t i = 1; i < samples.size(); ++i) divide(samples[i - 1], samples[i], 0);
    close();
    return std::move(_intervals);
  }

 private:
  [[nodiscard]] Sample at(double time) {
    Sample sample{time, std::vector<double>(_motion.values)};
    _motion.evaluate(time, sample.values);
    for (double& value : sample.values)
      if (!std::isfinite(value)) value = 0.0;
    _evaluated += _motion.values;
    return sample;
  }

  /// Scale of each value: its range, but not a far smaller one than the largest.
  void find_scales(const std::vector<Sample>& samples) {
    _scale.assign(_motion.values, 0.0);
    double largest = 0.0;
    for (std::size_t v = 0; v < _motion.values; ++v) {
      double low = infinite, high = -infinite;
      const auto include = [&](const Sample& sample) {
        low = std::min(low, sample.values[v]);
        high = std::max(high, sample.values[v]);
      };
      std::ranges::for_each(samples, include);
      _scale[v] = std::max(high - low, 1e-6 * std::max(std::abs(low), std::abs(high)));
      largest = std::max(largest, high - low);
    }
    for (double& scale : _scale) scale = std::max(scale, 1e-3 * largest);
  }

  /// Largest difference between a sample and the line through two others, in parts of the scales.
  [[nodiscard]] double deviation(const Sample& sample, const Sample& a, const Sample& b) const {
    const double weight = (sample.time - a.time) / (b.time - a.time);
    double largest = 0.0;
    for (std::size_t v = 0; v < _scale.size(); ++v) {
      const double line = a.values[v] + weight * (b.values[v] - a.values[v]);
      if (const double difference = std::abs(sample.values[v] - line); difference > 0.0)
        largest = std::max(largest, difference / _scale[v]);
    }
    return largest;
  }
  [[nodiscard]] double change(const Sample& a, const Sample& b) const {
    double largest = 0.0;
    for (std::size_t v = 0; v < _scale.size(); ++v)
      if (const double difference = std::abs(b.values[v] - a.values[v]); difference > 0.0)
        largest = std::max(largest, difference / _scale[v]);
    return largest;
  }

  void divide(const Sample& a, const Sample& b, int depth) {
    if (_intervals.size() >= most_intervals || _evaluated >= most_values) {
      _is_complete = false;
      return;
    }
    const double width = b.time - a.time;
    const Sample middle = at(a.time + 0.5 * width);
    // The places of the others have no common measure with the period of the motion.
    const Sample left = at(a.time + 0.309 * width), right = at(a.time + 0.764 * width);
    const bool is_straight = std::max({deviation(left, a, b), deviation(middle, a, b),
                                       deviation(right, a, b)}) <= largest_deviation;
    if (is_straight) return append(a, b, {&left, &middle, &right});
    if (depth >= most_depth || width <= unresolved * _end) return append_jump(a, b);
    divide(a, middle, depth + 1);
    divide(middle, b, depth + 1);
  }

  /// Joins a straight part to the interval that is open, or begins the next one.
  void append(const Sample& a, const Sample& b, std::initializer_list<const Sample*> between) {
    const bool stays_straight = std::ranges::all_of(
        _joints, [&](const Sample& joint) { return deviation(joint, _begin, b) <= largest_deviation; });
    if (!stays_straight) {
      close();
      open(a);
    }
    // Joints close to another one say little.
    if (_joints.size() >= 24) {
      std::vector<Sample> rest;
      for (std::size_t i = 0; i < _joints.size(); i += 2) rest.push_back(std::move(_joints[i]));
      _joints = std::move(rest);
    }
    _joints.push_back(b);
    const Sample* before = &a;
    const auto include = [&](const Sample& after) {
      _rate = std::max(_rate, _motion.rate(after.time - before->time, before->values, after.values));
      before = &after;
    };
    for (const Sample* sample : between) include(*sample);
    include(b);
    _last = b;
  }

  /// Interval that begins at the last number before a jump.
  void append_jump(Sample a, Sample b) {
    for (double middle = 0.5 * (a.time + b.time); middle > a.time && middle < b.time;
         middle = 0.5 * (a.time + b.time)) {
      Sample sample = at(middle);
      const double first = change(a, sample), second = change(sample, b);
      if (std::min(first, second) > largest_deviation && b.time - a.time < 1e-3 * unresolved * _end) break;
      (first >= second ? b : a) = std::move(sample);
    }
    _last.time = a.time;
    close();
    // A step ends just before the jump, whatever the rounding of its time, and the next one begins with the
    // values before it.
    const double rate =
        std::max(_motion.rate(0.0, a.values, a.values), _motion.rate(0.0, b.values, b.values));
    _intervals.push_back({a.time * (1.0 - 4.0 * std::numeric_limits<double>::epsilon()), infinite, rate, 1});
    open(b);
  }

  void open(const Sample& sample) {
    _begin = _last = sample;
    _joints.clear();
    _rate = 0.0;
  }
  void close() {
    // A motion that rests, or changes evenly, needs no resolution of its own.
    const bool is_linear = change(_begin, _last) <= 0.0;
    const double width = _last.time - _begin.time;
    _intervals.push_back({_begin.time, is_linear || !(width > 0.0) ? infinite : width, _rate, 0});
    if (!_is_complete) {
      MotionInterval rest{_last.time, infinite, 0.0, 0};
      for (const MotionInterval& interval : _intervals) {
        rest.longest = std::min(rest.longest, interval.longest);
        rest.rate = std::max(rest.rate, interval.rate);
      }
      _intervals.push_back(rest);
      _is_complete = true;
    }
  }

  const PrescribedMotion& _motion;
  double _end;
  std::vector<double> _scale;
  std::vector<MotionInterval> _intervals;
  Sample _begin{}, _last{};
  std::vector<Sample> _joints;
  double _rate = 0.0;
  bool _is_complete = true;
  std::size_t _evaluated = 0;
};

}  // namespace

std::vector<MotionInterval> motion_intervals(const PrescribedMotion& motion, double end) {
  return Division(motion, end).run();
}

std::vector<MotionInterval> merged(const std::vector<MotionInterval>& a,
                                   const std::vector<MotionInterval>& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  std::vector<MotionInterval> result;
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const double next_a = i < a.size() ? a[i].begin : infinite;
    const double next_b = j < b.size() ? b[j].begin : infinite;
    const double begin = std::min(next_a, next_b);
    const bool from_a = next_a == begin, from_b = next_b == begin;
    if (from_a) ++i;
    if (from_b) ++j;
    MotionInterval joined{begin, infinite, 0.0, 0};
    const auto include = [&](const std::vector<MotionInterval>& list, std::size_t next, bool begins) {
      if (next == 0) return;
      const MotionInterval& present = list[next - 1];
      joined.longest = std::min(joined.longest, present.longest);
      joined.rate = std::max(joined.rate, present.rate);
      if (begins && present.begins_with != 0) joined.begins_with = 1;
    };
    include(a, i, from_a);
    include(b, j, from_b);
    result.push_back(joined);
  }
  return result;
}

std::vector<double> constants_of(std::span<const device::ExpressionProgram> programs) {
  std::vector<double> constants;
  for (const device::ExpressionProgram& program : programs) {
    const auto count =
        std::count(program.operations, program.operations + program.length, device::Operation::constant);
    for (std::ptrdiff_t i = 0; i < count; ++i) constants.push_back(std::abs(program.constants[i]));
  }
  return constants;
}

}  // namespace drogue::stepping
