#include "common/expression/sample_times.hpp"

#include <algorithm>
#include <cmath>

#include "common/expression/compile.hpp"

namespace drogue::expression {

std::vector<double> sample_times(const std::string& text, const std::vector<std::string>& variables,
                                 double end) {
  constexpr int parts = 256;
  const std::vector<Instruction> program = compile(text, variables);
  if (std::ranges::find(program, variables.back(), &Instruction::name) == program.end()) return {0.0};
  std::vector<double> times;
  for (int i = 0; i <= parts; ++i) times.push_back(end * i / parts);
  for (const Instruction& instruction : program)
    if (const double time = std::abs(instruction.value); time < end) times.push_back(time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace drogue::expression
