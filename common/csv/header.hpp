#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/csv/line_reader.hpp"
#include "common/program/failure.hpp"

namespace drogue::csv {

/// Returns a `Failure` (invalid_scene) `FILE:LINE: sentence`.
Failure invalid_at(const std::filesystem::path& file, std::int64_t line, const std::string& sentence);

/// Column names of a file.
struct Header {
  std::int64_t line = 0;
  std::vector<int> places;  ///< column index of each requested name; -1: absent
};

/// Reads the first line as column names; `sep=,` before it is skipped, and rows of commas after it will be.
/// Throws `Failure` (invalid_scene) for an empty file, for a name that is not in `names`, with the nearest
/// valid one, for a repeated name, and for another separator, encoding or end of lines, which it names.
Header read_header(LineReader& reader, const std::vector<std::string>& names);

}  // namespace drogue::csv
