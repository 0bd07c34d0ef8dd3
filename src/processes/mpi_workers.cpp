// The module that lets several processes share their tasks by MPI. The program loads it where it was started as one of
// several, so that nobody else needs MPI.

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "posewright/support/bytes.hpp"
#include "posewright/support/process_module.hpp"
#include "tree.hpp"

namespace posewright {
namespace {

using namespace std::chrono_literals;

// A process looks for messages this often: soon at first and where threads wait, then less and less, because looking
// takes time from the tasks.
constexpr std::chrono::nanoseconds first_pause = 100us;
// After an error the others are waited for no longer.
constexpr auto patience = 2s;
// A process has tasks ahead for so long, so that no thread waits for a message. Of long tasks none: at the end another
// process would wait for them.
constexpr double seconds_ahead = 8e-3, long_task = 0.2;
constexpr double most_ahead = 4096;
// Broadcasts in pieces: MPI counts in int.
constexpr std::size_t piece = std::size_t(1) << 30;

enum Tag : int { asks = 1, tasks = 2, result = 3 };  // 4: tree.cpp

using Results = std::vector<std::pair<std::size_t, std::string>>;

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

  void give(const std::size_t* indices, std::size_t count) {
    const std::scoped_lock lock(mutex_);
    open_.insert(open_.end(), indices, indices + count);
    running_ += count;
    for (std::size_t i = 0; i < count; ++i) wanted_.notify_one();
  }
  /// Results finished by this time, or as soon as there is one and the queue is empty. Throws what a task
  /// threw.
  Results take(std::chrono::nanoseconds pause) {
    std::unique_lock lock(mutex_);
    ready_.wait_for(lock, pause, [&] { return error_ || worth_waking(); });
    if (error_) std::rethrow_exception(error_);
    running_ -= done_.size();
    return std::exchange(done_, {});
  }
  /// Tasks that were given and not taken.
  std::size_t running() const { return running_; }
  /// Number of further tasks to give it now.
  std::size_t wanted() {
    const std::scoped_lock lock(mutex_);
    const auto threads = double(threads_.size());
    const double mean = finished_ > 0 ? seconds_ / double(finished_) : long_task;
    const double ahead = mean < long_task ? std::min(std::ceil(seconds_ahead * threads / mean), most_ahead) : 0.0;
    const std::size_t enough = threads_.size() + std::size_t(ahead);
    const std::size_t has = running_ - done_.size();
    return has < enough ? enough - has : 0;
  }

