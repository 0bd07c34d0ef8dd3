// The files in golden/ are what the program writes, byte for byte; commands.txt there names the words.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>

#include "posewright/support/file.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

const fs::path golden_folder = fs::path(POSEWRIGHT_SOURCE_DIR) / "tests/formats/golden";
const std::set<std::string> inputs = {
    "commands.txt", "pivot.yaml", "plan.json", "platform.json", "route.json", "route_one_station.json", "yaskawa.yaml"};

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) names.insert(fs::relative(entry.path(), folder).string());
  return names;
}

TEST(GoldenExports, AreWrittenAgainByteForByte) {
  const TemporaryFolder folder;
  for (const std::string& name : inputs) fs::copy_file(golden_folder / name, folder / name);
  std::istringstream lines(read_file(golden_folder / "commands.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream stream("export " + line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    const ProgramRun run = run_program(folder.path(), words);
    ASSERT_EQ(run.exit_code, 0) << line << "\n" << run.err;
  }
  EXPECT_EQ(files_in(folder.path()), files_in(golden_folder))
      << "every golden file is made by a command, and nothing else is";
  for (const std::string& name : files_in(golden_folder))
    EXPECT_EQ(read_file(folder / name), read_file(golden_folder / name)) << name;
}

}  // namespace
}  // namespace posewright
