#pragma once

#include <cstdint>

#include "common/run/result_document.hpp"
#include "miniapps/options/batch_reader.hpp"
#include "miniapps/options/chunk.hpp"
#include "miniapps/options/command.hpp"

namespace drogue::options_app {

/// Tells on standard output how many rows ended how, and where the prices are. `read`: rows of the input.
void print_summary(const Command& command, const run::ResultDocument& result, const Tally& tally,
                   std::int64_t read);

/// Throws Failure where rows did not end well: numerical_failure if one failed, else invalid_scene if one is
/// invalid.
void require_priced_rows(const Command& command, const Tally& tally, const BatchReader& reader);

/// How many rows of the output ended how.
void count_rows(const Tally& tally, run::ResultDocument& result);

}  // namespace drogue::options_app
