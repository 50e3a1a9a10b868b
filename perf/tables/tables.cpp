#include "perf/tables/tables.hpp"

#include "perf/measure/record.hpp"

namespace drogue::perf {

void Table::add(const Record& record, const nlohmann::json& provenance, const nlohmann::json& facts) {
  records.push_back(to_json(record, provenance, facts));
  passed = passed && record.passed();
}

}  // namespace drogue::perf
