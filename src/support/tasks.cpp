#include "posewright/support/tasks.hpp"

#include <atomic>
#include <mutex>
#include <utility>

#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

class Threads : public Workers {
 public:
  int rank() const override { return 0; }
  int processes() const override { return 1; }
  void compute(const std::vector<std::size_t>& indices, int threads, const Task& task,
               const TaskResult& finished) override {
    std::mutex mutex;
    parallel_for(indices.size(), thread_count(threads), [&](std::size_t k, int worker) {
      const std::string bytes = task(indices[k], worker);
      const std::scoped_lock lock(mutex);
      finished(indices[k], bytes);
    });
  }
  void share(std::string&) override {}
  void share_from(int, std::string&) override {}
  void combine(std::string&, const Join&) override {}
  Traffic traffic() const override { return {}; }
  Traffic own_traffic() const override { return {}; }
  void leave(int) override {}
};

// A task's outcome as it travels.
enum class Ended : char { result, left_out, cut_short, bad_input, cannot_do };

/// task(i) with what became of it in front: errors travel to every process, and are thrown there.
std::string ended(const TaskGroup& group, const Task& task, std::size_t index, int worker, const Monitor& monitor,
                  const std::atomic<bool>& failed) {
  const bool always = group.first_always && index == 0;
  if (failed || (monitor.should_stop() && !always)) return {char(Ended::left_out)};
  try {
    std::string bytes = task(index, worker);
    return char(monitor.should_stop() ? Ended::cut_short : Ended::result) + std::move(bytes);
  } catch (const InputError& error) {
    return char(Ended::bad_input) + std::string(error.what());
  } catch (const CannotDo& error) {
    return char(Ended::cannot_do) + std::string(error.what());
  }
}

void throw_error(std::string_view bytes) {
  const std::string text(bytes.substr(1));
  if (Ended(bytes[0]) == Ended::bad_input) throw InputError({}, text, "");
  if (Ended(bytes[0]) == Ended::cannot_do) throw CannotDo(text);
}

}  // namespace

std::unique_ptr<Workers> thread_workers() { return std::make_unique<Threads>(); }

TaskEngine::TaskEngine(std::shared_ptr<Workers> workers, std::unique_ptr<TaskLog> log, std::optional<Shard> shard)
    : workers_(std::move(workers)), log_(std::move(log)), shard_(shard) {}

TaskEngine::Results TaskEngine::results_of(const TaskGroup& group, const Task& task, const Monitor& monitor,
                                           bool& stopped) {
  const int number = groups_++;
  Results results;
  std::string open_bytes;
  if (writes()) {
    if (log_)
      for (const auto& [index, bytes] : log_->begin(number, group.name, group.count))
        results[index] = char(Ended::result) + bytes;
    known_ += long(results.size());
    ByteWriter open;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < group.count; ++i)
      if (!results.contains(i) && (!shard_ || i % std::size_t(shard_->parts) == std::size_t(shard_->part - 1)))
        indices.push_back(i);
    open.put(number);
    open.put(group.name);
    open.put(group.count);
    open.put(indices);
    open_bytes = open.take();
  }
  workers_->share(open_bytes);
  ByteReader open(open_bytes);
  if (open.get<int>() != number || open.get<std::string>() != group.name || open.get<std::size_t>() != group.count)
    throw CannotDo("the processes came to different tasks: " + group.name + " is not what the first one is at");
  const auto indices = open.get<std::vector<std::size_t>>();
  std::atomic<bool> failed = false;
  std::size_t done = results.size();
  if (!group.finished && !indices.empty()) monitor.report({group.name, double(done), double(group.count), {}, {}, {}});
  workers_->compute(
      indices, group.threads,
      [&](std::size_t i, int worker) {
        std::string bytes = ended(group, task, i, worker, monitor, failed);
        if (Ended(bytes[0]) >= Ended::bad_input) failed = true;
        return bytes;
      },
      [&](std::size_t i, std::string_view bytes) {
        if (Ended(bytes[0]) == Ended::left_out) return;
        results[i] = std::string(bytes);
        if (Ended(bytes[0]) >= Ended::bad_input) return;
        ++computed_;
        if (log_ && Ended(bytes[0]) == Ended::result) log_->append(number, i, bytes.substr(1));
        if (group.finished) group.finished(i, bytes.substr(1));
        else monitor.report({group.name, double(++done), double(group.count), {}, {}, {}});
      });
  if (log_ && writes()) log_->flush();
  stopped = monitor.should_stop();
  return results;
}

bool TaskEngine::run(const TaskGroup& group, const Task& task, const TaskResult& merge, const Monitor& monitor) {
  bool stopped = false;
  Results results = results_of(group, task, monitor, stopped);
  std::string all;
  if (workers_->processes() > 1) {
    ByteWriter writer;
    writer.put(stopped);
    for (const auto& [index, bytes] : results) {
      writer.put(index);
      writer.put(bytes);
    }
    if (writes()) all = writer.take();
    workers_->share(all);
    ByteReader reader(all);
    reader.get(stopped);
    results.clear();
    while (!reader.at_end()) {
      const auto index = reader.get<std::size_t>();
      reader.get(results[index]);
    }
  }
  for (const auto& [index, bytes] : results) throw_error(bytes);
  if (shard_ && results.size() < group.count && !stopped) throw ShardDone{group.name, results.size(), group.count};
  for (const auto& [index, bytes] : results) merge(index, std::string_view(bytes).substr(1));
  return stopped;
}

bool run_tasks(const TaskGroup& group, const Task& task, const TaskResult& merge, const Monitor& monitor) {
  if (monitor.engine != nullptr) return monitor.engine->run(group, task, merge, monitor);
  TaskEngine engine(thread_workers());
  return engine.run(group, task, merge, monitor);
}

}  // namespace posewright
