#include "perf/compare/record_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/program/failure.hpp"

namespace drogue::perf {

namespace {

constexpr const char* schema = "drogue.perf/1";

Failure invalid(const std::string& place, const std::string& sentence) {
  return {ExitCode::invalid_scene, place + ": " + sentence};
}

/// NaN or Infinity around a column where the text is no JSON, as other programs write them; else empty.
std::string infinite_number(const std::string& line, std::size_t column) {
  for (const char* word : {"NaN", "Infinity"}) {
    const std::size_t found = line.find(word, column > 9 ? column - 9 : 0);
    if (found != std::string::npos && found < column) return word;
  }
  return "";
}

/// True for the beginning of an array of objects.
bool begins_array(const std::string& line) {
  constexpr const char* blanks = " \t\r";
  const std::size_t bracket = line.find_first_not_of(blanks);
  if (line[bracket] != '[') return false;
  const std::size_t next = line.find_first_not_of(blanks, bracket + 1);
  return next == std::string::npos || line[next] == '{';
}

nlohmann::json parse_line(const std::string& line, const std::string& place) {
  if (begins_array(line))
    throw invalid(
        place, "the file is a JSON array; records are JSON objects, one a line, as `jq -c .[]` writes them");
  try {
    nlohmann::json json = nlohmann::json::parse(line);
    if (json.is_object()) return json;
  } catch (const nlohmann::json::parse_error& error) {
    const bool ends = error.byte > line.size();
    if (const std::string word = infinite_number(line, error.byte); !word.empty())
      throw invalid(place, word + " at column " + std::to_string(error.byte) + " is no number of JSON");
    const std::string column = std::to_string(error.byte);
    throw invalid(place, ends ? "the line ends within a record; is the file truncated?"
                              : "no JSON at column " + column + "; is this a file of records?");
  } catch (const nlohmann::json::out_of_range&) {
    throw invalid(place, "a number is too large");
  }
  throw invalid(place, "the line is no JSON object");
}

void require_schema(const nlohmann::json& json, const std::string& place) {
  const auto found = json.find("schema");
  if (found == json.end())
    throw invalid(place,
                  std::string("no record of drogue-perf, which has a key 'schema' of '") + schema + "'");
  if (*found != schema)
    throw invalid(place, "the schema is " +
                             found->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                             "; this version reads \"" + schema + "\" alone");
}

const nlohmann::json& member(const nlohmann::json& json, const char* key, const std::string& place) {
  const auto found = json.find(key);
  if (found == json.end()) throw invalid(place, std::string("the record has no '") + key + "'");
  return *found;
}

std::string text_member(const nlohmann::json& json, const char* key, const std::string& place) {
  const nlohmann::json& found = member(json, key, place);
  if (!found.is_string() || found.get_ref<const std::string&>().empty())
    throw invalid(place, std::string("'") + key + "' is no text");
  return found.get<std::string>();
}

std::vector<double> sample_times(const nlohmann::json& json, const std::string& name,
                                 const std::string& place) {
  const nlohmann::json& list = member(json, "samples", place);
  if (!list.is_array()) throw invalid(place, "'samples' of " + name + " is no list");
  std::vector<double> times;
  for (const nlohmann::json& value : list) {
    const double time = value.is_number() ? value.get<double>() : std::nan("");
    if (!std::isfinite(time) || time <= 0.0)
      throw invalid(place, "samples[" + std::to_string(times.size()) + "] of " + name +
                               " is no positive finite number of seconds");
    times.push_back(time);
  }
  return times;
}

/// Throws unless a record with samples has the median and interval that drogue-perf writes beside them, where
/// it has them at all.
void require_statistics(const nlohmann::json& json, const std::string& name, const std::string& place) {
  const auto median = json.find("median"), interval = json.find("interval");
  if (median != json.end() && !median->is_number())
    throw invalid(place, "'median' of " + name + " is no number beside its samples");
  if (interval != json.end() && (!interval->is_array() || interval->size() != 2 ||
                                 !interval->at(0).is_number() || !interval->at(1).is_number()))
    throw invalid(place, "'interval' of " + name + " is not two numbers beside its samples");
}

nlohmann::json object_member(const nlohmann::json& json, const char* key, const std::string& place) {
  const auto found = json.find(key);
  if (found == json.end() || found->is_null()) return nlohmann::json::object();
  if (!found->is_object()) throw invalid(place, std::string("'") + key + "' is no JSON object");
  return *found;
}

/// Records without a statement were made with warm caches.
bool has_cold_caches(const nlohmann::json& instrument, const std::string& name, const std::string& place) {
  const nlohmann::json caches = instrument.value("caches", nlohmann::json("warm"));
  if (caches != "cold" && caches != "warm")
    throw invalid(place, "'caches' of " + name + " is neither \"cold\" nor \"warm\"");
  return caches == "cold";
}

MeasuredCase parse_record(const std::string& line, const std::string& place) {
  MeasuredCase found;
  found.document = parse_line(line, place);
  const nlohmann::json& json = found.document;
  require_schema(json, place);
  found.place = place;
  found.name = text_member(json, "case", place);
  if (std::ranges::any_of(found.name, [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    throw invalid(place, "'case' holds a control character");
  found.unit = text_member(json, "unit", place);
  found.samples = sample_times(json, found.name, place);
  if (!found.samples.empty()) require_statistics(json, found.name, place);
  const std::string check = text_member(json, "check", place);
  if (check != "passed" && check != "failed")
    throw invalid(place, "'check' of " + found.name + " is neither \"passed\" nor \"failed\"");
  found.passed = check == "passed";
  const nlohmann::json& error = member(json, "error", place);
  if (!error.is_number() && !error.is_null())
    throw invalid(place, "'error' of " + found.name + " is no number");
  if (error.is_number() && std::isfinite(error.get<double>())) found.error = error.get<double>();
  found.provenance = object_member(json, "provenance", place);
  found.facts = object_member(json, "facts", place);
  found.clocks = object_member(json, "clocks", place);
  found.cold_caches = has_cold_caches(object_member(json, "instrument", place), found.name, place);
  return found;
}

}  // namespace

std::string MeasuredCase::origin(const std::string& key) const {
  const auto found = provenance.find(key);
  if (found == provenance.end()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

std::vector<MeasuredCase> read_records(const std::string& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw Failure(ExitCode::usage, "there is no file '" + file + "'");
  if (std::filesystem::is_directory(status))
    throw Failure(ExitCode::usage, "'" + file + "' is a folder; give a file of records");
  std::ifstream in(file);
  if (!in) throw Failure(ExitCode::io_error, "'" + file + "' cannot be read");
  std::vector<MeasuredCase> records;
  std::string line;
  for (long number = 1; std::getline(in, line); ++number)
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      records.push_back(parse_record(line, file + ":" + std::to_string(number)));
  if (in.bad()) throw Failure(ExitCode::io_error, "'" + file + "' cannot be read");
  if (records.empty()) throw invalid(file, "the file holds no records");
  return records;
}

}  // namespace drogue::perf
