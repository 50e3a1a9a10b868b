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
/// Intervals of a block at first, and number of blocks after the first one.
constexpr int first_intervals = 128, most_doublings = 10;
/// Blocks beyond one whose values count for its scale.
constexpr int lookahead = 3;
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
    // Blocks of doubled length, so that another end changes no block before it.
    int exponent = 0;
    std::frexp(_end, &exponent);
    std::vector<std::vector<Sample>> blocks;
    double begin = 0.0;
    for (int block = 0; block <= most_doublings + lookahead; ++block) {
      const double end = std::ldexp(1.0, exponent - most_doublings + block);
      blocks.push_back(samples_between(begin, end));
      begin = end;
    }
    find_ranges(blocks);
    open(blocks.front().front());
    for (std::size_t block = 0; block <= most_doublings; ++block) {
      set_scales(block);
      for (std::size_t i = 1; i < blocks[block].size(); ++i)
        divide(blocks[block][i - 1], blocks[block][i], 0);
    }
    close();
    divide_pulses();
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

  [[nodiscard]] std::vector<Sample> samples_between(double begin, double end) {
    std::vector<double> times;
    for (int i = 0; i <= first_intervals; ++i) times.push_back(begin + (end - begin) * i / first_intervals);
    for (const double time : _motion.times)
      if (time > begin && time < end) times.push_back(time);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::vector<Sample> samples;
    for (const double time : times) samples.push_back(at(time));
    return samples;
  }

  /// Range of each value until the end of each block.
  void find_ranges(const std::vector<std::vector<Sample>>& blocks) {
    std::vector<double> low(_motion.values, infinite), high(_motion.values, -infinite);
    const auto include = [&](const Sample& sample) {
      for (std::size_t v = 0; v < low.size(); ++v) {
        low[v] = std::min(low[v], sample.values[v]);
        high[v] = std::max(high[v], sample.values[v]);
      }
    };
    for (const std::vector<Sample>& samples : blocks) {
      std::ranges::for_each(samples, include);
      // Equal parts may have a common measure with the period of the motion.
      for (std::size_t i = 1; i < samples.size(); ++i)
        for (const double place : {0.309, 0.764})
          include(at(samples[i - 1].time + place * (samples[i].time - samples[i - 1].time)));
      std::vector<double> range(low.size());
      for (std::size_t v = 0; v < low.size(); ++v)
        range[v] = std::max(high[v] - low[v], 1e-6 * std::max(std::abs(low[v]), std::abs(high[v])));
      _ranges.push_back(std::move(range));
    }
  }

  /// Scale of each value in a block: its range until eight times the end, but not a far smaller one than the
  /// largest.
  void set_scales(std::size_t block) {
    _scale = _ranges[block + lookahead];
    const double largest = *std::ranges::max_element(_scale),
                 whole = *std::ranges::max_element(_ranges.back());
    for (double& scale : _scale) scale = std::max({scale, 1e-3 * largest, 1e-9 * whole});
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

  /// True if joints at even distances, as far as there are some, lie beside the line to a sample.
  [[nodiscard]] bool is_straight_until(const Sample& end) const {
    constexpr int places = 16;
    for (int i = 1; i <= places && !_joints.empty(); ++i) {
      const double time = _begin.time + (end.time - _begin.time) * i / (places + 1);
      const auto joint = std::ranges::lower_bound(_joints, time, {}, &Sample::time);
      if (deviation(joint == _joints.end() ? _joints.back() : *joint, _begin, end) > largest_deviation)
        return false;
    }
    return true;
  }

  /// Joins a straight part to the interval that is open, or begins the next one.
  void append(const Sample& a, const Sample& b, std::initializer_list<const Sample*> between) {
    // Motion that begins after rest has an interval of its own, however slow it is at first.
    constexpr double round_off = 1e-9;
    const bool begins = _last.time > _begin.time && change(_begin, _last) <= 0.0 && change(a, b) > round_off;
    if (begins || !is_straight_until(b)) {
      close();
      open(a);
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

  /// Bounds dt between two jumps. Rates of a step are in part those before its beginning, so that a first
  /// step misses a part of what a jump changes, and the first one after a pulse adds as much.
  void divide_pulses() {
    constexpr double steps = 20.0;
    auto jump = _intervals.end();
    for (auto interval = _intervals.begin(); interval != _intervals.end(); ++interval) {
      if (interval->begins_with == 0) continue;
      const double longest = jump == _intervals.end() ? infinite : (interval->begin - jump->begin) / steps;
      for (; jump < interval; ++jump) jump->longest = std::min(jump->longest, longest);
      jump = interval;
    }
  }

  void open(const Sample& sample) {
    _begin = _last = sample;
    _joints.clear();
    _rate = 0.0;
  }
  void close() {
    // A motion that rests needs no resolution of its own.
    const bool rests = change(_begin, _last) <= 0.0;
    const double width = _last.time - _begin.time;
    const bool begins = !rests && !_intervals.empty() && _intervals.back().begins_with == 0 &&
                        !(_intervals.back().longest < infinite);
    _intervals.push_back({_begin.time, rests || !(width > 0.0) ? infinite : width, _rate, begins ? 1 : 0});
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
  std::vector<std::vector<double>> _ranges;  ///< by block
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
