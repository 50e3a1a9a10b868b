#include "perf/rows/block_rows.hpp"

#include <cmath>
#include <cstdio>

#include "common/run/statistics.hpp"
#include "perf/models/rank_correlation.hpp"
#include "perf/rows/timed_columns.hpp"

namespace drogue::perf {
namespace {

/// States whether the order of the speeds is that of the occupancies.
std::string explanation(const std::vector<const Record*>& records, const std::vector<double>& occupancies) {
  std::vector<double> known, speeds;
  for (std::size_t k = 0; k < records.size(); ++k) {
    if (!records[k]->passed() || records[k]->samples.empty()) continue;
    known.push_back(occupancies[k]);
    speeds.push_back(1.0 / run::median(records[k]->samples));
  }
  if (speeds.size() < 2) return "";
  const RankCorrelation found = rank_correlation(known, speeds);
  if (std::isnan(found.rho)) return "  one occupancy: it explains nothing";
  char text[96];
  std::snprintf(text, sizeof text, "  rho %+.2f, p %.3f: occupancy %s the order", found.rho,
                found.probability, found.probability <= 0.05 ? "explains" : "does not explain");
  return text;
}

}  // namespace

std::string block_row(std::int64_t cells, const std::vector<const Record*>& records,
                      const std::vector<double>& occupancies) {
  char text[32];
  std::snprintf(text, sizeof text, "%10lld", static_cast<long long>(cells));
  std::string row = text;
  for (const Record* record : records) {
    std::snprintf(text, sizeof text, "%12s", median_text(*record, 1e6, 2).c_str());
    row += text;
  }
  return row + explanation(records, occupancies);
}

}  // namespace drogue::perf
