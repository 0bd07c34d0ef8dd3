#include "posewright/support/tasks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/version.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

std::unique_ptr<TaskLog> log_of(const std::filesystem::path& file, const std::string& key = "k") {
  return std::make_unique<TaskLog>(file, [key] { return key; });
}

/// Squares of 0 … count − 1, with what was computed in this run.
struct Squares {
  std::vector<std::size_t> merged{};
  std::vector<std::string> results{};
  std::atomic<int> computed = 0;

  bool run(TaskEngine* engine, std::size_t count, const Monitor& from = {}) {
    Monitor monitor;
    monitor.interrupted = from.interrupted;
    monitor.engine = engine;
    return run_tasks(
        {"squares", count, 3},
        [&](std::size_t i, int) {
          ++computed;
          return std::to_string(i * i);
        },
        [&](std::size_t i, std::string_view bytes) {
          merged.push_back(i);
          results.emplace_back(bytes);
        },
        monitor);
  }
};

TEST(Tasks, AreMergedInOrderOnAnyNumberOfThreads) {
  Squares squares;
  EXPECT_FALSE(squares.run(nullptr, 100));
  ASSERT_EQ(squares.results.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(squares.merged[i], i);
    EXPECT_EQ(squares.results[i], std::to_string(i * i));
  }
}

TEST(Tasks, ThrowWhatATaskThrewAndMergeNothing) {
  int merged = 0;
  const auto run = [&](auto error) {
    run_tasks(
        {"errors", 20, 4}, [&](std::size_t i, int) -> std::string { return i == 7 ? throw error : "x"; },
        [&](std::size_t, std::string_view) { ++merged; }, Monitor());
  };
  EXPECT_THROW(run(CannotDo("seven")), CannotDo);
  EXPECT_THROW(run(InputError({"a.yaml", 3}, "wrong", "right")), InputError);
  EXPECT_EQ(merged, 0);
}

TEST(Tasks, AStopLeavesOutWhatWasNotBegunButNotATaskThatMustBeDone) {
  const std::atomic<bool> stop = true;
  Monitor monitor;
  monitor.interrupted = &stop;
  for (const bool first_always : {false, true}) {
    TaskGroup group{"tasks", 5, 2};
    group.first_always = first_always;
    std::vector<std::size_t> merged;
    EXPECT_TRUE(run_tasks(
        group, [](std::size_t, int) { return "x"; }, [&](std::size_t i, std::string_view) { merged.push_back(i); },
        monitor));
    EXPECT_EQ(merged, first_always ? std::vector<std::size_t>{0} : std::vector<std::size_t>{});
  }
}

TEST(TaskLog, FinishedTasksAreNotDoneAgain) {
  const TemporaryFolder folder;
  const auto file = folder / "tasks.log";
  {
    TaskEngine first(thread_workers(), log_of(file));
    Squares squares;
    squares.run(&first, 50);
    EXPECT_EQ(squares.computed, 50);
  }
  TaskEngine second(thread_workers(), log_of(file));
  Squares again;
  again.run(&second, 50);
  EXPECT_EQ(again.computed, 0);
  EXPECT_EQ(second.known(), 50);
  ASSERT_EQ(again.results.size(), 50U);
  EXPECT_EQ(again.results[49], "2401");
  // A second group of the same run is one of its own.
  Squares more;
  more.run(&second, 4);
  EXPECT_EQ(more.computed, 4);
}

TEST(TaskLog, WhateverIsLeftOfItIsTakenUpAndGivesTheSame) {
  const TemporaryFolder folder;
  const auto file = folder / "tasks.log";
  {
    TaskEngine engine(thread_workers(), log_of(file));
    Squares().run(&engine, 12);
  }
  const std::string whole = read_file(file);
  const std::size_t header = whole.find('\n') + 1;
  for (std::size_t cut = header; cut <= whole.size(); ++cut) {
    folder.write("tasks.log", whole.substr(0, cut));
    TaskEngine engine(thread_workers(), log_of(file));
    Squares squares;
    squares.run(&engine, 12);
    ASSERT_EQ(squares.results.size(), 12U) << cut;
    EXPECT_EQ(squares.results[11], "121");
    EXPECT_EQ(engine.known() + squares.computed, 12);
    // And then it is whole.
    EXPECT_EQ(read_task_log(file).groups.at(0).results.size(), 12U);
  }
}

