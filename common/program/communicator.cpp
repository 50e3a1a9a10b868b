#include "common/program/communicator.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include "common/program/mpi_guard.hpp"
#include "common/program/program.hpp"

namespace drogue {
namespace {

bool is_done(MPI_Request& request) {
  int done = 0;
  MPI_Test(&request, &done, MPI_STATUS_IGNORE);
  return done != 0;
}

/// Waits with sleeps: MPI would spin, and a rank that waits for seconds must leave its core to others.
void finish(MPI_Request& request) {
  for (Backoff pause; !is_done(request);) pause.wait();
}

/// Has ranks that wait inside of Open MPI leave their core to ranks that work. A core with one rank costs
/// nothing by it. A value of the environment or of --mca stays; one of a file of parameters, such as
/// ~/.openmpi/mca-params.conf, does not, since Open MPI prefers the environment.
void yield_while_waiting() { setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0); }

std::string of_rank(const std::string& sentence, int rank) {
  return rank == 0 ? sentence : sentence + " (on rank " + std::to_string(rank) + ")";
}

}  // namespace

struct Communicator::Transfer {
  std::string bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

Communicator::Communicator() {
  const LaunchedRank launched = launched_rank();
  if (launched.ranks == 1) return;
  yield_while_waiting();
  int threads = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &threads);
  MPI_Comm_rank(MPI_COMM_WORLD, &_rank);
  MPI_Comm_size(MPI_COMM_WORLD, &_size);
  const bool complete = _size == launched.ranks;
  if (complete && threads >= MPI_THREAD_SERIALIZED) {
    MPI_Comm host = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host);
    MPI_Comm_size(host, &_ranks_on_host);
    MPI_Comm_free(&host);
    return;
  }
  MPI_Finalize();
  if (!complete)
    throw Failure(ExitCode::usage, "the launcher started " + std::to_string(launched.ranks) +
                                       " processes, of which MPI finds " + std::to_string(_size) +
                                       ": use the mpirun of the MPI that --version names");
  throw Failure(ExitCode::usage, "this MPI does not serve threads: start the program without mpirun");
}

Communicator::~Communicator() {
  if (_size == 1) return;
  wait_until_sent();
  for (const auto& [sender, receiving] : _receives) finish(receiving->request);
  MPI_Finalize();
}

Communicator::Communicator(Alone) {}

Communicator& Communicator::self() {
  static Communicator alone{Alone()};
  return alone;
}

void Communicator::send(int to, int tag, std::string bytes) {
  release_sent();
  Transfer& sending = *_sends.emplace_back(std::make_unique<Transfer>());
  sending.bytes = std::move(bytes);
  MPI_Isend(sending.bytes.data(), static_cast<int>(sending.bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
            &sending.request);
}

void Communicator::release_sent() {
  _sends.remove_if([](const std::unique_ptr<Transfer>& sending) { return is_done(sending->request); });
}

void Communicator::wait_until_sent() {
  for (const std::unique_ptr<Transfer>& sending : _sends) finish(sending->request);
  _sends.clear();
}

bool Communicator::has_message(int from, int tag) {
  if (_receives.contains({from, tag})) return true;
  int there = 0;
  MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
  return there != 0;
}

std::optional<std::string> Communicator::receive(int from, int tag) {
  // MPI makes progress on large messages only while both sides call it.
  release_sent();
  auto at = _receives.find({from, tag});
  if (at == _receives.end()) {
    int there = 0, count = 0;
    MPI_Status status;
    MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return std::nullopt;
    MPI_Get_count(&status, MPI_BYTE, &count);
    at = _receives.emplace(std::pair(from, tag), std::make_unique<Transfer>()).first;
    Transfer& receiving = *at->second;
    receiving.bytes.resize(static_cast<std::size_t>(count));
    MPI_Irecv(receiving.bytes.data(), count, MPI_BYTE, from, tag, MPI_COMM_WORLD, &receiving.request);
  }
  // The rest of an announced message may never arrive: its sender may be killed.
  if (!is_done(at->second->request)) return std::nullopt;
  std::string bytes = std::move(at->second->bytes);
  _receives.erase(at);
  return bytes;
}

std::string Communicator::broadcast(std::string bytes) {
  if (_size == 1) return bytes;
  std::uint64_t size = bytes.size();
  MPI_Request request;
  MPI_Ibcast(&size, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD, &request);
  finish(request);
  bytes.resize(size);
  MPI_Ibcast(bytes.data(), static_cast<int>(size), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
  finish(request);
  return bytes;
}

void Communicator::run_collectively(const std::function<void()>& action) {
  if (_size == 1) return action();
  std::optional<Failure> mine;
  try {
    action();
  } catch (...) {
    mine = current_failure();
  }
  constexpr int fine = -1;
  const int code = mine ? static_cast<int>(mine->code()) : fine;
  std::vector<int> codes(static_cast<std::size_t>(_size));
  MPI_Request request;
  MPI_Iallgather(&code, 1, MPI_INT, codes.data(), 1, MPI_INT, MPI_COMM_WORLD, &request);
  finish(request);
  const auto failed = std::find_if(codes.begin(), codes.end(), [](int each) { return each != fine; });
  if (failed == codes.end()) return;
  // Only rank 0 prints the message, so only rank 0 needs its text.
  const int rank = static_cast<int>(failed - codes.begin());
  std::string sentence = mine ? mine->what() : "another rank gave up";
  constexpr int tag = 0;
  if (rank != 0 && _rank == rank) send(0, tag, sentence);
  if (rank != 0 && _rank == 0) {
    Backoff pause;
    std::optional<std::string> words;
    while (!(words = receive(rank, tag))) pause.wait();
    sentence = *words;
  }
  throw Failure(static_cast<ExitCode>(*failed), of_rank(sentence, rank));
}

void Communicator::run_on_root(const std::function<void()>& action) {
  run_collectively([&] {
    if (is_root()) action();
  });
}

void Communicator::run_or_abort(const std::function<void()>& action,
                                const std::function<void()>& before_abort) {
  if (_size == 1) return action();
  try {
    action();
  } catch (const Failure&) {
    throw;
  } catch (...) {
    if (is_root() && before_abort) before_abort();
    abort();
  }
}

void Communicator::abort() {
  const Failure failure = current_failure();
  std::fprintf(stderr, "%s\n", of_rank(failure.what(), _rank).c_str());
  if (_size > 1) MPI_Abort(MPI_COMM_WORLD, static_cast<int>(failure.code()));
  std::exit(static_cast<int>(failure.code()));
}

void Backoff::wait() {
  std::this_thread::sleep_for(std::chrono::microseconds(_microseconds));
  _microseconds = std::min(2 * _microseconds, most);
}

}  // namespace drogue
