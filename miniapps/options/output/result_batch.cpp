#include "miniapps/options/output/result_batch.hpp"

#include <algorithm>
#include <cmath>

#include "common/program/message.hpp"

namespace drogue::options_app {

void RowCounts::add(const RowCounts& later) {
  if (invalid == 0) {
    invalid_line = later.invalid_line;
    invalid_message = later.invalid_message;
  }
  if (failed == 0) failed_line = later.failed_line;
  rows += later.rows;
  coarse += later.coarse;
  invalid += later.invalid;
  failed += later.failed;
  invalid_points += later.invalid_points;
  largest_error = std::fmax(largest_error, later.largest_error);
}

void WorkerUsage::add(const WorkerUsage& other) {
  wall_times.add(other.wall_times);
  counters.kernel_launches += other.counters.kernel_launches;
  counters.fences += other.counters.fences;
  counters.allocations_after_warmup += other.counters.allocations_after_warmup;
  counters.h2d_bytes += other.counters.h2d_bytes;
  counters.d2h_bytes += other.counters.d2h_bytes;
  counters.peak_device_bytes = std::max(counters.peak_device_bytes, other.counters.peak_device_bytes);
}

std::string to_message(const ResultBatch& batch) {
  MessageWriter message;
  message.put(batch.chunk);
  message.put(batch.ends_chunk);
  message.put(batch.chunk_seconds);
  const RowCounts& counts = batch.counts;
  for (const std::int64_t count : {counts.rows, counts.coarse, counts.invalid, counts.failed,
                                   counts.invalid_points, counts.invalid_line, counts.failed_line})
    message.put(count);
  message.put(counts.largest_error);
  message.put_text(counts.invalid_message);
  message.put_text(batch.prices);
  message.put_text(batch.boundaries);
  message.put(batch.worker_finished);
  message.put(batch.usage);
  return message.take();
}

ResultBatch result_batch_from(const std::string& message) {
  MessageReader reader(message);
  ResultBatch batch;
  batch.chunk = reader.get<std::int64_t>();
  batch.ends_chunk = reader.get<bool>();
  batch.chunk_seconds = reader.get<double>();
  RowCounts& counts = batch.counts;
  for (std::int64_t* count : {&counts.rows, &counts.coarse, &counts.invalid, &counts.failed,
                              &counts.invalid_points, &counts.invalid_line, &counts.failed_line})
    *count = reader.get<std::int64_t>();
  counts.largest_error = reader.get<double>();
  counts.invalid_message = reader.get_text();
  batch.prices = reader.get_text();
  batch.boundaries = reader.get_text();
  batch.worker_finished = reader.get<bool>();
  batch.usage = reader.get<WorkerUsage>();
  return batch;
}

}  // namespace drogue::options_app
