#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "common/program/failure.hpp"

namespace drogue::csv {

/// Failure(invalid_scene): `FILE:LINE: sentence`.
Failure invalid_at(const std::filesystem::path& file, std::int64_t line, const std::string& sentence);

/// The line that names the columns.
struct Header {
  std::int64_t line = 0;
  std::vector<int> places;  ///< of each name that was asked for, in the lines; -1 for none
};

/// Reads the first line as names of columns. Throws Failure(invalid_scene): no line, a name that is not among
/// `names` (with the nearest), one twice.
Header read_header(LineReader& reader, const std::vector<std::string>& names);

}  // namespace drogue::csv
