#include "common/study/tables.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/run/statistics.hpp"

namespace drogue::study {
namespace {

double time_of(const StudyRow& row) { return row.samples.empty() ? NAN : run::median(row.samples); }

/// Error of a row by name; NaN if the row lacks it.
double error_of(const StudyRow& row, const std::string& name) {
  for (const auto* values : {&row.errors, &row.others})
    if (const auto found = values->find(name); found != values->end()) return found->second;
  return NAN;
}

}  // namespace

std::string csv(const std::vector<StudyRow>& rows, const Columns& columns, const std::string& backend) {
  std::ostringstream text;
  text.precision(9);
  text << "label";
  for (const std::string& name : columns.settings) text << ',' << name;
  text << ",backend," << columns.mesh << ",steps,compute_s";
  for (const std::string& name : columns.errors) text << ',' << name;
  text << ",status\n";
  for (const StudyRow& row : rows) {
    text << row.label;
    for (const auto& setting : row.settings)
      std::visit([&text](const auto& value) { text << ',' << value; }, setting);
    text << ',' << backend << ',' << row.mesh << ',' << row.steps << ',';
    const bool ok = row.code == ExitCode::ok;
    if (ok) text << time_of(row);
    for (const std::string& name : columns.errors) {
      text << ',';
      if (const double error = error_of(row, name); ok && !std::isnan(error)) text << error;
    }
    text << ',' << run::status_name(row.code) << '\n';
  }
  return text.str();
}

std::string json(const std::vector<StudyRow>& rows, const Columns& columns,
                 const run::ResultDocument& facts) {
  nlohmann::json document = {{"schema", "drogue.study/1"},
                             {"program", facts.program},
                             {"version", facts.version},
                             {"git", facts.git},
                             {"scene", facts.scene},
                             {"backend", facts.backend},
                             {"device", facts.device},
                             {"threads", facts.threads},
                             {"compiler", facts.provenance.compiler},
                             {"date", facts.provenance.date}};
  for (const StudyRow& row : rows) {
    nlohmann::json entry = {{"label", row.label},
                            {columns.mesh, row.mesh},
                            {"steps", row.steps},
                            {"samples", row.samples},
                            {"errors", row.errors},
                            {"message", row.message},
                            {"status", run::status_name(row.code)}};
    for (std::size_t k = 0; k < columns.settings.size(); ++k)
      std::visit([&](const auto& value) { entry[columns.settings[k]] = value; }, row.settings.at(k));
    if (!row.series.empty()) entry["series"] = row.series;
    if (row.code == ExitCode::ok) {
      entry["compute_s"] = time_of(row);
      for (const auto& [name, value] : row.others) entry[name] = value;
    }
    document["rows"].push_back(entry);
  }
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string line(const StudyRow& row, const Columns& columns) {
  char text[160];
  std::snprintf(text, sizeof text, "%-24s %8lld %s  ", row.label.c_str(), static_cast<long long>(row.mesh),
                columns.mesh.c_str());
  std::string result = text;
  if (row.code != ExitCode::ok) return result + row.message + '\n';
  std::snprintf(text, sizeof text, "%8lld steps %10.3g s", static_cast<long long>(row.steps), time_of(row));
  result += text;
  if (columns.shown.empty()) return result + '\n';
  std::snprintf(text, sizeof text, "  %s %.4g\n", columns.shown_title.c_str(), error_of(row, columns.shown));
  return result + text;
}

}  // namespace drogue::study
