// The module that lets several processes share their tasks by MPI. The program loads it where it was started as one of
// several, so that nobody else needs MPI.

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "posewright/support/process_module.hpp"

namespace posewright {
namespace {

using namespace std::chrono_literals;

// A process looks for messages this often: soon after the last one, then less and less, because looking takes time from
// the tasks.
constexpr std::chrono::microseconds first_pause = 100us, longest_pause = 2ms;
// After an error the others are waited for no longer.
constexpr auto patience = 2s;
// Tasks beside those that its threads are at, so that no thread waits for a message.
constexpr std::size_t ahead = 4;
// Broadcasts in pieces: MPI counts in int.
constexpr std::size_t piece = std::size_t(1) << 30;

enum Tag : int { asks = 1, tasks = 2, result = 3 };

/// Threads that take indices from a queue and put results into another.
class Pool {
 public:
  Pool(int threads, const Task& task) {
    for (int worker = 0; worker < threads; ++worker)
      threads_.emplace_back([this, worker, &task](const std::stop_token& stop) { work(worker, task, stop); });
  }
  ~Pool() {
    for (std::jthread& thread : threads_) thread.request_stop();
    wanted_.notify_all();
  }

  void give(std::size_t index) {
    const std::scoped_lock lock(mutex_);
    open_.push_back(index);
    wanted_.notify_one();
  }
  /// The next result, if there is one within this time. Throws what a task threw.
  bool take(std::pair<std::size_t, std::string>& found, std::chrono::microseconds pause) {
    std::unique_lock lock(mutex_);
    ready_.wait_for(lock, pause, [&] { return error_ || !done_.empty(); });
    if (error_) std::rethrow_exception(error_);
    if (done_.empty()) return false;
    found = std::move(done_.front());
    done_.pop_front();
    return true;
  }

 private:
  void work(int worker, const Task& task, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (wanted_.wait(lock, stop, [&] { return !open_.empty(); })) {
      const std::size_t index = open_.front();
      open_.pop_front();
      lock.unlock();
      std::string bytes;
      std::exception_ptr error;
      try {
        bytes = task(index, worker);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error) error_ = error;
      else done_.emplace_back(index, std::move(bytes));
      ready_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any wanted_;
  std::condition_variable ready_;
  std::deque<std::size_t> open_;
  std::deque<std::pair<std::size_t, std::string>> done_;
  std::exception_ptr error_;
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

/// How long to wait for the next message.
class Pause {
 public:
  std::chrono::microseconds length() const { return length_; }
  void after(bool something_came) { length_ = something_came ? first_pause : std::min(2 * length_, longest_pause); }

 private:
  std::chrono::microseconds length_ = first_pause;
};

class MpiWorkers : public Workers {
 public:
  MpiWorkers() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &processes_);
  }

  int rank() const override { return rank_; }
  int processes() const override { return processes_; }
  Traffic traffic() const override { return traffic_; }

  void compute(const std::vector<std::size_t>& indices, int threads, const Task& task,
               const TaskResult& finished) override {
    const int here = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
    Pool pool(here, task);
    if (rank_ == 0) hand_out(indices, std::size_t(here), pool, finished);
    else work_off(std::size_t(here), pool);
  }

  void share(std::string& bytes) override {
    unsigned long long size = bytes.size();
    MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    bytes.resize(size);
    for (std::size_t at = 0; at < size; at += piece)
      MPI_Bcast(bytes.data() + at, int(std::min<std::size_t>(piece, size - at)), MPI_BYTE, 0, MPI_COMM_WORLD);
    // A tree of messages: every other process gets it once.
    count(2L * (processes_ - 1), long(size + sizeof size) * (processes_ - 1));
  }

  void leave(int exit_code) override {
    MPI_Request together = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &together);
    const auto begin = std::chrono::steady_clock::now();
    for (int all = 0; all == 0;) {
      MPI_Test(&together, &all, MPI_STATUS_IGNORE);
      if (all == 0 && exit_code != 0 && std::chrono::steady_clock::now() - begin > patience)
        MPI_Abort(MPI_COMM_WORLD, exit_code);
      if (all == 0) std::this_thread::sleep_for(longest_pause);
    }
    MPI_Finalize();
  }

