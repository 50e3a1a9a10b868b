#pragma once

#include <string>
#include <vector>

namespace drogue {

/// Runs `drogue-plot`, which lies beside this program, with `words` as its arguments and this program's
/// output, and waits. Returns its exit code, or a code other than 0 if there is none or a signal ended it.
/// Does not throw.
int run_drogue_plot(const std::vector<std::string>& words);

}  // namespace drogue
