// Candidates that an earlier computation drew are those that are drawn anew, and of nothing else.

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/result_store.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

class Memory : public ResultStore {
 public:
  std::optional<std::string> find(const std::string& name) const override {
    const auto at = kept.find(name);
    if (at == kept.end()) return std::nullopt;
    ++found;
    return at->second;
  }
  void keep(const std::string& name, std::string_view bytes) const override { kept[name] = bytes; }

  mutable std::map<std::string, std::string> kept;
  mutable int found = 0;
};

/// A cube of this edge in m about the origin.
std::string cube(double edge) {
  std::ostringstream stl;
  stl << "solid cube\n";
  const auto corner = [&](int k) {
    stl << "vertex " << edge * ((k & 1) - 0.5) << ' ' << edge * ((k >> 1 & 1) - 0.5) << ' '
        << edge * ((k >> 2 & 1) - 0.5) << '\n';
  };
  for (const auto& [a, b, c, d] :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    for (const auto& [p, q, r] : {std::array{a, b, c}, {a, c, d}}) {
      stl << "facet normal 0 0 0\nouter loop\n";
      corner(p), corner(q), corner(r);
      stl << "endloop\nendfacet\n";
    }
  stl << "endsolid\n";
  return stl.str();
}

const std::string cell_text =
    "posewright: 1\n"
    "robot: {urdf: \"" POSEWRIGHT_SOURCE_DIR
    "/examples/kr270/kr270.urdf\", base: base_link, tip: flange}\n"
    "measurement: {type: points, targets: {P1: [0.277, -0.046, -0.094], P2: [0.276, -0.048, 0.094], P3: [0.278, "
    "0.103, -0.002]}, device: {type: laser_tracker, stations: {A: [3.6, -1.4, 0.5]}}}\n"
    "variants: {geometric: {parameters: auto, nuisance: [\"base.*\", \"target.*\"]}}\n"
    "workspace:\n"
    "  joints: {margin: 3 deg}\n"
    "  collision: {clearance: 30 mm, obstacles: [{name: block, mesh: block.stl, at: [1.9, 0.2, -0.4]}]}\n"
    "  line_of_sight: {visible: 2, range: [0.8, 30], acceptance: 30 deg, normals: {\"*\": [1, 0, 0]}}\n"
    "design: {poses: 14, candidates: 150, restarts: 1, method: exchange, criterion: o1}\n";

class KeptCandidates : public testing::Test {
 protected:
  Problem problem(const std::string& what = "", const std::string& with = "") const {
    std::string text = cell_text;
    if (!what.empty()) text.replace(text.find(what), what.size(), with);
    return parse_problem(text, folder / "problem.yaml");
  }

  static Configurations drawn(const Problem& problem, const ResultStore* store, std::uint64_t seed = 0) {
    RunOptions run;
    run.seed = seed;
    Monitor monitor;
    monitor.store = store;
    const posewright::Setup setup = resolve(problem, run, monitor);
    return draw_candidates(setup, monitor);
  }

  /// Draws with the store of the problem as it stands, and without any.
  void expect_another_draw(const Problem& changed, const char* what, std::uint64_t seed = 0) const {
    const int before = memory.found;
    const Configurations with = drawn(changed, &memory, seed);
    EXPECT_EQ(memory.found, before) << what << " is no part of the name";
    EXPECT_NE(with.values, first.values) << what << ": the test tells nothing";
    EXPECT_EQ(with.values, drawn(changed, nullptr, seed).values) << what;
  }

  const TemporaryFolder folder;
  const std::filesystem::path mesh = folder.write("block.stl", cube(0.9));
  const Memory memory;
  const Configurations first = drawn(problem(), &memory);
};

TEST_F(KeptCandidates, AreBitForBitThoseThatAreDrawn) {
  ASSERT_EQ(memory.kept.size(), 1u);
  const Configurations again = drawn(problem(), &memory), anew = drawn(problem(), nullptr);
  EXPECT_EQ(memory.found, 1);
  for (const Configurations* other : {&again, &anew}) {
    EXPECT_EQ(other->values, first.values);
    EXPECT_EQ(other->dimension, first.dimension);
    EXPECT_EQ(other->drawn, first.drawn);
    EXPECT_EQ(other->rejected, first.rejected);
  }
}

TEST_F(KeptCandidates, GiveThePlanThatDrawnOnesGive) {
  const auto plan = [&](const ResultStore* store, int threads) {
    RunOptions run;
    run.threads = threads;
    Monitor monitor;
    monitor.store = store;
    auto json = parse_json(plan_json(plan_problem(problem(), run, monitor)));
    const std::function<void(nlohmann::json&)> forget_seconds = [&](nlohmann::json& value) {
      if (value.is_object()) value.erase("seconds");
      for (auto& part : value)
        if (part.is_structured()) forget_seconds(part);
    };
    forget_seconds(json);
    return json.dump();
  };
  const std::string anew = plan(nullptr, 2);
  EXPECT_EQ(plan(&memory, 1), anew);
  EXPECT_EQ(memory.found, 1);
}

TEST_F(KeptCandidates, AreOfNoOtherProblem) {
  expect_another_draw(problem("clearance: 30 mm", "clearance: 31 mm"), "clearance");
  expect_another_draw(problem("visible: 2", "visible: 3"), "visibility");
  expect_another_draw(problem("acceptance: 30 deg", "acceptance: 29 deg"), "acceptance");
  expect_another_draw(problem("[3.6, -1.4, 0.5]", "[3.6, -1.3, 0.5]"), "station");
  expect_another_draw(problem("margin: 3 deg", "margin: 4 deg"), "margin");
  expect_another_draw(problem("at: [1.9, ", "at: [1.8, "), "place of an obstacle");
  expect_another_draw(problem("candidates: 150", "candidates: 151"), "number");
  expect_another_draw(problem(), "seed", 1);
}

TEST_F(KeptCandidates, AreOfNoOtherContentsOfAFile) {
  // As many bytes, and as old.
  const auto time = std::filesystem::last_write_time(folder / "block.stl");
  folder.write("block.stl", cube(0.6));
  std::filesystem::last_write_time(folder / "block.stl", time);
  expect_another_draw(problem(), "contents of a mesh");
}

TEST_F(KeptCandidates, AreOfNoProblemThatWasChangedInMemory) {
  Problem moved = problem();
  (*stations_of(moved.measurement))[0].placement.position.y() += 0.1;
  expect_another_draw(moved, "a station in memory");
  Problem wider = problem();
  wider.workspace.collision->clearance += 0.001;
  expect_another_draw(wider, "clearance in memory");
}

TEST_F(KeptCandidates, ServeOtherPlansInTheSameCell) {
  EXPECT_EQ(drawn(problem("poses: 14", "poses: 20"), &memory).values, first.values);
  EXPECT_EQ(drawn(problem("posewright: 1\n", "# a copy elsewhere\nposewright: 1\n"), &memory).values, first.values);
  const TemporaryFolder elsewhere;
  elsewhere.write("block.stl", cube(0.9));
  EXPECT_EQ(drawn(parse_problem(cell_text, elsewhere / "other.yaml"), &memory).values, first.values);
  EXPECT_GE(memory.found, 2);
}

TEST_F(KeptCandidates, AreNotKeptOfADrawThatWasStopped) {
  const Memory empty;
  std::atomic<bool> stop = false;
  Monitor monitor;
  monitor.store = &empty;
  monitor.interrupted = &stop;
  const Problem cell = problem();
  const posewright::Setup setup = resolve(cell, {}, monitor);
  stop = true;
  draw_candidates(setup, monitor);
  EXPECT_TRUE(empty.kept.empty());
}

TEST_F(KeptCandidates, ThatAreNoDrawAreDrawnAnew) {
  const auto [name, bytes] = *memory.kept.begin();
  for (const std::string& damaged :
       {std::string(), bytes.substr(0, bytes.size() / 2), bytes + "x", "\x05" + bytes.substr(1)}) {
    memory.kept[name] = damaged;
    EXPECT_EQ(drawn(problem(), &memory).values, first.values);
    EXPECT_EQ(memory.kept[name], bytes);
  }
}

// Without bodies and sights a draw is as quick as a start.
TEST(KeptCandidatesWithoutCell, AreNotKept) {
  const Memory memory;
  Monitor monitor;
  monitor.store = &memory;
  const Problem problem = read_problem(POSEWRIGHT_SOURCE_DIR "/examples/kr270/problem.yaml");
  draw_candidates(resolve(problem, {}, monitor), monitor);
  EXPECT_TRUE(memory.kept.empty());
}

}  // namespace
}  // namespace posewright
