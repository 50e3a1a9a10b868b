#include "kernels/linear/parallel/rank_group.hpp"

#include <mpi.h>
#if defined(OPEN_MPI)
#include <mpi-ext.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace drogue::linear {
namespace {

void initialise_mpi() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised == 0) {
    int threads = MPI_THREAD_SINGLE;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads);
    std::atexit([] {
      int finalised = 0;
      MPI_Finalized(&finalised);
      if (finalised == 0) MPI_Finalize();
    });
  }
}

/// Offsets of consecutive blocks.
std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  return offsets;
}

int length(std::size_t size) { return static_cast<int>(size); }

}  // namespace

bool mpi_takes_device_memory() {
#if defined(DROGUE_HAVE_HIP) && defined(MPIX_ROCM_AWARE_SUPPORT)
  return MPIX_Query_rocm_support() == 1;
#elif defined(DROGUE_HAVE_HIP) && defined(MPIX_GPU_SUPPORT_HIP)
  int supports = 0;
  return MPIX_GPU_query_support(MPIX_GPU_SUPPORT_HIP, &supports) == MPI_SUCCESS && supports != 0;
#elif defined(DROGUE_HAVE_HIP)
  return false;
#elif defined(MPIX_CUDA_AWARE_SUPPORT)
  return MPIX_Query_cuda_support() == 1;
#elif defined(MPIX_GPU_SUPPORT_CUDA)
  int supports = 0;
  return MPIX_GPU_query_support(MPIX_GPU_SUPPORT_CUDA, &supports) == MPI_SUCCESS && supports != 0;
#else
  return false;
#endif
}

struct RankGroup::Communicator {
  MPI_Comm handle = MPI_COMM_NULL;

  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  ~Communicator() {
    int finalised = 0;
    MPI_Finalized(&finalised);
    if (finalised == 0) MPI_Comm_free(&handle);
  }
};

struct Transfers::Requests {
  std::vector<MPI_Request> all;
};

Transfers::Transfers() = default;
Transfers::~Transfers() { wait(); }
Transfers::Transfers(Transfers&& other) noexcept = default;

Transfers& Transfers::operator=(Transfers&& other) noexcept {
  wait();
  _requests = std::move(other._requests);
  return *this;
}

void Transfers::wait() {
  if (!_requests) return;
  MPI_Waitall(length(_requests->all.size()), _requests->all.data(), MPI_STATUSES_IGNORE);
  _requests.reset();
}

RankGroup::RankGroup() = default;

RankGroup::RankGroup(std::shared_ptr<const Communicator> communicator)
    : _communicator(std::move(communicator)) {
  MPI_Comm_rank(_communicator->handle, &_rank);
  MPI_Comm_size(_communicator->handle, &_size);
  MPI_Comm host = MPI_COMM_NULL;
  MPI_Comm_split_type(_communicator->handle, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
  MPI_Comm_size(host, &_ranks_on_host);
  MPI_Comm_free(&host);
}

RankGroup RankGroup::world() {
  initialise_mpi();
  int threads = MPI_THREAD_SINGLE;
  MPI_Query_thread(&threads);
  if (threads < MPI_THREAD_SERIALIZED) throw std::runtime_error("this MPI does not serve threads");
  auto communicator = std::make_shared<Communicator>();
  MPI_Comm_dup(MPI_COMM_WORLD, &communicator->handle);
  return RankGroup(std::move(communicator));
}

RankGroup RankGroup::split(int color) const {
  if (!_communicator) return {};
  auto part = std::make_shared<Communicator>();
  MPI_Comm_split(_communicator->handle, color, _rank, &part->handle);
  return RankGroup(std::move(part));
}

void RankGroup::maximize(std::span<std::uint64_t> values) const {
  if (_size == 1) return;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), length(values.size()), MPI_UINT64_T, MPI_MAX,
                _communicator->handle);
}

bool RankGroup::all(bool mine) const {
  std::uint64_t refused = mine ? 0 : 1;
  maximize({&refused, 1});
  return refused == 0;
}

void RankGroup::sum(std::span<double> values) const {
  if (_size == 1) return;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), length(values.size()), MPI_DOUBLE, MPI_SUM,
                _communicator->handle);
}

std::vector<double> RankGroup::gather(std::span<const double> values) const {
  std::vector<double> all(values.size() * static_cast<std::size_t>(_size));
  gather(values.data(), all.data(), values.size());
  return all;
}

void RankGroup::gather(const double* values, double* all, std::size_t count) const {
  const bool in_place = values == all + count * static_cast<std::size_t>(_rank);
  if (_size == 1) {
    if (!in_place) std::copy_n(values, count, all);
    return;
  }
  MPI_Allgather(in_place ? MPI_IN_PLACE : values, length(count), MPI_DOUBLE, all, length(count), MPI_DOUBLE,
                _communicator->handle);
}

Transfers RankGroup::begin(std::span<const Message> messages) const {
  Transfers transfers;
  transfers._requests = std::make_unique<Transfers::Requests>();
  std::vector<MPI_Request>& requests = transfers._requests->all;
  for (const Message& message : messages)
    if (!message.receive.empty())
      MPI_Irecv(message.receive.data(), length(message.receive.size()), MPI_DOUBLE, message.peer,
                message.receive_tag, _communicator->handle, &requests.emplace_back());
  for (const Message& message : messages)
    if (!message.send.empty())
      MPI_Isend(message.send.data(), length(message.send.size()), MPI_DOUBLE, message.peer, message.send_tag,
                _communicator->handle, &requests.emplace_back());
  return transfers;
}

void RankGroup::redistribute(const double* send, const std::vector<int>& send_counts, double* receive,
                             const std::vector<int>& receive_counts) const {
  const std::vector<int> send_offsets = offsets_of(send_counts), receive_offsets = offsets_of(receive_counts);
  MPI_Alltoallv(send, send_counts.data(), send_offsets.data(), MPI_DOUBLE, receive, receive_counts.data(),
                receive_offsets.data(), MPI_DOUBLE, _communicator->handle);
}

int RankGroup::handle() const {
  if (_communicator) return MPI_Comm_c2f(_communicator->handle);
  initialise_mpi();
  return MPI_Comm_c2f(MPI_COMM_SELF);
}

}  // namespace drogue::linear
