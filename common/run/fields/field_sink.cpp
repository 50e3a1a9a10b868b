#include "common/run/fields/field_sink.hpp"

#include <algorithm>

namespace drogue::run {

void FieldSink::add_mesh(const DatasetSpec& spec, const std::vector<double>& values) {
  add_mesh(spec, Source([&](std::uint64_t first, std::span<double> to) {
             std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), to.size(), to.begin());
           }));
}

}  // namespace drogue::run