 private:
  bool worth_waking() const { return open_.empty() && !done_.empty(); }
  void work(int worker, const Task& task, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (wanted_.wait(lock, stop, [&] { return !open_.empty(); })) {
      const std::size_t index = open_.front();
      open_.pop_front();
      lock.unlock();
      std::string bytes;
      std::exception_ptr error;
      const auto begin = std::chrono::steady_clock::now();
      try {
        bytes = task(index, worker);
      } catch (...) {
        error = std::current_exception();
      }
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
      lock.lock();
      seconds_ += seconds.count();
      ++finished_;
      if (error) error_ = error;
      else done_.emplace_back(index, std::move(bytes));
      if (error || worth_waking()) ready_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable_any wanted_;
  std::condition_variable ready_;
  std::deque<std::size_t> open_;
  Results done_;
  std::exception_ptr error_;
  std::size_t running_ = 0;  // of the caller's thread
  double seconds_ = 0.0;
  long finished_ = 0;
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

/// Time to wait for the next message.
class Pause {
 public:
  /// @param busy  all threads have something to do
  std::chrono::nanoseconds length(bool busy) const {
    constexpr int part = 8;
    const std::chrono::nanoseconds since = std::chrono::steady_clock::now() - (busy ? begin_ : last_);
    return std::clamp(since / part, first_pause, longest_pause);
  }
  void something_came() { last_ = std::chrono::steady_clock::now(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_ = begin_;
};

/// Messages on their way. MPI's own sending waits, on a busy core, until the other process looks for them.
class Outbox {
 public:
  void send(std::string bytes, int to, int tag) {
    letters_.push_back({std::move(bytes), MPI_REQUEST_NULL});
    Letter& letter = letters_.back();
    MPI_Isend(letter.bytes.data(), int(letter.bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD, &letter.request);
    forget_arrived();
  }
  void forget_arrived() {
    for (int gone = 1; gone != 0 && !letters_.empty();) {
      MPI_Test(&letters_.front().request, &gone, MPI_STATUS_IGNORE);
      if (gone != 0) letters_.pop_front();
    }
  }
  void wait_for_all() {
    for (Letter& letter : letters_) wait(letter.request);
    letters_.clear();
  }

 private:
  struct Letter {
    std::string bytes;
    MPI_Request request;
  };
  std::deque<Letter> letters_;  // its elements stay where they are
};

template <class T>
std::string bytes_of(const T* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

class MpiWorkers : public Workers {
 public:
  MpiWorkers() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &processes_);
    tree_.emplace(rank_, processes_);
  }

  int rank() const override { return rank_; }
  int processes() const override { return processes_; }
  Traffic traffic() const override {
    const Traffic trees = tree_->all();
    return {traffic_.messages + trees.messages, traffic_.bytes + trees.bytes};
  }
  Traffic own_traffic() const override { return tree_->own(); }

  void compute(const std::vector<std::size_t>& indices, int threads, const Task& task,
               const TaskResult& finished) override {
    const int here = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
    Pool pool(here, task);
    if (rank_ == 0) hand_out(indices, std::size_t(here), pool, finished);
    else work_off(std::size_t(here), pool);
  }

  void share(std::string& bytes) override {
    unsigned long long size = bytes.size();
    broadcast(&size, sizeof size);
    bytes.resize(size);
    for (std::size_t at = 0; at < size; at += piece)
      broadcast(bytes.data() + at, std::min<std::size_t>(piece, size - at));
    // A tree of messages: every other process gets it once.
    count(2L * (processes_ - 1), long(size + sizeof size) * (processes_ - 1));
  }

  void share_from(int from, std::string& bytes) override { tree_->share(from, bytes); }
  void combine(std::string& bytes, const Join& join) override { tree_->combine(bytes, join); }

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
  static void broadcast(void* bytes, std::size_t size) {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibcast(bytes, int(size), MPI_BYTE, 0, MPI_COMM_WORLD, &request);
    wait(request);
  }

  void count(long messages, long bytes) {
    traffic_.messages += messages;
    traffic_.bytes += bytes;
  }

  /// The first process: its own threads take tasks as the others do.
  void hand_out(const std::vector<std::size_t>& indices, std::size_t here, Pool& pool, const TaskResult& finished) {
    Open open{indices, 0, indices.size(), processes_ - 1};
    Pause pause;
    while (open.results > 0 || open.working > 0) {
      const std::size_t given = std::min(pool.wanted(), indices.size() - open.next);
      pool.give(indices.data() + open.next, given);
      open.next += given;
      bool came = false;
      while (answer(open, finished)) came = true;
      const Results own = pool.take(pause.length(pool.running() >= here));
      if (came || !own.empty()) pause.something_came();
      open.results -= own.size();
      for (const auto& [index, bytes] : own) finished(index, bytes);
    }
    outbox_.wait_for_all();
  }

  /// State of a group in the first process.
  struct Open {
    const std::vector<std::size_t>& indices;
    std::size_t next, results;  // to be given, to come
    int working;                // processes that have not been told that nothing is left
  };

  /// One message of another process, if there is one.
  bool answer(Open& open, const TaskResult& finished) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return false;
    const std::string message = received(status);
    count(1, long(message.size()));
    ByteReader from(message);
    if (status.MPI_TAG == result) {
      std::string bytes;
      while (!from.at_end()) {
        const auto index = from.get<std::size_t>();
        from.get(bytes);
        --open.results;
        finished(index, bytes);
      }
      return true;
    }
    // It asks for so many; an empty answer: nothing is left.
    const std::size_t given = std::min(from.get<std::size_t>(), open.indices.size() - open.next);
    outbox_.send(bytes_of(open.indices.data() + open.next, given), status.MPI_SOURCE, tasks);
    count(1, long(given * sizeof(std::size_t)));
    open.next += given;
    if (given == 0) --open.working;
    return true;
  }

  void work_off(std::size_t here, Pool& pool) {
    bool more = true, asked = false;
    Pause pause;
    while (more || pool.running() > 0) {
      outbox_.forget_arrived();
      if (more && !asked)
        if (const std::size_t wanted = pool.wanted(); wanted > 0) {
          outbox_.send(bytes_of(&wanted, 1), 0, asks);
          asked = true;
        }
      if (asked && take_tasks(pool, more)) {
        asked = false;
        pause.something_came();
      }
      const Results own = pool.take(pause.length(pool.running() >= here));
      if (own.empty()) continue;
      pause.something_came();
      ByteWriter message;
      for (const auto& [index, bytes] : own) {
        message.put(index);
        message.put(bytes);
      }
      outbox_.send(message.take(), 0, result);
    }
    outbox_.wait_for_all();
  }

  /// The answer to what was asked, if it has come.
  static bool take_tasks(Pool& pool, bool& more) {
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(0, tasks, MPI_COMM_WORLD, &there, &status);
    if (there == 0) return false;
    const std::string message = received(status);
    std::vector<std::size_t> indices(message.size() / sizeof(std::size_t));
    std::copy_n(message.data(), message.size(), reinterpret_cast<char*>(indices.data()));
    more = !indices.empty();
    pool.give(indices.data(), indices.size());
    return true;
  }

  int rank_ = 0, processes_ = 1;
  Outbox outbox_;
  std::optional<Tree> tree_;
  Traffic traffic_;
};

}  // namespace
}  // namespace posewright

extern "C" posewright::Workers* posewright_make_workers();
posewright::Workers* posewright_make_workers() { return new posewright::MpiWorkers; }