 private:
  void count(long messages, long bytes) {
    traffic_.messages += messages;
    traffic_.bytes += bytes;
  }

  /// The first process: its own threads take tasks as the others do.
  void hand_out(const std::vector<std::size_t>& indices, std::size_t here, Pool& pool, const TaskResult& finished) {
    std::size_t next = 0, open = indices.size();
    int working = processes_ - 1;  // that have not been told that nothing is left
    std::pair<std::size_t, std::string> own;
    std::size_t running = 0;
    Pause pause;
    while (open > 0 || working > 0) {
      for (; running < here + ahead && next < indices.size(); ++running) pool.give(indices[next++]);
      bool came = false;
      while (answer(indices, next, open, working, finished)) came = true;
      const bool took = pool.take(own, pause.length());
      pause.after(came || took);
      if (!took) continue;
      --running;
      --open;
      finished(own.first, own.second);
    }
  }

  /// One message of another process, if there is one.
  bool answer(const std::vector<std::size_t>& indices, std::size_t& next, std::size_t& open, int& working,
              const TaskResult& finished) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return false;
    const std::string message = received(status);
    count(1, long(message.size()));
    if (status.MPI_TAG == result) {
      std::size_t index = 0;
      std::copy_n(message.data(), sizeof index, reinterpret_cast<char*>(&index));
      --open;
      finished(index, std::string_view(message).substr(sizeof index));
      return true;
    }
    // It asks for so many; an empty answer: nothing is left.
    std::size_t wanted = 0;
    std::copy_n(message.data(), sizeof wanted, reinterpret_cast<char*>(&wanted));
    const std::size_t given = std::min(wanted, indices.size() - next);
    MPI_Send(indices.data() + next, int(given * sizeof(std::size_t)), MPI_BYTE, status.MPI_SOURCE, tasks,
             MPI_COMM_WORLD);
    count(1, long(given * sizeof(std::size_t)));
    next += given;
    if (given == 0) --working;
    return true;
  }

  void work_off(std::size_t here, Pool& pool) {
    std::size_t running = 0;
    bool more = true, asked = false;
    Pause pause;
    std::pair<std::size_t, std::string> own;
    while (more || running > 0) {
      if (more && !asked && running < here + ahead) {
        const std::size_t wanted = here + ahead - running;
        MPI_Send(&wanted, int(sizeof wanted), MPI_BYTE, 0, asks, MPI_COMM_WORLD);
        asked = true;
      }
      const bool came = asked && take_tasks(pool, running, more);
      if (came) asked = false;
      const bool took = pool.take(own, pause.length());
      pause.after(came || took);
      if (!took) continue;
      --running;
      std::string message(reinterpret_cast<const char*>(&own.first), sizeof own.first);
      message += own.second;
      MPI_Send(message.data(), int(message.size()), MPI_BYTE, 0, result, MPI_COMM_WORLD);
    }
  }

  /// The answer to what was asked, if it has come.
  static bool take_tasks(Pool& pool, std::size_t& running, bool& more) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(0, tasks, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return false;
    const std::string message = received(status);
    std::vector<std::size_t> indices(message.size() / sizeof(std::size_t));
    std::copy_n(message.data(), message.size(), reinterpret_cast<char*>(indices.data()));
    more = !indices.empty();
    running += indices.size();
    for (const std::size_t index : indices) pool.give(index);
    return true;
  }

  static std::string received(const MPI_Status& status) {
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::string message(std::size_t(size), '\0');
    MPI_Recv(message.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

  int rank_ = 0, processes_ = 1;
  Traffic traffic_;
};

}  // namespace
}  // namespace posewright

extern "C" posewright::Workers* posewright_make_workers();
posewright::Workers* posewright_make_workers() { return new posewright::MpiWorkers; }