TEST(TaskLog, ADamagedResultIsDoneAgain) {
  const TemporaryFolder folder;
  const auto file = folder / "tasks.log";
  {
    TaskEngine engine(thread_workers(), log_of(file));
    Squares().run(&engine, 12);
  }
  std::string text = read_file(file);
  const std::size_t at = text.rfind("\n", text.size() - 2);
  text[at + 1] = text[at + 1] == '9' ? '8' : '9';
  folder.write("tasks.log", text);
  TaskEngine engine(thread_workers(), log_of(file));
  Squares squares;
  squares.run(&engine, 12);
  EXPECT_EQ(squares.computed, 1);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(squares.results[i], std::to_string(i * i));
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

TEST(TaskLog, OfAnotherComputationVersionOrKindIsRefused) {
  const TemporaryFolder folder;
  const auto begin = [&](const std::string& name, std::size_t count) {
    TaskEngine engine(thread_workers(), log_of(folder / name, "this"));
    Squares().run(&engine, count);
  };
  folder.write("other.log", "posewright-tasks/1 " + std::string(version) + " that\n");
  EXPECT_THAT(refusal([&] { begin("other.log", 3); }), HasSubstr("other.log: is of another computation"));
  folder.write("old.log", "posewright-tasks/1 0.0.1 this\n");
  EXPECT_THAT(refusal([&] { begin("old.log", 3); }), HasSubstr("was written by posewright 0.0.1"));
  folder.write("notes.txt", "bolts, nuts\n");
  EXPECT_THAT(refusal([&] { begin("notes.txt", 3); }), HasSubstr("is no log"));
  EXPECT_EQ(read_file(folder / "notes.txt"), "bolts, nuts\n");
  begin("mine.log", 3);
  EXPECT_THAT(refusal([&] { begin("mine.log", 4); }), HasSubstr("another computation"));
}

TEST(TaskLog, IsWrittenByOneProgramAtATime) {
  const TemporaryFolder folder;
  const auto first = log_of(folder / "tasks.log");
  first->begin(0, "tasks", 3);
  EXPECT_THAT(refusal([&] { log_of(folder / "tasks.log")->begin(0, "tasks", 3); }), HasSubstr("another program"));
}

TEST(Shards, TogetherTheyHaveEveryTaskOnce) {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> parts;
  int computed = 0;
  for (int part = 1; part <= 3; ++part) {
    parts.push_back(folder / ("part" + std::to_string(part)));
    TaskEngine engine(thread_workers(), log_of(parts.back()), TaskEngine::Shard{part, 3});
    Squares squares;
    EXPECT_THROW(squares.run(&engine, 10), ShardDone);
    EXPECT_TRUE(squares.merged.empty());
    computed += squares.computed;
  }
  EXPECT_EQ(computed, 10);
  folder.write("whole", task_log_bytes(merged(parts)));
  TaskEngine engine(thread_workers(), log_of(folder / "whole"));
  Squares squares;
  squares.run(&engine, 10);
  EXPECT_EQ(squares.computed, 0);
  EXPECT_EQ(squares.results.size(), 10U);
  parts.pop_back();
  EXPECT_THAT(refusal([&] { merged(parts); }), HasSubstr("no part has these squares: 2, 5, 8"));
}

TEST(Bytes, ComeBackAsTheyWereAndNeverFromTooFew) {
  ByteWriter writer;
  writer.put(-3.5);
  writer.put(std::string("word"));
  writer.put(std::vector<int>{1, -2});
  writer.put(Eigen::VectorXd(Eigen::VectorXd::LinSpaced(3, 0, 1)));
  writer.put(true);
  const std::string bytes = writer.take();
  const auto read = [](std::string_view from) {
    ByteReader reader(from);
    EXPECT_EQ(reader.get<double>(), -3.5);
    EXPECT_EQ(reader.get<std::string>(), "word");
    EXPECT_EQ(reader.get<std::vector<int>>(), (std::vector<int>{1, -2}));
    EXPECT_EQ(reader.get<Eigen::VectorXd>(), Eigen::VectorXd(Eigen::VectorXd::LinSpaced(3, 0, 1)));
    EXPECT_TRUE(reader.get<bool>());
    EXPECT_TRUE(reader.at_end());
  };
  read(bytes);
  for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    EXPECT_THROW(read(std::string_view(bytes).substr(0, cut)), CannotDo) << cut;
}

}  // namespace
}  // namespace posewright
