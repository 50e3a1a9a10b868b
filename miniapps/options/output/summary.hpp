#pragma once

#include <cstdint>

#include "common/run/result_document.hpp"
#include "miniapps/options/command.hpp"
#include "miniapps/options/input/batch_reader.hpp"
#include "miniapps/options/output/result_batch.hpp"

namespace drogue::options_app {

/// Prints the numbers of rows by status and the names of the files. `input_rows`: rows of the input.
void print_summary(const Command& command, const run::ResultDocument& result, const RowCounts& counts,
                   std::int64_t input_rows);

/// Throws `Failure`: numerical_failure if a row failed, else invalid_scene if a row is invalid.
void require_all_priced(const Command& command, const RowCounts& counts, const BatchReader& reader);

/// Sets the group `counts` of result.json.
void describe_counts(const RowCounts& counts, run::ResultDocument& result);

}  // namespace drogue::options_app
