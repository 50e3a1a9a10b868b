#pragma once

#include "common/study/study.hpp"

namespace drogue::study {

/// study.csv.
std::string csv(const std::vector<StudyRow>& rows, const Columns& columns, const std::string& backend);

/// study.json, schema `drogue.study/1`.
std::string json(const std::vector<StudyRow>& rows, const Columns& columns, const run::ResultDocument& facts);

/// One line for the terminal on a finished run.
std::string line(const StudyRow& row, const Columns& columns);

}  // namespace drogue::study
